//! What all integrators have in common.

use super::flows::{FlowWorkspace, Moment};
use super::topology::Plant;
use crate::PlantError;

/// A span to integrate over, in which nothing jumps.
#[derive(Clone, Copy)]
pub(super) struct Span<'a> {
    pub(super) plant: &'a Plant,
    /// Where the step begins, and where the span ends at the latest.
    pub(super) at: Moment,
    /// Sizes of the unknowns.
    pub(super) scales: &'a [f64],
    pub(super) tolerance: f64,
    /// Where something jumped: nothing of the step before holds.
    pub(super) fresh: bool,
    /// Where the step has to have the length that is set, whatever its error.
    pub(super) forced: bool,
}

/// What is integrated, and memory for the streams.
#[derive(Clone, Debug)]
pub(super) struct Followed {
    pub(super) y: Vec<f64>,
    pub(super) totals: Vec<f64>,
    pub(super) work: FlowWorkspace,
    /// Steps, and steps that were repeated.
    pub(super) steps: [usize; 2],
}

/// One step of an integrator with control of its length.
pub(super) trait StepMethod: Send + Sync {
    /// Advances unknowns and totals by one step that ends at the end of the span at the latest; the time it took. A failure
    /// of the rates within a step shortens it.
    fn advance(&mut self, span: &Span<'_>, now: &mut Followed) -> Result<f64, PlantError>;

    /// Length of the next step in s; zero before the first.
    fn step(&self) -> f64;

    /// Sets the length of the next step in s.
    fn set_step(&mut self, step: f64);
}

impl Span<'_> {
    /// Time left in s.
    pub(super) fn left(&self) -> f64 {
        self.at.end - self.at.time
    }

    /// The step of a length that is asked for, and whether it ends the span.
    pub(super) fn cut(&self, step: f64) -> (f64, bool) {
        let left = self.left();
        let ends = step >= 0.999 * left;
        (if ends { left } else { step }, ends)
    }

    /// A moment of the step that takes `h`, at a share of it.
    pub(super) fn moment(&self, share: f64, h: f64) -> Moment {
        Moment {
            time: self.at.time + share * h,
            end: self.at.end,
        }
    }

    /// Errors that count as 1.
    pub(super) fn sizes(&self, y: &[f64], to: &mut Vec<f64>) {
        to.clear();
        let pairs = self.scales.iter().zip(y);
        to.extend(pairs.map(|(scale, y)| self.tolerance * (scale + y.abs())));
    }

    /// A first step by which unknowns change by a tenth of what the tolerance allows a method of this order.
    pub(super) fn first_step(&self, y: &[f64], rates: &[f64], order: u8) -> f64 {
        let pairs = y.iter().zip(rates).zip(self.scales);
        let fastest = pairs.map(|((y, rate), scale)| (rate / (scale + y.abs())).abs());
        let fastest = fastest.fold(0.0, f64::max);
        let guess = 0.1 * self.tolerance.powf(1.0 / f64::from(order)) / fastest;
        if fastest > 0.0 {
            guess.min(self.left())
        } else {
            self.left()
        }
    }

    /// An error where a step has become too short to add up: `why` if the rates failed, else that of the method.
    pub(super) fn too_short(
        &self,
        step: f64,
        why: Option<PlantError>,
        cause: &'static str,
    ) -> Result<(), PlantError> {
        if self.at.time + 1e-3 * step > self.at.time && step > 0.0 {
            return Ok(());
        }
        Err(why.unwrap_or(PlantError::Steps {
            reached: self.at.time,
            cause,
        }))
    }
}

/// Largest error in sizes; infinite where one is NaN.
pub(super) fn worst(errors: impl Iterator<Item = f64>, sizes: &[f64]) -> f64 {
    let mut largest = 0.0f64;
    for (error, size) in errors.zip(sizes) {
        let own = (error / size).abs();
        if own.is_nan() {
            return f64::INFINITY;
        }
        largest = largest.max(own);
    }
    largest
}

/// y + Σ h a k of stages that are weighted.
pub(super) fn weighted(to: &mut [f64], from: &[f64], h: f64, stages: &[Vec<f64>], weights: &[f64]) {
    to.copy_from_slice(from);
    add_weighted(to, 0, h, stages, weights);
}

/// Adds Σ h a k to values that stand `from` of the stages on.
pub(super) fn add_weighted(
    to: &mut [f64],
    from: usize,
    h: f64,
    stages: &[Vec<f64>],
    weights: &[f64],
) {
    for (rates, weight) in stages.iter().zip(weights).filter(|(_, w)| **w != 0.0) {
        let share = h * weight;
        let pairs = to.iter_mut().zip(&rates[from..]);
        pairs.for_each(|(x, k)| *x += share * k);
    }
}
