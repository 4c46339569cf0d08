// Reactions of the gas with itself, in species and enthalpy alike, as in Calcine's native gas: per kg of gas
//
//   w_k = (R_k(Y, T; dt) - Y_k)/dt,   q = -sum h0_k w_k,
//
// with what OpenFOAM's chemistry makes of a cell's gas over the motion span, R, and the enthalpies of formation h0.
//
// Where the gas stores over the motion span the window takes the rates of its start once. Where it stores over a longer
// one, the equations with the rates of their own end are iterated in pseudo-steps of dt (dual time stepping),
//
//   m (Y - Y0)/dt + (m Y - m_old Y_old)/dtau + transport = m w(Y0),
//
// so that the place of a steady flame does not depend on dtau. After the last pseudo-step the equations are solved once
// more without it, with m (R' - Y)/dt in place of m w, which is what that step took in all, R' being R(Y0) with the elements of
// the new Y: so energy and every element close whatever the iteration did, and no cell gives what it does not have.
#include "gas.H"

namespace
{

// A span is longer than the motion span beyond this share: less is round-off of clocks.
const Foam::scalar longer = 1e-6;
// Pseudo-steps in an outer iteration at most.
const Foam::label pseudoSteps = 5;

} // End anonymous namespace


bool Foam::calcine::gas::isDual() const
{
    return reactions_ && window_.storageSpan > (1 + longer)*window_.motionSpan;
}


void Foam::calcine::gas::evaluateReactions()
{
    reactions_->evaluate(window_.motionSpan, thermo_->T(), species_->Y(), *models_);
}


void Foam::calcine::gas::beginReactions()
{
    if (!reactions_)
    {
        return;
    }
    speciesMade_.setSize(species_->Y().size());
    evaluateReactions();
    react(false);
}


// Sets what the equations take, with the pseudo-step or without.
void Foam::calcine::gas::react(bool pseudo)
{
    // In an early iterate the masses of continuity may be no masses of a gas.
    const scalarField mass
    (
        isDual()
      ? scalarField(given_.voidFraction*density()*mesh_.cellVolumes())
      : committed_.mass
    );
    heatMade_ = scalarField(mass.size(), Zero);
    forAll(speciesMade_, k)
    {
        speciesMade_[k] = mass*reactions_->rates()[k];
        heatMade_ -= species_->mixture()[k].formationEnthalpy()*speciesMade_[k];
    }
    pseudoInertia_ = pseudo ? scalarField(mass/window_.motionSpan) : scalarField();
    if (pseudo)
    {
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


Foam::scalar Foam::calcine::gas::solveScalars(report& result)
{
    if (!isDual())
    {
        const scalar residual = solveSpecies(result);
        return max(residual, solveEnthalpy(result));
    }
    scalar first = 0, change = 0;
    for (label step = 0; step < pseudoSteps; ++step)
    {
        evaluateReactions();
        react(true);
        enthalpyBefore_ = thermo_->he().primitiveField();
        scalar residual = solveSpecies(result);
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
        if (change <= outerTolerance_)
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
    const scalarField mass(given_.voidFraction*density()*mesh_.cellVolumes());
    const label species = speciesMade_.size();
    scalarList here(species), reached(species);
    heatMade_ = Zero;
    forAll(mass, celli)
    {
        for (label k = 0; k < species; ++k)
        {
            here[k] = species_->Y()[k][celli];
            reached[k] = speciesBefore_[k][celli]
              + window_.motionSpan*reactions_->rates()[k][celli];
        }
        reactions_->restoreElements(here, reached);
        for (label k = 0; k < species; ++k)
        {
            speciesMade_[k][celli] = mass[celli]*(reached[k] - here[k])/window_.motionSpan;
            heatMade_[celli] -=
                species_->mixture()[k].formationEnthalpy()*speciesMade_[k][celli];
        }
    }
    pseudoInertia_.clear();
    solveSpecies(result);
    solveEnthalpy(result);
    thermo_->correct();
}
