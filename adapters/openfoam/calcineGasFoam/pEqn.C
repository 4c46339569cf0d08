// Pressure and mass flux. A half cell between a centre and a face is a resistance in series with the
// next: with the force F on the gas per chi V (everything but pressure; chi the share of grad(p) that the
// gas takes, eps by model A), the mobility b = rho eps chi/A and the distance d to the face, the superficial mass flux per area G obeys
//
//   p_f = p_P + d_P (F_P.n - G/b_P)   and   p_N = p_f + d_N (F_N.n - G/b_N),
//
// so G = (d_P F_P.n + d_N F_N.n + p_P - p_N)/(d_P/b_P + d_N/b_N): Rhie-Chow with a distance-weighted
// harmonic mean. The slopes F.n - G/b of a cell's halves make its gradient, which the momentum equation
// takes and which is reported: sum A d n (n.grad p) = sum A d n (F.n - G/b), Gauss' theorem with what lies
// along the faces on the left side. Where centres are displaced along a face, pressures are carried there by another gradient
// (updatePressureAlong), a correction later. Gas at rest stays at rest
// whatever the void fraction does, and a bed's resistance is exact to its last half cell. The inertia at a face is that of the face's own old flux, so that a steady
// flow does not depend on the time step; what friction and convection owe to the cell's own velocity in
// transport.C. Rhie and Chow 1983, doi 10.2514/3.8284.
//
// Continuity, per cell: sum phi_f = -(eps rho V - m_old)/dtau, rho of the model at pRef.
#include "gas.H"

Foam::scalar Foam::calcine::gas::beside(label facei, label celli) const
{
    const scalar faceFlux = committed_.flux[facei]/mag(mesh_.faceAreas()[facei]);
    const scalar cellFlux =
        committed_.mass[celli]/mesh_.cellVolumes()[celli]*(committed_.velocity[celli] & normal_[facei]);
    return (faceFlux - cellFlux)/(window_.motionSpan*pressureShare_[celli])
      - across(facei, celli);
}


Foam::scalar Foam::calcine::gas::slopeBeyond(label facei, label celli) const
{
    const scalar span = window_.motionSpan*pressureShare_[celli];
    const scalar passing = flux_[facei]/mag(mesh_.faceAreas()[facei]) - reach(facei, celli, massGradient_);
    return beside(facei, celli) - reach(facei, celli, oldMassGradient_)/span
      - passing/mobilityAlong(facei, celli);
}


Foam::scalar Foam::calcine::gas::halfCellForce(label facei, label celli) const
{
    return (force_[celli] & normal_[facei]) + beside(facei, celli);
}


Foam::scalar Foam::calcine::gas::ownerPush(label facei) const
{
    // The second term, added to p_P, leaves the fall of pressure along the normal alone.
    const label celli = mesh_.faceOwner()[facei];
    return
        ownerDistance_[facei]*halfCellForce(facei, celli)
      + (ownerSkew_[facei] & pressureAlong_[celli]);
}


void Foam::calcine::gas::updateForce()
{
    force_ = (momentum_->H()().primitiveField() + frictionGivenBack()/mesh_.cellVolumes())/pressureShare_;
}


Foam::scalar Foam::calcine::gas::assemblePressure(const scalarField& density, bool first)
{
    const scalar missed = updateOpenings();
    mobility_ = density*given_.voidFraction*pressureShare_/momentumDiagonal_;
    const labelUList& owner = mesh_.faceOwner();
    const scalarField mobilityBeyond(shared_.beyond(mobility_));
    const tensorField addedBeyond
    (
        shared_.beyond(tensorField(normalFriction_/(momentumDiagonal_*mesh_.cellVolumes())))
    );
    forAll(conductance_, facei)
    {
        if (shared_.within(facei))
        {
            const vector& n = normal_[facei];
            const scalar beyond = mobilityBeyond[facei]/(1 + ((n & addedBeyond[facei]) & n));
            conductance_[facei] = mag(mesh_.faceAreas()[facei])
               /(
                    ownerDistance_[facei]/mobilityAlong(facei, owner[facei])
                  + neighbourDistance_[facei]/beyond
                );
        }
    }
    for (const fvPatch& patch : mesh_.boundary())
    {
        const bool open = boundary_.of(patch.index()) == passage::open;
        if (boundary_.of(patch.index()) == passage::within)
        {
            continue;
        }
        for (label facei = patch.start(); facei < patch.start() + patch.size(); ++facei)
        {
            const scalar area = mag(mesh_.faceAreas()[facei]);
            conductance_[facei] = !open ? 0
              : area
               /(ownerDistance_[facei]/mobilityAlong(facei, owner[facei]) + area*openingSlope_[facei]);
        }
    }

    // How far the flux at hand is from continuity, relative to what is held and what flows. What openings missed is known after the
    // first iteration.
    if (first && inflow_.opens())
    {
        return 1;
    }
    const scalar error = gSumMag(wantedOutflow(density) - outflow()) + missed;
    scalar flowing = 0;
    forAll(flux_, facei)
    {
        flowing += (facei < mesh_.nInternalFaces() ? 1 : 0.5)*mag(flux_[facei]);
    }
    return
        error
       /(
            gSum(committed_.mass)/window_.storageSpan
          + returnReduce(flowing, sumOp<scalar>())
        );
}


