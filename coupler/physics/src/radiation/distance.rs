//! What share of an open view is left over a distance in a random bed.

use crate::points::linear;

/// Share of the open view of two equal spheres that other spheres leave in a random bed, over the distance of
/// the centres in radii.
///
/// Mean over 3610 spheres in a box at a solid fraction of 0.56 (0.60 inside), of rays as
/// `calcine_coupler::view_factors` traces them (1024 a particle, some 600 to 7000 pairs to each point; the standard
/// error is below 0.01); linear between the points. The dip at 4 is that of spheres which stand in one row.
///
/// Validity: random beds of equal spheres at solid fractions of 0.55 to 0.62. Feng and Han, Int. J. Heat Mass
/// Transf. 55 (2012) 6374, doi 10.1016/j.ijheatmasstransfer.2012.06.021, proceed likewise.
pub fn visibility(distance: f64) -> f64 {
    left(&PAIRS, distance, 1.1)
}

/// Share of the half of its surface by which a sphere would see a plane wall that other spheres leave, over the
/// distance of its centre from the wall in radii; from the same bed.
pub fn wall_visibility(distance: f64) -> f64 {
    left(&WALLS, distance, 1.5)
}

/// Between points linear, beyond the last by an exponential of a rate per radius.
fn left(points: &[(f64, f64)], distance: f64, rate: f64) -> f64 {
    let (end, share) = points[points.len() - 1];
    if distance > end {
        return share * (-rate * (distance - end)).exp();
    }
    linear(points, distance)
}

const PAIRS: [(f64, f64); 20] = [
    (2.0, 0.990),
    (2.05, 0.983),
    (2.25, 0.952),
    (2.45, 0.916),
    (2.65, 0.855),
    (2.85, 0.773),
    (3.05, 0.647),
    (3.25, 0.493),
    (3.45, 0.320),
    (3.65, 0.230),
    (3.85, 0.151),
    (3.95, 0.105),
    (4.1, 0.130),
    (4.35, 0.110),
    (4.65, 0.086),
    (5.0, 0.056),
    (5.5, 0.029),
    (6.0, 0.017),
    (7.0, 0.006),
    (8.0, 0.002),
];

const WALLS: [(f64, f64); 16] = [
    (1.0, 0.66),
    (1.125, 0.631),
    (1.375, 0.473),
    (1.625, 0.406),
    (1.875, 0.304),
    (2.125, 0.209),
    (2.375, 0.138),
    (2.625, 0.075),
    (2.875, 0.053),
    (3.125, 0.050),
    (3.375, 0.032),
    (3.625, 0.020),
    (4.0, 0.014),
    (4.5, 0.0075),
    (5.0, 0.004),
    (6.0, 0.001),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_is_left_beyond_three_diameters() {
        assert_eq!(visibility(1.9), 0.99);
        assert!((visibility(2.35) - 0.934).abs() < 1e-12);
        assert!(visibility(6.0) < 0.02 && visibility(9.0) < 0.001 && visibility(9.0) > 0.0);
        assert!((wall_visibility(1.25) - 0.552).abs() < 1e-3);
    }
}
