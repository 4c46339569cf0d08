//! Rates at which two particles aggregate.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

/// Rate β at which two particles of volumes u, v in m³ aggregate, in 1/s (for a bed as a whole: the number of
/// aggregations in a second is ½ Σ Σ β N N).
pub trait AggregationKernel: Send + Sync {
    /// β(u, v) in 1/s.
    fn rate(&self, u: f64, v: f64) -> f64;
}

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
static CONSTANT: LawEntry<dyn AggregationKernel> = LawEntry {
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

/// Its entry in a case file.
static SUM: LawEntry<dyn AggregationKernel> = LawEntry {
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

/// Its entry in a case file.
static PRODUCT: LawEntry<dyn AggregationKernel> = LawEntry {
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

/// The kernels of aggregation that a case may choose. A new one is declared and listed here.
pub static AGGREGATION_LAWS: &[&LawEntry<dyn AggregationKernel>] = &[&CONSTANT, &SUM, &PRODUCT];
