#include "models.H"
#include "IFstream.H"
#include "OFstream.H"
#include "OSspecific.H"

#include <cmath>

namespace
{

const char* const lastWord = "complete";

bool given(const Foam::fvMesh& mesh, const Foam::word& name)
{
    return Foam::isFile(mesh.time().path()/mesh.time().constant()/name)
        || Foam::isFile(mesh.time().globalPath()/mesh.time().constant()/name);
}

// A field of cells, zero at first, that fvOptions find by its name.
Foam::volScalarField::Internal made
(
    const Foam::fvMesh& mesh,
    const Foam::word& name,
    const Foam::dimensionSet& dimensions
)
{
    using namespace Foam;
    return volScalarField::Internal
    (
        IOobject(name, mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::NO_WRITE),
        mesh,
        dimensionedScalar(name, dimensions, Zero)
    );
}

} // End anonymous namespace


Foam::calcine::models::models
(
    fvMesh& mesh,
    const volVectorField& U,
    const surfaceScalarField& phi,
    fluidThermo& thermo
)
:
    mesh_(mesh),
    density_
    (
        // Kept with the fields of the models: its values at inlets are those of the window committed last.
        IOobject
        (
            "epsRho", mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::AUTO_WRITE
        ),
        1*thermo.rho()
    ),
    eddyEnergy_(made(mesh, "eddyEnergy", sqr(dimVelocity)/dimTime)),
    eddyDissipation_(made(mesh, "eddyDissipation", sqr(dimVelocity/dimTime))),
    eddyGrowth_(made(mesh, "eddyGrowth", dimless/dimTime)),
    schmidt_(0.7)
{
    if (given(mesh, turbulenceModel::propertiesName))
    {
        const IOdictionary properties
        (
            IOobject
            (
                turbulenceModel::propertiesName, mesh.time().constant(), mesh,
                IOobject::MUST_READ, IOobject::NO_WRITE, false
            )
        );
        if (properties.get<word>("simulationType") != "laminar")
        {
            schmidt_ = properties.lookupOrDefault<scalar>("Sct", schmidt_);
            turbulence_ = compressible::turbulenceModel::New(density_, U, phi, thermo);
            turbulence_->validate();
        }
    }
    if (given(mesh, "radiationProperties"))
    {
        radiation_ = radiation::radiationModel::New(thermo.T());
    }
    for (const auto* field : mesh.lookupClass<volSymmTensorField>())
    {
        if (any() && field->writeOpt() == IOobject::AUTO_WRITE)
        {
            FatalErrorInFunction
                << "the turbulence model keeps the tensor field " << field->name()
                << ", which a checkpoint of calcineGasFoam does not hold; choose a model of "
                << "scalar fields" << exit(FatalError);
        }
    }
    // From now on OpenFOAM keeps the values of the time step before, in a resumed run as in one that goes on.
    density_.oldTime();
    const HashTable<volScalarField*> all(fields());
    forAllConstIters(all, field)
    {
        field.val()->oldTime();
    }
    store();
}


Foam::HashTable<Foam::volScalarField*> Foam::calcine::models::fields() const
{
    HashTable<volScalarField*> result;
    if (!any())
    {
        return result;
    }
    for (volScalarField* field : mesh_.lookupClass<volScalarField>())
    {
        // What OpenFOAM would write with a time, but for the gas' own.
        const bool own = field->name() == "T" || field->name() == "p";
        if (!own && field->writeOpt() == IOobject::AUTO_WRITE)
        {
            result.insert(field->name(), field);
        }
    }
    return result;
}


void Foam::calcine::models::store()
{
    const HashTable<volScalarField*> all(fields());
    for (const word& name : all.sortedToc())
    {
        const volScalarField& field = *all[name];
        List<scalarField>& kept = committed_(name);
        kept.setSize(1 + field.boundaryField().size());
        kept[0] = field.primitiveField();
        forAll(field.boundaryField(), patchi)
        {
            kept[1 + patchi] = field.boundaryField()[patchi];
        }
    }
}


Foam::tmp<Foam::volScalarField> Foam::calcine::models::eddyViscosity() const
{
    tmp<volScalarField> field(turbulence_->mut());
    // Between ranks the model's own is that of before the bed was taken out.
    field.ref().correctBoundaryConditions();
    return field;
}


