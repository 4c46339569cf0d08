//! Equipartition of kinetic energy.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};
use calcine_physics::sphere::volume_of_diameter;

use super::aggregation_kernel::AggregationKernel;

/// Particles whose random velocities share the kinetic energy alike, as in fluidised and tumbling beds.
///
/// β = β₀ (x + y)² √(1/x³ + 1/y³)/√32,   x, y the diameters relative to a reference
///
/// Source: Hounslow, KONA 16 (1998) 179, doi 10.14356/kona.1998021.
#[derive(Clone, Copy, Debug)]
pub struct EquipartitionKernel {
    /// β₀, the rate between two particles of the reference diameter, in 1/s.
    pub rate: f64,
    /// Reference diameter in m.
    pub reference: f64,
}

impl AggregationKernel for EquipartitionKernel {
    fn rate(&self, u: f64, v: f64) -> f64 {
        let unit = volume_of_diameter(self.reference);
        let (u, v) = (u / unit, v / unit);
        let apart = (1.0 / u + 1.0 / v).sqrt();
        self.rate * (u.cbrt() + v.cbrt()).powi(2) * apart / 32f64.sqrt()
    }
}

/// Its entry in a case file.
pub(super) static EQUIPARTITION: LawEntry<dyn AggregationKernel> = LawEntry {
    name: "equipartition",
    summary: "Random velocities that share the kinetic energy alike.",
    source: "Hounslow, KONA 16 (1998) 179, doi 10.14356/kona.1998021",
    parameters: &[
        LawParameter {
            name: "rate",
            dimension: Dimension([0, 0, -1, 0, 0]),
            bound: Bound::NotNegative,
            default: None,
            needed_with: None,
            meaning: "Rate at which two particles of the reference diameter aggregate.",
            example: "\"1e-9 1/s\"",
        },
        LawParameter {
            name: "reference",
            dimension: Dimension([1, 0, 0, 0, 0]),
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Reference diameter.",
            example: "\"1 mm\"",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(EquipartitionKernel {
            rate: values[0],
            reference: values[1],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        let law = EquipartitionKernel {
            rate: 2.0,
            reference: 1e-3,
        };
        let [one, two] = [1e-3, 2e-3].map(volume_of_diameter);
        assert!((law.rate(one, one) - 2.0).abs() < 1e-14);
        // 2 · 3² √1.125/√32 = 2 · 9 · 0.1875.
        let found = law.rate(one, two);
        assert!((found - 3.375).abs() < 1e-13, "{found}");
    }
}
