//! Exit codes, stable for scripts.

use calcine_coupler::coordinator::RunError;
use calcine_coupler::error::FailureKind;

use crate::results::{Summary, Verdict};

/// All went well.
pub const OK: u8 = 0;
/// Anything without a code of its own.
pub const OTHER: u8 = 1;
/// The case, or the command line, is wrong.
pub const CASE: u8 = 2;
/// A solver diverged, did not converge, or lost particles.
pub const DIVERGED: u8 = 3;
/// A peer died, was silent, or could not be started.
pub const PEER: u8 = 4;
/// A quantity lies outside its band, or a solver breaks a law of the conformance suite.
pub const OUTSIDE_BANDS: u8 = 5;
/// Complete and inside its bands, but outside the ranges of laws, or not converged; with `--strict` only.
pub const WARNINGS: u8 = 6;
/// Interrupted, with a checkpoint to go on from.
pub const CHECKPOINTED: u8 = 75;

/// The exit code of a complete run.
pub fn complete(summary: &Summary, strict: bool) -> u8 {
    let mut quantities = summary.quantities.values();
    if quantities.any(|quantity| quantity.verdict == Verdict::Fail) {
        OUTSIDE_BANDS
    } else if strict && !summary.warnings.is_empty() {
        WARNINGS
    } else {
        OK
    }
}

/// The exit code of a run's error.
pub fn of(error: &RunError) -> u8 {
    match error {
        RunError::Part(part) => match part.kind {
            FailureKind::Diverged
            | FailureKind::NotFinite
            | FailureKind::NotConverged
            | FailureKind::LostParticles => DIVERGED,
            FailureKind::Io | FailureKind::OutOfMemory => OTHER,
            FailureKind::Refused => CASE,
            FailureKind::Interrupted => CHECKPOINTED,
            FailureKind::Died
            | FailureKind::Silent
            | FailureKind::NotStarted
            | FailureKind::Protocol
            | FailureKind::InvalidInput
            | FailureKind::Reported => PEER,
        },
        RunError::Smoother(_)
        | RunError::Mapping(_)
        | RunError::Origin(_)
        | RunError::NoFollowingDrag { .. } => CASE,
        RunError::NoDragImpulse { .. } => PEER,
        RunError::Closure { .. } => DIVERGED,
        _ => OTHER,
    }
}
