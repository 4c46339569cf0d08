// Friction at walls within the pressure corrections of an outer iteration, as in the native gas (native-solver/src/gas/friction.rs has the
// derivation). A correction lets gas slip along walls; with all of their friction w = mu A/d the second correction overshoots where
// nu dt/d^2 is large. Corrections take the pull of a wall as
//
//   w (u* - u_w) + w' (u - u*),   1/w' = (1/w + 1/w_d) (a - w + g)/a,   w_d = i/2 + sqrt(i^2/4 + g i),   g = w d A/V,
//
// u* the velocity that the predictor found, i the part of the diagonal a by inertia and drag, w' at most w. Where u = u* the pull is
// that of the momentum equation.
#include "gas.H"

namespace
{

using namespace Foam;

// Part along the face of half a line between two centres, over that along the normal, above which the line is oblique: 6 degrees.
const scalar obliqueness = 0.1;

// w - w' in kg/s, by w, g, i and a in kg/s.
scalar held(scalar friction, scalar between, scalar inertia, scalar diagonal)
{
    if (!(friction > 0))
    {
        return 0;
    }
    const scalar layer = 0.5*inertia + Foam::sqrt(0.25*inertia*inertia + between*inertia);
    const scalar beyond = diagonal - friction + between;
    const scalar share = layer/(friction + layer)*diagonal/beyond;
    return friction*(1 - min(share, scalar(1)));
}

} // End anonymous namespace


void Foam::calcine::gas::updateFriction()
{
    scalarField friction(mesh_.nCells(), Zero);
    const scalarField& upper = momentum_->upper();
    const scalarField& lower = momentum_->lower();
    for (label facei = 0; facei < mesh_.nInternalFaces(); ++facei)
    {
        // One of the two is friction alone, the other one with what flows in.
        const scalar viscous = -max(upper[facei], lower[facei]);
        friction[mesh_.faceOwner()[facei]] += viscous;
        friction[mesh_.faceNeighbour()[facei]] += viscous;
    }
    forAll(mesh_.boundary(), patchi)
    {
        const labelUList& cells = mesh_.boundary()[patchi].faceCells();
        const scalarField across(boundaryFriction(patchi));
        forAll(across, i)
        {
            friction[cells[i]] += across[i];
        }
    }
    withoutFriction_ = 1 - friction/(momentumDiagonal_*mesh_.cellVolumes());
}


Foam::scalar Foam::calcine::gas::largestFriction() const
{
    const scalarField inertia(committed_.mass/window_.motionSpan + given_.dragCoefficient);
    const scalarField friction((1 - withoutFriction_)*momentumDiagonal_*mesh_.cellVolumes());
    scalar largest = 0;
    const auto offer = [&](label celli)
    {
        largest = max(largest, friction[celli]/inertia[celli]);
    };
    for (label facei = 0; facei < mesh_.nFaces(); ++facei)
    {
        if (shared_.within(facei) && leans(facei))
        {
            offer(mesh_.faceOwner()[facei]);
            if (facei < mesh_.nInternalFaces())
            {
                offer(mesh_.faceNeighbour()[facei]);
            }
        }
    }
    reduce(largest, maxOp<scalar>());
    return largest;
}


bool Foam::calcine::gas::leans(label facei) const
{
    return mag(ownerSkew_[facei]) > obliqueness*ownerDistance_[facei]
        || mag(neighbourSkew_[facei]) > obliqueness*neighbourDistance_[facei];
}


Foam::scalarField Foam::calcine::gas::boundaryFriction(label patchi) const
{
    const fvPatchVectorField& U = U_.boundaryField()[patchi];
    scalarField friction(U.size(), Zero);
    if (U.coupled() || U.fixesValue())
    {
        forAll(friction, i)
        {
            friction[i] = U.coupled()
              ? max(momentum_->boundaryCoeffs()[patchi][i].x(), scalar(0))
              : momentum_->internalCoeffs()[patchi][i].x();
        }
    }
    return friction;
}


void Foam::calcine::gas::holdFriction()
{
    predicted_ = U_.primitiveField();
    heldFriction_ = scalarField(mesh_.nFaces(), Zero);
    if (follows_)
    {
        return;
    }
    const scalarField& volume = mesh_.cellVolumes();
    const scalarField inertia(committed_.mass/window_.motionSpan + given_.dragCoefficient);
    const scalarField diagonal(momentumDiagonal_*volume);
    forAll(mesh_.boundary(), patchi)
    {
        const fvPatch& patch = mesh_.boundary()[patchi];
        if (U_.boundaryField()[patchi].coupled())
        {
            continue;
        }
        const scalarField across(boundaryFriction(patchi));
        forAll(across, i)
        {
            const label facei = patch.start() + i, celli = patch.faceCells()[i];
            const scalar between = across[i]*mag(mesh_.faceAreas()[facei])*ownerDistance_[facei]/volume[celli];
            heldFriction_[facei] = held(across[i], between, inertia[celli], diagonal[celli]);
        }
    }
}


Foam::vectorField Foam::calcine::gas::frictionGivenBack() const
{
    vectorField force(mesh_.nCells(), Zero);
    for (label facei = mesh_.nInternalFaces(); facei < mesh_.nFaces(); ++facei)
    {
        const scalar held = heldFriction_[facei];
        if (held > 0)
        {
            const label celli = mesh_.faceOwner()[facei];
            const vector& n = normal_[facei];
            const vector slip = U_[celli] - predicted_[celli];
            force[celli] += held*(slip - (slip & n)*n);
        }
    }
    return force;
}
