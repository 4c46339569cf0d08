#include "stockGas.H"
#include "process.H"
#include "meshIdentity.H"
#include "fvc.H"
#include "IOdictionary.H"
#include "OFstream.H"
#include "OSspecific.H"
#include "Time.H"
#include "stringList.H"
#include "turbulentFluidThermoModel.H"
#include "uniformDimensionedFields.H"

namespace Foam
{
namespace calcine
{

defineTypeNameAndDebug(stockGas, 0);

} // End namespace calcine
} // End namespace Foam

namespace
{

const Foam::scalar ticksPerSecond = 1e12;

} // End anonymous namespace


Foam::calcine::stockGas& Foam::calcine::stockGas::New(const fvMesh& mesh)
{
    stockGas* gas = mesh.objectRegistry::getObjectPtr<stockGas>(typeName);
    if (!gas)
    {
        gas = new stockGas(mesh);
        regIOobject::store(gas);
        gas->send(CALCINE_STATE, false);
        gas->serve();
    }
    return *gas;
}


Foam::calcine::stockGas::stockGas(const fvMesh& mesh)
:
    regIOobject(IOobject(typeName, mesh.time().timeName(), mesh)),
    mesh_(mesh),
    link_(0),
    thermo_(mesh.lookupObject<fluidThermo>(basicThermo::dictName)),
    U_(mesh.lookupObject<volVectorField>("U")),
    voidFraction_(mesh.nCells(), 1),
    dragCoefficient_(mesh.nCells(), Zero),
    heatCoefficient_(mesh.nCells(), Zero),
    heatSource_(mesh.nCells(), Zero),
    dragSource_(mesh.nCells(), Zero),
    span_(mesh.time().deltaTValue()),
    reference_(0)
{
    if (Pstream::parRun())
    {
        FatalErrorInFunction
            << "calcineSource couples a stock solver on one rank only" << exit(FatalError);
    }
    const addressing numbers(mesh);
    compareCells(mesh, numbers);
    const IOdictionary properties
    (
        IOobject
        (
            "calcineGas", mesh.time().constant(), mesh,
            IOobject::MUST_READ, IOobject::NO_WRITE, false
        )
    );
    const scalarField one(1, 298.15), pressure(1, thermo_.p()[0]);
    reference_ = thermo_.he(pressure, one, labelList(1, 0))()[0];
    link_.greet(introduce(properties, mesh, numbers));
    link_.claim(numbers.cells);
    remember();
}


Foam::Time& Foam::calcine::stockGas::time() const
{
    return const_cast<Time&>(mesh_.time());
}


Foam::scalarField Foam::calcine::stockGas::enthalpy() const
{
    return thermo_.he().primitiveField() - reference_;
}


Foam::scalarField Foam::calcine::stockGas::heat() const
{
    return heatSource_ - heatCoefficient_*(heatBase_ + thermo_.he().primitiveField()/heatCapacity_);
}


void Foam::calcine::stockGas::remember()
{
    heatCapacity_ = thermo_.Cp()().primitiveField();
    heatBase_ = thermo_.T().primitiveField() - thermo_.he().primitiveField()/heatCapacity_;
    oldDensity_ = mesh_.lookupObject<volScalarField>("rho").primitiveField();
    oldEnthalpy_ = enthalpy();
    oldPressure_ = thermo_.p().primitiveField();
    oldVelocity_ = U_.primitiveField();
}


void Foam::calcine::stockGas::take(const calcine_header& header)
{
    const scalar motion = scalar(header.span_motion)/ticksPerSecond;
    const scalar storage = scalar(header.storage_span)/ticksPerSecond;
    if (header.attempt > 0 || mag(motion - storage) > 1e-9*motion)
    {
        FatalErrorInFunction
            << "a stock solver makes one attempt at a window (asked: " << label(header.attempt + 1)
            << ") and stores over its own time step of " << motion << " s (asked: " << storage
            << " s)" << exit(FatalError);
    }
    link_.get("void_fraction", voidFraction_);
    link_.get("drag_coefficient", dragCoefficient_);
    link_.get("drag_source", dragSource_);
    link_.get("heat_coefficient", heatCoefficient_);
    link_.get("heat_source", heatSource_);
    span_ = motion;
    time().setDeltaT(motion, false);
    remember();
}


