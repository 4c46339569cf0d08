//! The outer loop of an attempt: momentum predictor, pressure corrections, continuity, enthalpy.

use std::sync::Arc;

use calcine_coupler::gas_chemistry::ReactingGas;
use calcine_coupler::part::{Convergence, GasPhases};
use calcine_coupler::setup::GasControls;

use super::acceleration::FlowAcceleration;
use super::attempt::{AttemptFrame, CellProperties};
use super::chemistry::{CellChemistry, ReactionSource, ScalarEquations};
use super::enthalpy::Enthalpy;
use super::failure::GasFailure;
use super::friction;
use super::guard;
use super::momentum::Momentum;
use super::pace::{Pace, PaceChange};
use super::phases::Stopwatch;
use super::pressure::{self, Pressure};
use super::species::SpeciesEquations;
use super::state::GasState;
use super::tolerance::{self, Assembled, ContinuityResidual, LinearTolerances, ScalarTolerance};
use crate::numerics::grid::MeshGraph;
use crate::numerics::krylov::Krylov;
use crate::numerics::matrix::Matrix;
use crate::numerics::parallel::largest;

/// Species and enthalpy need not be solved closer than this share of their initial residuals as
/// long as the outer loop goes on. After it they are, so that energy and species close whatever it did.
const SCALARS: f64 = 1e-2;

/// From this outer iteration on, what limiters leave to the last iterate follows it half way only: their
/// switching may otherwise lead from one iterate to another and back for ever. The limiter of species follows by half as much in each
/// iteration as in the one before, so that it comes to rest: it switches between them, and with it the density, for as long as it follows.
const FOLLOWED: u32 = 8;

/// Sweeps of reacting species and enthalpy in an outer iteration at most.
const SWEEPS: u32 = 5;

/// Solves at the end of an attempt by which fractions below zero are taken out of what reacts, at most.
const CLOSINGS: u32 = 3;

/// Sweeps need not change a value by less than this share of the residual of momentum and continuity, whose fluxes they take.
const CLOSER: f64 = 0.1;

/// What an attempt begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Begin {
    /// A window: what earlier ones left in the equations is dropped, so that a resumed one takes the same path.
    Window,
    /// Another state to step from, within a window.
    Stage,
    /// The same once more, from what the attempt before found.
    Again,
}

/// The equations and their scratch memory, reused from window to window.
#[derive(Debug)]
pub struct Equations {
    /// Momentum.
    pub momentum: Momentum,
    /// Pressure and mass flux.
    pub pressure: Pressure,
    /// Enthalpy.
    pub enthalpy: Enthalpy,
    /// Species.
    pub species: SpeciesEquations,
    /// Reactions of the gas with itself.
    pub chemistry: CellChemistry,
    /// Properties at the last temperature.
    pub material: CellProperties,
    /// Memory of the linear solvers.
    pub krylov: Krylov,
    /// How far what is taken explicitly from the last iterate follows it, as a share.
    share: f64,
    /// The same of the limiter of species.
    limited: f64,
    /// Residual of momentum and continuity.
    flow: f64,
    /// Continuity with the fluxes at hand.
    continuity: ContinuityResidual,
    /// By how much closer than usual continuity is solved.
    closer: f64,
    /// What they have taken so far.
    pub phases: GasPhases,
    watch: Stopwatch,
    /// Windows so far.
    windows: u32,
    best: Best,
    acceleration: FlowAcceleration,
}

/// The best that an outer loop had from when its pace did not suffice on, in memory that is kept.
#[derive(Debug, Default)]
struct Best {
    state: GasState,
    /// Residual of momentum and continuity; `None` where there is no such state.
    flow: Option<f64>,
}

impl Best {
    /// Takes up a state that is better than what is there.
    fn offer(&mut self, state: &GasState, flow: f64) {
        if self.flow.is_none_or(|best| flow < best) {
            self.state.take(state);
            self.flow = Some(flow);
        }
    }
}

