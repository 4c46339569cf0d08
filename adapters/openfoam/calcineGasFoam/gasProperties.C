// What the gas is made of and how it transports, eddies included.
#include "gas.H"
#include "fvc.H"

Foam::wordList Foam::calcine::gas::speciesNames() const
{
    return species_ ? species_->mixture().names() : wordList();
}


Foam::scalarField Foam::calcine::gas::composition() const
{
    const label count = speciesNames().size();
    scalarField all(count*mesh_.nCells());
    for (label k = 0; k < count; ++k)
    {
        const scalarField& Y = species_->Y()[k].primitiveField();
        forAll(Y, celli)
        {
            all[celli*count + k] = Y[celli];
        }
    }
    return all;
}


Foam::tmp<Foam::volScalarField> Foam::calcine::gas::viscosity() const
{
    tmp<volScalarField> laminar(voidFraction_*thermo_->mu());
    return models_->turbulent() ? laminar + models_->eddyViscosity() : laminar;
}


Foam::tmp<Foam::volScalarField> Foam::calcine::gas::conductivity() const
{
    tmp<volScalarField> laminar(voidFraction_*thermo_->kappa());
    return models_->turbulent()
      ? laminar + thermo_->Cp()*models_->eddyDiffusivity()
      : laminar;
}


Foam::tmp<Foam::volScalarField> Foam::calcine::gas::diffusivity() const
{
    tmp<volScalarField> laminar(voidFraction_*thermo_->mu()/schmidt_);
    return models_->turbulent()
      ? laminar + models_->eddyViscosity()/models_->turbulentSchmidt()
      : laminar;
}


Foam::tmp<Foam::surfaceScalarField> Foam::calcine::gas::speciesDiffusion() const
{
    tmp<surfaceScalarField> faces(fvc::interpolate(diffusivity()));
    inflow_.seal(faces.ref());
    return faces;
}
