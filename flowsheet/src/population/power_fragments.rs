//! Powers of the volume.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};
use calcine_physics::sphere::volume_of_diameter;

use super::fragments::BreakageLaw;

/// Breakage whose rate and whose fragments are powers of the volume.
///
/// S = S₀ (v/v₀)ⁿ with v₀ the volume of a reference diameter,   of the fragments' volume the share (u/v)^q is below u, in q/(q − 1) fragments
///
/// q = 2 is random binary breakage; towards 1 ever more and finer fragments are made, of which there would be infinitely many at 1.
///
/// Source: Hill and Ng, AIChE J. 41 (1995) 1204, doi 10.1002/aic.690410516.
#[derive(Clone, Copy, Debug)]
pub struct PowerBreakage {
    /// S₀ in 1/s.
    pub rate: f64,
    /// Reference diameter in m.
    pub reference: f64,
    /// n.
    pub power: f64,
    /// q.
    pub fragments: f64,
}

impl BreakageLaw for PowerBreakage {
    fn rate(&self, v: f64) -> f64 {
        self.rate * (v / volume_of_diameter(self.reference)).powf(self.power)
    }

    fn below(&self, u: f64, v: f64) -> [f64; 2] {
        let (x, q) = (u / v, self.fragments);
        [q / (q - 1.0) * x.powf(q - 1.0), v * x.powf(q)]
    }

    fn refused(&self) -> Option<(&'static str, f64, &'static str)> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        if !positive(self.reference) {
            let allowed = "it is above zero";
            return Some((
                "reference diameter of breakage in m",
                self.reference,
                allowed,
            ));
        }
        let enough = self.fragments.is_finite() && self.fragments > 1.0;
        let allowed = "it is above 1, where fragments become infinitely many";
        (!enough).then_some(("power of the fragments", self.fragments, allowed))
    }
}

/// Its entry in a case file.
pub(super) static POWER: LawEntry<dyn BreakageLaw> = LawEntry {
    name: "power",
    summary: "Powers of the volume, for the rate and for the fragments.",
    source: "Hill and Ng, AIChE J. 41 (1995) 1204, doi 10.1002/aic.690410516",
    parameters: &[
        LawParameter {
            name: "rate",
            dimension: Dimension([0, 0, -1, 0, 0]),
            bound: Bound::NotNegative,
            default: None,
            needed_with: None,
            meaning: "Rate at which a particle of the reference diameter breaks.",
            example: "\"0.01 1/s\"",
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
        LawParameter {
            name: "power",
            dimension: Dimension([0, 0, 0, 0, 0]),
            bound: Bound::Any,
            default: None,
            needed_with: None,
            meaning: "Power of the volume in the rate.",
            example: "1.0",
        },
        LawParameter {
            name: "fragments",
            dimension: Dimension([0, 0, 0, 0, 0]),
            bound: Bound::Within(1.0, f64::INFINITY),
            default: None,
            needed_with: None,
            meaning: "Power of the volume in the share of the fragments below a size: 2 for two fragments of any size, nearer to 1 for more and finer ones.",
            example: "2.0",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(PowerBreakage {
            rate: values[0],
            reference: values[1],
            power: values[2],
            fragments: values[3],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::RandomBinary;

    #[test]
    fn is_random_binary_breakage_with_a_power_of_two() {
        let law = PowerBreakage {
            rate: 3.0,
            reference: 2e-3,
            power: 1.0,
            fragments: 2.0,
        };
        let binary = RandomBinary {
            rate: 3.0 / volume_of_diameter(2e-3),
        };
        assert!((law.rate(5e-9) / binary.rate(5e-9) - 1.0).abs() < 1e-14);
        for (a, b) in law.below(2e-9, 5e-9).iter().zip(binary.below(2e-9, 5e-9)) {
            assert!((a / b - 1.0).abs() < 1e-14);
        }
        // Three fragments: q/(q − 1) = 3.
        let three = PowerBreakage {
            fragments: 1.5,
            ..law
        };
        assert!((three.below(5e-9, 5e-9)[0] - 3.0).abs() < 1e-14);
        assert!(
            PowerBreakage {
                fragments: 1.0,
                ..law
            }
            .refused()
            .is_some()
        );
    }
}
