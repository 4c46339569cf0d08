//! A product that does not depend on the feed.

use std::fmt::Display;

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::model::MillLaw;
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
        _place: &dyn Display,
    ) -> Result<Transformation, PlantError> {
        Ok(Transformation::Uniform(self.row.clone()))
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn MillLaw> = LawEntry {
    name: "constant",
    summary: "One normal distribution, whatever is fed.",
    source: "as the crusher of Dyssol, SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572",
    parameters: &[
        LawParameter {
            name: "mean",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Mean diameter of the product.",
            example: "\"1 mm\"",
        },
        LawParameter {
            name: "deviation",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Standard deviation of the product.",
            example: "\"0.1 mm\"",
        },
    ],
    tables: &[],
    make: |values| Box::new(ConstantMill::new(values[0], values[1])),
};
