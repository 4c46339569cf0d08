//! Stress of the solid by Harris and Crighton.

/// Isotropic stress between particles over their solid fraction α (docs/theory.md, COR-10):
///
/// τ = P_s α^β / D,   D = max(α_cp − α, e (1 − α)).
///
/// Validity: 0 ≤ α ≤ 1; e keeps the stress finite at and above close packing α_cp.
///
/// Source: Harris and Crighton, J. Fluid Mech. 266 (1994) 243, doi 10.1017/S0022112094000996; Snider, J. Comput. Phys. 170
/// (2001) 523, doi 10.1006/jcph.2001.6747.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarrisCrighton {
    /// P_s in Pa.
    pub pressure: f64,
    /// β, 2 to 5.
    pub exponent: f64,
    /// e, a small number.
    pub floor: f64,
    /// Solid fraction α_cp of the closest packing.
    pub close_packing: f64,
}

impl HarrisCrighton {
    /// τ in Pa and dτ/dα in Pa at a solid fraction.
    pub fn stress(&self, solid_fraction: f64) -> (f64, f64) {
        let room = self.close_packing - solid_fraction;
        let least = self.floor * (1.0 - solid_fraction);
        // The slope of D: −1 below close packing, −e where the floor holds.
        let (gap, slope) = if room >= least {
            (room, 1.0)
        } else {
            (least, self.floor)
        };
        let power = solid_fraction.powf(self.exponent - 1.0);
        let stress = self.pressure * power * solid_fraction / gap;
        let slope = self.pressure * power / gap * (self.exponent + solid_fraction * slope / gap);
        (stress, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: HarrisCrighton = HarrisCrighton {
        pressure: 10.0,
        exponent: 2.0,
        floor: 1e-7,
        close_packing: 0.6,
    };

    #[test]
    fn agrees_with_independent_values() {
        // docs/theory.md, COR-10.
        for (alpha, expected) in [(0.1, 0.2), (0.5, 25.0), (0.59, 348.1), (0.0, 0.0)] {
            let found = LAW.stress(alpha).0;
            assert!(
                (found - expected).abs() <= 1e-9 * expected,
                "{alpha}: {found}"
            );
        }
    }

    #[test]
    fn the_slope_is_the_difference_quotient_on_both_sides_of_close_packing() {
        for law in [
            LAW,
            HarrisCrighton {
                exponent: 3.5,
                floor: 1e-2,
                ..LAW
            },
        ] {
            for alpha in [0.05, 0.4, 0.58, 0.605, 0.64] {
                let width = 1e-7 * (0.6_f64 - alpha).abs();
                let quotient =
                    (law.stress(alpha + width).0 - law.stress(alpha - width).0) / (2.0 * width);
                let found = law.stress(alpha).1;
                assert!(
                    (found / quotient - 1.0).abs() < 1e-5,
                    "{alpha}: {found} {quotient}"
                );
            }
        }
    }

    #[test]
    fn it_rises_through_close_packing_without_a_limit_of_its_own() {
        let mut last = 0.0;
        for step in 1..=70 {
            let stress = LAW.stress(f64::from(step) / 100.0).0;
            assert!(stress > last && stress.is_finite());
            last = stress;
        }
    }

    #[test]
    fn an_empty_cell_has_neither_stress_nor_slope() {
        assert_eq!(LAW.stress(0.0), (0.0, 0.0));
    }
}
