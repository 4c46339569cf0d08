//! NASA's seven coefficients, 1971.

use calcine_numerics::Lanes;

use super::{ThermoError, inverse};
use crate::gas::GAS_CONSTANT;

/// Molar heat capacity, enthalpy and entropy of an ideal gas at 1 bar by a polynomial for each of two
/// temperature ranges (docs/theory.md, COR-8).
///
/// c_p/R = a₁ + a₂ T + a₃ T² + a₄ T³ + a₅ T⁴
/// h/R = a₁ T + a₂ T²/2 + a₃ T³/3 + a₄ T⁴/4 + a₅ T⁵/5 + a₆
/// s/R = a₁ ln T + a₂ T + a₃ T²/2 + a₄ T³/3 + a₅ T⁴/4 + a₇
///
/// h is the formation enthalpy at 298.15 K plus the sensible enthalpy from there. The lower range
/// holds up to and at the common temperature.
///
/// Validity: [`Nasa7::range`]. Outside it c_p stays what it is at its end, so that the enthalpy goes on
/// growing with the temperature; only [`Nasa7::temperature`] refuses.
///
/// Source: Gordon and McBride, NASA SP-273 (1971); McBride, Gordon and Reno, NASA TM-4513 (1993).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nasa7 {
    lowest: f64,
    common: f64,
    highest: f64,
    low: [f64; 7],
    high: [f64; 7],
}

impl Nasa7 {
    /// Polynomials from `lowest` over `common` to `highest`, in K.
    pub fn new(
        [lowest, common, highest]: [f64; 3],
        low: [f64; 7],
        high: [f64; 7],
    ) -> Result<Self, ThermoError> {
        if !(lowest > 0.0 && lowest < common && common < highest && highest.is_finite()) {
            return Err(ThermoError::Range {
                lowest,
                common,
                highest,
            });
        }
        Ok(Self::checked([lowest, common, highest], low, high))
    }

    /// As [`Nasa7::new`], for the table of this crate.
    pub(super) const fn checked(range: [f64; 3], low: [f64; 7], high: [f64; 7]) -> Self {
        let [lowest, common, highest] = range;
        Self {
            lowest,
            common,
            highest,
            low,
            high,
        }
    }

    /// Lowest and highest temperature in K.
    pub fn range(&self) -> (f64, f64) {
        (self.lowest, self.highest)
    }

    /// Temperature in K at which the ranges meet.
    pub fn common_temperature(&self) -> f64 {
        self.common
    }

    /// Coefficients a₁ to a₇ of the lower and the upper range.
    pub fn coefficients(&self) -> [&[f64; 7]; 2] {
        [&self.low, &self.high]
    }

    /// The same with ranges that meet exactly in enthalpy: fits leave a step there, of less than
    /// 1e-3 J/mol in the built-in species, on which an inversion would find no foothold.
    #[must_use]
    pub fn joined(mut self) -> Self {
        self.high[5] += within(&self.low, self.common) - within(&self.high, self.common);
        self
    }

    /// The temperature, or the end of the range that it is beyond, and the coefficients there.
    #[inline]
    fn at(&self, temperature: f64) -> (f64, &[f64; 7]) {
        let t = temperature.clamp(self.lowest, self.highest);
        (
            t,
            if t <= self.common {
                &self.low
            } else {
                &self.high
            },
        )
    }

    /// Molar heat capacity c_p in J/mol/K.
    pub fn heat_capacity(&self, temperature: f64) -> f64 {
        let (t, a) = self.at(temperature);
        GAS_CONSTANT * (a[0] + t * (a[1] + t * (a[2] + t * (a[3] + t * a[4]))))
    }

    /// dc_p/dT in J/mol/K².
    pub fn heat_capacity_slope(&self, temperature: f64) -> f64 {
        let (t, a) = self.at(temperature);
        if t != temperature {
            return 0.0;
        }
        GAS_CONSTANT * (a[1] + t * (2.0 * a[2] + t * (3.0 * a[3] + t * 4.0 * a[4])))
    }

