//! How far windows go, and those that are begun again, shorter.

use calcine_interior::NetworkOutcome;

use super::CoupledRun;
use super::error::RunError;
use super::span::next_span;
use crate::error::FailureKind;
use crate::part::Gas as _;
use crate::time::{Clocks, Ticks, TimeError, Window};

impl CoupledRun {
    /// How far the next window goes: to the end of the case's window, of the run, or of a change of its schedules.
    pub(super) fn next_window(&self) -> Result<Window, TimeError> {
        let plan = &self.plan;
        let (_, change) = plan.holds.at(self.clocks.process);
        let ends = [change, self.cut.until].into_iter().flatten();
        let span = next_span(
            &plan.acceleration,
            self.clocks,
            Ticks::new((plan.motion_window.count() >> self.cut.halvings).max(1)),
            ends.fold(plan.end, Ticks::min),
        )?;
        Ok(Window {
            index: self.windows,
            attempt: 0,
            start: self.clocks,
            span,
        })
    }

    /// True where a window whose exchange did not settle may be cut: the gas can begin it again, and no particle moves over
    /// steps of its own.
    pub(super) fn may_cut(&self) -> bool {
        let may = self.plan.repeats && self.plan.free.is_empty() && !self.cut.given_up;
        may && self.cut.halvings < self.plan.cuts
    }

    /// True where shorter windows would not help: what reacts is settled with its gas, and heat between particles is.
    pub(super) fn settled(&self) -> bool {
        let network = &self.interior.network_outcome;
        let reacts = self.interior.has_channels();
        let exchange = !reacts || self.exchange.agreement.settled;
        exchange && !matches!(network, NetworkOutcome::Unsettled { .. })
    }

    /// True where an attempt failed as one does whose window is too long for what reacts, and the gas can begin it again.
    pub(super) fn begins_again_after(&self, error: &RunError) -> bool {
        let numerical = match error {
            RunError::Part(part) => matches!(
                part.kind,
                FailureKind::Diverged | FailureKind::NotFinite | FailureKind::NotConverged
            ),
            RunError::NotFinite(_) | RunError::Interior { .. } | RunError::Closure { .. } => true,
            _ => false,
        };
        numerical && self.interior.has_channels() && self.parts.gas.begins_again()
    }

    /// The window again, of half its length, from the gas of the last commit.
    pub(super) fn cut_window(&mut self, window: &Window) -> Result<Window, TimeError> {
        self.cut.shorter(window.end()?.process);
        self.exchange.discard();
        self.parts.gas.go_back();
        self.interior.begin_again();
        let cut = self.next_window()?;
        tracing::debug!(
            window = window.index,
            span = %cut.span.process,
            "the exchange did not settle; the window is cut"
        );
        Ok(cut)
    }

    /// After a commit the next part of a window that was cut is twice as long.
    pub(super) fn lengthen(&mut self, clocks: Clocks) {
        let settled = self.settled();
        self.cut.longer(clocks.process, settled);
    }
}
