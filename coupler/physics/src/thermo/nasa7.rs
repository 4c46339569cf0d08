//! NASA polynomials of seven coefficients (requirements COR-8).

use crate::gas::GAS_CONSTANT;

/// Lowest temperature of the fits in K. Below it and above [`HIGHEST`] the heat capacity stays what it
/// is there, so that enthalpy goes on growing with temperature.
pub const LOWEST: f64 = 200.0;
/// Highest temperature of the fits in K.
pub const HIGHEST: f64 = 3500.0;

/// Molar heat capacity, enthalpy and entropy of a species as an ideal gas at 1 bar (1 atm in the older
/// fits), in two ranges of temperature:
///
/// c_p/R = a₁ + a₂T + a₃T² + a₄T³ + a₅T⁴
/// h/(RT) = a₁ + a₂T/2 + a₃T²/3 + a₄T³/4 + a₅T⁴/5 + a₆/T
/// s/R = a₁ ln T + a₂T + a₃T²/2 + a₄T³/3 + a₅T⁴/4 + a₇
///
/// h is that of formation from the elements at 298.15 K, so that heats of reaction are differences.
///
/// Source of the form: McBride, Gordon and Reno, NASA TM-4513 (1993).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nasa7 {
    /// a₁ … a₇ below the middle temperature.
    pub low: [f64; 7],
    /// a₁ … a₇ above it.
    pub high: [f64; 7],
    /// Where the ranges meet, in K.
    pub middle: f64,
}

impl Nasa7 {
    #[inline]
    fn range(&self, temperature: f64) -> &[f64; 7] {
        if temperature < self.middle {
            &self.low
        } else {
            &self.high
        }
    }

    /// The same with ranges that meet exactly in enthalpy: fits leave a step there, of less than
    /// 1e-3 J/mol in the built-in species, on which an inversion would find no foothold.
    #[must_use]
    pub fn joined(mut self) -> Self {
        let t = self.middle;
        let at = |[a, b, c, d, e, f, _]: [f64; 7]| {
            t * (a + t * (b / 2.0 + t * (c / 3.0 + t * (d / 4.0 + t * e / 5.0)))) + f
        };
        self.high[5] += at(self.low) - at(self.high);
        self
    }

    /// Molar heat capacity c_p in J/mol/K at a temperature in K.
    #[inline]
    pub fn heat_capacity(&self, temperature: f64) -> f64 {
        let t = temperature.clamp(LOWEST, HIGHEST);
        let [a, b, c, d, e, ..] = *self.range(t);
        GAS_CONSTANT * (a + t * (b + t * (c + t * (d + t * e))))
    }

    /// Derivative of the molar heat capacity in J/mol/K².
    pub fn heat_capacity_slope(&self, temperature: f64) -> f64 {
        if !(LOWEST..=HIGHEST).contains(&temperature) {
            return 0.0;
        }
        let t = temperature;
        let [_, b, c, d, e, ..] = *self.range(t);
        GAS_CONSTANT * (b + t * (2.0 * c + t * (3.0 * d + t * 4.0 * e)))
    }

