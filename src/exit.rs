//! Exit codes, stable for scripts.

use calcine_coupler::coordinator::RunError;
use calcine_coupler::error::FailureKind;
use calcine_coupler::models::ParticleModelError;

use crate::results::{Summary, Verdict};

/// All went well.
pub const OK: u8 = 0;
/// Anything without a code of its own.
pub const OTHER: u8 = 1;
/// The case, or the command line, is wrong.
pub const CASE: u8 = 2;
/// A solver diverged, did not converge, or lost particles; the inside of a particle could not be integrated.
pub const DIVERGED: u8 = 3;
/// A peer died, was silent, or could not be started.
pub const PEER: u8 = 4;
/// A quantity lies outside its band, or a solver breaks a law of the conformance suite.
pub const OUTSIDE_BANDS: u8 = 5;
/// Complete and inside its bands, but warned of: as the case was checked, outside the ranges of laws, or not converged; with
/// `--strict` only.
pub const WARNINGS: u8 = 6;
/// Interrupted, with a checkpoint to go on from.
pub const CHECKPOINTED: u8 = 75;

/// Interrupted a second time before the window was done: ended at once; the last checkpoint, where there is one, stays.
pub const INTERRUPTED: u8 = 130;

/// The exit code of a complete run.
pub fn complete(summary: &Summary, strict: bool) -> u8 {
    let mut quantities = summary.quantities.values();
    if quantities.any(|quantity| quantity.verdict == Verdict::Fail) {
        OUTSIDE_BANDS
    } else if strict && !(summary.warnings.is_empty() && summary.case_warnings.is_empty()) {
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
            FailureKind::Interrupted => INTERRUPTED,
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
        RunError::Reacting { cause, .. } => of(cause),
        RunError::Closure { .. }
        | RunError::Lost { .. }
        | RunError::ClosureInGas { .. }
        | RunError::Unphysical { .. }
        | RunError::NotFinite(_)
        | RunError::Interior {
            cause: ParticleModelError::Particle { .. },
            ..
        } => DIVERGED,
        _ => OTHER,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::interior::ModelError;

    #[test]
    fn an_interior_that_cannot_be_integrated_is_a_numerical_failure_and_a_wrong_column_is_not() {
        let of = |cause| of(&RunError::Interior { window: 3, cause });
        let broken = || ModelError::Particle {
            row: 0,
            cause: "the integration ended after 1000 steps".into(),
        };
        let particle = ParticleModelError::Particle {
            id: 7,
            cause: broken(),
        };
        assert_eq!(of(particle), DIVERGED);
        let column = ModelError::Column {
            column: "temperature".into(),
            found: "2 values".into(),
            expected: "3 values".into(),
        };
        assert_eq!(of(ParticleModelError::Column(column)), OTHER);
    }
}
