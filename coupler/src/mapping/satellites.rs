//! Points that stand for a sphere.

use calcine_physics::Vec3;
use nalgebra::Matrix3;

/// Directions of a shell: the axes and the diagonals of a cube. Both sets are spherical 3-designs,
/// so that the second moments of a shell are those of a sphere.
const AXES: [[f64; 3]; 6] = [
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [0.0, 0.0, 1.0],
];

/// The rotation of the unit quaternion (8, 3, 3, 3)/√91, about a diagonal of the cube. It turns the
/// shells so that no two points cross a plane across an axis at once: along each axis any two are
/// at least 0.017 R apart. Unturned, 9 of the 29 cross together.
const TURN: Matrix3<f64> = Matrix3::new(
    55.0 / 91.0,
    -30.0 / 91.0,
    66.0 / 91.0,
    66.0 / 91.0,
    55.0 / 91.0,
    -30.0 / 91.0,
    -30.0 / 91.0,
    66.0 / 91.0,
    55.0 / 91.0,
);

/// Points per sphere: the centre and two shells of 14, as many as CFDEMcoupling's `divided` has.
pub const COUNT: usize = 29;

/// Points of equal weight in a sphere. It is cut into a central sphere and two shells of 1, 14 and 14
/// parts of its volume; a shell's points sit at its root-mean-square radius,
/// r² = 3/5 (b⁵ − a⁵)/(b³ − a³), so that the spread of the sphere is kept (to 0.4 %, the centre's).
pub(super) fn points(centre: Vec3, radius: f64) -> impl Iterator<Item = Vec3> {
    let reach = |parts: f64| radius * (parts / COUNT as f64).cbrt();
    let mean_square = |inner: f64, outer: f64| {
        (0.6 * (outer.powi(5) - inner.powi(5)) / (outer.powi(3) - inner.powi(3))).sqrt()
    };
    let shells = [
        mean_square(reach(1.0), reach(15.0)),
        mean_square(reach(15.0), reach(29.0)),
    ];
    let shell =
        move |distance: f64| directions().map(move |direction| centre + direction * distance);
    std::iter::once(centre).chain(shells.into_iter().flat_map(shell))
}

fn directions() -> impl Iterator<Item = Vec3> {
    let corners = (0..8).map(|bits: u8| {
        let side = |axis: u8| if bits & (1 << axis) == 0 { -1.0 } else { 1.0 };
        Vec3::new(side(0), side(1), side(2)) / 3f64.sqrt()
    });
    let axes = AXES.into_iter().map(Vec3::from);
    axes.chain(corners).map(|direction| TURN * direction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn satellites_balance_and_keep_the_spread_of_a_ball() {
        let points: Vec<_> = points(Vec3::zeros(), 2.0).collect();
        assert_eq!(points.len(), COUNT);
        assert!(points.iter().sum::<Vec3>().norm() < 1e-14);
        // A sphere of radius R has the variance R²/5 along each axis and no covariance; the central
        // sphere of 1/29 of the volume holds 29^(-5/3) of it, which a point does not have.
        let variance = 0.8 * (1.0 - 29f64.powf(-5.0 / 3.0));
        let moment =
            |i: usize, j: usize| points.iter().map(|p| p[i] * p[j]).sum::<f64>() / COUNT as f64;
        for i in 0..3 {
            assert!((moment(i, i) / variance - 1.0).abs() < 1e-13);
            assert!(moment(i, (i + 1) % 3).abs() < 1e-15);
        }
        assert!(points.iter().all(|p| p.norm() < 2.0));
    }

    #[test]
    fn no_two_satellites_cross_a_plane_across_an_axis_at_once() {
        let points: Vec<_> = points(Vec3::zeros(), 1.0).collect();
        for axis in 0..3 {
            let mut along: Vec<f64> = points.iter().map(|p| p[axis]).collect();
            along.sort_by(f64::total_cmp);
            assert!(
                along.windows(2).all(|pair| pair[1] - pair[0] > 0.017),
                "{along:?}"
            );
        }
    }
}
