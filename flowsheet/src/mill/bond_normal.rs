//! Bond's law with a normal distribution.

use std::fmt::Display;

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::bond::{POWER, WORK_INDEX};
use super::model::MillLaw;
use super::{BondLaw, BondLength};
use crate::distribution::{OUTSIDE, normal_below, normal_shares, quantile};
use crate::{PlantError, SizeGrid, Transformation};

/// Key of the product's deviation.
const DEVIATION: LawParameter = LawParameter {
    name: "deviation",
    dimension: Dimension::LENGTH,
    bound: Bound::Positive,
    default: None,
    needed_with: None,
    meaning: "Standard deviation of the product.",
    example: "\"0.1 mm\"",
};

/// A mill whose product is normally distributed, with the x₈₀ of Bond's law.
///
/// mean = x₈₀,out − 0.83 σ
///
/// 0.83 is Dyssol's; the quantile of the normal distribution is 0.8416.
///
/// Source: the unit "Crusher" of Dyssol (Skorych, Dosta and Heinrich, SoftwareX 12 (2020) 100572,
/// doi 10.1016/j.softx.2020.100572).
#[derive(Clone, Debug, PartialEq)]
pub struct BondNormal {
    /// Work, index and length.
    pub bond: BondLaw,
    /// Standard deviation σ of the product in m.
    pub deviation: f64,
}

impl MillLaw for BondNormal {
    fn transformation(
        &self,
        grid: &SizeGrid,
        feed: &[f64],
        place: &dyn Display,
    ) -> Result<Transformation, PlantError> {
        self.bond.check(place)?;
        let flow: f64 = feed.iter().sum();
        let size = quantile(grid, feed, 0.8).unwrap_or(f64::NAN);
        let made = self.bond.product_size(size, flow);
        let mean = made - 0.83 * self.deviation;
        let share = normal_below(0.0, mean, self.deviation);
        if share > OUTSIDE {
            return Err(PlantError::MilledTooFine {
                place: place.to_string(),
                power: self.bond.power,
                flow,
                size: made,
                deviation: self.deviation,
                share,
            });
        }
        let row = normal_shares(grid, mean, self.deviation, place)?;
        Ok(Transformation::Uniform(row))
    }

    fn power(&self) -> f64 {
        self.bond.power
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn MillLaw> = LawEntry {
    name: "bond-normal",
    summary: "A normal distribution of the x80 of Bond's law.",
    source: "Bond, Trans. AIME 193 (1952) 484; as the crusher of Dyssol, SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572",
    parameters: &[WORK_INDEX, POWER, DEVIATION],
    tables: &[],
    make: |values| {
        Box::new(BondNormal {
            bond: BondLaw {
                work_index: values[0],
                power: values[1],
                length: BondLength::Micrometre,
            },
            deviation: values[2],
        })
    },
};

/// Its entry in a case file.
pub(super) static IN_MILLIMETRES: LawEntry<dyn MillLaw> = LawEntry {
    name: "bond-mm-normal",
    summary: "The same with sizes in mm where Bond has them in µm, as Dyssol computes it.",
    source: "Bond, Trans. AIME 193 (1952) 484; as the crusher of Dyssol, SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572",
    parameters: &[WORK_INDEX, POWER, DEVIATION],
    tables: &[],
    make: |values| {
        Box::new(BondNormal {
            bond: BondLaw {
                work_index: values[0],
                power: values[1],
                length: BondLength::Millimetre,
            },
            deviation: values[2],
        })
    },
};
