// Reactions of the gas with itself, in species and enthalpy alike, as in Calcine's native gas: per kg of gas
//
//   w_k = (R_k(Y, T; dt) - Y_k)/dt,   q = -sum h0_k w_k,
//
// with what OpenFOAM's chemistry makes of a cell's gas over the motion span, R, and the enthalpies of formation h0.
//
// Where the gas stores over the motion span the window takes the rates of its start once. Where it stores over a longer
// one, the equations with the rates of their own end are iterated in pseudo-steps d (dual time stepping),
//
//   m (Y - Y0)/d + (m Y - m_old Y_old)/dtau + transport = m w(Y0),   w = (R(Y0, T0; d) - Y0)/d,
//
// so that the place of a steady flame does not depend on dtau. d is dt, or a quarter of the time in which the gas that leaves a
// cell empties it where that is shorter: else a flame would be spread over all cells that the gas passes in dt. After the last pseudo-step the equations are solved once
// more without it, with m (R' - Y)/d in place of m w (m as in that step), which is what that step took in all, R' being R(Y0) with the elements of
// the new Y: so energy and every element close whatever the iteration did, and no cell gives what it does not have.
#include "gas.H"
#include "clockValue.H"

namespace
{

// A span is longer than the motion span beyond this share: less is round-off of clocks.
const Foam::scalar longer = 1e-6;
// Pseudo-steps in an outer iteration at most.
const Foam::label pseudoSteps = 5;
// They need not change a value by less than this share of the residual of momentum and continuity, whose fluxes they take.
const Foam::scalar closer = 0.1;
// A pseudo-step is no longer than this share of the time in which the gas that leaves a cell empties it.
const Foam::scalar residence = 0.25;

} // End anonymous namespace


bool Foam::calcine::gas::isDual() const
{
    return reactions_ && window_.storageSpan > (1 + longer)*window_.motionSpan;
}


void Foam::calcine::gas::evaluateReactions()
{
    const clockValue begun(true);
    reactionSpan_ = scalarField(mesh_.nCells(), window_.motionSpan);
    if (isDual())
    {
        scalarField leaving(mesh_.nCells(), Zero);
        forAll(flux_, facei)
        {
            leaving[mesh_.faceOwner()[facei]] += max(flux_[facei], scalar(0));
            if (facei < mesh_.nInternalFaces())
            {
                leaving[mesh_.faceNeighbour()[facei]] += max(-flux_[facei], scalar(0));
            }
        }
        const scalarField held(residence*given_.voidFraction*density()*mesh_.cellVolumes());
        forAll(held, celli)
        {
            if (leaving[celli]*window_.motionSpan > held[celli])
            {
                reactionSpan_[celli] = held[celli]/leaving[celli];
            }
        }
    }
    reactions_->evaluate(reactionSpan_, thermo_->T(), species_->Y(), *models_);
    reactionTime_ += begun.elapsed();
}


void Foam::calcine::gas::beginReactions()
{
    if (!reactions_)
    {
        return;
    }
    speciesMade_.setSize(species_->Y().size());
    particlesExchangeGas_ = particlesExchangeGas();
    // Else each pseudo-step takes the rates of its own start.
    if (!isDual())
    {
        evaluateReactions();
        react();
    }
}


// Sets what the equations take, with the pseudo-step where there is one.
void Foam::calcine::gas::react()
{
    const bool pseudo = isDual();
    // In an early iterate the masses of continuity may be no masses of a gas.
    const scalarField mass
    (
        pseudo
      ? scalarField(given_.voidFraction*density()*mesh_.cellVolumes())
      : committed_.mass
    );
    heatMade_ = scalarField(mass.size(), Zero);
    forAll(speciesMade_, k)
    {
        speciesMade_[k] = mass*reactions_->rates()[k];
        heatMade_ -= species_->mixture()[k].formationEnthalpy()*speciesMade_[k];
    }
    pseudoInertia_.clear();
    if (pseudo)
    {
        // Where nothing reacts nothing need be held back.
        scalarField fastest(mass.size(), Zero);
        for (const scalarField& rate : reactions_->rates())
        {
            fastest = max(fastest, mag(rate));
        }
        pseudoInertia_ = pos(fastest - VSMALL)*mass/reactionSpan_;
        speciesBefore_.setSize(speciesMade_.size());
        forAll(speciesMade_, k)
        {
            speciesBefore_[k] = species_->Y()[k].primitiveField();
        }
        temperatureBefore_ = thermo_->T().primitiveField();
    }
}