impl Equations {
    /// Empty equations on a grid.
    pub fn new(grid: &Arc<MeshGraph>) -> Self {
        let matrix = Matrix::new(grid.clone());
        Self {
            momentum: Momentum::new(matrix.clone()),
            pressure: Pressure::new(matrix.clone()),
            enthalpy: Enthalpy::new(matrix.clone()),
            species: SpeciesEquations::new(matrix),
            chemistry: CellChemistry::default(),
            material: CellProperties::default(),
            krylov: Krylov::default(),
            share: 1.0,
            limited: 1.0,
            flow: f64::INFINITY,
            continuity: ContinuityResidual::default(),
            closer: 1.0,
            phases: GasPhases::default(),
            watch: Stopwatch::new(),
            windows: 0,
            best: Best::default(),
            acceleration: FlowAcceleration::default(),
        }
    }

    /// Advances `now` to the end of the frame's span; what diverged otherwise. `now` holds the first guess.
    pub fn solve(
        &mut self,
        frame: &AttemptFrame<'_>,
        controls: &GasControls,
        begin: Begin,
        now: &mut GasState,
    ) -> Result<Convergence, GasFailure> {
        let mut convergence = Convergence::default();
        if begin == Begin::Window {
            self.windows = self.windows.wrapping_add(1);
            self.pressure.forget(frame);
            self.species.begin(frame);
        }
        self.enthalpy.begin();
        if begin != Begin::Again {
            self.pressure.begin(frame);
        }
        self.chemistry.begin(frame, begin != Begin::Window);
        self.share = 1.0;
        self.limited = 1.0;
        self.closer = 1.0;
        self.watch = Stopwatch::of_window(self.windows, frame.grid.cells());
        self.assess_flow(frame, now);
        let friction = friction::largest_share(frame, &self.momentum);
        let mut pace = Pace::new(controls, self.flow, friction);
        self.best.flow = None;
        for outer in 1..=controls.outer_iterations.max(1) {
            if pace.accelerated {
                self.begin_accelerated(frame, now);
            }
            let iterated = self.iterate(frame, controls, pace.corrections, now);
            convergence.outer_iterations = outer;
            if outer >= FOLLOWED {
                self.share = 0.5;
                self.limited *= 0.5;
            }
            // Early iterates may be no state of a gas (after a start from rest a cell may give more than it
            // holds), as long as they are numbers; the last one must be one.
            let sense = guard::nonsense(now, &frame.grid.centre);
            match iterated.and_then(|iterations| sense.map(|()| iterations)) {
                Ok(iterations) => convergence.linear_iterations += iterations,
                Err(failure) => {
                    if self.best.flow.is_none() {
                        return Err(failure);
                    }
                    convergence.residual = self.go_back(frame, now);
                    pace.go_back(self.flow);
                    self.acceleration.forget();
                    continue;
                }
            }
            convergence.residual = self.assess(frame, now);
            if convergence.residual <= controls.outer_tolerance {
                if self.volume_residual(frame, now) <= tolerance::volume_bound(controls) {
                    convergence.converged = true;
                    break;
                }
                // What is left of continuity is in few cells.
                self.closer *= 0.1;
            }
            let verdict = pace.judge(controls, outer, self.flow);
            if verdict != PaceChange::GoOn {
                self.acceleration.forget();
            }
            if pace.accelerated || verdict != PaceChange::GoOn {
                self.best.offer(now, self.flow);
            }
            if pace.accelerated && verdict == PaceChange::GoOn && outer < controls.outer_iterations
            {
                self.combine(frame, pace.share, now);
            }
        }
        // What longer sequences made worse until the end.
        if !convergence.converged && self.best.flow.is_some_and(|best| self.flow > best) {
            convergence.residual = self.go_back(frame, now);
        }
        let linear = LinearTolerances::new(controls, &self.continuity);
        convergence.linear_iterations += self.close(frame, linear.scalars, now);
        guard::complaint(now, &frame.grid.centre)?;
        convergence.volume_residual = self.volume_residual(frame, now);
        if !frame.turbulence.is_laminar() {
            self.momentum.update_gradients(frame, &now.velocity);
        }
        Ok(convergence)
    }

    /// Takes up the flow before an accelerated iteration.
    fn begin_accelerated(&mut self, frame: &AttemptFrame<'_>, now: &GasState) {
        let diagonal = self.momentum.matrix.diagonal();
        let push =
            |cell: usize| frame.pressure_share[cell] * frame.grid.volume[cell] / diagonal[cell];
        self.acceleration.begin(now, self.pressure.along(), push);
    }

