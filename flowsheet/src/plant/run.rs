//! A plant in time.

use super::explicit::DormandPrince;
use super::flows::{FlowWorkspace, Moment};
use super::implicit::ImplicitRungeKutta;
use super::ledger::PlantLedger;
use super::method::{Followed, Span, StepMethod};
use super::stabilised::Chebyshev;
use super::topology::Plant;
use crate::{CoupledBed, PlantError};

/// How a plant is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Dormand and Prince's explicit pair of fifth order: cheap steps, of which fast exchange takes many.
    Explicit,
    /// Runge–Kutta–Chebyshev, explicit and of second order: as many stages as fast exchange asks for.
    Stabilised,
    /// Kennedy and Carpenter's ESDIRK4(3)6L, with a Jacobian by differences.
    Stiff,
}

/// Most steps between two times that are asked for.
const MOST_STEPS: usize = 2_000_000;

/// What decides how a run goes on: with the plant itself, all of a checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantStep {
    /// Time in s.
    pub time: f64,
    /// Unknowns.
    pub unknowns: Vec<f64>,
    /// Totals since the start.
    pub totals: Vec<f64>,
    /// Streams: tear streams begin there.
    pub streams: Vec<f64>,
    /// Length of the next step in s, as far as it is known.
    pub step: f64,
    /// Length of the next window in s.
    pub window: f64,
    /// Largest closure of each tear stream so far.
    pub closures: Vec<f64>,
    /// What was held at the start.
    pub held: Vec<Vec<f64>>,
}

/// A plant that is followed in time, with all recycles closed at every evaluation (docs/theory.md, FLS-4).
pub struct PlantRun<'a> {
    pub(super) plant: &'a Plant,
    method: Box<dyn StepMethod>,
    pub(super) tolerance: f64,
    pub(super) time: f64,
    pub(super) now: Followed,
    scales: Vec<f64>,
    pub(super) held: Vec<Vec<f64>>,
    pub(super) closures: Vec<f64>,
    /// Length of the next window of waveform relaxation in s; zero before the first.
    pub(super) window: f64,
    /// Beds that are computed elsewhere, in the order of their units.
    pub(super) beds: Vec<Box<dyn CoupledBed>>,
    stops: Option<Box<dyn Fn() -> bool + Send>>,
}

impl<'a> PlantRun<'a> {
    /// A plant at its start.
    pub fn new(
        plant: &'a Plant,
        integrator: Integrator,
        tolerance: f64,
    ) -> Result<Self, PlantError> {
        Self::from(plant, plant.start(), integrator, tolerance)
    }

