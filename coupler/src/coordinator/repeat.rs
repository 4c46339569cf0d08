//! What a window that is begun again, shorter, needs: the gas as it was at the last commit, and how it was cut.

use std::path::Path;
use std::time::Duration;

use crate::boundary_value::BoundaryValue;
use crate::error::PartError;
use crate::gas_columns::GasColumns;
use crate::part::{
    Backflow, Bed, CellExchange, CellReceived, Convergence, Gas, GasFields, GasPhases, Part,
    SolverInfo,
};
use crate::supervisor::Supervisor;
use crate::time::{Ticks, Window};

/// A window whose exchange did not settle is cut: it goes on in parts of half its length, and halves of those, up to its
/// end, each part twice as long as the one before where that one settled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct WindowCut {
    /// How often the next part is halved.
    pub halvings: u32,
    /// Process time at which the window that was cut ends; `None` where none is cut.
    pub until: Option<Ticks>,
    /// True where cuts did not help: parts of the rest of the window that do not settle are committed too, as long as what
    /// they leave is near enough.
    pub given_up: bool,
}

impl WindowCut {
    /// After a window that did not settle.
    pub fn shorter(&mut self, end: Ticks) {
        self.until.get_or_insert(end);
        self.halvings += 1;
    }

    /// After a commit of a part that settled, or of one that did not and may not be cut again.
    pub fn longer(&mut self, reached: Ticks, settled: bool) {
        self.given_up |= self.until.is_some() && !settled;
        self.halvings = self.halvings.saturating_sub(1);
        if self.until.is_some_and(|end| reached >= end) {
            *self = Self::default();
        }
    }

    /// As numbers of a checkpoint.
    pub fn numbers(self) -> [u64; 3] {
        let until = self.until.unwrap_or(Ticks::ZERO).count().cast_unsigned();
        [u64::from(self.halvings), until, u64::from(self.given_up)]
    }

    /// From the numbers of a checkpoint.
    pub fn from_numbers([halvings, until, given_up]: [u64; 3]) -> Self {
        Self {
            halvings: u32::try_from(halvings).unwrap_or_default(),
            until: (until > 0).then(|| Ticks::new(until.cast_signed())),
            given_up: given_up > 0,
        }
    }
}

/// A gas that shows its fields of the last commit after an attempt that is given up.
pub(super) struct RepeatableGas {
    gas: Box<dyn Gas>,
    committed: Option<GasColumns>,
    /// True from [`RepeatableGas::go_back`] to the next attempt.
    back: bool,
}

impl RepeatableGas {
    pub fn new(gas: Box<dyn Gas>) -> Self {
        Self {
            gas,
            committed: None,
            back: false,
        }
    }

    /// Keeps the committed fields before the first attempt of a window that may be cut.
    pub fn keep(&mut self) {
        if !self.back {
            let committed = self.committed.get_or_insert_default();
            committed.take(&self.gas.fields());
        }
    }

    /// Shows the fields that were kept, up to the next attempt.
    pub fn go_back(&mut self) {
        self.back = self.committed.is_some();
    }
}

impl Part for RepeatableGas {
    fn about(&self) -> &SolverInfo {
        self.gas.about()
    }

    fn commit(&mut self) -> Result<(), PartError> {
        self.gas.commit()
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        self.gas.checkpoint(directory)
    }

    fn processor_time(&self) -> Duration {
        self.gas.processor_time()
    }

    fn finish_run(&mut self, supervisor: &Supervisor) -> Result<(), PartError> {
        self.gas.finish_run(supervisor)
    }
}

impl Gas for RepeatableGas {
    fn fields(&self) -> GasFields<'_> {
        match &self.committed {
            Some(committed) if self.back => committed.fields(),
            _ => self.gas.fields(),
        }
    }

    fn phases(&self) -> Option<GasPhases> {
        self.gas.phases()
    }

    fn turbulence_residual(&self) -> Option<f64> {
        self.gas.turbulence_residual()
    }

    fn begins_again(&self) -> bool {
        self.gas.begins_again()
    }

    fn backflow(&self) -> Option<Backflow> {
        self.gas.backflow()
    }

    fn set_boundary(&mut self, value: &BoundaryValue) -> Result<(), PartError> {
        self.gas.set_boundary(value)
    }

    fn start(
        &mut self,
        window: &Window,
        bed: &Bed,
        exchange: &CellExchange,
    ) -> Result<(), PartError> {
        self.gas.start(window, bed, exchange)
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut CellReceived,
    ) -> Result<Convergence, PartError> {
        let convergence = self.gas.finish(supervisor, received)?;
        self.back = false;
        Ok(convergence)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_double_up_to_the_end_of_the_window_that_was_cut() {
        let mut cut = WindowCut::default();
        for _ in 0..3 {
            cut.shorter(Ticks::new(800));
        }
        assert_eq!((cut.halvings, cut.until), (3, Some(Ticks::new(800))));
        assert_eq!(WindowCut::from_numbers(cut.numbers()), cut);
        cut.longer(Ticks::new(100), true);
        cut.shorter(Ticks::new(300));
        assert_eq!((cut.halvings, cut.until), (3, Some(Ticks::new(800))));
        cut.longer(Ticks::new(200), true);
        cut.longer(Ticks::new(400), true);
        assert_eq!(cut.halvings, 1);
        cut.longer(Ticks::new(800), true);
        assert_eq!(cut, WindowCut::default());
        assert_eq!(WindowCut::from_numbers(cut.numbers()), cut);
    }

    #[test]
    fn where_cuts_do_not_help_parts_grow_all_the_same_up_to_the_end_of_the_window() {
        let mut cut = WindowCut::default();
        cut.longer(Ticks::new(100), false);
        assert_eq!(cut, WindowCut::default());
        for _ in 0..4 {
            cut.shorter(Ticks::new(1600));
        }
        cut.longer(Ticks::new(200), false);
        assert!(cut.given_up && cut.halvings == 3);
        assert_eq!(WindowCut::from_numbers(cut.numbers()), cut);
        cut.longer(Ticks::new(1600), false);
        assert_eq!(cut, WindowCut::default());
    }
}