    /// Combines the flow after an iteration with that of earlier ones, and assembles the next one's equations with it.
    fn combine(&mut self, frame: &AttemptFrame<'_>, share: f64, now: &mut GasState) {
        self.acceleration
            .combine(now, self.pressure.along_mut(), share);
        pressure::advance_mass(frame, now);
        self.watch.lap(&mut self.phases.momentum);
        self.assess_flow(frame, now);
    }

    /// Takes up the best state, once; its residual.
    fn go_back(&mut self, frame: &AttemptFrame<'_>, now: &mut GasState) -> f64 {
        now.take(&self.best.state);
        self.best.flow = None;
        self.pressure.carry_by(frame, &now.pressure_gradient);
        self.assess(frame, now)
    }

    /// Assembles momentum with the fields at hand; how far these are from solving it and continuity.
    fn assess_flow(&mut self, frame: &AttemptFrame<'_>, now: &mut GasState) {
        self.material.update(frame, now);
        self.watch.lap(&mut self.phases.properties);
        let material = &self.material;
        self.momentum.assemble(frame, material, self.share, now);
        let unsettled = self.pressure.unsettled(frame, material, now);
        let momentum = self.momentum.residual(frame, now, unsettled);
        self.watch.lap(&mut self.phases.momentum);
        self.continuity = self.pressure.residual(frame, material, now);
        self.watch.lap(&mut self.phases.pressure);
        let continuity = self.continuity.share;
        tracing::debug!("residuals: momentum {momentum:.1e}, continuity {continuity:.1e}");
        self.flow = momentum.max(continuity);
    }

    /// Assembles all equations with the fields at hand; how far these are from solving
    /// them at once: the largest scaled residual.
    fn assess(&mut self, frame: &AttemptFrame<'_>, now: &mut GasState) -> f64 {
        self.assess_flow(frame, now);
        self.react(frame);
        let species = self
            .species
            .residual(frame, &self.material, self.limited, now);
        self.watch.lap(&mut self.phases.species);
        let carried = &self.species.carried;
        self.enthalpy
            .assemble(frame, &self.material, carried, self.share, now);
        let enthalpy = self.enthalpy.residual(now);
        self.watch.lap(&mut self.phases.enthalpy);
        let change = self.chemistry.change;
        tracing::debug!(
            "residuals: enthalpy {enthalpy:.1e}, species {species:.1e}, sweep {change:.1e}"
        );
        self.flow.max(enthalpy).max(species).max(change)
    }

    /// One outer iteration, on the momentum equation as assembled; returns linear iterations.
    fn iterate(
        &mut self,
        frame: &AttemptFrame<'_>,
        controls: &GasControls,
        corrections: u32,
        now: &mut GasState,
    ) -> Result<u32, GasFailure> {
        let mut linear = LinearTolerances::new(controls, &self.continuity);
        linear.continuity *= self.closer;
        let (krylov, material) = (&mut self.krylov, &self.material);
        let mut iterations = self.momentum.predict(frame, krylov, linear.terms, now);
        self.watch.lap(&mut self.phases.momentum);
        self.pressure
            .assemble(frame, material, &self.momentum, corrections, now);
        for _ in 0..corrections {
            iterations +=
                self.pressure
                    .correct(frame, material, &self.momentum, krylov, &linear, now);
        }
        pressure::advance_mass(frame, now);
        self.watch.lap(&mut self.phases.pressure);
        let Some(gas) = frame.chemistry.reacting() else {
            let goal = ScalarTolerance {
                absolute: linear.scalars,
                relative: SCALARS,
            };
            return Ok(iterations + self.scalars(frame, goal, Assembled::No, now));
        };
        let enough = controls.outer_tolerance.max(CLOSER * self.flow);
        self.chemistry.follow(frame, now);
        for _ in 0..SWEEPS {
            self.chemistry.start(now);
            iterations += self.conserve(frame, linear.scalars, now)?;
            self.sweep(frame, gas, controls.outer_tolerance, now)?;
            self.watch.lap(&mut self.phases.chemistry);
            if self.chemistry.change <= enough {
                break;
            }
        }
        Ok(iterations)
    }

    /// Gives species and enthalpy what reacts.
    fn react(&mut self, frame: &AttemptFrame<'_>) {
        let sources = [&mut self.species.reactions, &mut self.enthalpy.reactions];
        self.chemistry.apply(frame, sources);
    }

