//! Brownian motion.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::aggregation_kernel::AggregationKernel;

/// Particles that meet by Brownian motion in a continuum.
///
/// β = β₀ (u^(1/3) + v^(1/3)) (u^(−1/3) + v^(−1/3))
///
/// It is 4 β₀ among equals.
///
/// Source: von Smoluchowski, Z. Phys. Chem. 92 (1917) 129, doi 10.1515/zpch-1918-9209.
#[derive(Clone, Copy, Debug)]
pub struct BrownianKernel {
    /// β₀ in 1/s.
    pub rate: f64,
}

impl AggregationKernel for BrownianKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        let (a, b) = (u.cbrt(), v.cbrt());
        self.rate * (a + b) * (1.0 / a + 1.0 / b)
    }
}

/// Its entry in a case file.
pub(super) static BROWNIAN: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "brownian",
    summary: "Brownian motion in a continuum.",
    source: "von Smoluchowski, Z. Phys. Chem. 92 (1917) 129, doi 10.1515/zpch-1918-9209",
    parameters: &[LawParameter {
        name: "rate",
        dimension: Dimension([0, 0, -1, 0, 0]),
        bound: Bound::NotNegative,
        default: None,
        needed_with: None,
        meaning: "A quarter of the rate at which two particles of one size aggregate.",
        example: "\"1e-9 1/s\"",
    }],
    tables: &[],
    make: |values| Box::new(BrownianKernel { rate: values[0] }),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        let law = BrownianKernel { rate: 3.0 };
        // Diameters as 1 to 2: 3 · (1 + 2)(1 + 1/2).
        assert!((law.rate(1e-9, 8e-9) - 13.5).abs() < 1e-12);
        assert!((law.rate(1e-9, 1e-9) - 12.0).abs() < 1e-12);
    }
}