void Foam::calcine::stockGas::serve()
{
    try
    {
        for (;;)
        {
            const calcine_header header = link_.receive();
            switch (header.kind)
            {
                case CALCINE_START:
                    take(header);
                    return;
                case CALCINE_COMMIT:
                    break;
                case CALCINE_CHECKPOINT:
                    write(link_.text());
                    send(CALCINE_CHECKPOINTED, false);
                    break;
                case CALCINE_BYE:
                    link_.loan(CALCINE_BYE, 0);
                    link_.send();
                    time().setEndTime(time().value());
                    return;
                default:
                    FatalErrorInFunction
                        << "a request of kind " << label(header.kind) << " arrived, which a gas "
                        << "does not serve" << exit(FatalError);
            }
        }
    }
    catch (const linkError& what)
    {
        FatalErrorInFunction << what.what() << exit(FatalError);
    }
}


void Foam::calcine::stockGas::stepped()
{
    send(CALCINE_FINISHED, true);
    serve();
}


void Foam::calcine::stockGas::write(const fileName& directory) const
{
    mkDir(directory);
    for (const word& name : {word("T"), word("p"), word("p_rgh")})
    {
        if (const auto* field = mesh_.findObject<volScalarField>(name))
        {
            OFstream file(directory/name, IOstream::BINARY);
            field->writeHeader(file);
            field->writeData(file);
        }
    }
    OFstream file(directory/"U", IOstream::BINARY);
    U_.writeHeader(file);
    U_.writeData(file);
}


Foam::DynamicList<Foam::scalar> Foam::calcine::stockGas::balances() const
{
    const scalarField& V = mesh_.V();
    const scalarField& rho = mesh_.lookupObject<volScalarField>("rho").primitiveField();
    const surfaceScalarField& phi = mesh_.lookupObject<surfaceScalarField>("phi");
    const volScalarField& h = thermo_.he();
    const vectorField& U = U_.primitiveField();
    const vector gravity =
        mesh_.foundObject<uniformDimensionedVectorField>("g")
      ? mesh_.lookupObject<uniformDimensionedVectorField>("g").value() : vector(Zero);

    const scalarField mass((rho - oldDensity_)*V);
    const scalarField energy((rho*enthalpy() - oldDensity_*oldEnthalpy_)*V);
    const vectorField momentum((rho*U - oldDensity_*oldVelocity_)*V);
    const vectorField drag
    (
        (dragSource_ - dragCoefficient_*U/voidFraction_)/voidFraction_
    );
    const vectorField push
    (
        (rho*gravity - fvc::grad(thermo_.p())().primitiveField())*V*span_
    );
    const scalarField work
    (
        (thermo_.p().primitiveField() - oldPressure_)*V
      - 0.5*(rho*magSqr(U) - oldDensity_*magSqr(oldVelocity_))*V
      + span_*rho*(U & gravity)*V
    );
    scalar massIn = 0, massMagnitude = 0, energyIn = 0, energyMagnitude = 0;
    vector momentumIn(Zero), momentumMagnitude(Zero);
    // Of conduction and friction what the solver's own model has at the boundary.
    const auto* model =
        mesh_.findObject<compressible::turbulenceModel>(turbulenceModel::propertiesName);
    const tmp<volScalarField> alpha(model ? model->alphaEff() : thermo_.alphahe());
    const tmp<volScalarField> mu(model ? model->muEff() : thermo_.mu());
    forAll(mesh_.boundary(), patchi)
    {
        const scalarField& out = phi.boundaryField()[patchi];
        const fvPatch& patch = mesh_.boundary()[patchi];
        const scalarField conducted
        (
            alpha().boundaryField()[patchi]*h.boundaryField()[patchi].snGrad()*patch.magSf()
        );
        const scalarField carried
        (
            conducted
          - out*(h.boundaryField()[patchi] - reference_ + 0.5*magSqr(U_.boundaryField()[patchi]))
        );
        const vectorField stress
        (
            mu().boundaryField()[patchi]*U_.boundaryField()[patchi].snGrad()*patch.magSf()
          - out*U_.boundaryField()[patchi]
        );
        massIn -= span_*gSum(out);
        massMagnitude += span_*gSumMag(out);
        energyIn += span_*gSum(carried);
        energyMagnitude += span_*gSumMag(carried);
        momentumIn += span_*gSum(stress);
        momentumMagnitude += span_*gSumCmptMag(stress);
    }
    DynamicList<scalar> list(35);
    list.append({gSum(mass), gSumMag(mass), massIn, massMagnitude, 0, 0, 0});
    list.append
    (
        {
            gSum(energy), gSumMag(energy), energyIn, energyMagnitude, span_*gSum(heat()),
            gSum(work), gSumMag(work)
        }
    );
    for (direction axis = 0; axis < 3; ++axis)
    {
        const scalarField stored(momentum.component(axis)), source(push.component(axis));
        list.append
        (
            {
                gSum(stored), gSumMag(stored), momentumIn[axis], momentumMagnitude[axis],
                span_*gSum(drag.component(axis)()), gSum(source), gSumMag(source)
            }
        );
    }
    return list;
}


