//! Bond's law with a normal distribution.

use super::{BondLaw, MillLaw};
use crate::distribution::{normal_shares, quantile};
use crate::{PlantError, SizeGrid, Transformation};

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
        place: &str,
    ) -> Result<Transformation, PlantError> {
        self.bond.check(place)?;
        let flow: f64 = feed.iter().sum();
        let size = quantile(grid, feed, 0.8).unwrap_or(f64::NAN);
        let mean = self.bond.product_size(size, flow) - 0.83 * self.deviation;
        let row = normal_shares(grid, mean, self.deviation, place)?;
        Ok(Transformation::Uniform(row))
    }

    fn power(&self) -> f64 {
        self.bond.power
    }
}
