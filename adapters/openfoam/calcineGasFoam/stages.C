// The stages of an attempt, each with an outer loop: one, or the two implicit ones of docs/theory.md (TSM-11), gamma = 1 - 1/sqrt(2). The
// second is a step over gamma of the window from the start and (1 - gamma)/gamma times what the first changed, in what cells hold.
#include "gas.H"
#include "acceleration.H"
#include "correctionPace.H"

namespace
{

using namespace Foam;

const scalar stageShare = 1 - Foam::sqrt(scalar(0.5));

void scaleAndAdd(calcine::balance& total, const calcine::balance& first, scalar amount)
{
    total.stored += amount*first.stored;
    total.storedMagnitude += amount*first.storedMagnitude;
    total.boundary += amount*first.boundary;
    total.boundaryMagnitude += amount*first.boundaryMagnitude;
    total.exchange += amount*first.exchange;
    total.source += amount*first.source;
    total.sourceMagnitude += amount*first.sourceMagnitude;
}

// Makes a report of the second stage one of the window: mean rates of both, and amounts, of which the first's count so often.
void joinFirst(calcine::report& result, const calcine::report& first, scalar amount)
{
    result.heat = stageShare*result.heat + (1 - stageShare)*first.heat;
    result.drag = stageShare*result.drag + (1 - stageShare)*first.drag;
    scaleAndAdd(result.mass, first.mass, amount);
    scaleAndAdd(result.energy, first.energy, amount);
    for (direction axis = 0; axis < 3; ++axis)
    {
        scaleAndAdd(result.momentum[axis], first.momentum[axis], amount);
    }
    forAll(result.species, k)
    {
        scaleAndAdd(result.species[k], first.species[k], amount);
    }
    forAll(result.patches, patchi)
    {
        scalarList& flows = result.patches[patchi];
        forAll(flows, k)
        {
            flows[k] = stageShare*flows[k] + (1 - stageShare)*first.patches[patchi][k];
        }
    }
    result.storageClock += amount*first.storageClock;
    result.outerIterations += first.outerIterations;
    result.linearIterations += first.linearIterations;
    result.residual = max(result.residual, first.residual);
    result.volumeResidual = max(result.volumeResidual, first.volumeResidual);
    result.converged = result.converged && first.converged;
}

} // End anonymous namespace


void Foam::calcine::gas::beginStage(const window& when, const scalarField& voidFraction)
{
    window_ = when;
    given_.voidFraction = voidFraction;
    voidFraction_.primitiveFieldRef() = given_.voidFraction;
    voidFraction_.correctBoundaryConditions();
    pressureShare_ = given_.voidFraction;
    if (takesAllPressure_)
    {
        pressureShare_ = 1;
    }
    // Inlets of a given velocity carry gas of pRef, whatever the pressure of a closed domain is.
    modelPressure_ == dimensionedScalar("p", dimPressure, pRef_);
    boundary_.updateState(when.processEnd, pRef_, thermo_->T(), p_);
    if (species_)
    {
        boundary_.updateComposition(when.processEnd, species_->Y());
    }
    thermo_->he().correctBoundaryConditions();
    thermo_->correct();
    boundary_.updateVelocity(when.processEnd, given_.voidFraction, thermo_->rho()(), U_);
    modelPressure_ == dimensionedScalar("p", dimPressure, committed_.basePressure);
    thermo_->correct();
    // Without a commit the bed of this attempt says how much gas there is.
    if (when.index == 0 || !committed_.placed)
    {
        place();
        restore();
        models_->place(committed_.voidFraction*density());
    }
    updateInflow();
    U_.correctBoundaryConditions();
    if (oblique_)
    {
        const scalarField held(committed_.mass/mesh_.cellVolumes());
        oldMassGradient_ = massVelocityGradient(held*committed_.velocity, held, committed_.flux);
        massGradient_ = oldMassGradient_;
    }

    models_->begin();
    beginReactions();
}


