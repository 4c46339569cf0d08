//! Laminar shear.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::aggregation_kernel::AggregationKernel;

/// Particles that meet in laminar shear.
///
/// β = β₀ (u^(1/3) + v^(1/3))³
///
/// Source: von Smoluchowski, Z. Phys. Chem. 92 (1917) 129, doi 10.1515/zpch-1918-9209.
#[derive(Clone, Copy, Debug)]
pub struct ShearKernel {
    /// β₀ in 1/(s m³).
    pub rate: f64,
}

impl AggregationKernel for ShearKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        self.rate * (u.cbrt() + v.cbrt()).powi(3)
    }
}

/// Its entry in a case file.
pub(super) static SHEAR: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "shear",
    summary: "Laminar shear.",
    source: "von Smoluchowski, Z. Phys. Chem. 92 (1917) 129, doi 10.1515/zpch-1918-9209",
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
    make: |values| Box::new(ShearKernel { rate: values[0] }),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // (1 mm + 2 mm)³.
        let found = ShearKernel { rate: 2.0 }.rate(1e-9, 8e-9);
        assert!((found / 54e-9 - 1.0).abs() < 1e-14, "{found}");
    }
}
