//! Controls of a run: set between windows, in force from the next one on.

use super::CoupledRun;
use super::control::Control;
use super::error::RunError;
use crate::checkpoint::{StateFile, StateFileError};
use crate::part::Gas as _;

/// Name of the array of a checkpoint: the lines, byte by byte.
const ARRAY: &str = "controls";

impl CoupledRun {
    /// Sets something from the start of the next window on; between two steps.
    pub fn set(&mut self, control: Control) -> Result<(), RunError> {
        match &control {
            Control::Boundary(value) => self.parts.gas.set_boundary(value)?,
            other => other.apply(&mut self.plan.feeds_and_outlets)?,
        }
        tracing::info!(
            process_time = self.clocks.process.seconds(),
            control = control.line(),
            "set"
        );
        self.controls.retain(|old| !control.replaces(old));
        self.controls.push(control);
        self.length.jump();
        Ok(())
    }

    /// What was set so far, each condition once.
    pub fn controls(&self) -> &[Control] {
        &self.controls
    }

    /// Writes what was set.
    pub(super) fn record_controls(&self, state: &mut StateFile) {
        let lines: Vec<String> = self.controls.iter().map(Control::line).collect();
        let bytes: Vec<u64> = lines.join("\n").bytes().map(u64::from).collect();
        state.set_u64s(ARRAY, &bytes);
    }

    /// Sets it again.
    pub(super) fn restore_controls(&mut self, state: &StateFile) -> Result<(), RunError> {
        let bytes = state.u64s(ARRAY)?.iter().map(|&byte| byte as u8).collect();
        let text = String::from_utf8(bytes).unwrap_or_default();
        for line in text.lines() {
            let control = Control::read(line).ok_or_else(|| StateFileError::Missing {
                name: format!("{ARRAY}: {line}"),
                kind: "control",
            })?;
            self.set(control)?;
        }
        Ok(())
    }
}
