//! A solid of which every part reacts alike.

use super::conversion_law::ConversionLaw;

/// f = w.
///
/// Source: Vyazovkin et al., Thermochimica Acta 520 (2011) 1, doi 10.1016/j.tca.2011.03.034, table 1 (F1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstOrder;

impl ConversionLaw for FirstOrder {
    fn of(&self, left: f64) -> [f64; 2] {
        [left, 1.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_what_is_left() {
        assert_eq!(FirstOrder.of(0.3), [0.3, 1.0]);
    }
}
