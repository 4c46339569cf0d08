// Enthalpy, with exactly the fluxes and masses of continuity, per cell:
//
//   (m h - m_old h_old)/dtau + sum phi_f h_f - sum (eps kappa/c_p)_f grad(h).S = S - K T(h) + eps V (p0 - p0_old)/dtau
//
// h_f as fvSchemes says, beyond upwind explicitly; T linear in h: T = T* + (h - h*)/c_p. Because m = m_old - dtau sum phi_f, a uniform temperature
// stays uniform whatever the flow does (p0, the model's pressure, changes in a closed domain alone), and energy closes to the linear tolerance whatever the outer
// loop does. In the pores the gas conducts with eps kappa: its share of the cross-section.
#include "gas.H"
#include "convection.H"
#include "fvm.H"
#include "fvc.H"

Foam::scalar Foam::calcine::gas::solveEnthalpy(report& result)
{
    volScalarField& h = thermo_->he();
    const volScalarField& T = thermo_->T();
    const scalar span = window_.storageSpan;
    heatCapacity_ = thermo_->Cp()().primitiveField();
    temperatureBase_ = T.primitiveField() - h.primitiveField()/heatCapacity_;

    const scalar compression = (basePressure() - committed_.basePressure)/span;
    const surfaceScalarField conduction
    (
        "conduction", fvc::interpolate(voidFraction_*thermo_->alphahe())
    );
    enthalpy_.reset();
    enthalpy_.reset
    (
        new fvScalarMatrix
        (
            convect(phi_, h, "div(phi,h)", share_, beyondH_) - fvm::laplacian(conduction, h)
        )
    );
    fvScalarMatrix& matrix = *enthalpy_;
    matrix.diag() +=
        committed_.mass/span + given_.heatCoefficient/heatCapacity_ - outflow();
    matrix.source() += committed_.mass*committed_.enthalpy/span
      + given_.heatSource - given_.heatCoefficient*temperatureBase_
      - outOf(*beyondH_) + compression*given_.voidFraction*mesh_.cellVolumes();
    boundary_.addHeat
    (
        window_.processEnd,
        given_.voidFraction*thermo_->kappa()().primitiveField(),
        temperatureBase_,
        heatCapacity_,
        ownerDistance_,
        matrix
    );

    // The tolerance is a share of the energy that moves; no closer than round-off of the terms.
    const scalar content = gSumMag(matrix.diag()*heatCapacity_*T.primitiveField());
    const scalarField heat
    (
        given_.heatSource - given_.heatCoefficient*T.primitiveField()
    );
    scalar moving = sumMag(heat) + sumMag
    (
        mass_*(h.primitiveField() - referenceEnthalpy_)
      - committed_.mass*(committed_.enthalpy - referenceEnthalpy_)
    )/span;
    for (const fvPatch& patch : mesh_.boundary())
    {
        if (boundary_.of(patch.index()) == passage::within)
        {
            continue;
        }
        const fvsPatchScalarField& flux = phi_.boundaryField()[patch.index()];
        moving += sumMag(flux*(h.boundaryField()[patch.index()] - referenceEnthalpy_));
    }
    reduce(moving, sumOp<scalar>());
    const scalar target = max(linearTolerance_*moving, 1e-15*content);
    const solved solution =
        enthalpySolver_.solve(matrix, scalarField(matrix.source()), target, h);
    result.linearIterations += solution.iterations;
    return solution.initial/content;
}
