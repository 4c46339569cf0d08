//! Where the time goes: the one place that measures stages.

use std::time::{Duration, Instant};

use rustix::time::{ClockId, clock_gettime};

use crate::observer::Timing;

/// Stages that have an account of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// Waiting for the gas; processor time of this process too.
    Gas,
    /// Waiting for the particles; processor time of this process too.
    Particles,
    /// Inside and between particles.
    Interior,
    /// Base mapping.
    Mapping,
    /// The smoother.
    Smoother,
    /// Laws between the phases and the exchange.
    Exchange,
    /// Observers and checkpoints.
    Output,
}

/// The accounts of a run.
#[derive(Debug, Default)]
pub(super) struct Meter {
    pub timing: Timing,
}

/// A stage that is under way.
pub(super) struct Running {
    stage: Stage,
    begun: Instant,
    used: Option<Duration>,
}

impl Meter {
    /// Begins a stage.
    pub fn start(stage: Stage) -> Running {
        let solver = matches!(stage, Stage::Gas | Stage::Particles);
        Running {
            stage,
            used: solver.then(processor),
            begun: Instant::now(),
        }
    }

    /// Adds what a stage took to its account.
    pub fn stop(&mut self, running: Running) {
        let (wall, of) = (running.begun.elapsed(), &mut self.timing);
        let used = running
            .used
            .map(|before| processor().saturating_sub(before));
        let used = used.unwrap_or_default();
        match running.stage {
            Stage::Gas => {
                of.gas += wall;
                of.gas_processor += used;
            }
            Stage::Particles => {
                of.particles += wall;
                of.particles_processor += used;
            }
            Stage::Interior => of.interior += wall,
            Stage::Mapping => of.mapping += wall,
            Stage::Smoother => of.smoother += wall,
            Stage::Exchange => of.exchange += wall,
            Stage::Output => of.output += wall,
        }
    }

    /// A stage in one go.
    pub fn time<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let running = Self::start(stage);
        let value = work();
        self.stop(running);
        value
    }
}

/// Processor time that all threads of this process have used.
fn processor() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}
