//! Lengths of windows and estimated errors of their steps, over a run.

use calcine_coupler::observer::CommittedState;
use serde::{Deserialize, Serialize};

use super::files::number;

/// Windows and the errors of their steps (docs/theory.md, TSM-12, TSM-13).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct StepSummary {
    /// The shortest window in s of motion time; zero before the first.
    pub shortest_window_s: f64,
    /// The longest.
    pub longest_window_s: f64,
    /// Windows for whose steps there is an estimate.
    pub estimated: u64,
    /// Largest estimated error of the velocity, as a share of its largest root mean square.
    #[serde(deserialize_with = "number")]
    pub largest_velocity_error: f64,
    /// Largest estimated error of the temperature, as a share of it.
    #[serde(deserialize_with = "number")]
    pub largest_temperature_error: f64,
    /// Largest estimated error of a mass fraction.
    #[serde(deserialize_with = "number")]
    pub largest_composition_error: f64,
    /// Largest Courant number at the end of a window, over its motion time.
    #[serde(deserialize_with = "number")]
    pub largest_courant: f64,
    /// Windows whose estimated error is above `time.motion_window.error`.
    pub above_error: u64,
    /// Windows whose Courant number at their end is above `time.motion_window.courant`.
    pub above_courant: u64,
}

impl StepSummary {
    /// Adds the window that was committed last.
    pub(super) fn add(&mut self, moment: &CommittedState<'_>, bounds: [Option<f64>; 2]) {
        let Some(window) = moment.window else {
            return;
        };
        let span = window.span.motion.seconds();
        self.shortest_window_s = match self.longest_window_s > 0.0 {
            true => self.shortest_window_s.min(span),
            false => span,
        };
        self.longest_window_s = self.longest_window_s.max(span);
        let above = |value: f64, bound: Option<f64>| u64::from(bound.is_some_and(|it| value > it));
        let [error_bound, courant_bound] = bounds;
        if let Some(error) = moment.step_error {
            self.estimated += 1;
            self.largest_velocity_error = self.largest_velocity_error.max(error.velocity);
            self.largest_temperature_error = self.largest_temperature_error.max(error.temperature);
            self.largest_composition_error = self.largest_composition_error.max(error.composition);
            self.above_error += above(error.largest(), error_bound);
        }
        if let Some(courant) = moment.courant {
            self.largest_courant = self.largest_courant.max(courant);
            self.above_courant += above(courant, courant_bound);
        }
    }
}
