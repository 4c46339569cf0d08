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

/// Of stages that take less than this, processor time is looked up in one of so many and counts for all: asking the kernel takes a part of a
/// microsecond.
const SHORT: Duration = Duration::from_micros(200);
const SAMPLED: u32 = 8;

/// The accounts of a run.
#[derive(Debug, Default)]
pub(super) struct Meter {
    pub timing: Timing,
    /// Of the gas and the particles.
    looks: [Looks; 2],
}

/// Which stages of a solver have their processor time looked up.
#[derive(Debug, Default)]
struct Looks {
    /// One stage of so many, after the first.
    every: u32,
    /// Stages before the next look.
    left: u32,
}

impl Looks {
    /// For how many stages the one that begins is looked at; zero where it is not.
    fn begin(&mut self) -> u32 {
        match self.left.checked_sub(1) {
            Some(left) => {
                self.left = left;
                0
            }
            None => self.every.max(1),
        }
    }

    /// Takes up how long a stage took that was looked at.
    fn end(&mut self, wall: Duration) {
        self.every = if wall < SHORT { SAMPLED } else { 1 };
        self.left = self.every - 1;
    }
}

/// A stage that is under way.
pub(super) struct Running {
    stage: Stage,
    begun: Instant,
}

impl Meter {
    /// Begins a stage.
    pub fn start(stage: Stage) -> Running {
        Running {
            stage,
            begun: Instant::now(),
        }
    }

    /// Adds what a stage took to its account.
    pub fn stop(&mut self, running: Running) {
        let (wall, of) = (running.begun.elapsed(), &mut self.timing);
        match running.stage {
            Stage::Gas => of.gas += wall,
            Stage::Particles => of.particles += wall,
            Stage::Interior => of.interior += wall,
            Stage::Mapping => of.mapping += wall,
            Stage::Smoother => of.smoother += wall,
            Stage::Exchange => of.exchange += wall,
            Stage::Output => of.output += wall,
        }
    }

    /// A stage in one go; of a solver with its processor time.
    pub fn time<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let solver = match stage {
            Stage::Gas => Some(0),
            Stage::Particles => Some(1),
            _ => None,
        };
        let counts = solver.map_or(0, |solver: usize| self.looks[solver].begin());
        let before = (counts > 0).then(processor);
        let running = Self::start(stage);
        let begun = running.begun;
        let value = work();
        self.stop(running);
        if let (Some(solver), Some(before)) = (solver, before) {
            self.looks[solver].end(begun.elapsed());
            let used = processor().saturating_sub(before) * counts;
            match solver {
                0 => self.timing.gas_processor += used,
                _ => self.timing.particles_processor += used,
            }
        }
        value
    }
}

/// Processor time that all threads of this process have used.
fn processor() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}
