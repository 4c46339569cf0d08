//! Differential settling.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::aggregation_kernel::AggregationKernel;

/// Particles that meet because large ones settle faster, after Stokes. Equals never meet.
///
/// β = β₀ (u^(1/3) + v^(1/3))² |u^(2/3) − v^(2/3)|
///
/// It gels: its degree in volume is 4/3.
///
/// Source: Friedlander, Smoke, Dust, and Haze (2000), section 7.5.
#[derive(Clone, Copy, Debug)]
pub struct SettlingKernel {
    /// β₀ in 1/(s m⁴).
    pub rate: f64,
}

impl AggregationKernel for SettlingKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        let (a, b) = (u.cbrt(), v.cbrt());
        self.rate * (a + b) * (a + b) * (a * a - b * b).abs()
    }
}

/// Its entry in a case file.
pub(super) static SETTLING: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "settling",
    summary: "Large particles that settle faster; it gels.",
    source: "Friedlander, Smoke, Dust, and Haze (2000), section 7.5",
    parameters: &[LawParameter {
        name: "rate",
        dimension: Dimension([-4, 0, -1, 0, 0]),
        bound: Bound::NotNegative,
        default: None,
        needed_with: None,
        meaning: "Rate at which two particles of the bed aggregate, of the volumes that the law has in it.",
        example: "\"0.1 1/s/m^4\"",
    }],
    tables: &[],
    make: |values| Box::new(SettlingKernel { rate: values[0] }),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation_and_is_zero_among_equals() {
        let law = SettlingKernel { rate: 1.0 };
        // (3 mm)² (4 − 1) mm².
        assert!((law.rate(1e-9, 8e-9) / 27e-12 - 1.0).abs() < 1e-14);
        assert_eq!(law.rate(8e-9, 8e-9), 0.0);
    }
}
