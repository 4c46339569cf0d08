//! Conductivity of solids.

use crate::points::linear;

/// Thermal conductivity of a solid, linear in temperature between given points and constant outside them.
#[derive(Clone, Debug, PartialEq)]
pub struct Conductivity {
    /// Temperatures in K, increasing, and conductivities in W/m/K there; at least one.
    points: Vec<(f64, f64)>,
}

impl Conductivity {
    /// The same at all temperatures, in W/m/K.
    pub fn constant(value: f64) -> Self {
        Self::table(vec![(0.0, value)])
    }

    /// Points of temperature in K, increasing, and conductivity in W/m/K, positive; at least one.
    pub fn table(points: Vec<(f64, f64)>) -> Self {
        debug_assert!(!points.is_empty());
        Self { points }
    }

    /// The value in W/m/K that it has at all temperatures; `None` where it depends on them.
    pub fn everywhere(&self) -> Option<f64> {
        match self.points[..] {
            [(_, value)] => Some(value),
            _ => None,
        }
    }

    /// Conductivity in W/m/K at a temperature in K.
    pub fn at(&self, temperature: f64) -> f64 {
        linear(&self.points, temperature)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_linear_between_points_and_constant_outside() {
        let iron = Conductivity::table(vec![(300.0, 80.0), (600.0, 55.0), (1000.0, 33.0)]);
        for (kelvin, expected) in [(200.0, 80.0), (450.0, 67.5), (800.0, 44.0), (2000.0, 33.0)] {
            assert!((iron.at(kelvin) - expected).abs() < 1e-12, "{kelvin}");
        }
        assert_eq!(Conductivity::constant(1.1).at(500.0), 1.1);
        assert_eq!(Conductivity::constant(1.1).everywhere(), Some(1.1));
        assert_eq!(iron.everywhere(), None);
    }
}
