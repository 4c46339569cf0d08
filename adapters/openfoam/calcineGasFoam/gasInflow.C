// What comes in through patches whose gas is stated, and what comes back in where it is not (inflow.H).
#include "gas.H"

void Foam::calcine::gas::updateInflow()
{
    inflow_.clear();
    const wordList names(speciesNames());
    const volScalarField spread(species_ ? diffusivity() : viscosity()), conducted(conductivity());
    const volScalarField capacity(thermo_->Cp());
    for (statedGas& stated : boundary_.stated(window_.processEnd, pRef_, names))
    {
        const label patchi = stated.patch;
        if (!mesh_.boundary()[patchi].size())
        {
            continue;
        }
        const scalarField T(1, stated.temperature), p(1, pRef_);
        if (species_)
        {
            const gasMixture& mixture = species_->mixture();
            stated.enthalpy = mixture.enthalpy(stated.temperature, stated.fractions);
            stated.density = pRef_*mixture.compressibility(stated.temperature, stated.fractions);
        }
        else
        {
            // An ideal gas, or one of constant density.
            const scalar psi = thermo_->psi()[0];
            stated.enthalpy = thermo_->he(p, T, labelList(1, 0))()[0];
            stated.density = psi > 0
              ? pRef_*psi*thermo_->T()[0]/stated.temperature
              : density()[0];
        }
        inflow_.add
        (
            mesh_.boundary()[patchi],
            std::move(stated),
            spread.boundaryField()[patchi],
            conducted.boundaryField()[patchi],
            capacity.boundaryField()[patchi]
        );
    }
    inflow_.mix(thermo_->T(), species_ ? &species_->Y() : nullptr);
    thermo_->he().correctBoundaryConditions();
}


void Foam::calcine::gas::updateProperties()
{
    PtrList<volScalarField>* Y = species_ ? &species_->Y() : nullptr;
    inflow_.state(thermo_->T(), Y);
    thermo_->correct();
    inflow_.mix(thermo_->T(), Y);
    thermo_->he().correctBoundaryConditions();
}


// How far the pressures at openings, linear in the flux, are from those at the flux at hand, as a flow in kg/s; and takes
// the new ones.
Foam::scalar Foam::calcine::gas::updateOpenings()
{
    scalar missed = 0;
    for (const fvPatch& patch : mesh_.boundary())
    {
        const statedGas* opening = inflow_.surroundings(patch.index());
        if (!opening)
        {
            continue;
        }
        fvPatchScalarField& pressures = p_.boundaryFieldRef()[patch.index()];
        forAll(patch, i)
        {
            const label facei = patch.start() + i;
            const scalar area = mag(mesh_.faceAreas()[facei]);
            const outerPressure beyond = inflow::pressure
            (
                *opening,
                mesh_.faceCentres()[facei],
                gravity_,
                given_.voidFraction[patch.faceCells()[i]]*area,
                flux_[facei]
            );
            const scalar before = pressures[i] + openingSlope_[facei]*flux_[facei];
            missed += conductance_[facei]*mag(before - beyond.pressure - beyond.slope*flux_[facei]);
            pressures[i] = beyond.pressure;
            openingSlope_[facei] = beyond.slope;
        }
    }
    return returnReduce(missed, sumOp<scalar>());
}


Foam::scalarList Foam::calcine::gas::backflow() const
{
    scalarList found(3, scalar(0));
    const scalarField rho(density());
    for (const fvPatch& patch : mesh_.boundary())
    {
        if (boundary_.of(patch.index()) != passage::open || inflow_.has(patch.index()))
        {
            continue;
        }
        forAll(patch, i)
        {
            const label facei = patch.start() + i, celli = patch.faceCells()[i];
            const scalar inwards = -flux_[facei];
            if (inwards*window_.storageSpan <= outer_.tolerance*mass_[celli])
            {
                continue;
            }
            const scalar speed = inwards/(rho[celli]*mag(mesh_.faceAreas()[facei]));
            found[0] += 1;
            if (speed > found[1])
            {
                found[1] = speed;
                found[2] = numbers_.cells[celli];
            }
        }
    }
    return found;
}