void Foam::calcine::gas::step(report& result)
{
    result = report();
    correctionPace pace(outer_);
    acceleration iterates;
    const accelerated flow
    {
        U_.primitiveFieldRef(), pressureGradient_, pressureAlong_, p_.primitiveFieldRef(), flux_
    };
    scalar settling = 0;
    for (label outer = 1; outer <= max(outer_.iterations, 1); ++outer)
    {
        // The switching of limiters may otherwise lead from one iterate to another and back for ever.
        share_ = outer > 8 ? 0.5 : 1;
        updateBasePressure();
        const scalarField rho(density());
        setFlux();
        const bool combines = pace.accelerated();
        if (combines)
        {
            iterates.begin(flow, mass_, pressureShare_/momentumDiagonal_);
        }
        result.residual = predictVelocity(rho, result);
        result.residual = max(result.residual, assemblePressure(rho, outer == 1));
        if (pace.judge(outer - 1, max(result.residual, settling)))
        {
            iterates.forget();
        }
        updateFriction();
        if (oblique_ && outer == 1)
        {
            pace.begin(largestFriction());
        }
        // Friction at walls and what transport does at faces follow a longer sequence of corrections (native-solver/src/gas/friction.rs).
        follows_ = pace.corrections() > holding_;
        holdFriction();
        if (oblique_ && outer == 1)
        {
            // The gradient that carries pressures along faces is not kept between windows: it follows the fluxes at hand.
            updateForce();
            for (label settling = 0; settling < 4; ++settling)
            {
                updatePressureAlong(false);
            }
        }
        for (label correction = 0; correction < pace.corrections(); ++correction)
        {
            correctPressure(rho, correction == 0, result);
        }
        mass_ = committed_.mass - window_.storageSpan*(outflow() - massSource());
        setFlux();
        settling = unsettled(rho)/tolerances::worst;
        result.residual = max(result.residual, settling);
        result.residual = max(result.residual, solveScalars(result.residual, result));
        guard(true);
        result.outerIterations = outer;
        updateProperties();
        if (result.residual <= outer_.tolerance)
        {
            result.converged = true;
            break;
        }
        if (combines && outer < outer_.iterations)
        {
            iterates.combine(flow, pace.share());
            U_.correctBoundaryConditions();
            p_.correctBoundaryConditions();
            mass_ = committed_.mass - window_.storageSpan*(outflow() - massSource());
        }
    }
    closeReactions(result);
    guard(false);
    finishReport(result);
}


Foam::calcine::gasState Foam::calcine::gas::beyondFirstStage(scalar beyond) const
{
    gasState state(committed_);
    const scalarField& m = committed_.mass;
    state.mass = m + beyond*(mass_ - m);
    const scalarField& h = thermo_->he().primitiveField();
    state.enthalpy = (m*committed_.enthalpy + beyond*(mass_*h - m*committed_.enthalpy))/state.mass;
    forAll(state.composition, k)
    {
        const scalarField& Y = species_->Y()[k].primitiveField();
        const scalarField& old = committed_.composition[k];
        state.composition[k] = (m*old + beyond*(mass_*Y - m*old))/state.mass;
    }
    const vectorField& u = U_.primitiveField();
    state.velocity = (m*committed_.velocity + beyond*(mass_*u - m*committed_.velocity))/state.mass;
    state.flux = committed_.flux + beyond*(flux_ - committed_.flux);
    state.basePressure += beyond*(basePressure() - committed_.basePressure);
    return state;
}


void Foam::calcine::gas::attemptTwoStages
(
    const window& when,
    const scalarField& voidFraction,
    report& result
)
{
    const scalar beyond = (1 - stageShare)/stageShare;
    window stage(when);
    stage.motionSpan = stageShare*when.motionSpan;
    stage.storageSpan = stageShare*when.storageSpan;
    stage.processEnd = when.processEnd - (1 - stageShare)*when.storageSpan;
    // The bed moves evenly over the window.
    const bool known = committed_.placed && when.index > 0;
    beginStage
    (
        stage,
        known ? scalarField(committed_.voidFraction + stageShare*(voidFraction - committed_.voidFraction)) : voidFraction
    );
    report first;
    step(first);

    const gasState start(committed_);
    committed_ = beyondFirstStage(beyond);
    stage.processEnd = when.processEnd;
    stage.index = max(when.index, uint64_t(1));
    committed_.placed = true;
    beginStage(stage, voidFraction);
    step(result);
    joinFirst(result, first, beyond);
    committed_ = start;
    window_ = when;
}
