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
#include "slippingCells.H"
#include "emptyPolyPatch.H"

Foam::tensorField Foam::calcine::gas::massVelocityGradient
(
    const vectorField& massVelocity,
    const scalarField& held,
    const scalarField& flux
) const
{
    if (oblique_)
    {
        return obliqueGradient(massVelocity, held, flux);
    }
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
            gradient[owner[facei]] += S*(own + (flux[facei]/mag(S) - (own & n))*n);
        }
    }
    gradient /= mesh_.cellVolumes();
    return gradient;
}


void Foam::calcine::gas::updateTransport(const scalarField& density)
{
    const labelUList& owner = mesh_.faceOwner();
    const vectorField massVelocity(density*given_.voidFraction*U_.primitiveField());
    massGradient_ = massVelocityGradient(massVelocity, density*given_.voidFraction, flux_);
    const tensorField& gradient = massGradient_;
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
    scalarField along;
    vectorField bending, bendingBeyond;
    if (oblique_)
    {
        along = passing(massVelocity, massVelocityBeyond, gradientBeyond);
        bending = bent(massVelocity, along);
        bendingBeyond = shared_.beyond(bending);
    }
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
        const scalar mean = oblique_
          ? along[facei] - ((weight*bending[P] + (1 - weight)*bendingBeyond[facei]) & n)
          : weight*here + (1 - weight)*there - bend;
        transportPush_[facei] =
            ownerDistance_[facei]*(perFlux[P] + ((n & normalPerFlux[P]) & n))*(mean - here)
          + neighbourDistance_[facei]
           *(perFluxBeyond[facei] + ((n & normalPerFluxBeyond[facei]) & n))*(mean - there);
    }
}


// By least squares, exact for linear fields on any mesh, half of it the mean of the gradients of the cells beside, which keeps what is fed back bounded on
// tetrahedra, and more in cells along whose faces gas slips; where nothing but the slope along the normal is given, zero, the value counts at
// the foot of the normal.
Foam::tensorField Foam::calcine::gas::obliqueGradient
(
    const vectorField& massVelocity,
    const scalarField& held,
    const scalarField& flux
) const
{
    const vectorField beyond(shared_.beyond(massVelocity));
    tensorField ways(mesh_.nCells(), Zero), sum(mesh_.nCells(), Zero);
    const auto add = [&](label celli, const vector& way, const vector& difference)
    {
        const vector weighted = way/magSqr(way);
        ways[celli] += weighted*way;
        sum[celli] += weighted*difference;
    };
    for (label facei = 0; facei < mesh_.nFaces(); ++facei)
    {
        if (!shared_.within(facei))
        {
            continue;
        }
        const label P = mesh_.faceOwner()[facei];
        const vector way = ownerDistance_[facei]*normal_[facei] + ownerSkew_[facei]
          + neighbourDistance_[facei]*normal_[facei] + neighbourSkew_[facei];
        const vector difference = beyond[facei] - massVelocity[P];
        add(P, way, difference);
        if (facei < mesh_.nInternalFaces())
        {
            add(mesh_.faceNeighbour()[facei], -way, -difference);
        }
    }
    forAll(mesh_.boundary(), patchi)
    {
        const fvPatch& patch = mesh_.boundary()[patchi];
        if (boundary_.of(patchi) == passage::within)
        {
            continue;
        }
        const fvPatchVectorField& U = U_.boundaryField()[patchi];
        const bool given = U.fixesValue();
        forAll(patch, i)
        {
            const label facei = patch.start() + i, P = patch.faceCells()[i];
            const vector& n = normal_[facei];
            const vector own = given ? vector(held[P]*U[i]) : massVelocity[P];
            const vector value = own + (flux[facei]/mag(mesh_.faceAreas()[facei]) - (own & n))*n;
            const vector foot = ownerDistance_[facei]*n;
            add(P, given ? vector(foot + ownerSkew_[facei]) : foot, value - massVelocity[P]);
        }
    }
    for (const polyPatch& patch : mesh_.boundaryMesh())
    {
        // Nothing varies across empty patches, whose faces have no field.
        if (isA<emptyPolyPatch>(patch))
        {
            forAll(patch, i)
            {
                const vector& n = normal_[patch.start() + i];
                ways[patch.faceCells()[i]] += n*n;
            }
        }
    }
    forAll(sum, celli)
    {
        sum[celli] = inv(ways[celli]) & sum[celli];
    }
    mixBeside(U_, 0.5, 0.25, sum);
    return sum;
}


Foam::scalar Foam::calcine::gas::reach(label facei, label celli, const tensorField& gradient) const
{
    const vector way = mesh_.faceCentres()[facei] - mesh_.cellCentres()[celli];
    return oblique_ ? (way & gradient[celli]) & normal_[facei] : 0;
}


Foam::scalarField Foam::calcine::gas::passing
(
    const vectorField& massVelocity,
    const vectorField& massVelocityBeyond,
    const tensorField& gradientBeyond
) const
{
    scalarField values(mesh_.nFaces());
    forAll(values, facei)
    {
        if (!shared_.within(facei))
        {
            values[facei] = flux_[facei]/mag(mesh_.faceAreas()[facei]);
            continue;
        }
        const label P = mesh_.faceOwner()[facei];
        const scalar weight = ownerWeight(facei);
        const vector miss = weight*ownerSkew_[facei] - (1 - weight)*neighbourSkew_[facei];
        const tensor slope = weight*massGradient_[P] + (1 - weight)*gradientBeyond[facei];
        const vector mean = weight*massVelocity[P] + (1 - weight)*massVelocityBeyond[facei];
        values[facei] = (mean + (miss & slope)) & normal_[facei];
    }
    return values;
}


Foam::vectorField Foam::calcine::gas::bent
(
    const vectorField& massVelocity,
    const scalarField& passing
) const
{
    vectorField sum(mesh_.nCells(), Zero);
    const auto add = [&](label facei, label celli, scalar distance)
    {
        // Nothing is recovered across the sides of wedges.
        if (turns_[facei])
        {
            return;
        }
        const scalar part = passing[facei] - reach(facei, celli, massGradient_);
        sum[celli] += mag(mesh_.faceAreas()[facei])*distance*part*normal_[facei];
    };
    forAll(passing, facei)
    {
        add(facei, mesh_.faceOwner()[facei], ownerDistance_[facei]);
        if (facei < mesh_.nInternalFaces())
        {
            add(facei, mesh_.faceNeighbour()[facei], neighbourDistance_[facei]);
        }
    }
    return (recovery_ & (sum/mesh_.cellVolumes())) - massVelocity;
}


Foam::scalar Foam::calcine::gas::ownerWeight(label facei) const
{
    return neighbourDistance_[facei]/(ownerDistance_[facei] + neighbourDistance_[facei]);
}
