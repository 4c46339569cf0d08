//! What every law of a mill is.

use std::fmt::Display;

use crate::{PlantError, SizeGrid, Transformation};

/// What a mill makes of a distribution.
pub trait MillLaw: Send + Sync {
    /// Looks at the law's numbers and prepares what does not depend on the feed.
    fn prepare(&mut self, _grid: &SizeGrid, _place: &str) -> Result<(), PlantError> {
        Ok(())
    }

    /// The transformation of a feed with the masses `feed` of each class in kg/s. `place` is what an error names.
    fn transformation(
        &self,
        grid: &SizeGrid,
        feed: &[f64],
        place: &dyn Display,
    ) -> Result<Transformation, PlantError>;

    /// Power drawn in W, which heats what is milled.
    fn power(&self) -> f64 {
        0.0
    }

    /// True where it needs solids to act on.
    fn needs_feed(&self) -> bool {
        self.power() > 0.0
    }
}
