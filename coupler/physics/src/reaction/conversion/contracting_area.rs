//! Cylinders that shrink from their side.

use super::conversion_law::ConversionLaw;

/// f = 2 w^1/2 (R2): 1 − (1 − X)^1/2 = k t.
///
/// Source: Vyazovkin et al., Thermochimica Acta 520 (2011) 1, doi 10.1016/j.tca.2011.03.034, table 1 (R2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContractingArea;

impl ConversionLaw for ContractingArea {
    fn of(&self, left: f64) -> [f64; 2] {
        let root = left.sqrt();
        [2.0 * root, 1.0 / root]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_twice_the_root_of_what_is_left() {
        // √0.3 = 0.547 722 557 505 166.
        assert!((ContractingArea.of(0.3)[0] - 1.095_445_115_010_332).abs() < 1e-14);
    }
}
