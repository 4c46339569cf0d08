//! Driving a run from a program: open a case, step, look, set, checkpoint, finish.
//!
//! A [`Simulation`] owns all that a run needs, may be sent to another thread, and installs no signal handlers.
//! `calcine run` is its first user: the same case stepped here and run there gives the same bits.
//!
//! ```
//! use calcine::simulation::{BoundaryQuantity, Simulation};
//! # let case = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-column.toml");
//! # let folder = tempfile::tempdir()?;
//! # let out = folder.path().join("results");
//!
//! let mut simulation = Simulation::open(&case).out(&out).start()?;
//! simulation.advance_to(0.02)?;
//! let hottest = simulation.particle_temperature().iter().copied().fold(0.0, f64::max);
//! if hottest < 350.0 {
//!     simulation.set_boundary("bottom", BoundaryQuantity::Temperature(380.0))?;
//! }
//! simulation.step()?;
//! assert!(simulation.time() > 0.02);
//! simulation.stop()?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Units are SI. Times are process time in s, as in case files. Fields are those of the last committed window; cells
//! are numbered as in the mesh, particles stand in ascending id. What is set takes effect at the start of the next
//! window, is logged, and is part of the checkpoint.
//!
//! Runs side by side in one process share its threads; runs that are to be independent are processes.

mod builder;
mod error;
mod folder;

use std::path::{Path, PathBuf};

use calcine_coupler::boundary_value::BoundaryValue;
use calcine_coupler::coordinator::{CoupledRun, RunError};
use calcine_coupler::ledger::Ledger;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::observer::{CommittedState, Observer};
use calcine_coupler::part::{GasFields, ParticleFields};
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use tracing::dispatcher::{Dispatch, with_default};
use tracing::error;

pub use builder::SimulationBuilder;
pub(crate) use builder::results_folder;
pub use calcine_coupler::boundary_value::BoundaryQuantity;
pub use calcine_coupler::coordinator::{Control, Ending};
pub use error::SimulationError;
pub use folder::finished;
pub(crate) use folder::{OWN_LOG, begun_before, claim, has_checkpoint};

use crate::case::model::Case;
use crate::results::summary::RunFailure;
use crate::results::{Recorder, Summary};

/// A run in the hands of a program; see the [module](self).
pub struct Simulation {
    // Dropped in this order: the solvers end before what they depend on.
    run: CoupledRun,
    supervisor: Supervisor,
    recorder: Recorder,
    observers: Vec<Box<dyn Observer + Send>>,
    case: Case,
    out: PathBuf,
    log: Dispatch,
    notes: Vec<String>,
    ending: Option<Ending>,
    /// True after a failure: the parts may stand in the middle of a window.
    failed: bool,
    _lock: Option<folder::HeldFolder>,
}

impl Simulation {
    /// One window, with the output and the checkpoint that are due after it. `None`: the run goes on. An interrupt
    /// ends it after the window with a checkpoint.
    pub fn step(&mut self) -> Result<Option<Ending>, SimulationError> {
        let ending = self.act(|run, supervisor, observers| run.step(supervisor, observers))?;
        self.ending.clone_from(&ending);
        if let Some(Ending::Checkpointed(_)) = ending {
            self.record_stop(None);
        }
        Ok(ending)
    }

    /// Steps until the process time in s is reached or passed, or the run ends. Windows are as long as in any run of
    /// the case: none is cut short to end at this time.
    pub fn advance_to(&mut self, time: f64) -> Result<Option<Ending>, SimulationError> {
        while self.time() < time {
            let ending = self.step()?;
            if ending.is_some() {
                return Ok(ending);
            }
        }
        Ok(None)
    }

    /// What is to be told of the start: a checkpoint that was damaged, and the older one that the run goes on from in its place.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Steps to the end of the case, or to an interrupt's checkpoint.
    pub fn finish(&mut self) -> Result<Ending, SimulationError> {
        loop {
            if let Some(ending) = self.step()? {
                return Ok(ending);
            }
        }
    }

    /// Writes a checkpoint and goes on.
    pub fn checkpoint(&mut self) -> Result<(), SimulationError> {
        self.act(|run, _, observers| run.checkpoint(observers))
    }

    /// Ends the run where it stands, with a checkpoint from which `resume` goes on. One that has ended stays as it is.
    pub fn stop(&mut self) -> Result<Ending, SimulationError> {
        if let Some(ending) = &self.ending {
            return Ok(ending.clone());
        }
        let ending = self.act(|run, supervisor, observers| run.stop(supervisor, observers))?;
        self.ending = Some(ending.clone());
        self.record_stop(None);
        Ok(ending)
    }

    /// Sets a condition of the gas at a patch from the start of the next window on, in place of the case's value or
    /// schedule.
    pub fn set_boundary(
        &mut self,
        patch: &str,
        quantity: BoundaryQuantity,
    ) -> Result<(), SimulationError> {
        self.set(Control::Boundary(BoundaryValue {
            patch: patch.to_owned(),
            quantity,
        }))
    }

    /// Sets the mass flow of a feed in kg/s.
    pub fn set_feed_rate(&mut self, feed: &str, rate: f64) -> Result<(), SimulationError> {
        self.set(Control::FeedRate {
            feed: feed.to_owned(),
            rate,
        })
    }

