// Momentum, for the interstitial velocity u, in the form that subtracts u times the continuity
// residual, per cell:
//
//   m_old (u - u_old)/dt + sum phi_f u_f - u sum phi_f
//       - sum (eps mu)_f (grad(u) + grad(u)^T - 2/3 div(u)).S = -chi (grad(p) + G) V + chi rho V g + S_d - K_d u
//
// G a mean pressure gradient that the case gives, chi the share of the pressure gradient that the gas takes, eps by model A, 1 by model B.
// u_f as fvSchemes says, beyond upwind explicitly; of the viscous stress the part grad(u).S is implicit. On walls without friction and planes of
// symmetry the normal viscous stress acts alone (normalStress.C); mu with that of eddies (models.H); gas leaves an outlet as if the flow
// were developed there.
#include "gas.H"
#include "convection.H"
#include "slippingCells.H"
#include "fvm.H"
#include "fvc.H"

Foam::scalar Foam::calcine::gas::predictVelocity(const scalarField& density, report& result)
{
    const scalarField& volume = mesh_.cellVolumes();
    const scalarField share(pressureShare_*volume);
    const scalarField inertia(committed_.mass/window_.motionSpan);
    const volScalarField mu("mu", viscosity());
    const surfaceScalarField faceViscosity("viscosity", fvc::interpolate(mu));
    const volTensorField gradU("gradU", fvc::grad(U_));

    // The matrix of the last outer iteration goes first, with the memory it holds.
    momentum_.reset();
    momentum_.reset
    (
        new fvVectorMatrix
        (
            convect(phi_, U_, "div(phi,U)", share_, beyondU_) - fvm::laplacian(faceViscosity, U_)
        )
    );
    fvVectorMatrix& matrix = *momentum_;

    updateNormalFriction(mu);
    setNormalFriction(matrix, false);

    // Force of the explicit part of the stress on the owner of each face, in N.
    volTensorField stress("explicitStress", mu*dev2(T(gradU)));
    forAll(mesh_.boundary(), patchi)
    {
        const passage way = boundary_.of(patchi);
        if (slips(U_.boundaryField()[patchi]))
        {
            stress.boundaryFieldRef()[patchi] = normalStress(patchi, mu, gradU);
        }
        else if (way != passage::open && way != passage::within && !U_.boundaryField()[patchi].fixesValue())
        {
            stress.boundaryFieldRef()[patchi] = Zero;
        }
    }
    stressForce_.reset((mesh_.Sf() & fvc::interpolate(stress)).ptr());

    outflow_ = outflow();
    matrix.diag() += inertia + given_.dragCoefficient - outflow_;
    matrix.source() +=
        inertia*committed_.velocity + given_.dragSource + density*share*gravity_
      - share*meanGradient_ + outOf(*stressForce_) - outOf(*beyondU_);

    // Gas of the surroundings comes in straight through openings.
    for (const fvPatch& patch : mesh_.boundary())
    {
        const statedGas* opening = inflow_.surroundings(patch.index());
        if (!opening)
        {
            continue;
        }
        forAll(patch, i)
        {
            const label facei = patch.start() + i;
            const scalar flux = flux_[facei];
            if (flux < 0)
            {
                const scalar held = opening->density*given_.voidFraction[patch.faceCells()[i]];
                const scalar speed = flux/(held*mag(mesh_.faceAreas()[facei]));
                matrix.internalCoeffs()[patch.index()][i] = Zero;
                matrix.boundaryCoeffs()[patch.index()][i] = -flux*speed*normal_[facei];
            }
        }
    }

    momentumDiagonal_ = matrix.A()().primitiveField();
    const vectorField push(-share*pressureGradient_);
    const vectorField pull(matrix.H()().primitiveField()*volume);
    const vectorField own
    (
        momentumDiagonal_*volume*U_.primitiveField() + (normalFriction_ & U_.primitiveField())
    );
    // What the equation misses, as a share of its terms, and by how much that moves the velocity of the worst cell, relative to the fastest gas: the
    // first is a mean over cells, which hardly sees few small ones. Gas that moves by less than a hundred-thousandth of a cell is still.
    const scalarField missed(mag(pull + push - own));
    const scalar still = tolerances::still/window_.motionSpan*gSum(momentumDiagonal_*volume*Foam::cbrt(volume));
    const scalar terms = gSumMag(own) + gSumMag(push) + gSumMag(pull) + still;
    const scalar worst = gMax(missed/(momentumDiagonal_*volume))/fastest();
    const scalar error = max(gSum(missed)/terms, worst/tolerances::worst);

    const vectorField source(matrix.source() + push);
    setNormalFriction(matrix, true);
    result.linearIterations +=
        momentumSolver_.solve(matrix, source, linearTolerance_*terms, U_).iterations;
    setNormalFriction(matrix, false);
    return error;
}
