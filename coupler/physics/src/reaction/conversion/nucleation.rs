//! Nuclei that grow.

use super::conversion_law::ConversionLaw;

/// f = m w (a − ln w)^(1 − 1/m): (a − ln w)^1/m = k t + a^1/m. With a = 0 it is the law of Avrami and Erofeev, whose rate is zero at
/// the start, so that it would never begin; a is the share that nuclei hold then.
///
/// Source: Vyazovkin et al., Thermochimica Acta 520 (2011) 1, doi 10.1016/j.tca.2011.03.034, table 1 (A2 to A4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nucleation {
    /// m.
    pub exponent: f64,
    /// a.
    pub nuclei: f64,
}

impl ConversionLaw for Nucleation {
    fn of(&self, left: f64) -> [f64; 2] {
        let (m, power) = (self.exponent, 1.0 - 1.0 / self.exponent);
        let inside = self.nuclei - left.ln();
        let grown = inside.powf(power);
        [m * left * grown, m * grown * (1.0 - power / inside)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // 2 · 0.3 · (1e-3 − ln 0.3)^½ in Python.
        let law = Nucleation {
            exponent: 2.0,
            nuclei: 1e-3,
        };
        assert!((law.of(0.3)[0] - 0.658_627_519_587_009_8).abs() < 1e-14);
    }

    #[test]
    fn an_exponent_of_one_is_first_order() {
        let law = Nucleation {
            exponent: 1.0,
            nuclei: 1e-3,
        };
        assert_eq!(law.of(0.4), [0.4, 1.0]);
    }
}
