//! Rate constants of gas reactions.

use calcine_numerics::Number;

use crate::reaction::Arrhenius;

/// How fast a reaction runs at unit concentrations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RateConstant {
    /// k = A T^b exp(−E/(R T)); with a third body, rates are also proportional to its concentration.
    Arrhenius(Arrhenius),
    /// Between a limit k₀ [M] of low and a limit k∞ of high pressure,
    /// k = k∞ P/(1 + P) F, P = k₀ [M]/k∞.
    ///
    /// Source: Lindemann, Trans. Faraday Soc. 17 (1922) 598, doi 10.1039/TF9221700598.
    Falloff {
        /// k∞, in the unit of the reaction.
        high: Arrhenius,
        /// k₀, in that unit times m³/mol.
        low: Arrhenius,
        /// F.
        broadening: Broadening,
    },
}

/// How far the rate between the limits of pressure lies below Lindemann's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Broadening {
    /// F = 1.
    Lindemann,
    /// log F = log F_c/(1 + f²), f = (log P + c)/(n − 0.14 (log P + c)), c = −0.4 − 0.67 log F_c,
    /// n = 0.75 − 1.27 log F_c, logarithms to base ten, and
    /// F_c = (1 − a) exp(−T/T₃) + a exp(−T/T₁) + exp(−T₂/T).
    ///
    /// Source: Gilbert, Luther and Troe, Ber. Bunsenges. Phys. Chem. 87 (1983) 169,
    /// doi 10.1002/bbpc.19830870218.
    Troe {
        /// a.
        share: f64,
        /// T₃ in K; the term of a temperature of zero is zero.
        third: f64,
        /// T₁ in K, as T₃.
        first: f64,
        /// T₂ in K; without it the last term is zero.
        second: Option<f64>,
    },
}

impl RateConstant {
    /// k at a temperature in K and a concentration of third bodies in mol/m³.
    #[inline]
    pub fn at<N: Number>(&self, temperature: N, bodies: N) -> N {
        match self {
            Self::Arrhenius(law) => law.of(temperature),
            Self::Falloff {
                high,
                low,
                broadening,
            } => {
                let high = high.of(temperature);
                let pressure = low.of(temperature) * bodies / high;
                if pressure.value() <= 0.0 {
                    return N::constant(0.0);
                }
                let lindemann = high * pressure / (N::constant(1.0) + pressure);
                match broadening {
                    Broadening::Lindemann => lindemann,
                    Broadening::Troe { .. } => lindemann * broadening.factor(temperature, pressure),
                }
            }
        }
    }
}

