//! A gas whose equations stay unsolved, window after window: what it leaves is no flow.

use crate::error::{FailureKind, PartError};
use crate::part::Convergence;
use crate::time::Window;

/// Residual, relative to the terms of the equations, that is none of a solution.
const UNSOLVED: f64 = 0.01;
/// So many such windows, each that was solved since taken off; starts and jumps of what is given may leave a few.
const WINDOWS: u32 = 5;

/// Counts windows whose gas was not solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct UnsolvedWindows(u32);

impl UnsolvedWindows {
    /// Refuses the last one of too many windows.
    pub(super) fn check(
        &mut self,
        convergence: &Convergence,
        window: &Window,
    ) -> Result<(), PartError> {
        if !self.count(convergence) {
            return Ok(());
        }
        let message = format!(
            "its equations were {:.2e} of their terms off after {} outer iterations, as they were by {UNSOLVED} and more in {} windows before: what \
             they leave is no flow; shorten the windows (`time.motion_window`), raise `gas.controls.outer_iterations`, or mend the cells that \
             `calcine check` names",
            convergence.residual,
            convergence.outer_iterations,
            WINDOWS - 1
        );
        Err(PartError::new("gas", FailureKind::NotConverged, message).in_window(window))
    }

    /// Takes up how a window went; true where it is the last one of too many.
    fn count(&mut self, convergence: &Convergence) -> bool {
        // A residual that is NaN is no small one.
        let small = convergence.residual < UNSOLVED;
        self.0 = match convergence.converged || small {
            true => self.0.saturating_sub(1),
            false => self.0 + 1,
        };
        self.0 >= WINDOWS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_windows_are_too_many_and_one_that_is_solved_takes_one_off() {
        let of = |residual: f64| Convergence {
            residual,
            ..Convergence::default()
        };
        let mut unsolved = UnsolvedWindows::default();
        let row = |unsolved: &mut UnsolvedWindows, residuals: &[f64]| {
            let counted = residuals.iter().map(|&one| unsolved.count(&of(one)));
            counted.collect::<Vec<_>>()
        };
        // Three count, and one is taken off.
        assert!(!row(&mut unsolved, &[0.2, 0.01, 0.0099, 0.5]).contains(&true));
        let found = row(&mut unsolved, &[0.2, f64::NAN, 0.01]);
        assert_eq!(found, [false, false, true]);
        let solved = Convergence {
            converged: true,
            ..of(0.3)
        };
        assert!(!unsolved.count(&solved));
        assert!(unsolved.count(&of(0.3)));
    }
}
