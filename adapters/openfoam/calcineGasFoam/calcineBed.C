#include "calcineBed.H"
#include "nutWallFunctionFvPatchScalarField.H"
#include "turbulentFluidThermoModel.H"
#include "addToRunTimeSelectionTable.H"
#include "fvc.H"

namespace Foam
{
namespace fv
{

defineTypeNameAndDebug(calcineBed, 0);
addToRunTimeSelectionTable(option, calcineBed, dictionary);

} // End namespace fv
} // End namespace Foam


Foam::fv::calcineBed::calcineBed
(
    const word& name,
    const word& modelType,
    const dictionary& dict,
    const fvMesh& mesh
)
:
    option(name, modelType, dict, mesh),
    maxSolidFraction_(dict.get<scalar>("maxSolidFraction")),
    eddies_(dict.getOrDefault<bool>("eddies", false))
{
    fieldNames_ = wordList({"k", "epsilon", "nut"});
    // That nut has no equation is no reason for a warning.
    applied_.setSize(fieldNames_.size(), true);
}


void Foam::fv::calcineBed::addSup
(
    const volScalarField& rho,
    fvMatrix<scalar>& eqn,
    const label fieldi
)
{
    const bool energy = fieldNames_[fieldi] == "k";
    if (eddies_)
    {
        const auto& model = mesh_.lookupObject<turbulenceModel>(turbulenceModel::propertiesName);
        const scalar destruction = model.coeffDict().lookupOrDefault<scalar>("C2", 1.92);
        addProduction(energy ? "eddyEnergy" : "eddyDissipation", energy ? 1 : destruction, rho, eqn);
    }
    else if (energy)
    {
        removeProductionOfEnergy(rho, eqn);
    }
    else
    {
        removeProductionOfDissipation(rho, eqn);
    }
}


void Foam::fv::calcineBed::addProduction
(
    const word& made,
    scalar times,
    const volScalarField& rho,
    fvMatrix<scalar>& eqn
) const
{
    const auto& source = mesh_.lookupObject<volScalarField::Internal>(made);
    const auto& growth = mesh_.lookupObject<volScalarField::Internal>("eddyGrowth");
    const scalarField& field = eqn.psi().primitiveField();
    // A matrix has what is made on its left side: minus.
    eqn.source() -=
        rho.primitiveField()*mesh_.V()*(source.field() + times*growth.field()*field);
}


// In the bed nut, and with it G, is zero but in cells at walls, where the wall function sets G.
void Foam::fv::calcineBed::removeProductionOfEnergy
(
    const volScalarField& rho,
    fvMatrix<scalar>& eqn
) const
{
    const auto& model = mesh_.lookupObject<turbulenceModel>(turbulenceModel::propertiesName);
    const auto& G = mesh_.lookupObject<volScalarField::Internal>(model.GName());
    const auto& voidFraction = mesh_.lookupObject<volScalarField>("voidFraction");
    forAll(voidFraction, celli)
    {
        if (holds(voidFraction[celli]))
        {
            // A matrix has what is made on its left side: minus.
            eqn.source()[celli] += rho[celli]*G[celli]*mesh_.V()[celli];
        }
    }
}


void Foam::fv::calcineBed::removeProductionOfDissipation
(
    const volScalarField& rho,
    fvMatrix<scalar>& eqn
) const
{
    const auto& model = mesh_.lookupObject<turbulenceModel>(turbulenceModel::propertiesName);
    const dictionary& coefficients = model.coeffDict();
    const scalar made = coefficients.lookupOrDefault<scalar>("C1", 1.44)
       *coefficients.lookupOrDefault<scalar>("Cmu", 0.09);
    const auto& voidFraction = mesh_.lookupObject<volScalarField>("voidFraction");
    const auto& k = mesh_.lookupObject<volScalarField>("k");
    const tmp<volTensorField> gradient(fvc::grad(model.U()));
    forAll(voidFraction, celli)
    {
        if (holds(voidFraction[celli]))
        {
            const tensor& slope = gradient()[celli];
            const scalar strain = slope && dev(twoSymm(slope));
            eqn.source()[celli] += rho[celli]*made*k[celli]*strain*mesh_.V()[celli];
        }
    }
}


void Foam::fv::calcineBed::correct(volScalarField& nut)
{
    // The model has k and epsilon corrected too, after each solve.
    if (nut.name() != "nut")
    {
        return;
    }
    const auto& voidFraction = mesh_.lookupObject<volScalarField>("voidFraction");
    forAll(nut, celli)
    {
        if (!eddies_ && holds(voidFraction[celli]))
        {
            nut[celli] = 0;
        }
    }
    forAll(nut.boundaryField(), patchi)
    {
        fvPatchScalarField& patch = nut.boundaryFieldRef()[patchi];
        const labelUList& cells = patch.patch().faceCells();
        // With eddies in the bed walls alone have none: they have no wall function there.
        if (patch.coupled() || (eddies_ && !isA<nutWallFunctionFvPatchScalarField>(patch)))
        {
            continue;
        }
        scalarField values(patch);
        forAll(values, i)
        {
            if (holds(voidFraction[cells[i]]))
            {
                values[i] = 0;
            }
        }
        patch == values;
    }
    exchange(nut);
}


// The model goes on with what is at the border between ranks: of the field as it is now.
void Foam::fv::calcineBed::exchange(volScalarField& field)
{
    auto& patches = field.boundaryFieldRef();
    const label requests = Pstream::nRequests();
    for (fvPatchScalarField& patch : patches)
    {
        if (patch.coupled())
        {
            patch.initEvaluate(Pstream::defaultCommsType);
        }
    }
    if (Pstream::parRun() && Pstream::defaultCommsType == Pstream::commsTypes::nonBlocking)
    {
        Pstream::waitRequests(requests);
    }
    for (fvPatchScalarField& patch : patches)
    {
        if (patch.coupled())
        {
            patch.evaluate(Pstream::defaultCommsType);
        }
    }
}