impl Broadening {
    /// F at a temperature in K and a reduced pressure P > 0.
    fn factor<N: Number>(&self, temperature: N, pressure: N) -> N {
        let Self::Troe {
            share,
            third,
            first,
            second,
        } = *self
        else {
            return N::constant(1.0);
        };
        // At a scale of zero −1/scale is infinite, and its product with a slope of zero is NaN.
        let decay = |scale: f64| match scale == 0.0 {
            true => N::constant(0.0),
            false => temperature.times(-1.0 / scale).exp(),
        };
        let mut centre = decay(third).times(1.0 - share) + decay(first).times(share);
        if let Some(second) = second {
            centre = centre + (N::constant(-second) / temperature).exp();
        }
        if centre.value() <= 0.0 {
            // The limit of F_c going to zero: log F is −log(1/F_c)/(1 + 0.57²).
            return N::constant(0.0);
        }
        let to_ten = std::f64::consts::LOG10_E;
        let centre = centre.ln().times(to_ten);
        let shifted = pressure.ln().times(to_ten) - N::constant(0.4) - centre.times(0.67);
        let width = N::constant(0.75) - centre.times(1.27);
        let f = shifted / (width - shifted.times(0.14));
        (centre / (N::constant(1.0) + f * f))
            .times(1.0 / to_ten)
            .exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_numerics::Dual;

    /// GRI-Mech 3.0's H + CH3 (+M) <=> CH4 (+M), in mol, m³, s, J/mol.
    fn methyl(broadening: Broadening) -> RateConstant {
        let calorie = 4.184;
        RateConstant::Falloff {
            high: Arrhenius {
                factor: 13.9e15 * 1e-6,
                exponent: -0.534,
                activation_energy: 536.0 * calorie,
            },
            low: Arrhenius {
                factor: 2.62e33 * 1e-12,
                exponent: -4.76,
                activation_energy: 2440.0 * calorie,
            },
            broadening,
        }
    }

    const TROE: Broadening = Broadening::Troe {
        share: 0.783,
        third: 74.0,
        first: 2941.0,
        second: Some(6964.0),
    };

    #[test]
    fn the_limits_of_pressure_are_those_of_their_own_laws() {
        let law = methyl(TROE);
        let RateConstant::Falloff { high, low, .. } = law else {
            unreachable!()
        };
        // F goes to 1 only as 1/(1 + f²), f to −1/0.14, at both ends.
        let lindemann = methyl(Broadening::Lindemann);
        let few: f64 = lindemann.at(1500.0, 1e-9);
        assert!((few / (1e-9 * low.at(1500.0)) - 1.0).abs() < 1e-8);
        let many: f64 = lindemann.at(1500.0, 1e15);
        assert!((many / high.at(1500.0) - 1.0).abs() < 1e-8);
        assert_eq!(law.at(1500.0, 0.0), 0.0);
    }

    #[test]
    fn troe_s_form_agrees_with_an_independent_evaluation() {
        // In Python from the doc's equations; k in m³/mol/s at 1500 K and 8.1 mol/m³.
        let k: f64 = methyl(TROE).at(1500.0, 8.1);
        assert!((k / TROE_AT_1500 - 1.0).abs() < 1e-9, "{k:e}");
    }

    const TROE_AT_1500: f64 = 5_153_221.750_737_188;

    #[test]
    fn a_centre_of_zero_leaves_no_rate_between_the_limits() {
        let law = methyl(Broadening::Troe {
            share: 1.0,
            third: 1e30,
            first: 1e-3,
            second: None,
        });
        let k: f64 = law.at(1500.0, 8.1);
        assert_eq!(k, 0.0);
        let nearly = methyl(Broadening::Troe {
            share: 1.0,
            third: 1e30,
            first: 5.0,
            second: None,
        });
        let k: f64 = nearly.at(1500.0, 8.1);
        assert!(k > 0.0 && k < 1e-60, "{k:e}");
    }

    /// T₃, and T₁, of zero.
    const WITHOUT: [Broadening; 2] = [
        Broadening::Troe {
            share: 0.783,
            third: 0.0,
            first: 2941.0,
            second: None,
        },
        Broadening::Troe {
            share: 0.783,
            third: 740.0,
            first: 0.0,
            second: Some(6964.0),
        },
    ];

    #[test]
    fn a_temperature_of_zero_leaves_its_term_out() {
        // In Python from the doc's equations without the term, as above.
        for (broadening, expected) in WITHOUT.into_iter().zip([5_091_294.421_79, 384_299.142_576]) {
            let k: f64 = methyl(broadening).at(1500.0, 8.1);
            assert!((k / expected - 1.0).abs() < 1e-9, "{k:e}");
        }
    }

    #[test]
    fn derivatives_are_the_difference_quotients() {
        let [without_third, without_first] = WITHOUT.map(methyl);
        for law in [
            methyl(TROE),
            methyl(Broadening::Lindemann),
            without_third,
            without_first,
        ] {
            let at = |t: f64, m: f64| -> f64 { law.at(t, m) };
            let dual = law.at(
                Dual {
                    value: 1500.0,
                    slope: [3.0],
                },
                Dual {
                    value: 8.0,
                    slope: [0.5],
                },
            );
            let h = 1e-4;
            let quotient = (at(1500.0 + 3.0 * h, 8.0 + 0.5 * h)
                - at(1500.0 - 3.0 * h, 8.0 - 0.5 * h))
                / (2.0 * h);
            assert!((dual.slope[0] / quotient - 1.0).abs() < 1e-7);
        }
    }
}
