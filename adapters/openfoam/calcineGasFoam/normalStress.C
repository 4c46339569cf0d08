// Normal viscous stress of walls without friction, planes of symmetry and the sides of wedges. There u.n = 0, and the stress on the cell behind has the one part
//
//   tau_n = mu (4/3 du_n/dn - 2/3 div_t(u)),   du_n/dn = -(u.n + t.grad(u_n))/d,
//
// d the distance of the centre along the normal n, t from below the face's centre to it, div_t the divergence along the face. What it owes to
// the cell's own velocity is implicit in all steps, a tensor beside the diagonal A of the momentum equation,
//
//   N = sum w n n,   w = 4/3 mu area/d,
//
// which damps each component by what it has of the normal: with that explicit, outer iterations diverge where nu dt/d2 is large. OpenFOAM's own
// coefficients of such patches, |n_i| for each component, would enter A as their mean over the components.
#include "gas.H"
#include "slippingCells.H"

void Foam::calcine::gas::updateNormalFriction(const scalarField& mu)
{
    normalFriction_ = tensorField(mesh_.nCells(), Zero);
    normalStiffness_ = scalarField(mesh_.nFaces(), Zero);
    forAll(mesh_.boundary(), patchi)
    {
        if (!slips(U_.boundaryField()[patchi]))
        {
            continue;
        }
        const fvPatch& patch = mesh_.boundary()[patchi];
        forAll(patch, i)
        {
            const label facei = patch.start() + i, celli = patch.faceCells()[i];
            const scalar area = mag(mesh_.faceAreas()[facei]);
            normalStiffness_[facei] = 4.0/3.0*mu[celli]*area/ownerDistance_[facei];
            normalFriction_[celli] += normalStiffness_[facei]*normal_[facei]*normal_[facei];
        }
    }
}


Foam::tensorField Foam::calcine::gas::normalStress
(
    label patchi,
    const scalarField& mu,
    const tensorField& gradU
) const
{
    const fvPatch& patch = mesh_.boundary()[patchi];
    tensorField stress(patch.size(), Zero);
    forAll(patch, i)
    {
        const label facei = patch.start() + i, celli = patch.faceCells()[i];
        const vector& n = normal_[facei];
        const tensor& g = gradU[celli];
        const scalar stiffness = normalStiffness_[facei]/mag(mesh_.faceAreas()[facei]);
        const scalar along = tr(g) - ((n & g) & n);
        const scalar skewed = (ownerSkew_[facei] & g) & n;
        stress[i] = -(stiffness*skewed + 2.0/3.0*mu[celli]*along)*n*n;
    }
    return stress;
}


void Foam::calcine::gas::setNormalFriction(fvVectorMatrix& matrix, bool present) const
{
    forAll(mesh_.boundary(), patchi)
    {
        if (!slips(U_.boundaryField()[patchi]))
        {
            continue;
        }
        const fvPatch& patch = mesh_.boundary()[patchi];
        forAll(patch, i)
        {
            const label facei = patch.start() + i;
            const vector& n = normal_[facei];
            const vector& u = U_[patch.faceCells()[i]];
            const scalar w = present ? normalStiffness_[facei] : 0;
            const vector diagonal = w*cmptMultiply(n, n);
            matrix.internalCoeffs()[patchi][i] = diagonal;
            matrix.boundaryCoeffs()[patchi][i] = cmptMultiply(diagonal, u) - w*(n & u)*n;
        }
    }
}


Foam::scalar Foam::calcine::gas::mobilityAlong(label facei, label celli) const
{
    const vector& n = normal_[facei];
    const scalar added = (n & normalFriction_[celli]) & n;
    return mobility_[celli]/(1 + added/(momentumDiagonal_[celli]*mesh_.cellVolumes()[celli]));
}


Foam::scalar Foam::calcine::gas::across(label facei, label celli) const
{
    const vector& n = normal_[facei];
    const vector& u = U_[celli];
    const vector pulled = normalFriction_[celli] & n;
    return ((pulled & u) - (pulled & n)*(n & u))
       /(pressureShare_[celli]*mesh_.cellVolumes()[celli]);
}


void Foam::calcine::gas::updateVelocity()
{
    forAll(force_, celli)
    {
        const vector force = pressureShare_[celli]*(force_[celli] - pressureGradient_[celli]);
        const tensor& N = normalFriction_[celli];
        if (magSqr(N) > 0)
        {
            U_[celli] = inv(momentumDiagonal_[celli]*tensor::I + N/mesh_.cellVolumes()[celli]) & force;
        }
        else
        {
            U_[celli] = force/momentumDiagonal_[celli];
        }
    }
    U_.correctBoundaryConditions();
}
