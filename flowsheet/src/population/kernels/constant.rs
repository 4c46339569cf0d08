//! A constant rate.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::aggregation_kernel::AggregationKernel;

/// β = β₀.
#[derive(Clone, Copy, Debug)]
pub struct ConstantKernel {
    /// β₀ in 1/s.
    pub rate: f64,
}

impl AggregationKernel for ConstantKernel {
    fn rate(&self, _u: f64, _v: f64) -> f64 {
        self.rate
    }
}

/// Its entry in a case file.
pub(super) static CONSTANT: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "constant",
    summary: "A rate that does not depend on the particles.",
    source: "Smoluchowski, Z. Phys. Chem. 92 (1917) 129",
    parameters: &[LawParameter {
        name: "rate",
        dimension: Dimension([0, 0, -1, 0, 0]),
        bound: Bound::NotNegative,
        default: None,
        needed_with: None,
        meaning: "Rate at which two particles of the bed aggregate, of the volumes that the law has in it.",
        example: "\"1e-9 1/s\"",
    }],
    tables: &[],
    make: |values| Box::new(ConstantKernel { rate: values[0] }),
};
