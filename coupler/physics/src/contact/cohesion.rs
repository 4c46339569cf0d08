//! Simplified Johnson, Kendall, Roberts.

use std::f64::consts::PI;

use super::PairConstants;

/// The circle in which a sphere cuts another sphere or a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CohesionArea {
    /// Its area A in m².
    pub area: f64,
    /// A integrated over the overlap so far, in m³.
    pub integral: f64,
}

impl CohesionArea {
    /// Of two spheres of radii in m at a distance d in m:
    /// A = −π/4 (d − r₁ − r₂)(d + r₁ − r₂)(d − r₁ + r₂)(d + r₁ + r₂)/d².
    #[inline]
    pub fn of_spheres(first: f64, second: f64, distance: f64) -> Self {
        let (sum, difference) = ((first + second).powi(2), (first - second).powi(2));
        let square = distance * distance;
        // −∫ A dd from r₁ + r₂ inwards
        let primitive = |x: f64| x * x * x / 3.0 - (sum + difference) * x - sum * difference / x;
        Self {
            area: -PI / 4.0 * (square - sum) * (square - difference) / square,
            integral: -PI / 4.0 * (primitive(first + second) - primitive(distance)),
        }
    }

    /// Of a sphere and a flat wall at a distance d of its centre: A = π (r² − d²).
    #[inline]
    pub fn of_wall(radius: f64, distance: f64) -> Self {
        let primitive = |x: f64| radius * radius * x - x * x * x / 3.0;
        Self {
            area: PI * (radius * radius - distance * distance),
            integral: PI * (primitive(radius) - primitive(distance)),
        }
    }
}

/// Attraction in N (negative: it pulls), and the energy in J that it stores.
///
/// F = −k A, k the cohesion energy density
///
/// Source: LIGGGHTS' `sjkr`, after Johnson, Kendall, Roberts, Proc. R. Soc. Lond. A 324 (1971) 301,
/// doi 10.1098/rspa.1971.0141.
#[inline]
pub fn sjkr(pair: &PairConstants, area: CohesionArea) -> (f64, f64) {
    (
        -pair.cohesion_energy * area.area,
        -pair.cohesion_energy * area.integral,
    )
}

#[cfg(test)]
mod tests {
    use super::super::glass;
    use super::*;

    #[test]
    fn the_area_is_that_of_the_circle_in_which_the_spheres_cut() {
        // Spheres of 3 and 4 whose centres are 5 apart cut in a circle of radius 12/5.
        let area = CohesionArea::of_spheres(3.0, 4.0, 5.0).area;
        assert!((area / (PI * 5.76) - 1.0).abs() < 1e-14);
        assert!((CohesionArea::of_wall(5.0, 3.0).area / (PI * 16.0) - 1.0).abs() < 1e-15);
        assert!(
            (sjkr(&glass(0.5), CohesionArea::of_wall(5.0, 3.0)).0 / (-16_000.0 * PI) - 1.0).abs()
                < 1e-14
        );
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let pair = glass(0.5);
        for area in [
            |d: f64| CohesionArea::of_spheres(1.0, 0.7, d),
            |d: f64| CohesionArea::of_wall(1.7, d),
        ] {
            let slope = (sjkr(&pair, area(1.649)).1 - sjkr(&pair, area(1.651)).1) / 2e-3;
            assert!(
                (slope / sjkr(&pair, area(1.65)).0 - 1.0).abs() < 1e-4,
                "{slope}"
            );
            assert!(area(1.7).integral.abs() < 1e-15);
        }
    }
}