Foam::tmp<Foam::volScalarField> Foam::calcine::models::eddyDiffusivity() const
{
    return turbulence_->alphat();
}


Foam::tmp<Foam::scalarField> Foam::calcine::models::mixingTime
(
    const scalarField& viscosity,
    const scalarField& density
) const
{
    if (!turbulent())
    {
        FatalErrorInFunction
            << "PaSR needs a turbulence model, and constant/turbulenceProperties has none"
            << exit(FatalError);
    }
    const scalarField eddies(turbulence_->nut()().primitiveField());
    const scalarField dissipation(turbulence_->epsilon()().primitiveField());
    // No eddies in a bed at which they end: what is there counts as mixed.
    return pos(eddies - VSMALL)*sqrt((viscosity/density + eddies)/(dissipation + SMALL));
}


void Foam::calcine::models::radiativeHeat
(
    const scalarField& T,
    scalarField& coefficient,
    scalarField& source
) const
{
    // Ru - Rp T^4, by its tangent.
    const tmp<volScalarField> Rp(radiation_->Rp());
    const tmp<volScalarField::Internal> Ru(radiation_->Ru());
    coefficient = 4*Rp().primitiveField()*pow3(T);
    source = Ru().field() + 3*Rp().primitiveField()*pow4(T);
}


void Foam::calcine::models::setDensity(const scalarField& density)
{
    density_.primitiveFieldRef() = density;
    density_.correctBoundaryConditions();
    if (!turbulent())
    {
        return;
    }
    // Its patches are calculated ones. What flows in at a velocity has the density that goes with its flux.
    const surfaceScalarField& flux = turbulence_->alphaRhoPhi();
    const volVectorField& velocity = turbulence_->U();
    forAll(density_.boundaryField(), patchi)
    {
        fvPatchScalarField& patch = density_.boundaryFieldRef()[patchi];
        if (patch.coupled())
        {
            continue;
        }
        patch == patch.patchInternalField();
        const fvPatchVectorField& u = velocity.boundaryField()[patchi];
        if (!u.fixesValue())
        {
            continue;
        }
        const scalarField volume(u & patch.patch().Sf());
        const scalarField& mass = flux.boundaryField()[patchi];
        forAll(patch, facei)
        {
            if (mass[facei] < 0 && volume[facei] < 0)
            {
                patch[facei] = mass[facei]/volume[facei];
            }
        }
    }
}


void Foam::calcine::models::begin()
{
    const HashTable<volScalarField*> all(fields());
    forAllConstIters(committed_, kept)
    {
        if (!all.found(kept.key()))
        {
            continue;
        }
        volScalarField& field = *all[kept.key()];
        field.primitiveFieldRef() = kept.val()[0];
        forAll(field.boundaryField(), patchi)
        {
            field.boundaryFieldRef()[patchi] == kept.val()[1 + patchi];
        }
    }
    if (radiates())
    {
        radiation_->correct();
    }
}


void Foam::calcine::models::place(const scalarField& density)
{
    if (turbulent())
    {
        setDensity(density);
        turbulence_->validate();
        store();
    }
}


void Foam::calcine::models::advance
(
    scalar motionSpan,
    const scalarField& density,
    const scalarField& outflow,
    const exchange& given
)
{
    if (turbulent())
    {
        if (given.eddyEnergy.size())
        {
            eddyEnergy_.field() = given.eddyEnergy;
            eddyDissipation_.field() = given.eddyDissipation;
            eddyGrowth_.field() = given.eddyGrowth;
        }
        Time& time = const_cast<Time&>(mesh_.time());
        const label count = parts(motionSpan);
        const scalar span = motionSpan/count;
        unsolved_ = 0;
        // As natively: what changes by less is steady, and the rest of the step changes nothing.
        scalar change = GREAT;
        for (label left = count; left > 0 && change > 1e-8; --left)
        {
            time.setDeltaT(span, false);
            ++time;
            setDensity(density + (left - 1)*span*outflow);
            density_.oldTime().primitiveFieldRef() = density + left*span*outflow;
            // What is recorded from here on is of turbulence alone.
            const_cast<dictionary&>(mesh_.solverPerformanceDict()).clear();
            const scalarField k(energy()), epsilon(dissipation());
            turbulence_->correct();
            const scalar worst = recorded();
            if (unsolved_ == unsolved_ && !(worst <= unsolved_))
            {
                unsolved_ = worst;
            }
            if (left > 1)
            {
                change = max(gMax(mag(energy()/k - 1)), gMax(mag(dissipation()/epsilon - 1)));
            }
        }
    }
    store();
}


