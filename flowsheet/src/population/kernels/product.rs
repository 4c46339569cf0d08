//! In proportion to the product of volumes.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::aggregation_kernel::AggregationKernel;

/// β = β₀ u v. It gels: at N₀ v₀² β₀ t = ½ from an exponential distribution of mean v₀ the second moment is infinite.
#[derive(Clone, Copy, Debug)]
pub struct ProductKernel {
    /// β₀ in 1/(s m⁶).
    pub rate: f64,
}

impl AggregationKernel for ProductKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        self.rate * u * v
    }
}

/// Its entry in a case file.
pub(super) static PRODUCT: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "product",
    summary: "In proportion to the product of the volumes; it gels.",
    source: "McLeod, Q. J. Math. 13 (1962) 119",
    parameters: &[LawParameter {
        name: "rate",
        dimension: Dimension([-6, 0, -1, 0, 0]),
        bound: Bound::NotNegative,
        default: None,
        needed_with: None,
        meaning: "Rate at which two particles of the bed aggregate, of the volumes that the law has in it.",
        example: "\"1e8 1/s/m^6\"",
    }],
    tables: &[],
    make: |values| Box::new(ProductKernel { rate: values[0] }),
};
