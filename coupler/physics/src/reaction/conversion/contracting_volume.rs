//! Spheres that shrink from their surface.

use super::conversion_law::ConversionLaw;

/// f = 3 w^2/3 (R3): 1 − (1 − X)^1/3 = k t.
///
/// Source: Vyazovkin et al., Thermochimica Acta 520 (2011) 1, doi 10.1016/j.tca.2011.03.034, table 1 (R3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContractingVolume;

impl ConversionLaw for ContractingVolume {
    fn of(&self, left: f64) -> [f64; 2] {
        let root = left.cbrt();
        [3.0 * root * root, 2.0 / root]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_three_times_the_power_two_thirds_of_what_is_left() {
        // 0.3^(2/3) = 0.448 140 474 655 716 4.
        assert!((ContractingVolume.of(0.3)[0] - 1.344_421_423_967_149).abs() < 1e-14);
    }
}