// What reactions give to a species, with the pseudo-step; the sign is that of a source.
void Foam::calcine::gas::addMade(label k, fvScalarMatrix& matrix) const
{
    if (!reactions_)
    {
        return;
    }
    matrix.source() += speciesMade_[k];
    if (pseudoInertia_.size())
    {
        matrix.diag() += pseudoInertia_;
        matrix.source() += pseudoInertia_*speciesBefore_[k];
    }
}


// The same for the enthalpy h, whose fractions were those before the pseudo-step.
void Foam::calcine::gas::addHeatMade(fvScalarMatrix& matrix) const
{
    if (!reactions_)
    {
        return;
    }
    matrix.source() += heatMade_;
    if (pseudoInertia_.size())
    {
        matrix.diag() += pseudoInertia_;
        matrix.source() += pseudoInertia_*enthalpyBefore_;
    }
}


// `flow`: the residual of momentum and continuity.
Foam::scalar Foam::calcine::gas::solveScalars(scalar flow, report& result)
{
    if (!isDual())
    {
        const scalar residual = solveSpecies(result);
        return max(residual, solveEnthalpy(result));
    }
    const scalar enough = max(outerTolerance_, closer*flow);
    scalar first = 0, change = 0;
    for (label step = 0; step < pseudoSteps; ++step)
    {
        scalar residual = conserveElements(result);
        evaluateReactions();
        react();
        enthalpyBefore_ = thermo_->he().primitiveField();
        residual = max(residual, solveSpecies(result));
        residual = max(residual, solveEnthalpy(result));
        guard(true);
        thermo_->correct();
        if (step == 0)
        {
            first = residual;
        }
        const scalarField& T = thermo_->T().primitiveField();
        change = gMax(mag(T - temperatureBefore_)/T);
        forAll(speciesBefore_, k)
        {
            change = max(change, gMax(mag(species_->Y()[k].primitiveField() - speciesBefore_[k])));
        }
        if (change <= enough)
        {
            break;
        }
    }
    return max(first, change);
}


void Foam::calcine::gas::closeReactions(report& result)
{
    if (!isDual())
    {
        return;
    }
    const label species = speciesMade_.size();
    scalarList here(species), reached(species), masses(reactions_->elements().size());
    heatMade_ = Zero;
    forAll(pseudoInertia_, celli)
    {
        // Where there is less than nothing of an element, beside steep gradients on skewed meshes, nothing is made of that.
        for (const scalar least : {-GREAT, scalar(0)})
        {
            for (label k = 0; k < species; ++k)
            {
                here[k] = max(species_->Y()[k][celli], least);
                reached[k] = speciesBefore_[k][celli]
                  + reactionSpan_[celli]*reactions_->rates()[k][celli];
            }
            reactions_->elementsOf(here, masses);
            if (reactions_->restoreElements(masses, reached))
            {
                break;
            }
        }
        for (label k = 0; k < species; ++k)
        {
            speciesMade_[k][celli] = pseudoInertia_[celli]*(reached[k] - here[k]);
            heatMade_[celli] -=
                species_->mixture()[k].formationEnthalpy()*speciesMade_[k][celli];
        }
    }
    pseudoInertia_.clear();
    solveSpecies(result);
    solveEnthalpy(result);
    thermo_->correct();
}
