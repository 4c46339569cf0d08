// What friction and convection do at a face. Of the diagonal A of the momentum equation, with N of walls without
// friction (normalStress.C) along the face's normal, the part A_t of friction and convection multiplies the cell's
// own velocity, not that of the half cell that drag and inertia meet at the face: the balance of the half cell (pEqn.C) has A_t times the flux there only to damp
// oscillations between faces, and gets back, with M = rho eps u,
//
//   c_P = A_t/(rho eps chi) (M_f - M_P.n),
//   M_f = (d_N M_P + d_P M_N).n/(d_P + d_N) - d_P d_N (g_N - g_P)/(d_P + d_N),   g = n.grad(M).n:
//
// the flux per area that the cells around the face stand for, to fourth order of smooth fields, because a
// cell's velocity is the mean of its faces. Where the flux does not vary along itself, as in a bed in a
// duct, c is zero and resistances in series stay exact. Without c an excess A_t d^2 d2u_n/dn2 of friction
// would remain on every mesh.
#include "gas.H"

Foam::tensorField Foam::calcine::gas::massVelocityGradient(const vectorField& massVelocity) const
{
    const labelUList& owner = mesh_.faceOwner();
    const vectorField beyond(shared_.beyond(massVelocity));
    tensorField gradient(mesh_.nCells(), Zero);
    forAll(flux_, facei)
    {
        const vector& S = mesh_.faceAreas()[facei];
        const vector& n = normal_[facei];
        const vector& own = massVelocity[owner[facei]];
        if (shared_.within(facei))
        {
            const scalar weight = ownerWeight(facei);
            const tensor part = S*(weight*own + (1 - weight)*beyond[facei]);
            gradient[owner[facei]] += part;
            if (facei < mesh_.nInternalFaces())
            {
                gradient[mesh_.faceNeighbour()[facei]] -= part;
            }
        }
        else
        {
            // The cell's own, its normal part that of the flux.
            gradient[owner[facei]] += S*(own + (flux_[facei]/mag(S) - (own & n))*n);
        }
    }
    gradient /= mesh_.cellVolumes();
    return gradient;
}


void Foam::calcine::gas::updateTransport(const scalarField& density)
{
    const labelUList& owner = mesh_.faceOwner();
    const vectorField massVelocity(density*given_.voidFraction*U_.primitiveField());
    const tensorField gradient(massVelocityGradient(massVelocity));
    const scalarField held(density*given_.voidFraction*pressureShare_);
    const scalarField perFlux
    (
        (
            momentumDiagonal_
          - (committed_.mass/window_.motionSpan + given_.dragCoefficient)/mesh_.cellVolumes()
        )
       /held
    );
    const tensorField normalPerFlux(normalFriction_/(held*mesh_.cellVolumes()));
    const vectorField massVelocityBeyond(shared_.beyond(massVelocity));
    const tensorField gradientBeyond(shared_.beyond(gradient));
    const scalarField perFluxBeyond(shared_.beyond(perFlux));
    const tensorField normalPerFluxBeyond(shared_.beyond(normalPerFlux));
    forAll(transportPush_, facei)
    {
        if (!shared_.within(facei))
        {
            continue;
        }
        const label P = owner[facei];
        const vector& n = normal_[facei];
        const scalar weight = ownerWeight(facei);
        const scalar here = massVelocity[P] & n, there = massVelocityBeyond[facei] & n;
        const scalar bend =
            ownerDistance_[facei]*weight*(n & ((gradientBeyond[facei] - gradient[P]) & n));
        const vector miss = weight*ownerSkew_[facei] - (1 - weight)*neighbourSkew_[facei];
        const tensor slope = weight*gradient[P] + (1 - weight)*gradientBeyond[facei];
        const scalar mean =
            weight*here + (1 - weight)*there - bend + ((miss & slope) & n);
        transportPush_[facei] =
            ownerDistance_[facei]*(perFlux[P] + ((n & normalPerFlux[P]) & n))*(mean - here)
          + neighbourDistance_[facei]
           *(perFluxBeyond[facei] + ((n & normalPerFluxBeyond[facei]) & n))*(mean - there);
    }
}


Foam::scalar Foam::calcine::gas::ownerWeight(label facei) const
{
    return neighbourDistance_[facei]/(ownerDistance_[facei] + neighbourDistance_[facei]);
}
