//! In proportion to the sum of volumes.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::aggregation_kernel::AggregationKernel;

/// β = β₀ (u + v).
#[derive(Clone, Copy, Debug)]
pub struct SumKernel {
    /// β₀ in 1/(s m³).
    pub rate: f64,
}

impl AggregationKernel for SumKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        self.rate * (u + v)
    }
}

/// Its entry in a case file.
pub(super) static SUM: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "sum",
    summary: "In proportion to the sum of the volumes.",
    source: "Golovin, Bull. Acad. Sci. USSR Geophys. Ser. 5 (1963) 783",
    parameters: &[LawParameter {
        name: "rate",
        dimension: Dimension([-3, 0, -1, 0, 0]),
        bound: Bound::NotNegative,
        default: None,
        needed_with: None,
        meaning: "Rate at which two particles of the bed aggregate, of the volumes that the law has in it.",
        example: "\"0.1 1/s/m^3\"",
    }],
    tables: &[],
    make: |values| Box::new(SumKernel { rate: values[0] }),
};
