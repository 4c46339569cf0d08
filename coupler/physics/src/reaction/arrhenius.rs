//! Arrhenius' rate constant, 1889.

use calcine_numerics::{Lanes, Number};

use crate::dimension::Dimension;
use crate::gas::GAS_CONSTANT;
use crate::law::{Bound, LawParameter};

/// Key of the exponent b, for laws that take a rate constant from a case.
pub(super) const EXPONENT: LawParameter = LawParameter {
    name: "exponent",
    dimension: Dimension::NONE,
    bound: Bound::Any,
    default: Some(0.0),
    needed_with: None,
    meaning: "Exponent b of the temperature over 1 K in k = factor (T/K)^b exp(-E/RT): the factor has the unit of k.",
    example: "0.5",
};

/// Key of the activation energy E.
pub(super) const ACTIVATION_ENERGY: LawParameter = LawParameter {
    name: "activation_energy",
    dimension: Dimension::MOLAR_ENERGY,
    bound: Bound::Any,
    default: Some(0.0),
    needed_with: None,
    meaning: "Activation energy.",
    example: "\"60 kJ/mol\"",
};

/// A rate constant k = A T^b exp(−E/(R T)), or two of them in series, 1/k = 1/k₁ + 1/k₂, where the
/// slower of two steps (chemistry, diffusion in pores) governs.
///
/// Source: Arrhenius, Z. phys. Chem. 4 (1889) 226, doi 10.1515/zpch-1889-0416.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrhenius {
    /// A in the unit of k (times K^−b).
    pub factor: f64,
    /// b.
    pub exponent: f64,
    /// E in J/mol.
    pub activation_energy: f64,
}

impl Arrhenius {
    /// From the values of its keys: the factor, [`EXPONENT`] and [`ACTIVATION_ENERGY`].
    pub(super) fn from_values(values: &[f64]) -> Self {
        Self {
            factor: values[0],
            exponent: values[1],
            activation_energy: values[2],
        }
    }

    /// k at a temperature in K.
    pub fn at(&self, temperature: f64) -> f64 {
        let power = if self.exponent == 0.0 {
            1.0
        } else {
            temperature.powf(self.exponent)
        };
        self.factor * power * (-self.activation_energy / (GAS_CONSTANT * temperature)).exp()
    }

    /// k and dk/dT at temperatures in K side by side.
    #[inline(always)]
    pub fn lanes<const N: usize>(&self, temperature: Lanes<N>) -> [Lanes<N>; 2] {
        let over = temperature.inverse();
        let driven = over * (self.activation_energy / GAS_CONSTANT);
        let mut k = (-driven).exp() * self.factor;
        if self.exponent != 0.0 {
            k = k * temperature.map(|t| t.powf(self.exponent));
        }
        [k, k * (driven + self.exponent) * over]
    }

    /// The same with derivatives, dk/dT = k (b + E/(R T))/T.
    #[inline]
    pub fn of<N: Number>(&self, temperature: N) -> N {
        let t = temperature.value();
        let k = self.at(t);
        let slope = k * (self.exponent + self.activation_energy / (GAS_CONSTANT * t)) / t;
        temperature.through(k, slope)
    }
}

/// k of one constant, or of two steps in series, at a temperature in K.
pub fn in_series<N: Number>(first: &Arrhenius, second: Option<&Arrhenius>, temperature: N) -> N {
    let one = first.of(temperature);
    match second.map(|second| second.of(temperature)) {
        Some(other) if one.value() > 0.0 && other.value() > 0.0 => {
            (one.inverse() + other.inverse()).inverse()
        }
        Some(_) => N::constant(0.0),
        None => one,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Arrhenius = Arrhenius {
        factor: 4.4e11,
        exponent: 0.5,
        activation_energy: 125_520.0,
    };

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python: 4.4e11 · √1200 · exp(−125520/8.314462618/1200).
        assert!(
            (LAW.at(1200.0) / 5.240_909_191_381_193e7 - 1.0).abs() < 1e-9,
            "{:e}",
            LAW.at(1200.0)
        );
    }

    #[test]
    fn side_by_side_it_is_what_it_is_alone() {
        let all = [300.0, 555.5, 1200.0, 2000.0];
        let [k, slope] = LAW.lanes(Lanes(all));
        for (lane, t) in all.into_iter().enumerate() {
            let one = LAW.of(calcine_numerics::Dual::<1>::along(t, 0));
            assert!((k[lane] / one.value - 1.0).abs() < 1e-13, "{t}");
            assert!((slope[lane] / one.slope[0] - 1.0).abs() < 1e-13, "{t}");
        }
    }

    #[test]
    fn the_logarithm_over_one_over_temperature_has_the_slope_of_the_activation_energy() {
        let law = Arrhenius {
            exponent: 0.0,
            ..LAW
        };
        let slope = (law.at(1001.0) / law.at(999.0)).ln() / (1.0 / 999.0 - 1.0 / 1001.0);
        assert!((slope * GAS_CONSTANT / 125_520.0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_derivative_is_the_difference_quotient() {
        let dual = LAW.of(calcine_numerics::Dual::<1>::along(1200.0, 0));
        let quotient = (LAW.at(1200.01) - LAW.at(1199.99)) / 0.02;
        assert_eq!(dual.value, LAW.at(1200.0));
        assert!((dual.slope[0] / quotient - 1.0).abs() < 1e-7);
    }

    #[test]
    fn of_two_steps_in_series_the_slower_governs() {
        let slow = Arrhenius {
            factor: 2.0,
            exponent: 0.0,
            activation_energy: 0.0,
        };
        let fast = Arrhenius {
            factor: 3.0,
            ..slow
        };
        assert!((in_series(&slow, Some(&fast), 300.0) - 1.2).abs() < 1e-15);
        assert_eq!(in_series(&slow, None, 300.0), 2.0);
        assert_eq!(
            in_series(
                &slow,
                Some(&Arrhenius {
                    factor: 0.0,
                    ..slow
                }),
                300.0
            ),
            0.0
        );
    }
}
