//! A product that does not depend on the feed.

use super::MillLaw;
use crate::distribution::normal_shares;
use crate::{PlantError, SizeGrid, Transformation};

/// A mill whose product has one normal distribution, whatever comes in.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantMill {
    mean: f64,
    deviation: f64,
    row: Vec<f64>,
}

impl ConstantMill {
    /// A mill whose product has a mean diameter and a standard deviation in m.
    pub fn new(mean: f64, deviation: f64) -> Self {
        Self {
            mean,
            deviation,
            row: Vec::new(),
        }
    }
}

impl MillLaw for ConstantMill {
    fn prepare(&mut self, grid: &SizeGrid, place: &str) -> Result<(), PlantError> {
        self.row = normal_shares(grid, self.mean, self.deviation, place)?;
        Ok(())
    }

    fn transformation(
        &self,
        _grid: &SizeGrid,
        _feed: &[f64],
        _place: &str,
    ) -> Result<Transformation, PlantError> {
        Ok(Transformation::Uniform(self.row.clone()))
    }
}
