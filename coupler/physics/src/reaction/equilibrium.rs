//! Equilibria.

use calcine_numerics::{Dual, Lanes, Number};

use crate::gas::GAS_CONSTANT;

/// Standard pressure of thermodynamic tables in Pa.
pub const STANDARD_PRESSURE: f64 = 1e5;

/// How the equilibrium constant K of a reaction follows temperature; gases enter it by their partial
/// pressures over 1 bar, solids as pure phases.
#[derive(Clone, Debug, PartialEq)]
pub enum Equilibrium {
    /// The reaction goes one way: 1/K = 0.
    OneWay,
    /// ln K = a + b/T, such as a measured line.
    Line {
        /// a.
        constant: f64,
        /// b in K.
        over_temperature: f64,
    },
    /// ln K = −ΔG°/(R T) of the species' own Gibbs energies, tabulated.
    Gibbs(GibbsLine),
}

/// ln K at temperatures T₀, T₀ + ΔT … in between linear in T.
#[derive(Clone, Debug, PartialEq)]
pub struct GibbsLine {
    values: Vec<f64>,
}

/// First temperature of the table in K, and its step: within a step ln K is linear to 1e-3
/// at 300 K, 2e-5 at 1000 K.
const FIRST: f64 = 250.0;
const STEP: f64 = 2.0;
const LAST: f64 = 2500.0;

impl GibbsLine {
    /// Tabulates a change of Gibbs energy in J/mol over temperature in K.
    pub fn new(change: impl Fn(f64) -> f64) -> Self {
        let count = ((LAST - FIRST) / STEP) as usize + 1;
        let value = |k: usize| {
            let temperature = FIRST + k as f64 * STEP;
            -change(temperature) / (GAS_CONSTANT * temperature)
        };
        Self {
            values: (0..count).map(value).collect(),
        }
    }

    fn at<N: Number>(&self, temperature: N) -> N {
        let t = temperature.value();
        let place = ((t - FIRST) / STEP).clamp(0.0, (self.values.len() - 2) as f64);
        let low = place as usize;
        let share = (t - FIRST) / STEP - low as f64;
        let rise = self.values[low + 1] - self.values[low];
        temperature.through(self.values[low] + share * rise, rise / STEP)
    }
}

impl Equilibrium {
    /// 1/K at a temperature in K.
    pub fn inverse<N: Number>(&self, temperature: N) -> N {
        match self {
            Self::OneWay => N::constant(0.0),
            Self::Line {
                constant,
                over_temperature,
            } => {
                let t = temperature.value();
                let line = -constant - over_temperature / t;
                temperature.through(line, over_temperature / (t * t)).exp()
            }
            Self::Gibbs(line) => (-line.at(temperature)).exp(),
        }
    }

    /// 1/K at temperatures in K side by side, and the slope of its logarithm in 1/K.
    #[inline(always)]
    pub fn inverse_lanes<const N: usize>(&self, temperature: Lanes<N>) -> [Lanes<N>; 2] {
        let (mut logarithm, mut slope) = (Lanes::default(), Lanes::default());
        match self {
            Self::OneWay => return [logarithm, slope],
            Self::Line {
                constant,
                over_temperature,
            } => {
                let over = temperature.inverse();
                logarithm = over * -over_temperature - Lanes::all(*constant);
                slope = over * over * *over_temperature;
            }
            Self::Gibbs(line) => {
                for lane in 0..N {
                    let own = line.at(Dual::<1>::along(temperature[lane], 0));
                    (logarithm[lane], slope[lane]) = (-own.value, -own.slope[0]);
                }
            }
        }
        [logarithm.exp(), slope]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_its_formula_and_one_way_has_no_way_back() {
        let law = Equilibrium::Line {
            constant: -2.946,
            over_temperature: 2744.0,
        };
        // exp(2744/1173 − 2.946) in Python.
        assert!((law.inverse(1173.0) * 0.545_147_4 - 1.0).abs() < 1e-6);
        assert_eq!(Equilibrium::OneWay.inverse(1173.0), 0.0);
    }

    #[test]
    fn the_table_of_a_gibbs_energy_is_exact_at_its_points_and_near_between() {
        let change = |t: f64| 170e3 - 145.0 * t + 4.0 * t * (t / 300.0).ln();
        let law = Equilibrium::Gibbs(GibbsLine::new(change));
        for t in [300.0, 301.0, 777.7, 1166.0, 2499.0] {
            let exact = (change(t) / (GAS_CONSTANT * t)).exp();
            assert!((law.inverse(t) / exact - 1.0).abs() < 1e-3, "{t}");
        }
    }
}
