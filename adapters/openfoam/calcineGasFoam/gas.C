#include "gas.H"
#include "clockValue.H"
#include "link.H"
#include "obliqueSchemes.H"
#include "OStringStream.H"
#include "wedgePolyPatch.H"

#include <cmath>

namespace
{

using namespace Foam;

// 0/p as it stands: absolute.
tmp<volScalarField> readPressure(const fvMesh& mesh)
{
    const IOobject file
    (
        "p", mesh.time().timeName(), mesh, IOobject::MUST_READ, IOobject::NO_WRITE, false
    );
    return tmp<volScalarField>::New(file, mesh);
}

// The pressure above pRef: fixed where 0/p is, otherwise extrapolated by pEqn.C.
volScalarField relativePressure(const fvMesh& mesh, scalar pRef)
{
    const volScalarField absolute(readPressure(mesh));
    wordList types(mesh.boundary().size(), "zeroGradient");
    forAll(types, patchi)
    {
        const fvPatchScalarField& patch = absolute.boundaryField()[patchi];
        if (fvPatch::constraintType(patch.patch().type()))
        {
            types[patchi] = patch.patch().type();
        }
        else if (patch.fixesValue())
        {
            types[patchi] = "fixedValue";
        }
    }
    volScalarField relative
    (
        IOobject("pAboveRef", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimPressure, Zero),
        types
    );
    relative.primitiveFieldRef() = absolute.primitiveField() - pRef;
    forAll(types, patchi)
    {
        if (types[patchi] == "fixedValue")
        {
            relative.boundaryFieldRef()[patchi] == absolute.boundaryField()[patchi] - pRef;
        }
    }
    return relative;
}

// Enthalpy is what the equation of hEqn.C balances; an internal energy would need pressure work.
autoPtr<fluidThermo> readThermo(const fvMesh& mesh)
{
    autoPtr<fluidThermo> thermo
    (
        calcine::speciesThermo::wanted(mesh)
      ? autoPtr<fluidThermo>(new calcine::speciesThermo(mesh))
      : fluidThermo::New(mesh)
    );
    thermo->validate("calcineGasFoam", "h");
    return thermo;
}

} // End anonymous namespace