    /// Molar enthalpy, that of formation included, in J/mol.
    #[inline]
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        let t = temperature.clamp(LOWEST, HIGHEST);
        let [a, b, c, d, e, f, _] = *self.range(t);
        let within = t * (a + t * (b / 2.0 + t * (c / 3.0 + t * (d / 4.0 + t * e / 5.0)))) + f;
        GAS_CONSTANT * within + self.heat_capacity(t) * (temperature - t)
    }

    /// Molar entropy at the pressure of the fit in J/mol/K.
    pub fn entropy(&self, temperature: f64) -> f64 {
        let t = temperature.clamp(LOWEST, HIGHEST);
        let [a, b, c, d, e, _, g] = *self.range(t);
        let within = a * t.ln() + t * (b + t * (c / 2.0 + t * (d / 3.0 + t * e / 4.0))) + g;
        GAS_CONSTANT * within + self.heat_capacity(t) * (temperature / t).ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thermo::{species, species_names};

    /// Temperature in K, then c_p, h and s in J/mol(/K).
    type Row = (f64, f64, f64, f64);

    #[test]
    fn heat_capacity_enthalpy_and_entropy_agree_with_an_independent_evaluation() {
        // In Python, from the coefficients of the sources.
        let rows: [(&str, [Row; 2]); 4] = [
            (
                "N2",
                [
                    (250.0, 29.110605276, -1401.8689877, 186.480526962),
                    (1200.0, 33.638118102, 28099.6343269, 234.221341175),
                ],
            ),
            (
                "CO2",
                [
                    (900.0, 52.973879398, -365476.6676081, 263.633843102),
                    (3000.0, 62.172209522, -240696.1935619, 334.139726991),
                ],
            ),
            (
                "H2O",
                [
                    (250.0, 33.409418267, -243437.1385166, 182.929808367),
                    (1200.0, 43.877242732, -207300.8938127, 240.495854200),
                ],
            ),
            (
                "CH4",
                [
                    (900.0, 68.850963995, -43069.9651783, 240.779953703),
                    (3000.0, 111.612677743, 159935.0523012, 352.168667551),
                ],
            ),
        ];
        for (name, rows) in rows {
            let thermo = &species(name).unwrap().thermo;
            for (t, heat_capacity, enthalpy, entropy) in rows {
                assert!(
                    (thermo.heat_capacity(t) / heat_capacity - 1.0).abs() < 1e-9,
                    "{name} {t}"
                );
                assert!(
                    (thermo.enthalpy(t) / enthalpy - 1.0).abs() < 1e-9,
                    "{name} {t}"
                );
                assert!(
                    (thermo.entropy(t) / entropy - 1.0).abs() < 1e-8,
                    "{name} {t}"
                );
            }
        }
    }

    #[test]
    fn the_heat_capacities_are_those_of_requirement_cor_8() {
        // J/kg/K of therm.dat, another fit: within 5e-5.
        for (name, at_300, at_800) in [
            ("N2", 1039.69, 1121.91),
            ("CO2", 845.67, 1168.61),
            ("H2O", 1864.89, 2150.01),
        ] {
            let species = species(name).unwrap();
            for (t, expected) in [(300.0, at_300), (800.0, at_800)] {
                let found = species.thermo.heat_capacity(t) / species.molar_mass();
                assert!((found / expected - 1.0).abs() < 5e-5, "{name} {t}: {found}");
            }
        }
    }

    #[test]
    fn the_enthalpies_of_formation_are_those_of_the_tables() {
        // CODATA/NIST, kJ/mol at 298.15 K.
        for (name, expected) in [
            ("N2", 0.0),
            ("O2", 0.0),
            ("H2", 0.0),
            ("Ar", 0.0),
            ("CO2", -393.51),
            ("H2O", -241.83),
            ("CO", -110.53),
            ("CH4", -74.6),
        ] {
            let found = species(name).unwrap().thermo.enthalpy(298.15) / 1e3;
            assert!((found - expected).abs() < 0.05, "{name}: {found}");
        }
    }

    #[test]
    fn enthalpy_is_the_integral_of_the_heat_capacity_everywhere_and_the_slope_its_derivative() {
        for name in species_names() {
            let thermo = &species(name).unwrap().thermo;
            for t in [150.0, 199.99, 250.0, 700.0, 999.9, 1000.1, 2500.0, 3600.0] {
                let h = 1e-3;
                let slope = (thermo.enthalpy(t + h) - thermo.enthalpy(t - h)) / (2.0 * h);
                assert!(
                    (slope / thermo.heat_capacity(t) - 1.0).abs() < 1e-6,
                    "{name} {t}"
                );
                let difference =
                    (thermo.heat_capacity(t + h) - thermo.heat_capacity(t - h)) / (2.0 * h);
                assert!(
                    (difference - thermo.heat_capacity_slope(t)).abs() < 1e-5,
                    "{name} {t}"
                );
            }
        }
    }

    #[test]
    fn the_two_ranges_meet() {
        for name in species_names() {
            let thermo = &species(name).unwrap().thermo;
            let (below, above) = (1000.0 - 1e-9, 1000.0);
            let jump = |f: fn(&Nasa7, f64) -> f64| f(thermo, above) / f(thermo, below) - 1.0;
            assert!(jump(Nasa7::heat_capacity).abs() < 1e-6, "{name}");
            assert!(jump(Nasa7::entropy).abs() < 1e-6, "{name}");
            let step = thermo.enthalpy(above) - thermo.enthalpy(below);
            assert!(step.abs() < 1e-3, "{name}: {step} J/mol");
            let joined = thermo.joined();
            let step = joined.enthalpy(above) - joined.enthalpy(below);
            assert!(step.abs() < 1e-6, "{name}: {step} J/mol");
        }
    }
}