void Foam::calcine::gas::correctPressure(const scalarField& density, bool first, report& result)
{
    const label internal = mesh_.nInternalFaces();
    const labelUList& owner = mesh_.faceOwner();
    const labelUList& neighbour = mesh_.faceNeighbour();
    updateForce();
    if (first || !oblique_ || follows_)
    {
        updateTransport(density);
    }

    // What the forces alone would drive through each face; all of it where the flux is given.
    for (label facei = 0; facei < internal; ++facei)
    {
        const label N = neighbour[facei];
        drive_[facei] = conductance_[facei]
           *(
                ownerPush(facei)
              + neighbourDistance_[facei]*halfCellForce(facei, N)
              + (neighbourSkew_[facei] & pressureAlong_[N])
              + transportPush_[facei]
            );
    }
    // The neighbour of a shared face is the owner on the other side, where everything along the normal
    // has the other sign.
    scalarField otherPush(mesh_.nFaces(), 0);
    for (label facei = internal; facei < mesh_.nFaces(); ++facei)
    {
        otherPush[facei] = ownerPush(facei);
    }
    shared_.swap(otherPush);
    const tmp<volScalarField> model(thermo_->rho());
    for (const fvPatch& patch : mesh_.boundary())
    {
        const label patchi = patch.index();
        forAll(patch, i)
        {
            const label facei = patch.start() + i;
            switch (boundary_.of(patchi))
            {
                case passage::closed:
                    drive_[facei] = 0;
                    break;
                case passage::given:
                    drive_[facei] = boundary_.flow(patch, i, model(), voidFraction_, U_);
                    break;
                case passage::open:
                    drive_[facei] = conductance_[facei]*ownerPush(facei);
                    break;
                case passage::within:
                    drive_[facei] = conductance_[facei]
                       *(ownerPush(facei) - otherPush[facei] + transportPush_[facei]);
                    break;
            }
        }
    }

    fvScalarMatrix matrix(p_, dimMass/dimTime);
    scalarField& diagonal = matrix.diag();
    scalarField& upper = matrix.upper();
    diagonal = 0;
    flux_ = drive_;
    scalarField source(wantedOutflow(density) - outflow());
    for (label facei = 0; facei < internal; ++facei)
    {
        upper[facei] = -conductance_[facei];
        diagonal[owner[facei]] += conductance_[facei];
        diagonal[neighbour[facei]] += conductance_[facei];
    }
    if (boundary_.closed() && firstCell_ >= 0)
    {
        // The pressure of the first cell is the model's; no gas flows for it, because the wanted
        // outflows of all cells sum to what flows in.
        diagonal[firstCell_] *= 2;
    }
    scalar terms = sumMag(source) + sumMag(diagonal*p_.primitiveField());
    forAll(mesh_.boundary(), patchi)
    {
        const fvPatch& patch = mesh_.boundary()[patchi];
        if (!patch.size())
        {
            continue;
        }
        const scalarField coefficient
        (
            SubList<scalar>(conductance_, patch.size(), patch.start())
        );
        matrix.internalCoeffs()[patchi] = coefficient;
        if (boundary_.of(patchi) == passage::within)
        {
            // OpenFOAM multiplies it with the pressure beyond.
            matrix.boundaryCoeffs()[patchi] = coefficient;
            terms += sumMag(coefficient*p_.boundaryField()[patchi].patchInternalField());
        }
        else
        {
            matrix.boundaryCoeffs()[patchi] = coefficient*p_.boundaryField()[patchi];
            terms += sumMag(matrix.boundaryCoeffs()[patchi]);
        }
    }
    reduce(terms, sumOp<scalar>());
    // A single closed cell has no equation: its pressure is the model's.
    if (!(boundary_.closed() && returnReduce(mesh_.nCells(), sumOp<label>()) == 1))
    {
        result.linearIterations +=
            pressureSolver_.solve(matrix, source, linearTolerance_*terms, p_).iterations;
    }

    for (label facei = 0; facei < internal; ++facei)
    {
        flux_[facei] += conductance_[facei]*(p_[owner[facei]] - p_[neighbour[facei]]);
    }
    forAll(mesh_.boundary(), patchi)
    {
        const fvPatch& patch = mesh_.boundary()[patchi];
        const fvPatchScalarField& outer = p_.boundaryField()[patchi];
        const scalarField beyond(outer.coupled() ? outer.patchNeighbourField()() : scalarField(outer));
        forAll(patch, i)
        {
            const label facei = patch.start() + i;
            flux_[facei] += conductance_[facei]*(p_[owner[facei]] - beyond[i]);
        }
    }
    shared_.agree(flux_);
    updatePressureAlong(first);
    updatePressureGradient();

    updateVelocity();
}