Foam::calcine::gas::gas
(
    fvMesh& mesh,
    const dictionary& properties,
    const addressing& numbers
)
:
    mesh_(mesh),
    numbers_(numbers),
    shared_(mesh),
    firstCell_(numbers.local(0)),
    pRef_(properties.get<scalar>("pRef")),
    gravity_(properties.get<vector>("gravity")),
    meanGradient_(properties.lookupOrDefault<vector>("pressureGradient", Zero)),
    modelPressure_
    (
        IOobject("p", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar("p", dimPressure, pRef_)
    ),
    thermo_(readThermo(mesh)),
    species_(dynamic_cast<speciesThermo*>(thermo_.get())),
    voidFraction_
    (
        IOobject("voidFraction", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar("voidFraction", dimless, 1),
        "zeroGradient"
    ),
    U_
    (
        IOobject("U", mesh.time().timeName(), mesh, IOobject::MUST_READ, IOobject::NO_WRITE),
        mesh
    ),
    p_(relativePressure(mesh, pRef_)),
    phi_
    (
        IOobject("phi", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimMass/dimTime, Zero)
    ),
    pressureGradient_(mesh.nCells(), Zero),
    pressureAlong_(mesh.nCells(), Zero),
    mass_(mesh.nCells(), Zero),
    flux_(mesh.nFaces(), Zero),
    boundary_(properties.subDict("patches"), U_, p_),
    momentumSolver_(mesh, "U"),
    pressureSolver_(mesh, "p"),
    enthalpySolver_(mesh, "h"),
    takesAllPressure_(properties.getOrDefault<word>("momentumModel", "a") == "b"),
    schmidt_(properties.lookupOrDefault<scalar>("schmidt", 1)),
    sendsEddies_(properties.lookupOrDefault<bool>("sendsEddies", false)),
    tellsBackflow_(properties.lookupOrDefault<bool>("tellsBackflow", false)),
    startVelocity_(U_.primitiveField())
{
    const dictionary& controls = properties.subDict("controls");
    outer_.iterations = controls.get<label>("outerIterations");
    outer_.corrections = controls.get<label>("pressureCorrections");
    outer_.mostCorrections = controls.get<label>("mostPressureCorrections");
    outer_.tolerance = controls.get<scalar>("outerTolerance");
    linearTolerance_ = controls.get<scalar>("linearTolerance");
    twoStages_ = controls.lookupOrDefault<bool>("twoStages", false);
    measureFaces();
    models_.reset(new models(mesh, U_, phi_, *thermo_));
    if (properties.found("turbulenceIterations"))
    {
        models_->limitIterations(properties.get<label>("turbulenceIterations"));
    }
    if (species_ && reactions::wanted(mesh))
    {
        reactions_.reset(new reactions(mesh, thermo_->T(), species_->mixture()));
    }

    const scalarField reference(1, 298.15);
    referenceEnthalpy_ = thermo_->he(scalarField(1, pRef_), reference, labelList(1, 0))()[0];

    // Balances ask for what corrections of oblique lines carry through the boundary.
    mesh.setFluxRequired(U_.name());
    mesh.setFluxRequired(thermo_->T().name());
    if (species_)
    {
        speciesSolver_.reset(new linear(mesh, "Yi"));
        committed_.composition.setSize(species_->Y().size());
        forAll(species_->Y(), k)
        {
            mesh.setFluxRequired(species_->Y()[k].name());
            committed_.composition[k] = species_->Y()[k].primitiveField();
        }
    }
    committed_.mass = mass_;
    committed_.enthalpy = thermo_->he().primitiveField();
    committed_.temperature = thermo_->T().primitiveField();
    committed_.density = density();
    committed_.velocity = startVelocity_;
    committed_.pressure = p_.primitiveField();
    committed_.basePressure = pRef_;
    committed_.pressureGradient = pressureGradient_;
    committed_.flux = flux_;
    committed_.voidFraction = voidFraction_.primitiveField();
}


void Foam::calcine::gas::measureFaces()
{
    const label faces = mesh_.nFaces();
    const vectorField beyond(shared_.pointsBeyond(mesh_.cellCentres()));
    ownerDistance_.setSize(faces);
    neighbourDistance_.setSize(faces, 0);
    normal_.setSize(faces);
    ownerSkew_.setSize(faces);
    neighbourSkew_.setSize(faces, Zero);
    conductance_.setSize(faces, 0);
    drive_.setSize(faces, 0);
    openingSlope_.setSize(faces, 0);
    transportPush_.setSize(faces, 0);
    recovery_ = tensorField(mesh_.nCells(), Zero);
    warp_ = tensorField(mesh_.nCells(), Zero);
    turns_ = boolList(faces, false);
    // Normal of the middle plane of a wedge's cells: nothing is recovered along it.
    vectorField between(mesh_.nCells(), Zero);
    for (const polyPatch& patch : mesh_.boundaryMesh())
    {
        if (!isA<wedgePolyPatch>(patch))
        {
            continue;
        }
        forAll(patch, i)
        {
            turns_[patch.start() + i] = true;
            vector& sum = between[patch.faceCells()[i]];
            const vector n = normalised(mesh_.faceAreas()[patch.start() + i]);
            sum = mag(sum) > 0 ? vector(normalised(sum - n)) : n;
        }
    }
    for (label facei = 0; facei < faces; ++facei)
    {
        const vector& centre = mesh_.faceCentres()[facei];
        const vector& n = normal_[facei] = normalised(mesh_.faceAreas()[facei]);
        const vector fromOwner = centre - mesh_.cellCentres()[mesh_.faceOwner()[facei]];
        ownerDistance_[facei] = n & fromOwner;
        ownerSkew_[facei] = limitedSkew(fromOwner - ownerDistance_[facei]*n, ownerDistance_[facei]);
        if (shared_.within(facei))
        {
            const vector toNeighbour = beyond[facei] - centre;
            neighbourDistance_[facei] = n & toNeighbour;
            neighbourSkew_[facei] =
                limitedSkew(toNeighbour - neighbourDistance_[facei]*n, neighbourDistance_[facei]);
        }
        const vector& area = mesh_.faceAreas()[facei];
        warp_[mesh_.faceOwner()[facei]] -= area*fromOwner;
        if (facei < mesh_.nInternalFaces())
        {
            const label N = mesh_.faceNeighbour()[facei];
            warp_[N] += area*(centre - mesh_.cellCentres()[N]);
            recovery_[mesh_.faceNeighbour()[facei]] +=
                neighbourDistance_[facei]*mag(mesh_.faceAreas()[facei])*n*n;
        }
        if (!turns_[facei])
        {
            recovery_[mesh_.faceOwner()[facei]] +=
                ownerDistance_[facei]*mag(mesh_.faceAreas()[facei])*n*n;
        }
    }
    for (label facei = 0; facei < faces; ++facei)
    {
        const scalar skew = max(mag(ownerSkew_[facei]), mag(neighbourSkew_[facei]));
        oblique_ = oblique_ || skew > 1e-9*(ownerDistance_[facei] + neighbourDistance_[facei]);
    }
    reduce(oblique_, orOp<bool>());
    massGradient_ = tensorField(mesh_.nCells(), Zero);
    oldMassGradient_ = massGradient_;
    forAll(recovery_, celli)
    {
        recovery_[celli] =
            inv(recovery_[celli]/mesh_.cellVolumes()[celli] + between[celli]*between[celli]);
        warp_[celli] = tensor(I) + warp_[celli]/mesh_.cellVolumes()[celli];
    }
}


void Foam::calcine::gas::place()
{
    committed_.placed = true;
    committed_.voidFraction = given_.voidFraction;
    committed_.velocity = startVelocity_/given_.voidFraction;
    const scalarField rho(density());
    committed_.mass = rho*given_.voidFraction*mesh_.cellVolumes();
    const vectorField beyond(shared_.beyond(vectorField(rho*startVelocity_)));
    for (label facei = 0; facei < mesh_.nFaces(); ++facei)
    {
        const label owner = mesh_.faceOwner()[facei];
        if (facei < mesh_.nInternalFaces())
        {
            const label neighbour = mesh_.faceNeighbour()[facei];
            const scalar weight = ownerWeight(facei);
            const vector massVelocity =
                weight*rho[owner]*startVelocity_[owner]
              + (1 - weight)*rho[neighbour]*startVelocity_[neighbour];
            committed_.flux[facei] = massVelocity & mesh_.faceAreas()[facei];
            continue;
        }
        if (shared_.within(facei))
        {
            const scalar weight = ownerWeight(facei);
            const vector massVelocity =
                weight*rho[owner]*startVelocity_[owner] + (1 - weight)*beyond[facei];
            committed_.flux[facei] = massVelocity & mesh_.faceAreas()[facei];
            continue;
        }
        const label patchi = mesh_.boundaryMesh().whichPatch(facei);
        committed_.flux[facei] =
            boundary_.of(patchi) == passage::closed
          ? 0 : rho[owner]*(startVelocity_[owner] & mesh_.faceAreas()[facei]);
    }
    if (startFlux_.size())
    {
        committed_.flux = startFlux_;
    }
    shared_.agree(committed_.flux);
}


void Foam::calcine::gas::restore()
{
    thermo_->he().primitiveFieldRef() = committed_.enthalpy;
    thermo_->T().primitiveFieldRef() = committed_.temperature;
    forAll(committed_.composition, k)
    {
        species_->Y()[k].primitiveFieldRef() = committed_.composition[k];
        species_->Y()[k].correctBoundaryConditions();
    }
    U_.primitiveFieldRef() = committed_.velocity;
    p_.primitiveFieldRef() = committed_.pressure;
    p_.correctBoundaryConditions();
    modelPressure_ == dimensionedScalar("p", dimPressure, committed_.basePressure);
    pressureGradient_ = committed_.pressureGradient;
    pressureAlong_ = committed_.pressureGradient;
    mass_ = committed_.mass;
    flux_ = committed_.flux;
}


void Foam::calcine::gas::setFlux()
{
    const label internal = mesh_.nInternalFaces();
    phi_.primitiveFieldRef() = SubList<scalar>(flux_, internal);
    forAll(phi_.boundaryField(), patchi)
    {
        fvsPatchScalarField& patch = phi_.boundaryFieldRef()[patchi];
        patch == scalarField(SubList<scalar>(flux_, patch.size(), patch.patch().start()));
    }
}


Foam::scalarField Foam::calcine::gas::outflow() const
{
    scalarField sum(mesh_.nCells(), Zero);
    forAll(flux_, facei)
    {
        sum[mesh_.faceOwner()[facei]] += flux_[facei];
        if (facei < mesh_.nInternalFaces())
        {
            sum[mesh_.faceNeighbour()[facei]] -= flux_[facei];
        }
    }
    return sum;
}


Foam::scalarField Foam::calcine::gas::massSource() const
{
    scalarField sum(mesh_.nCells(), Zero);
    forAll(given_.speciesSource, k)
    {
        const scalarField& Y = species_->Y()[k].primitiveField();
        sum += given_.speciesSource[k] - given_.speciesCoefficient[k]*Y;
    }
    return sum;
}


Foam::scalarField Foam::calcine::gas::density() const
{
    return thermo_->rho()().primitiveField();
}


Foam::scalar Foam::calcine::gas::basePressure() const
{
    return mesh_.nCells() ? modelPressure_[0] : pRef_;
}


void Foam::calcine::gas::updateBasePressure()
{
    // psi is the derivative of the density by the pressure: zero where it is constant.
    const scalarField& psi = thermo_->psi().primitiveField();
    const scalar atOnePascal = gSum(psi*given_.voidFraction*mesh_.cellVolumes());
    if (!boundary_.closed() || !(atOnePascal > 0))
    {
        return;
    }
    const scalar held = gSum(committed_.mass)
      + window_.storageSpan*(gSum(massSource()) - boundaryOutflow());
    modelPressure_ == dimensionedScalar("p", dimPressure, held/atOnePascal);
    updateProperties();
}


Foam::scalar Foam::calcine::gas::boundaryOutflow() const
{
    scalar sum = 0;
    for (label facei = mesh_.nInternalFaces(); facei < mesh_.nFaces(); ++facei)
    {
        sum += shared_.within(facei) ? 0 : flux_[facei];
    }
    return returnReduce(sum, sumOp<scalar>());
}


Foam::scalarField Foam::calcine::gas::wantedOutflow(const scalarField& density) const
{
    return massSource()
      + (committed_.mass - given_.voidFraction*density*mesh_.cellVolumes())/window_.storageSpan;
}


void Foam::calcine::gas::resume(const fileName& directory)
{
    committed_.read(directory, numbers_, speciesNames().size());
    restore();
    thermo_->he().correctBoundaryConditions();
    thermo_->correct();
    models_->read(directory);
    resumed_ = true;
}


void Foam::calcine::gas::takeOver(const fileName& directory)
{
    resume(directory);
    if (committed_.placed)
    {
        startVelocity_ = committed_.velocity*committed_.voidFraction;
        startFlux_ = committed_.flux;
    }
    else
    {
        startVelocity_ = committed_.velocity;
    }
    if (!boundary_.closed())
    {
        committed_.pressure += committed_.basePressure - pRef_;
        committed_.basePressure = pRef_;
    }
    committed_.placed = false;
    thermo_->T().primitiveFieldRef() = committed_.temperature;
    committed_.enthalpy = thermo_->he(modelPressure_, thermo_->T())().primitiveField();
    restore();
    thermo_->he().correctBoundaryConditions();
    thermo_->correct();
    resumed_ = false;
}


void Foam::calcine::gas::attempt(const window& when, const exchange& given, report& result)
{
    const clockValue begun(true);
    reactionTime_ = 0;
    resumed_ = false;
    given_ = given;
    restore();
    // Reactions are split from transport, and particles follow the fractions at the window's end: both are first order anyhow.
    const bool reacts = reactions_ || particlesExchangeGas();
    if (twoStages_ && when.motionSpan == when.storageSpan && !reacts)
    {
        attemptTwoStages(when, given.voidFraction, result);
    }
    else
    {
        beginStage(when, given.voidFraction);
        step(result);
    }
    result.wallTime = begun.elapsed();
    result.reactionTime = reactionTime_;
}


void Foam::calcine::gas::commit()
{
    committed_.placed = true;
    committed_.mass = mass_;
    committed_.enthalpy = thermo_->he().primitiveField();
    committed_.temperature = thermo_->T().primitiveField();
    committed_.density = density();
    forAll(committed_.composition, k)
    {
        committed_.composition[k] = species_->Y()[k].primitiveField();
    }
    committed_.velocity = U_.primitiveField();
    committed_.pressure = p_.primitiveField();
    committed_.basePressure = basePressure();
    committed_.pressureGradient = pressureGradient_;
    committed_.flux = flux_;
    committed_.voidFraction = given_.voidFraction;
    models_->advance
    (
        window_.motionSpan, committed_.voidFraction*density(), outflow()/mesh_.cellVolumes(), given_
    );
}


void Foam::calcine::gas::checkpoint(const fileName& directory)
{
    committed_.write(directory, numbers_);
    models_->write(directory);
    resume(directory);
}


void Foam::calcine::gas::guard(bool early) const
{
    const scalarField& h = thermo_->he().primitiveField();
    forAll(mass_, celli)
    {
        const scalar T = temperatureBase_[celli] + h[celli]/heatCapacity_[celli];
        const scalar speed = mag(U_[celli]);
        // Each comparison is false for what is not a number.
        // An early iterate may give more gas than a cell holds; the last one must not.
        const bool held = mass_[celli] > 0 || (early && mag(mass_[celli]) < GREAT);
        if (T > 0 && T < 1e4 && speed < 1e4 && mag(p_[celli]) < GREAT && held)
        {
            continue;
        }
        OStringStream text;
        text<< "diverged: temperature " << T << " K, speed " << speed
            << " m/s, pressure above the reference " << p_[celli] << " Pa, gas mass "
            << mass_[celli] << " kg in cell " << numbers_.cells[celli] << " at "
            << mesh_.cellCentres()[celli] << " m";
        const bool finite = std::isfinite(T + speed + p_[celli] + mass_[celli]);
        throw solverFailure
        (
            finite ? CALCINE_FAILURE_DIVERGED : CALCINE_FAILURE_NOT_FINITE, text.str()
        );
    }
}


const Foam::scalarField& Foam::calcine::gas::temperature() const
{
    return resumed_ ? committed_.temperature : thermo_->T().primitiveField();
}


Foam::scalarField Foam::calcine::gas::absolutePressure() const
{
    return basePressure() + p_.primitiveField();
}


Foam::scalarField Foam::calcine::gas::gasDensity() const
{
    return resumed_ ? committed_.density : density();
}


const Foam::vectorField& Foam::calcine::gas::velocity() const
{
    return U_.primitiveField();
}


Foam::vectorField Foam::calcine::gas::pressureGradient() const
{
    return pressureGradient_ + meanGradient_;
}
