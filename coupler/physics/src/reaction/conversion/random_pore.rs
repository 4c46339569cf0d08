//! Pores that grow and meet.

use super::conversion_law::ConversionLaw;

/// f = w (1 − ψ ln w)^1/2.
///
/// Source: Bhatia and Perlmutter, AIChE J. 26 (1980) 379, doi 10.1002/aic.690260308.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomPore {
    /// ψ, zero or above.
    pub structure: f64,
}

impl ConversionLaw for RandomPore {
    fn of(&self, left: f64) -> [f64; 2] {
        let root = (1.0 - self.structure * left.ln()).sqrt();
        [left * root, root - 0.5 * self.structure / root]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // 0.3 √(1 − 4.6 ln 0.3) in Python.
        let law = RandomPore { structure: 4.6 };
        assert!((law.of(0.3)[0] - 0.767_101_519_351_211_7).abs() < 1e-12);
    }

    #[test]
    fn has_its_largest_rate_where_bhatia_and_perlmutter_have_it() {
        // X at the maximum: 1 − exp((2 − ψ)/(2ψ)).
        let law = RandomPore { structure: 4.6 };
        let w = ((2.0 - 4.6) / (2.0 * 4.6_f64)).exp();
        assert!(law.of(w)[1].abs() < 1e-14);
    }
}
