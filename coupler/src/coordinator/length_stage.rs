//! What the windows so far say of the error of steps and of the length of the next window.

use super::plan::Plan;
use crate::checkpoint::{StateFile, StateFileError};
use crate::part::GasFields;
use crate::step_error::{StepError, StepHistory};
use crate::window_control::WindowControl;

/// What the windows so far say of the next one's length.
pub(super) struct LengthStage {
    pub history: StepHistory,
    /// `None` where all windows are of one length.
    pub control: Option<WindowControl>,
    /// The estimated error of the last step; `None` where too few windows have passed.
    pub error: Option<StepError>,
    /// Largest Courant number at the end of the last window, over its motion time.
    pub courant: Option<f64>,
}

impl LengthStage {
    pub fn new(plan: &Plan, gas: &GasFields<'_>) -> Self {
        let control = |bounds| WindowControl::new(bounds, plan.particle_step);
        Self {
            history: StepHistory::begin(gas),
            control: plan.window_bounds.map(control),
            error: None,
            courant: None,
        }
    }

    /// After something that jumps: errors are counted anew, from the shortest window.
    pub fn jump(&mut self) {
        self.history.jump();
        if let Some(control) = &mut self.control {
            control.restart();
        }
    }

    pub fn record(&self, state: &mut StateFile) {
        self.history.record(state);
        if let Some(control) = &self.control {
            control.record(state);
        }
    }

    pub fn restore(
        &mut self,
        gas: &GasFields<'_>,
        state: &StateFile,
    ) -> Result<(), StateFileError> {
        self.history = StepHistory::restore(gas, state)?;
        match &mut self.control {
            Some(control) => control.restore(state),
            None => Ok(()),
        }
    }
}