Foam::label Foam::calcine::models::parts(scalar motionSpan) const
{
    const scalar destruction = turbulence_->coeffDict().lookupOrDefault<scalar>("C2", 1.92);
    scalar fastest = 0;
    forAll(eddyEnergy_, celli)
    {
        const scalar made = eddyEnergy_[celli];
        fastest = max
        (
            fastest,
            made > 0 ? eddyDissipation_[celli]/(destruction*made) : eddyGrowth_[celli]
        );
    }
    return max(label(1), label(std::ceil(motionSpan*returnReduce(fastest, maxOp<scalar>())/0.5)));
}


Foam::scalar Foam::calcine::models::recorded() const
{
    scalar worst = 0;
    const dictionary& record = mesh_.solverPerformanceDict();
    for (const word& name : record.toc())
    {
        const dictionary& controls = mesh_.solverDict(name);
        // Those that OpenFOAM takes where the dictionary has none.
        const scalar tolerance = controls.lookupOrDefault<scalar>("tolerance", 1e-6);
        const scalar relative = controls.lookupOrDefault<scalar>("relTol", 0);
        const List<SolverPerformance<scalar>> solves(record.lookup(name));
        for (const SolverPerformance<scalar>& solve : solves)
        {
            // A solve that ends at its limit does not check the last iteration. False for what is not a number.
            const scalar left = solve.finalResidual();
            const bool solved = left <= max(tolerance, relative*solve.initialResidual());
            if (!solved && worst == worst && !(left <= worst))
            {
                worst = left;
            }
        }
    }
    return worst;
}


void Foam::calcine::models::limitIterations(label iterations)
{
    for (const char* name : {"k", "epsilon"})
    {
        const_cast<dictionary&>(mesh_.solverDict(name)).set("maxIter", iterations);
    }
}


Foam::scalarField Foam::calcine::models::energy() const
{
    return turbulence_->k()().primitiveField();
}


Foam::scalarField Foam::calcine::models::dissipation() const
{
    return turbulence_->epsilon()().primitiveField();
}


Foam::scalarField Foam::calcine::models::viscosity() const
{
    return turbulence_->mut()().primitiveField();
}


Foam::fileName Foam::calcine::models::file(const fileName& directory)
{
    const fileName name(directory/"calcineModels");
    return Pstream::parRun() ? fileName(name + "." + Foam::name(Pstream::myProcNo())) : name;
}


void Foam::calcine::models::write(const fileName& directory) const
{
    if (!any())
    {
        return;
    }
    OFstream out(file(directory), IOstream::BINARY);
    out << committed_.size() << nl;
    for (const word& name : committed_.sortedToc())
    {
        out << name << nl << committed_[name].size() << nl;
        for (const scalarField& values : committed_[name])
        {
            out << values << nl;
        }
    }
    out << word(lastWord) << endl;
    if (!out.good())
    {
        FatalErrorInFunction
            << "the state of the models could not be written to " << out.name() << exit(FatalError);
    }
}


void Foam::calcine::models::read(const fileName& directory)
{
    if (!any())
    {
        return;
    }
    IFstream in(file(directory), IOstream::BINARY);
    if (!in.good())
    {
        FatalErrorInFunction
            << in.name() << ", the state of turbulence and radiation, is missing: the checkpoint is "
            << "of a run without these models, or of another number of ranks" << exit(FatalError);
    }
    committed_.clear();
    const label count = readLabel(in);
    for (label i = 0; i < count; ++i)
    {
        const word name(in);
        List<scalarField>& kept = committed_(name);
        kept.setSize(readLabel(in));
        for (scalarField& values : kept)
        {
            in >> values;
        }
    }
    if (word(in) != lastWord)
    {
        FatalErrorInFunction << in.name() << " is cut short" << exit(FatalError);
    }
    begin();
}
