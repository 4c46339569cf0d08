// What the gas took from the particles, and its balances, as the equations took them: boundary flows
// come from the coefficients of the solved matrices, whatever the boundary conditions are.
#include "gas.H"

void Foam::calcine::gas::finishReport(report& result) const
{
    // The temperature as the enthalpy equation took it, before the thermophysical model's.
    const scalarField T(temperatureBase_ + thermo_->he().primitiveField()/heatCapacity_);
    result.heat = heatGiven_ - heatSlope_*T;
    result.drag = given_.dragSource - given_.dragCoefficient*U_.primitiveField();

    const scalarField held(given_.voidFraction*density()*mesh_.cellVolumes());
    result.volumeResidual = gMax(mag(mass_ - held)/mass_);

    const scalarField stored(mass_ - committed_.mass);
    result.mass.stored = gSum(stored);
    result.mass.storedMagnitude = gSumMag(stored);
    scalar passing = 0, circulating = 0;
    forAll(flux_, facei)
    {
        (shared_.within(facei) ? circulating : passing) += shared_.share(facei)*mag(flux_[facei]);
    }
    reduce(circulating, sumOp<scalar>());
    result.mass.exchange = window_.storageSpan*gSum(massSource());
    result.mass.boundary = -window_.storageSpan*boundaryOutflow();
    result.mass.boundaryMagnitude =
        window_.storageSpan*returnReduce(passing, sumOp<scalar>());
    if (result.mass.boundaryMagnitude == 0)
    {
        // Where nothing passes the boundary: what circulates within, because the rounding of that is
        // all that the cells of a fluid of constant density store.
        result.mass.boundaryMagnitude = window_.storageSpan*circulating;
    }
    result.patches.setSize
    (
        mesh_.boundaryMesh().nNonProcessor(), scalarList(5 + speciesNames().size(), Zero)
    );
    forAll(result.patches, patchi)
    {
        if (boundary_.of(patchi) != passage::within)
        {
            result.patches[patchi][1] -= sum(phi_.boundaryField()[patchi]);
        }
    }
    balanceSpecies(result);
    balanceEnergy(result);
    balanceMomentum(result);
    for (scalarList& flows : result.patches)
    {
        Pstream::listCombineGather(flows, plusEqOp<scalar>());
        Pstream::listCombineScatter(flows);
    }
}


void Foam::calcine::gas::balanceEnergy(report& result) const
{
    const scalarField& h = thermo_->he().primitiveField();
    const scalarField stored
    (
        mass_*(h - referenceEnthalpy_)
      - committed_.mass*(committed_.enthalpy - referenceEnthalpy_)
    );
    balance& energy = result.energy;
    energy.stored = gSum(stored);
    energy.storedMagnitude = gSumMag(stored);
    energy.exchange = window_.storageSpan*gSum(result.heat);
    energy.source = (basePressure() - committed_.basePressure)
       *gSum(given_.voidFraction*mesh_.cellVolumes());
    energy.sourceMagnitude = mag(energy.source);
    if (reactions_)
    {
        // Heat of the gas' own reactions, from what the equations of the species say that they made.
        scalar reacted = 0;
        forAll(result.species, k)
        {
            reacted -= species_->mixture()[k].formationEnthalpy()*result.species[k].source;
        }
        energy.source += reacted;
        energy.sourceMagnitude += mag(reacted);
    }
    if (models_->radiates())
    {
        const scalarField T(temperatureBase_ + h/heatCapacity_);
        const scalarField radiation(radiationSource_ - radiationCoefficient_*T);
        energy.source += window_.storageSpan*gSum(radiation);
        energy.sourceMagnitude += window_.storageSpan*gSumMag(radiation);
    }
    const surfaceScalarField* oblique = enthalpy_->faceFluxCorrectionPtr();
    forAll(mesh_.boundary(), patchi)
    {
        if (boundary_.of(patchi) == passage::within)
        {
            continue;
        }
        const labelUList& cells = mesh_.boundary()[patchi].faceCells();
        const fvsPatchScalarField& flux = phi_.boundaryField()[patchi];
        forAll(cells, i)
        {
            const scalar out = enthalpy_->internalCoeffs()[patchi][i]*h[cells[i]]
              - enthalpy_->boundaryCoeffs()[patchi][i] - flux[i]*referenceEnthalpy_
              + (carried_.valid() ? carried_->boundaryField()[patchi][i] : 0)
              + (oblique ? oblique->boundaryField()[patchi][i] : 0);
            energy.boundary -= window_.storageSpan*out;
            result.patches[patchi][0] -= out;
            energy.boundaryMagnitude += window_.storageSpan*mag(out);
        }
    }
    reduce(energy.boundary, sumOp<scalar>());
    reduce(energy.boundaryMagnitude, sumOp<scalar>());
}


void Foam::calcine::gas::balanceMomentum(report& result) const
{
    const scalar span = window_.motionSpan;
    const vectorField& u = U_.primitiveField();
    const scalarField share(pressureShare_*mesh_.cellVolumes());
    const vectorField stored(mass_*u - committed_.mass*committed_.velocity);
    // Pressure, gravity, and u times the continuity residual of the motion clock, which the equation's form subtracts.
    const vectorField gained((mass_ - committed_.mass)*u);
    const vectorField source
    (
        span*(share*(density()*gravity_ - pressureGradient_ - meanGradient_) + u*outflow_) + gained
    );
    const surfaceVectorField* oblique = momentum_->faceFluxCorrectionPtr();
    result.storageClock = (1 - span/window_.storageSpan)*gSum(gained);
    for (direction axis = 0; axis < 3; ++axis)
    {
        balance& momentum = result.momentum[axis];
        momentum.stored = gSum(stored.component(axis)());
        momentum.storedMagnitude = gSumMag(stored.component(axis)());
        momentum.exchange = span*gSum(result.drag.component(axis)());
        momentum.source = gSum(source.component(axis)());
        momentum.sourceMagnitude = gSumMag(source.component(axis)());
        forAll(mesh_.boundary(), patchi)
        {
            if (boundary_.of(patchi) == passage::within)
            {
                continue;
            }
            const labelUList& cells = mesh_.boundary()[patchi].faceCells();
            const vectorField& internal = momentum_->internalCoeffs()[patchi];
            const vectorField& given = momentum_->boundaryCoeffs()[patchi];
            const label start = mesh_.boundary()[patchi].start();
            forAll(cells, i)
            {
                const label facei = start + i;
                const vector& n = normal_[facei];
                const scalar out = internal[i][axis]*u[cells[i]][axis] - given[i][axis]
                  + normalStiffness_[facei]*(n & u[cells[i]])*n[axis]
                  - stressForce_->boundaryField()[patchi][i][axis]
                  + (oblique ? oblique->boundaryField()[patchi][i][axis] : 0);
                momentum.boundary -= span*out;
                result.patches[patchi][2 + axis] -= out;
                momentum.boundaryMagnitude += span*mag(out);
            }
        }
        reduce(momentum.boundary, sumOp<scalar>());
        reduce(momentum.boundaryMagnitude, sumOp<scalar>());
    }
}
