//! The solid fraction as a function of the stress, for the implicit packing.

use calcine_coupler::physics::parcels::HarrisCrighton;

/// Share of close packing below which the stress is taken in proportion to the solid fraction: its slope is zero at zero, so
/// that the solid fraction would rise with an infinite one. There it is below 1e-6 of the constant P_s.
const LOOSE: f64 = 1e-3;
/// Distance from close packing, as a share of it, from which on the first guess of the stress does not rise.
const GUESS: f64 = 1e-3;
/// Steps of Newton's method at most; six are the rule.
const STEPS: u32 = 60;

/// α(τ) of the law of Harris and Crighton: rising, concave, and below close packing.
#[derive(Clone, Copy, Debug)]
pub struct StressCurve {
    law: HarrisCrighton,
    /// Solid fraction and stress in Pa below which they are in proportion.
    loose: (f64, f64),
}

impl StressCurve {
    /// The curve of a law.
    pub fn new(law: &HarrisCrighton) -> Self {
        let loose = LOOSE * law.close_packing;
        Self {
            law: *law,
            loose: (loose, law.stress(loose).0),
        }
    }

    /// A first guess of the stress in Pa at a solid fraction.
    pub fn first(&self, fraction: f64) -> f64 {
        let most = (1.0 - GUESS) * self.law.close_packing;
        let (loose, stress) = self.loose;
        if fraction < loose {
            return fraction / loose * stress;
        }
        self.law.stress(fraction.min(most)).0
    }

    /// α and dα/dτ in 1/Pa at a stress.
    pub fn fraction(&self, stress: f64) -> (f64, f64) {
        let (loose, least) = self.loose;
        if stress <= least {
            return (stress / least * loose, loose / least);
        }
        // α + P α^β/τ = α_cp: convex in α, so that Newton's method falls to its root from close packing.
        let HarrisCrighton {
            pressure,
            exponent,
            close_packing,
            ..
        } = self.law;
        let share = pressure / stress;
        let mut fraction = close_packing;
        for _ in 0..STEPS {
            let power = share * fraction.powf(exponent - 1.0);
            let step = (fraction + power * fraction - close_packing) / (1.0 + exponent * power);
            fraction -= step;
            if step <= 1e-15 {
                break;
            }
        }
        // τ = P α^β/D with D = α_cp − α: dτ/dα = τ (β/α + 1/D).
        let gap = share * fraction.powf(exponent);
        (fraction, 1.0 / (stress * (exponent / fraction + 1.0 / gap)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: HarrisCrighton = HarrisCrighton {
        pressure: 10.0,
        exponent: 2.0,
        floor: 1e-12,
        close_packing: 0.6,
    };

    #[test]
    fn it_is_the_inverse_of_the_law() {
        for exponent in [2.0, 3.5] {
            let law = HarrisCrighton { exponent, ..LAW };
            let curve = StressCurve::new(&law);
            for fraction in [1e-3, 0.1, 0.5, 0.59, 0.599_999, 0.599_999_999] {
                let (stress, slope) = law.stress(fraction);
                let (found, rise) = curve.fraction(stress);
                assert!((found - fraction).abs() < 1e-14, "{fraction}: {found}");
                assert!(
                    (rise * slope - 1.0).abs() < 1e-6,
                    "{fraction}: {rise} {slope}"
                );
            }
        }
    }

    #[test]
    fn it_rises_concavely_from_zero_and_stays_below_close_packing() {
        let curve = StressCurve::new(&LAW);
        assert_eq!(curve.fraction(0.0).0, 0.0);
        let mut last = curve.fraction(0.0);
        for k in -60..80 {
            let next = curve.fraction(10.0_f64.powf(f64::from(k) / 8.0));
            assert!(
                next.0 > last.0 && next.1 <= last.1 && next.0 < 0.6,
                "{k}: {next:?}"
            );
            last = next;
        }
    }
}
