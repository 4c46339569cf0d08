//! Stage: how far a window's step was off, and how long the next one is.

use super::CoupledRun;
use super::error::RunError;
use crate::part::Gas as _;
use crate::setup::TimeScheme;
use crate::step_error::{StepOrder, StepSpans};
use crate::time::{Ticks, Window};
use crate::window_control::WindowOutcome;

impl CoupledRun {
    /// Full length of the next window on the motion clock, and the next process time at which it ends because a boundary
    /// value follows another line from there on.
    pub(super) fn full_window(&self) -> (Ticks, Option<Ticks>) {
        let Some(control) = &self.length.control else {
            return (self.plan.motion_window, None);
        };
        let breaks = &self.plan.breaks;
        let next = breaks.partition_point(|time| *time <= self.clocks.process);
        (control.size(), breaks.get(next).copied())
    }

    /// True where a window whose step is too long may be begun again: no particle moves, and the gas can.
    pub(super) fn may_shorten(&self) -> bool {
        self.length.control.is_some() && self.plan.repeats && self.plan.free.is_empty()
    }

    /// The order in time of a window: two stages have the second where the gas takes both and nothing beside it is constant
    /// over a window.
    fn step_order(&self, window: &Window) -> StepOrder {
        let plan = &self.plan;
        let one_clock = window.span.motion == window.span.process;
        let constant = plan.gas_reacts || self.interior.has_channels() || !plan.free.is_empty();
        match plan.time_scheme {
            TimeScheme::Sdirk2 if one_clock && !constant => StepOrder::Second,
            _ => StepOrder::First,
        }
    }

    fn spans(&self, window: &Window) -> StepSpans {
        StepSpans {
            motion: window.span.motion.seconds(),
            storage: self.plan.storage.span(window),
        }
    }

    /// Volume of gas in each cell in m³.
    fn gas_volume(&self) -> Vec<f64> {
        let pores = &self.bed.mapped.bed.void_fraction;
        let volume = self.mesh.cell_volume().iter();
        volume.zip(pores).map(|(v, e)| v * e).collect()
    }

    /// The error of the step to the gas as it is, and its largest Courant number.
    fn estimate(&mut self, window: &Window) -> WindowOutcome {
        let (order, spans, volume) = (
            self.step_order(window),
            self.spans(window),
            self.gas_volume(),
        );
        let gas = self.parts.gas.fields();
        let history = &self.length.history;
        self.length.error = history.estimate(&gas, &volume, spans, order);
        let largest = self.mesh.courant(gas.velocity, spans.motion);
        self.length.courant = largest.map(|largest| largest.value);
        WindowOutcome {
            span: window.span.motion,
            error: self.length.error.map(|error| error.largest()),
            power: order.power(),
            courant_rate: self.length.courant.map_or(0.0, |it| it / spans.motion),
        }
    }

    /// True where the attempts were over a window that is too long, and shorter ones are tried.
    pub(super) fn is_too_long(&mut self, window: &Window) -> bool {
        if !self.may_shorten() {
            return false;
        }
        let outcome = self.estimate(window);
        let Some(control) = &mut self.length.control else {
            return false;
        };
        let Some(cause) = control.refuses(&outcome) else {
            return false;
        };
        control.shrink(&outcome);
        tracing::debug!(
            window = window.index,
            start = %window.start.process,
            span = %window.span.motion,
            next = %control.size(),
            cause,
            "the window is begun again, shorter"
        );
        true
    }

    /// The window again, shorter, from the gas of the last commit.
    pub(super) fn shorten_window(&mut self) -> Result<Window, RunError> {
        self.exchange.discard();
        self.give_up();
        Ok(self.next_window()?)
    }

    /// After the gas' commit: the error of the step, and how long the next window is.
    pub(super) fn judge_step(&mut self, window: &Window) {
        let outcome = self.estimate(window);
        let (volume, spans) = (self.gas_volume(), self.spans(window));
        let gas = self.parts.gas.fields();
        self.length.history.commit(&gas, &volume, spans);
        if let Some(control) = &mut self.length.control {
            control.advance(&outcome);
        }
        let end = window.start.process.count() + window.span.process.count();
        let ends_at = |time: &Ticks| time.count() == end;
        let steps = self.plan.acceleration.steps().iter();
        let mut jumps = steps.map(|step| &step.0).chain(&self.plan.jumps);
        if jumps.any(ends_at) {
            self.length.jump();
        }
    }
}