    /// Molar enthalpy in J/mol, formation included.
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        let (t, a) = self.at(temperature);
        let beyond = if t == temperature {
            0.0
        } else {
            self.heat_capacity(t) * (temperature - t)
        };
        GAS_CONSTANT * within(a, t) + beyond
    }

    /// Molar heat capacity in J/mol/K and enthalpy in J/mol, formation included, at temperatures in K side by side.
    #[inline(always)]
    pub fn lanes<const N: usize>(&self, temperature: Lanes<N>) -> [Lanes<N>; 2] {
        let [lowest, highest, common] = [self.lowest, self.highest, self.common].map(Lanes::all);
        let t = temperature.max(lowest).min(highest);
        let a = |k: usize| common.if_below(t, Lanes::all(self.high[k]), Lanes::all(self.low[k]));
        let [a0, a1, a2, a3, a4, a5] = [a(0), a(1), a(2), a(3), a(4), a(5)];
        let capacity = (a0 + t * (a1 + t * (a2 + t * (a3 + t * a4)))) * GAS_CONSTANT;
        let fourth = a3 * 0.25 + t * a4 * 0.2;
        let within = a5 + t * (a0 + t * (a1 * 0.5 + t * (a2 * (1.0 / 3.0) + t * fourth)));
        [
            capacity,
            within * GAS_CONSTANT + capacity * (temperature - t),
        ]
    }

    /// Molar entropy in J/mol/K at 1 bar.
    pub fn entropy(&self, temperature: f64) -> f64 {
        let (t, a) = self.at(temperature);
        let beyond = self.heat_capacity(t) * (temperature / t).ln();
        let rest = t * (a[1] + t * (a[2] / 2.0 + t * (a[3] / 3.0 + t * (a[4] / 4.0))));
        GAS_CONSTANT * (a[0] * t.ln() + rest + a[6]) + beyond
    }

    /// Molar Gibbs energy h − T s in J/mol at 1 bar.
    pub fn gibbs_energy(&self, temperature: f64) -> f64 {
        self.enthalpy(temperature) - temperature * self.entropy(temperature)
    }

    /// Temperature in K of a molar enthalpy in J/mol; `guess` in K is near it.
    pub fn temperature(&self, enthalpy: f64, guess: f64) -> Result<f64, ThermoError> {
        inverse::temperature(enthalpy, "J/mol", self.range(), guess, |t| {
            (self.enthalpy(t), self.heat_capacity(t))
        })
    }
}

