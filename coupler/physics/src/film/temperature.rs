//! The temperature at which properties of a film are taken.

use calcine_numerics::Number;

/// Which temperature of a film its properties and concentrations have.
///
/// Source of the two-thirds rule: Sparrow and Gregg, Trans. ASME 80 (1958) 879; Hubbard, Denny and Mills,
/// Int. J. Heat Mass Transfer 18 (1975) 1003, doi 10.1016/0017-9310(75)90217-3 (the one-third rule, counted from the surface).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmTemperature {
    /// That of the gas beyond the film.
    Gas,
    /// T_p + (T_gas − T_p)/3.
    TwoThirds,
    /// (T_p + T_gas)/2.
    Mean,
}

impl FilmTemperature {
    /// The share of the gas in the temperature of the film.
    pub fn share_of_gas(self) -> f64 {
        match self {
            Self::Gas => 1.0,
            Self::TwoThirds => 1.0 / 3.0,
            Self::Mean => 0.5,
        }
    }

    /// The temperature in K of the film between a surface and the gas beyond, both in K.
    #[inline]
    pub fn of<N: Number>(self, surface: N, gas: f64) -> N {
        let share = self.share_of_gas();
        surface.times(1.0 - share) + N::constant(share * gas)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_gives_the_gas_its_share() {
        for (rule, expected) in [
            (FilmTemperature::Gas, 1200.0),
            (FilmTemperature::TwoThirds, 800.0),
            (FilmTemperature::Mean, 900.0),
        ] {
            assert!(
                (rule.of(600.0, 1200.0) - expected).abs() < 1e-12,
                "{rule:?}"
            );
            assert!((rule.of(700.0, 700.0) - 700.0).abs() < 1e-12, "{rule:?}");
        }
    }
}