    /// Sets the mass flow of a discharge in kg/s at most; `f64::INFINITY`: all that is in its zone.
    pub fn set_outlet_rate(&mut self, outlet: &str, rate: f64) -> Result<(), SimulationError> {
        self.set(Control::OutletRate {
            outlet: outlet.to_owned(),
            rate,
        })
    }

    /// Sets a condition, a feed or a discharge. What is refused changes nothing, and the run can go on.
    pub fn set(&mut self, control: Control) -> Result<(), SimulationError> {
        self.ready()?;
        let (run, log) = (&mut self.run, &self.log);
        Ok(with_default(log, || run.set(control))?)
    }

    /// What was set so far, each condition once.
    pub fn controls(&self) -> &[Control] {
        self.run.controls()
    }

    /// Process time in s.
    pub fn time(&self) -> f64 {
        self.state().clocks.process.seconds()
    }

    /// Motion time in s.
    pub fn motion_time(&self) -> f64 {
        self.state().clocks.motion.seconds()
    }

    /// Windows committed so far.
    pub fn windows(&self) -> u64 {
        self.state().windows
    }

    /// The committed state: clocks, fields, bed, particles, ledger, convergence.
    pub fn state(&self) -> CommittedState<'_> {
        self.run.state()
    }

    /// Fields of the gas, one value a cell.
    pub fn gas(&self) -> GasFields<'_> {
        self.state().gas
    }

    /// Void fraction of each cell, mapped and smoothed.
    pub fn void_fraction(&self) -> &[f64] {
        &self.state().bed.void_fraction
    }

    /// The particles, in ascending id.
    pub fn particles(&self) -> ParticleFields<'_> {
        self.state().particles
    }

    /// Surface temperature of each particle in K.
    pub fn particle_temperature(&self) -> &[f64] {
        self.state().particle_temperature
    }

    /// The gas mesh.
    pub fn mesh(&self) -> &Mesh {
        self.state().mesh
    }

    /// Names and values of the case's quantities after the last committed window, as a row of `series.csv` has them; NaN where nothing
    /// is known yet.
    pub fn quantities(&self) -> Vec<(&str, f64)> {
        self.recorder.quantities(&self.state())
    }

    /// What is conserved, summed over all windows.
    pub fn ledger(&self) -> &Ledger {
        self.run.ledger()
    }

    /// The case, with what was set when it was opened.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The results folder.
    pub fn folder(&self) -> &Path {
        &self.out
    }

    /// The summary as written last, as `summary.json` has it.
    pub fn summary(&self) -> Option<&Summary> {
        self.recorder.summary()
    }

    /// How the run ended, if it has.
    pub fn ending(&self) -> Option<&Ending> {
        self.ending.as_ref()
    }

    /// Interrupts of this run, to be raised from another thread: one leaves a checkpoint after the window, two end the
    /// run at once.
    pub fn interrupts(&self) -> Interrupts {
        self.supervisor.interrupts().clone()
    }

    /// Has an observer look at each window from the next one on.
    pub fn observe(
        &mut self,
        mut observer: Box<dyn Observer + Send>,
    ) -> Result<(), SimulationError> {
        let told = observer.start(&self.run.state());
        told.map_err(RunError::from)?;
        self.observers.push(observer);
        Ok(())
    }

    fn ready(&self) -> Result<(), SimulationError> {
        match &self.ending {
            Some(ending) => Err(SimulationError::Over(ending.clone())),
            None if self.failed => Err(SimulationError::Failed),
            None => Ok(()),
        }
    }

    /// Acts on the run with its log; a failure is recorded in the results.
    fn act<T>(
        &mut self,
        action: impl FnOnce(
            &mut CoupledRun,
            &Supervisor,
            &mut [&mut dyn Observer],
        ) -> Result<T, RunError>,
    ) -> Result<T, SimulationError> {
        self.ready()?;
        let (run, supervisor) = (&mut self.run, &self.supervisor);
        let mut observers = all(&mut self.recorder, &mut self.observers);
        let done = with_default(&self.log, || action(run, supervisor, &mut observers));
        done.map_err(|failure| {
            self.failed = true;
            let message = crate::error_chain::chain(&failure);
            with_default(&self.log, || error!("{message}"));
            let failure = SimulationError::from(failure);
            self.record_stop(Some(RunFailure {
                code: failure.exit_code(),
                message,
            }));
            failure
        })
    }

    /// Says in the results that the run ended early; a failure of that is only logged.
    fn record_stop(&mut self, failure: Option<RunFailure>) {
        let recorder = &mut self.recorder;
        with_default(&self.log, || {
            if let Err(failure) = recorder.stopped(failure) {
                error!("{}", crate::error_chain::chain(&failure));
            }
        });
    }
}

/// All observers of a run, the recorder first.
fn all<'a>(
    recorder: &'a mut Recorder,
    others: &'a mut [Box<dyn Observer + Send>],
) -> Vec<&'a mut dyn Observer> {
    let others = others.iter_mut().map(|one| &mut **one as &mut dyn Observer);
    let recorder: &mut dyn Observer = recorder;
    std::iter::once(recorder).chain(others).collect()
}

// It may be sent to another thread, whatever its backends are.
const _: () = {
    const fn sent<T: Send>() {}
    sent::<Simulation>();
};
