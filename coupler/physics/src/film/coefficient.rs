//! A transfer coefficient over the temperature of its film.

use calcine_numerics::Number;

/// The temperatures, relative to that at hand, by whose coefficients a [`FilmCoefficient`] is drawn.
pub const FILM_TEMPERATURES: [f64; 3] = [1.0 / 1.5, 1.0, 1.5];

/// A mass transfer coefficient over the temperature T of its film, a parabola in logarithms:
///
/// β = β₀ (T/T₀)^(n + b ln(T/T₀)).
///
/// Through three temperatures from T₀/1.5 to 1.5 T₀ it is within 0.1 % of Sherwood laws of the form a + c Reᵐ Scⁿ
/// between them: β follows T^1.75 in still gas and about T^0.9 in fast flow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilmCoefficient {
    /// β₀ in m/s.
    pub value: f64,
    /// T₀ in K.
    pub at: f64,
    /// n.
    pub exponent: f64,
    /// b.
    pub bend: f64,
}

impl FilmCoefficient {
    /// A coefficient in m/s at every temperature.
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            at: 1.0,
            exponent: 0.0,
            bend: 0.0,
        }
    }

    /// Through the coefficients in m/s at the [`FILM_TEMPERATURES`] about a temperature in K.
    pub fn through(at: f64, values: [f64; 3]) -> Self {
        let [low, value, high] = values;
        if low <= 0.0 || value <= 0.0 || high <= 0.0 {
            return Self {
                at,
                ..Self::constant(value)
            };
        }
        let distance = FILM_TEMPERATURES[2].ln();
        let (below, above) = ((low / value).ln(), (high / value).ln());
        Self {
            value,
            at,
            exponent: (above - below) / (2.0 * distance),
            bend: (above + below) / (2.0 * distance * distance),
        }
    }

    /// β in m/s at a temperature of the film in K.
    #[inline]
    pub fn of<N: Number>(&self, temperature: N) -> N {
        if self.exponent == 0.0 && self.bend == 0.0 {
            return N::constant(self.value);
        }
        let t = temperature.value();
        let x = (t / self.at).ln();
        let value = self.value * (x * (self.exponent + self.bend * x)).exp();
        temperature.through(value, value * (self.exponent + 2.0 * self.bend * x) / t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_numerics::Dual;

    #[test]
    fn a_power_law_is_met_at_any_temperature() {
        let law = |t: f64| 0.3 * (t / 900.0).powf(1.75);
        let line = FilmCoefficient::through(900.0, FILM_TEMPERATURES.map(|f| law(900.0 * f)));
        for t in [300.0, 800.0, 2400.0] {
            assert!((line.of(t) / law(t) - 1.0).abs() < 1e-13, "{t}");
        }
    }

    #[test]
    fn a_sherwood_law_is_met_within_a_per_mille_between_its_temperatures() {
        // 2 + 0.6 Re^½ Sc^⅓ with D ~ T^1.75, ρ ~ 1/T, μ ~ T^0.7, Sc constant but for T^−0.05.
        let law = |t: f64| {
            let x: f64 = t / 900.0;
            let reynolds = 40.0 * x.powf(-1.7);
            (2.0 + 0.6 * reynolds.sqrt() * (0.75 * x.powf(-0.05)).cbrt()) * x.powf(1.75)
        };
        let line = FilmCoefficient::through(900.0, FILM_TEMPERATURES.map(|f| law(900.0 * f)));
        for t in [600.0, 700.0, 800.0, 900.0, 1000.0, 1150.0, 1350.0] {
            assert!((line.of(t) / law(t) - 1.0).abs() < 1e-3, "{t}");
        }
    }

    #[test]
    fn the_slope_is_the_difference_quotient() {
        let line = FilmCoefficient::through(900.0, [0.16, 0.3, 0.5]);
        let dual = line.of(Dual::<1>::along(1000.0, 0));
        let quotient = (line.of(1000.01) - line.of(999.99)) / 0.02;
        assert_eq!(dual.value, line.of(1000.0));
        assert!((dual.slope[0] / quotient - 1.0).abs() < 1e-7);
    }

    #[test]
    fn nothing_passes_a_film_without_a_coefficient() {
        assert_eq!(FilmCoefficient::through(900.0, [0.0; 3]).of(1000.0), 0.0);
    }
}