void Foam::calcine::stockGas::send(calcine_kind kind, bool stepped)
{
    const label cells = mesh_.nCells();
    const vectorField& U = U_.primitiveField();
    const scalarField& rho = mesh_.lookupObject<volScalarField>("rho").primitiveField();
    link_.loan(kind, cells);
    link_.put("heat", stepped ? heat() : scalarField(cells, Zero));
    link_.put
    (
        "drag",
        stepped ? vectorField(dragSource_ - dragCoefficient_*U/voidFraction_)
      : vectorField(cells, Zero)
    );
    link_.put("temperature", thermo_.T().primitiveField());
    link_.put("pressure", thermo_.p().primitiveField());
    link_.put("density", rho);
    link_.put("velocity", vectorField(U/voidFraction_));
    link_.put("pressure_gradient", fvc::grad(thermo_.p())().primitiveField());
    const DynamicList<scalar> sums
    (
        stepped ? balances() : DynamicList<scalar>(List<scalar>(35, Zero))
    );
    link_.put("balances", sums);
    // Stock solvers store over the motion span alone.
    link_.put("storage_clock", scalarList(3, Zero));
    // Of the energy balance, what the step left open; the solver's own loops have no other measure.
    const scalar scale = sums[8] + sums[10] + mag(sums[11]) + sums[13];
    const scalar open = mag(sums[7] - sums[9] - sums[11] - sums[12]);
    const tmp<volScalarField> model(thermo_.rho());
    const scalarList convergence
    {
        scalar(stepped), 0, scale > 0 ? open/scale : 0,
        gMax(mag(rho - model().primitiveField())/rho), scalar(stepped)
    };
    link_.put("convergence", convergence);
    link_.send();
}


void Foam::calcine::stockGas::addDrag(fvMatrix<vector>& momentum) const
{
    // A matrix on the right-hand side: its diagonal is minus the resistance.
    momentum.diag() -= dragCoefficient_/sqr(voidFraction_);
    momentum.source() -= dragSource_/voidFraction_;
}


void Foam::calcine::stockGas::addHeat(fvMatrix<scalar>& enthalpy)
{
    heatCapacity_ = thermo_.Cp()().primitiveField();
    heatBase_ = thermo_.T().primitiveField() - thermo_.he().primitiveField()/heatCapacity_;
    enthalpy.diag() -= heatCoefficient_/heatCapacity_;
    enthalpy.source() -= heatSource_ - heatCoefficient_*heatBase_;
}