    /// A plant from given unknowns at time zero.
    pub fn from(
        plant: &'a Plant,
        y: Vec<f64>,
        integrator: Integrator,
        tolerance: f64,
    ) -> Result<Self, PlantError> {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(PlantError::Value {
                place: "integrator".into(),
                quantity: "tolerance",
                value: tolerance,
                allowed: "it is above 0 and below 1",
            });
        }
        let mut run = Self {
            plant,
            method: match integrator {
                Integrator::Explicit => Box::new(DormandPrince::default()),
                Integrator::Stabilised => Box::new(Chebyshev::default()),
                Integrator::Stiff => Box::new(ImplicitRungeKutta::default()),
            },
            tolerance,
            time: 0.0,
            held: plant.held(&y),
            scales: plant.scales(),
            now: Followed {
                y,
                totals: vec![0.0; plant.totals()],
                work: FlowWorkspace::new(plant),
                steps: [0; 2],
            },
            closures: vec![0.0; plant.tears().len()],
            window: 0.0,
            beds: Vec::new(),
            stops: None,
        };
        run.settle()?;
        Ok(run)
    }

    /// Computes the streams of the present unknowns.
    pub(super) fn settle(&mut self) -> Result<(), PlantError> {
        let at = Moment {
            time: self.time,
            end: f64::INFINITY,
        };
        self.plant.flows(at, &self.now.y, &mut self.now.work)?;
        self.note_closures();
        self.plant.verify(at, &self.now.y, &self.now.work)
    }

    /// Keeps the largest closure of each tear stream; within a window of waveform relaxation there is none.
    fn note_closures(&mut self) {
        let pairs = self.closures.iter_mut().zip(&self.now.work.closures);
        pairs.for_each(|(largest, own)| *largest = largest.max(*own));
    }

    /// Advances to a time in s.
    pub fn advance(&mut self, until: f64) -> Result<(), PlantError> {
        self.go(until, |_| ())
    }

    /// [`Self::advance`], and the lengths in s of the steps that it took.
    pub(super) fn advance_and_tell(&mut self, until: f64) -> Result<Vec<f64>, PlantError> {
        let mut steps = Vec::new();
        self.go(until, |took| steps.push(took))?;
        Ok(steps)
    }

    /// [`Self::advance`] by steps of given lengths in s.
    pub(super) fn advance_by(&mut self, until: f64, steps: &[f64]) -> Result<(), PlantError> {
        let mut steps = steps.iter();
        while self.time < until {
            let end = self.plant.next_break(self.time).min(until);
            let mut fresh = true;
            while let (true, Some(step)) = (self.time < end, steps.next()) {
                self.method.set_step(*step);
                self.step_towards(end, fresh, true)?;
                fresh = false;
            }
            self.time = end;
            self.settle()?;
        }
        Ok(())
    }

    fn go(&mut self, until: f64, mut tell: impl FnMut(f64)) -> Result<(), PlantError> {
        while self.time < until {
            let end = self.plant.next_break(self.time).min(until);
            self.follow(end, &mut tell)?;
            self.time = end;
            self.exchange()?;
            self.settle()?;
        }
        Ok(())
    }

    /// Steps from the present time to `end`, between which nothing jumps; tells the length of each step in s.
    pub(super) fn follow(&mut self, end: f64, mut tell: impl FnMut(f64)) -> Result<(), PlantError> {
        for step in 0..MOST_STEPS {
            let left = end - self.time;
            let took = self.step_towards(end, step == 0, false)?;
            tell(took);
            if took >= left {
                return Ok(());
            }
        }
        Err(PlantError::Steps {
            reached: self.time,
            cause: "it took too many steps; let the `stiff` integrator follow it, or raise the tolerance",
        })
    }

    /// Ends what is followed with [`PlantError::Interrupted`] before the step in which this says so.
    pub fn stop_when(&mut self, stops: impl Fn() -> bool + Send + 'static) {
        self.stops = Some(Box::new(stops));
    }

    /// One step; what it took in s.
    fn step_towards(&mut self, end: f64, fresh: bool, forced: bool) -> Result<f64, PlantError> {
        if self.stops.as_ref().is_some_and(|stops| stops()) {
            return Err(PlantError::Interrupted(self.time));
        }
        let at = Moment {
            time: self.time,
            end,
        };
        let span = Span {
            plant: self.plant,
            at,
            scales: &self.scales,
            tolerance: self.tolerance,
            fresh,
            forced,
        };
        let took = self.method.advance(&span, &mut self.now)?;
        // The last stage is at the end of the step.
        self.note_closures();
        self.time += took;
        let now = Moment {
            time: self.time,
            end,
        };
        self.plant.verify(now, &self.now.y, &self.now.work)?;
        Ok(took)
    }

    /// What a window begins with.
    pub(super) fn clone_state(&self) -> (f64, Vec<f64>, Vec<f64>, f64) {
        let (y, totals) = (self.now.y.clone(), self.now.totals.clone());
        (self.time, y, totals, self.method.step())
    }

    /// Back to what a window began with.
    pub(super) fn restore(&mut self, to: &(f64, Vec<f64>, Vec<f64>, f64)) {
        self.time = to.0;
        self.now.y.copy_from_slice(&to.1);
        self.now.totals.copy_from_slice(&to.2);
        self.method.set_step(to.3);
    }

    /// Time in s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Unknowns.
    pub fn unknowns(&self) -> &[f64] {
        &self.now.y
    }

    /// Unknowns of a unit.
    pub fn unit(&self, index: usize) -> &[f64] {
        &self.now.y[self.plant.units[index].state.clone()]
    }

    /// A stream.
    pub fn stream(&self, index: usize) -> &[f64] {
        self.now.work.stream(self.plant, index)
    }

    /// Steps, and steps that were repeated.
    pub fn steps(&self) -> [usize; 2] {
        self.now.steps
    }

    /// Ways round the recycles, all in all.
    pub fn rounds(&self) -> usize {
        self.now.work.rounds
    }

    /// Balances since the start.
    pub fn ledger(&self) -> PlantLedger {
        let now = self.plant.held(&self.now.y);
        self.plant
            .ledger(&self.held, &now, &self.now.totals, &self.closures)
    }

    /// All that decides how the run goes on.
    pub fn checkpoint(&self) -> PlantStep {
        PlantStep {
            time: self.time,
            unknowns: self.now.y.clone(),
            totals: self.now.totals.clone(),
            streams: self.now.work.streams.clone(),
            step: self.method.step(),
            window: self.window,
            closures: self.closures.clone(),
            held: self.held.clone(),
        }
    }

    /// Goes on from a checkpoint of the same plant: the same bits as without.
    pub fn resume(&mut self, from: PlantStep) {
        self.time = from.time;
        self.now.y = from.unknowns;
        self.now.totals = from.totals;
        self.now.work.streams = from.streams;
        self.method.set_step(from.step);
        self.window = from.window;
        self.closures = from.closures;
        self.held = from.held;
    }
}
