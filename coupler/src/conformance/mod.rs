//! Laws that every [`Gas`](crate::part::Gas) and every [`Particles`](crate::part::Particles) must obey, written once
//! and run against each solver by its own tests.
//!
//! A solver joins with a function that makes it from a setup; `gas::run` and `particles::run` say of each law whether
//! it holds. Each law starts with a fresh solver. `calcine conform` runs them for any program.

pub mod annulus;
mod drag;
pub mod gas;
pub mod manufactured;
pub mod particles;
mod six_spheres;
pub mod wedge;

use std::fmt;
use std::time::Duration;

use thiserror::Error;

use crate::error::{FailureKind, PartError};
use crate::mesh::MeshError;
use crate::supervisor::{Interrupts, Supervisor};
use crate::time::{Clocks, Ticks, TimeError, Window};

/// Why a law does not hold.
#[derive(Debug, Error)]
pub enum LawError {
    /// The solver failed where it must not.
    #[error("{0}")]
    Part(#[from] PartError),
    /// It does something else than the law says.
    #[error("{0}")]
    Broken(String),
    /// A time that is none.
    #[error("{0}")]
    Time(#[from] TimeError),
    /// A mesh that cannot be made.
    #[error("{0}")]
    Mesh(#[from] MeshError),
    /// The folder for checkpoints cannot be used.
    #[error("{0}")]
    Folder(#[from] std::io::Error),
}

/// How a solver does on one law.
#[derive(Debug)]
pub struct LawOutcome {
    /// The law, a sentence.
    pub law: &'static str,
    /// How it is broken, if it is.
    pub result: Result<(), LawError>,
}

impl LawOutcome {
    /// True where the law holds.
    pub fn holds(&self) -> bool {
        self.result.is_ok()
    }
}

impl fmt::Display for LawOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let law = self.law.replace('_', " ");
        match &self.result {
            Ok(()) => write!(f, "holds   {law}"),
            Err(cause) => write!(f, "BROKEN  {law}: {cause}"),
        }
    }
}

/// The laws that do not hold, in words.
pub fn broken(outcomes: &[LawOutcome]) -> Vec<String> {
    let broken = outcomes.iter().filter(|outcome| !outcome.holds());
    broken.map(ToString::to_string).collect()
}

/// Watches one solver: a supervisor takes the end of any process that it watches for a death, also of one that was
/// dropped.
fn supervisor() -> Supervisor {
    Supervisor::new(Duration::from_secs(60), Interrupts::default())
}

/// Holds, or says what does not.
fn holds(condition: bool, words: impl FnOnce() -> String) -> Result<(), LawError> {
    match condition {
        true => Ok(()),
        false => Err(LawError::Broken(words())),
    }
}

/// The window of a number, all of one length: so many seconds of motion time, and of process time.
fn window(index: u64, motion: f64, process: f64) -> Result<Window, LawError> {
    let span = Clocks {
        motion: Ticks::from_seconds(motion)?,
        process: Ticks::from_seconds(process)?,
    };
    let times = i64::try_from(index).unwrap_or(i64::MAX);
    Ok(Window {
        index,
        attempt: 0,
        start: Clocks {
            motion: Ticks::new(times.saturating_mul(span.motion.count())),
            process: Ticks::new(times.saturating_mul(span.process.count())),
        },
        span,
    })
}

/// The same bits.
fn same(what: &str, one: &[u64], other: &[u64]) -> Result<(), LawError> {
    let differing = one.iter().zip(other).filter(|(a, b)| a != b).count();
    holds(one.len() == other.len() && differing == 0, || {
        format!("{what}: {differing} of {} numbers differ", one.len())
    })
}

/// Fails of this kind, with a word in its message.
fn is_refused(error: &PartError, kinds: &[FailureKind], word: &str) -> Result<(), LawError> {
    holds(
        kinds.contains(&error.kind) && error.to_string().contains(word),
        || {
            format!(
                "it fails as {:?}, {error}; the kind must be of {kinds:?}, with `{word}`",
                error.kind
            )
        },
    )
}