/// h/R in K of one range.
#[inline]
fn within(a: &[f64; 7], t: f64) -> f64 {
    let fourth = a[3] / 4.0 + t * (a[4] / 5.0);
    a[5] + t * (a[0] + t * (a[1] / 2.0 + t * (a[2] / 3.0 + t * fourth)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::thermo::Species;

    fn polynomials() -> impl Iterator<Item = (String, Nasa7)> {
        Species::built_in_names().map(|name| {
            let species = Species::built_in(name).unwrap();
            (name.to_owned(), *species.polynomial())
        })
    }

    fn of(name: &str) -> Nasa7 {
        *Species::built_in(name).unwrap().polynomial()
    }

    #[test]
    fn side_by_side_it_is_what_it_is_alone() {
        for (name, one) in polynomials() {
            let all = [150.0, 298.15, 700.0, 1000.0, 1001.0, 2500.0, 4000.0, 9000.0];
            let [capacity, enthalpy] = one.lanes(Lanes(all));
            for (k, t) in all.into_iter().enumerate() {
                assert!(
                    (capacity[k] / one.heat_capacity(t) - 1.0).abs() < 1e-12,
                    "{name}"
                );
                let size = one.enthalpy(t).abs() + 1e5;
                assert!(
                    (enthalpy[k] - one.enthalpy(t)).abs() < 1e-14 * size,
                    "{name}"
                );
            }
        }
    }

    #[test]
    fn agrees_with_an_independent_evaluation_in_both_ranges() {
        // c_p, h, s in Python, term by term.
        for (name, t, c_p, h, s) in [
            (
                "CO2",
                250.0,
                34.883856424324186,
                -395242.41506332357,
                207.44659820498995,
            ),
            (
                "CO2",
                900.0,
                52.973879397775235,
                -365476.6676081024,
                263.6338431021017,
            ),
            (
                "CO2",
                1500.0,
                58.2248661522485,
                -331890.9413396145,
                292.1169206016639,
            ),
            (
                "CO2",
                3000.0,
                62.24310953354683,
                -240615.05485515855,
                334.1375679730934,
            ),
            (
                "H2O",
                250.0,
                33.409418267086835,
                -243437.13851658002,
                182.92980836723896,
            ),
            (
                "H2O",
                900.0,
                39.98624515716774,
                -219885.488954736,
                228.45501248713316,
            ),
            (
                "H2O",
                1500.0,
                47.33367673611131,
                -193585.3225158267,
                250.6847277799665,
            ),
            (
                "H2O",
                3000.0,
                56.84248729440231,
                -114195.60763333134,
                286.9898632794202,
            ),
        ] {
            let gas = of(name);
            assert!(
                (gas.heat_capacity(t) / c_p - 1.0).abs() < 1e-13,
                "{name} {t}"
            );
            // The upper range is shifted to meet the lower one: 1e-3 J/mol at most.
            assert!((gas.enthalpy(t) / h - 1.0).abs() < 1e-8, "{name} {t}");
            assert!((gas.entropy(t) / s - 1.0).abs() < 1e-13, "{name} {t}");
        }
    }

    #[test]
    fn derivatives_are_the_difference_quotients() {
        for (name, gas) in polynomials() {
            for t in [150.0, 250.0, 600.0, 1100.0, 2500.0, 5000.0, 6500.0] {
                let step = 0.1;
                let quotient = |f: &dyn Fn(f64) -> f64| (f(t + step) - f(t - step)) / (2.0 * step);
                let c_p = gas.heat_capacity(t);
                let from_h = quotient(&|t| gas.enthalpy(t));
                let from_s = t * quotient(&|t| gas.entropy(t));
                let slope = quotient(&|t| gas.heat_capacity(t));
                // Errors of the quotients: the third derivative times 0.01, round-off 1e-16 h/0.2.
                assert!((from_h / c_p - 1.0).abs() < 1e-6, "{name} {t}");
                assert!((from_s / c_p - 1.0).abs() < 1e-6, "{name} {t}");
                let scale = c_p / t;
                assert!(
                    (gas.heat_capacity_slope(t) - slope).abs() < 1e-5 * scale,
                    "{name} {t}"
                );
            }
        }
    }

    #[test]
    fn the_ranges_meet_at_the_common_temperature() {
        for (name, gas) in polynomials() {
            let [below, above] = [1000.0, 1000.0 * (1.0 + 1e-15)].map(|t| {
                let c_p = gas.heat_capacity(t);
                [c_p, gas.enthalpy(t) / t, gas.entropy(t)]
            });
            for (left, right) in below.into_iter().zip(above) {
                // The fits are constrained there; their coefficients have 9 digits.
                assert!((left - right).abs() < 2e-6, "{name}: {left} {right}");
            }
        }
    }

    #[test]
    fn temperatures_that_do_not_rise_are_refused() {
        for range in [[200.0, 200.0, 300.0], [0.0, 1.0, 2.0], [1.0, 2.0, f64::NAN]] {
            assert!(Nasa7::new(range, [0.0; 7], [0.0; 7]).is_err(), "{range:?}");
        }
    }

    proptest! {
        #[test]
        fn temperature_is_the_inverse_of_enthalpy(
            t in 200.0..6000.0f64, guess in 200.0..6000.0f64, which in 0usize..8,
        ) {
            let (_, gas) = polynomials().nth(which).unwrap();
            let found = gas.temperature(gas.enthalpy(t), guess).unwrap();
            // Round-off of h (up to 4e5 J/mol here) over c_p T.
            prop_assert!((found / t - 1.0).abs() < 1e-12, "{} {}", t, found);
        }

        #[test]
        fn heat_capacities_are_at_least_those_of_translation(t in 200.0..6000.0f64) {
            for (_, gas) in polynomials() {
                prop_assert!(gas.heat_capacity(t) >= 2.5 * GAS_CONSTANT);
            }
        }
    }
}