void Foam::calcine::gas::updatePressureGradient()
{
    // What the slopes of a cell's halves have beyond its own force: without what transport adds, by
    // which the pressures on the two sides of a face differ.
    pressureGradient_ = Zero;
    const auto add = [this](label facei, label celli, scalar distance)
    {
        // The sides of wedges have the slope of their cell.
        if (turns_[facei])
        {
            return;
        }
        const scalar area = mag(mesh_.faceAreas()[facei]);
        pressureGradient_[celli] += area*distance*slopeBeyond(facei, celli)*normal_[facei];
    };
    forAll(flux_, facei)
    {
        add(facei, mesh_.faceOwner()[facei], ownerDistance_[facei]);
        if (facei < mesh_.nInternalFaces())
        {
            add(facei, mesh_.faceNeighbour()[facei], neighbourDistance_[facei]);
        }
    }
    pressureGradient_ = force_ + (recovery_ & (pressureGradient_/mesh_.cellVolumes()));
}


void Foam::calcine::gas::updatePressureAlong(bool first)
{
    // sum p_f S/V from the values that a cell's own half gives on its faces: to the face's plane along the normal by the half's
    // slope, and along the face. It does not take up its own last value where cells repeat, and so settles at any skewness: the
    // gradient that the velocities leave does, and grows from one correction to the next beyond 30 degrees of shear.
    vectorField next(mesh_.nCells(), Zero);
    const auto add = [this, &next](label facei, label celli, scalar distance, const vector& skew)
    {
        const scalar area = mag(mesh_.faceAreas()[facei]);
        const scalar slope = turns_[facei]
          ? (pressureAlong_[celli] & normal_[facei])
          : (force_[celli] & normal_[facei]) + slopeBeyond(facei, celli);
        next[celli] += area*(distance*slope + (skew & pressureAlong_[celli]))*normal_[facei];
    };
    forAll(flux_, facei)
    {
        add(facei, mesh_.faceOwner()[facei], ownerDistance_[facei], ownerSkew_[facei]);
        if (facei < mesh_.nInternalFaces())
        {
            add(facei, mesh_.faceNeighbour()[facei], neighbourDistance_[facei], neighbourSkew_[facei]);
        }
    }
    // The sum over warped faces of a pressure of this gradient is not the gradient.
    next = next/mesh_.cellVolumes() + (warp_ & pressureAlong_);
    // Of all of the difference one part overshoots on tetrahedra and polyhedra that lean by 45 degrees, to -1.02 times itself; and in the first
    // correction all do by friction.
    const scalar followed = 0.75;
    const scalarField share
    (
        first ? min(withoutFriction_, followed)() : tmp<scalarField>::New(mesh_.nCells(), followed)()
    );
    alongChange_ = share*(next - pressureAlong_);
    pressureAlong_ += alongChange_;
}


Foam::scalar Foam::calcine::gas::unsettled(const scalarField& density) const
{
    if (!oblique_)
    {
        return 0;
    }
    const scalarField held(density*given_.voidFraction);
    const tensorField change(massVelocityGradient(held*U_.primitiveField(), held, flux_) - massGradient_);
    const vectorField alongBeyond(shared_.beyond(alongChange_));
    vectorField missed(mesh_.nCells(), Zero);
    const auto add = [&](label facei, label celli, scalar distance, scalar flux)
    {
        if (turns_[facei])
        {
            return;
        }
        const scalar area = mag(mesh_.faceAreas()[facei]);
        missed[celli] += area*distance*(flux/area - reach(facei, celli, change))*normal_[facei];
    };
    forAll(flux_, facei)
    {
        const label P = mesh_.faceOwner()[facei];
        scalar push = ownerSkew_[facei] & alongChange_[P];
        if (shared_.within(facei))
        {
            push += neighbourSkew_[facei] & alongBeyond[facei];
        }
        const scalar flux = conductance_[facei]*push;
        add(facei, P, ownerDistance_[facei], flux);
        if (facei < mesh_.nInternalFaces())
        {
            add(facei, mesh_.faceNeighbour()[facei], neighbourDistance_[facei], flux);
        }
    }
    return gMax(mag(recovery_ & (missed/mesh_.cellVolumes()))/held)/fastest();
}


Foam::scalar Foam::calcine::gas::fastest() const
{
    const scalar size = gSum(Foam::cbrt(mesh_.cellVolumes()))/returnReduce(mesh_.nCells(), sumOp<label>());
    return gMax(mag(U_.primitiveField())) + tolerances::still*size/window_.motionSpan;
}
