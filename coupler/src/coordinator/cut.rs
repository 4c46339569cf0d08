//! How far windows go, and those that are begun again, shorter.

use calcine_interior::NetworkOutcome;

use super::CoupledRun;
use super::error::RunError;
use super::span::next_span;
use crate::error::FailureKind;
use crate::observer::CutNotice;
use crate::part::Gas as _;
use crate::physical::UnphysicalGas;
use crate::time::{Clocks, Ticks, TimeError, Window};

/// Mass fraction below zero, beyond the tolerance of the gas' own iterations, of a window that is cut.
const ROUGH_FRACTION: f64 = 1e-6;
/// The same of a window that is never kept where it may be cut, and ends the run where that did not help.
const GROSS_FRACTION: f64 = 1e-3;
/// Share of the exchange that a window may leave misplaced where shorter ones did not settle either.
const GROSS_SHARE: f64 = 0.03;

impl CoupledRun {
    /// How far the next window goes: to the end of the case's window, of the run, or of a change of its schedules.
    pub(super) fn next_window(&self) -> Result<Window, TimeError> {
        let plan = &self.plan;
        let (_, change) = plan.holds.at(self.clocks.process);
        let (full, a_break) = self.full_window();
        let ends = [change, self.cut.until, a_break].into_iter().flatten();
        let span = next_span(
            &plan.acceleration,
            self.clocks,
            Ticks::new((full.count() >> self.cut.halvings).max(1)),
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
        let may = self.plan.repeats && self.plan.free.is_empty();
        may && self.cut.halvings < self.plan.cuts
    }

    /// Why a window that was exchanged is cut, where it may be: it did not settle, or its gas is none. Where cuts have not
    /// helped before, what is near enough is kept.
    pub(super) fn cause_of_cut(&self) -> Option<String> {
        if !self.interior.has_channels() {
            return (!self.settled() && !self.cut.given_up)
                .then(|| "heat between particles did not settle".to_owned());
        }
        let given_up = self.cut.given_up;
        let tolerated = if given_up {
            GROSS_FRACTION
        } else {
            ROUGH_FRACTION
        };
        if let Some(found) = self.unphysical(tolerated) {
            return Some(found.to_string());
        }
        let misplaced = self.exchange.agreement.misplaced;
        // A share that is NaN is no small one.
        let gross = misplaced.is_nan() || misplaced > GROSS_SHARE;
        (!self.settled() && (gross || !given_up))
            .then(|| format!("{misplaced:.2e} of the exchange is misplaced"))
    }

    /// An error where a window was cut as often as it may be, and what it leaves is no gas all the same.
    pub(super) fn check_smallest(&self, window: &Window) -> Result<(), RunError> {
        if self.cut.halvings == 0 || !self.interior.has_channels() {
            return Ok(());
        }
        match self.unphysical(GROSS_FRACTION) {
            None => Ok(()),
            Some(found) => Err(RunError::Unphysical {
                window: window.index,
                start: window.start.process,
                span: window.span.process,
                cuts: self.cut.halvings,
                found,
            }),
        }
    }

    /// What of the gas no gas can be.
    fn unphysical(&self, tolerance: f64) -> Option<UnphysicalGas> {
        let species = self.laws.closures.gas.species();
        UnphysicalGas::find(&self.parts.gas.fields(), species, tolerance)
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
            RunError::NotFinite(_)
            | RunError::Interior { .. }
            | RunError::Closure { .. }
            | RunError::ClosureInGas { .. } => true,
            _ => false,
        };
        numerical && self.interior.has_channels() && self.parts.gas.begins_again()
    }

    /// The window again, of half its length, from the gas of the last commit; with what is told of it.
    pub(super) fn cut_window(
        &mut self,
        window: &Window,
        cause: &str,
    ) -> Result<(Window, CutNotice), TimeError> {
        self.cut.shorter(window.end()?.process);
        self.exchange.cut();
        self.give_up();
        let cut = self.next_window()?;
        let notice = CutNotice {
            cuts: self.exchange.cuts(),
            attempts: self.exchange.discarded(),
            span: cut.span.process.seconds(),
        };
        tracing::info!(
            window = window.index,
            start = %window.start.process,
            span = %cut.span.process,
            cuts = notice.cuts,
            attempts = notice.attempts,
            cause,
            "particles that react and their gas did not settle over {}; the window is cut",
            window.span.process
        );
        Ok((cut, notice))
    }

    /// Gives up the attempts since the last commit.
    pub(super) fn give_up(&mut self) {
        self.parts.gas.go_back();
        self.interior.begin_again();
        self.bodies.begin_again();
        self.interior.models.begin_again();
    }

    /// After a commit the next part of a window that was cut is twice as long.
    pub(super) fn lengthen(&mut self, clocks: Clocks) {
        let settled = self.settled();
        self.cut.longer(clocks.process, settled);
    }
}
