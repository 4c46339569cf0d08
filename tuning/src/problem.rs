//! What is tuned: parameters in, differences from what is measured out.

use crate::TuningError;
use crate::space::ParameterSpace;

/// Something with parameters whose differences from targets are to be small.
pub trait TuningProblem: Sync {
    /// The parameters.
    fn space(&self) -> &ParameterSpace;

    /// Names of the objectives: one a compared quantity.
    fn objectives(&self) -> &[String];

    /// Differences from the targets at places from zero to one, objective by objective: `out` has one list for each, whose
    /// lengths do not depend on the places.
    fn differences(&self, places: &[f64], out: &mut Vec<Vec<f64>>) -> Result<(), TuningError>;

    /// Differences from data that are shifted: each difference, and what an evaluation fits by itself, as if the measured values
    /// were lower by the shift.
    fn shifted(
        &self,
        places: &[f64],
        shifts: &[Vec<f64>],
        out: &mut Vec<Vec<f64>>,
    ) -> Result<(), TuningError> {
        self.differences(places, out)?;
        for (list, shift) in out.iter_mut().zip(shifts) {
            for (difference, shift) in list.iter_mut().zip(shift) {
                *difference += shift;
            }
        }
        Ok(())
    }

    /// Numbers beside the parameters that each evaluation fits by itself.
    fn scales(&self) -> usize {
        0
    }

    /// Step in places at which difference quotients of it are exact enough: well above the noise of what it computes.
    fn step(&self) -> f64 {
        1e-4
    }

    /// Places that are likely to be near the best ones.
    fn guesses(&self) -> Vec<Vec<f64>> {
        Vec::new()
    }
}

/// Sums of squares, objective by objective; infinite where the problem could not be evaluated.
pub fn objectives_at(problem: &dyn TuningProblem, places: &[f64]) -> Vec<f64> {
    let mut out = Vec::new();
    match problem.differences(places, &mut out) {
        Ok(()) => out.iter().map(|list| sum_of_squares(list)).collect(),
        Err(_) => vec![f64::INFINITY; problem.objectives().len()],
    }
}

/// Σ r²; a sum that is not finite is infinite.
pub fn sum_of_squares(list: &[f64]) -> f64 {
    let sum: f64 = list.iter().map(|r| r * r).sum();
    if sum.is_finite() { sum } else { f64::INFINITY }
}