    /// A sweep of species and enthalpy through all cells.
    fn sweep(
        &mut self,
        frame: &AttemptFrame<'_>,
        gas: &ReactingGas,
        tolerance: f64,
        now: &mut GasState,
    ) -> Result<(), GasFailure> {
        let sources = self
            .species
            .transport(frame, &self.material, self.limited, now);
        self.species.take(frame, now);
        self.enthalpy.reactions = ReactionSource::default();
        let carried = &self.species.carried;
        self.enthalpy
            .assemble(frame, &self.material, carried, self.share, now);
        let (matrix, heat) = self.enthalpy.equation();
        let equations = ScalarEquations {
            species: self.species.matrix(),
            sources: &sources,
            diffusion: self.species.diffusion(),
            enthalpy: matrix,
            heat,
        };
        self.chemistry
            .sweep(frame, gas, equations, tolerance, now)?;
        guard::nonsense(now, &frame.grid.centre)?;
        self.chemistry.correct(frame, equations, now);
        self.chemistry.measure(&self.material.heat_capacity, now);
        self.species.take(frame, now);
        self.react(frame);
        self.material.update(frame, now);
        Ok(())
    }

    /// Elements, and the enthalpy with the heat of what has to be made; returns linear iterations.
    fn conserve(
        &mut self,
        frame: &AttemptFrame<'_>,
        absolute: f64,
        now: &mut GasState,
    ) -> Result<u32, GasFailure> {
        let Some(elements) = self.chemistry.elements() else {
            return Ok(0);
        };
        let relative = SCALARS;
        let goal = ScalarTolerance { absolute, relative };
        let (krylov, material) = (&mut self.krylov, &self.material);
        let solve = (goal, self.limited);
        let solved = self
            .species
            .conserve(frame, material, krylov, solve, elements, now);
        let Some((made, iterations)) = solved else {
            return Ok(0);
        };
        self.enthalpy.reactions = self.chemistry.source_of(frame.species(), &made);
        let carried = &self.species.carried;
        self.enthalpy
            .assemble(frame, material, carried, self.share, now);
        let iterations = iterations + self.enthalpy.solve(frame, krylov, goal, now);
        guard::nonsense(now, &frame.grid.centre)?;
        self.material.update(frame, now);
        Ok(iterations)
    }

    /// Species and enthalpy once more to the linear tolerance, with the rates at hand.
    fn close(&mut self, frame: &AttemptFrame<'_>, tolerance: f64, now: &mut GasState) -> u32 {
        let goal = ScalarTolerance {
            absolute: tolerance,
            relative: 0.0,
        };
        let mut iterations = self.scalars(frame, goal, Assembled::Yes, now);
        for _ in 0..CLOSINGS {
            if !self.chemistry.keep_positive(self.species.matrix(), now) {
                break;
            }
            self.react(frame);
            iterations += self.scalars(frame, goal, Assembled::No, now);
        }
        self.species.carry_remainder(frame, now);
        self.watch.lap(&mut self.phases.species);
        self.enthalpy.carry_remainder(frame, now);
        self.watch.lap(&mut self.phases.enthalpy);
        iterations
    }

    /// Species and enthalpy with the fluxes and masses at hand; returns linear iterations.
    fn scalars(
        &mut self,
        frame: &AttemptFrame<'_>,
        goal: ScalarTolerance,
        assembled: Assembled,
        now: &mut GasState,
    ) -> u32 {
        let (krylov, material) = (&mut self.krylov, &self.material);
        let solve = (goal, self.limited, assembled);
        let iterations = self.species.solve(frame, material, krylov, solve, now);
        self.watch.lap(&mut self.phases.species);
        if assembled == Assembled::No || frame.species() > 0 {
            let carried = &self.species.carried;
            self.enthalpy
                .assemble(frame, material, carried, self.share, now);
        }
        let iterations = iterations + self.enthalpy.solve(frame, krylov, goal, now);
        self.watch.lap(&mut self.phases.enthalpy);
        iterations
    }

    fn volume_residual(&self, frame: &AttemptFrame<'_>, now: &GasState) -> f64 {
        let density = &self.material.density;
        let (_, worst) = largest(now.mass.len(), |cell| {
            let density = density[cell];
            let mass = frame.void_fraction[cell] * density * frame.grid.volume[cell];
            (now.mass[cell] - mass).abs() / now.mass[cell]
        });
        worst
    }
}
