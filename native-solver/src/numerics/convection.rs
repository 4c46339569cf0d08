//! Second-order convection by deferred correction: what a limited face value carries beyond the
//! upwind one. With C the cell upstream of a face, D the one downstream, Δ = q_D − q_C and
//! a = 2 ∇q_C·(x_D − x_C) − Δ (so that r = a/Δ), the limiter of van Leer 1974,
//! doi 10.1016/0021-9991(74)90019-9, ψ = (r + |r|)/(1 + |r|), gives
//!
//! q_f = q_C + w_D ψ Δ,   ψ Δ = 2 a Δ/(a + Δ) where a and Δ have one sign, else 0,
//!
//! w_D the weight of D in linear interpolation: second order where q is smooth and monotone, upwind
//! at extrema, and nothing to divide by zero. a is q_C less the value that the gradient leads to on the other side of C; on irregular cells
//! that may lie beyond all values there, and is bounded by those of C and of what is beside it ([`ConvectedScalar::bounds`]). Limited linear interpolation has ψ = max(0, min(2 r/k, 1)): ψ Δ = 2 a/k where that is
//! the smaller, else Δ; Sweby's bounds of a scheme that makes no new extrema (doi 10.1137/0721062) hold at k = 1. Central differences
//! carry a share of what linear interpolation to the centre of the face is beyond upwind, so that linear fields are exact on any
//! mesh where the share is one.

use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::Convection;
use nalgebra::Matrix3;

use super::grid::{CellFace, MeshGraph};
use super::parallel::fill;

/// Cells upstream and downstream of an internal face, and the weight of the latter.
#[inline]
fn sides(grid: &MeshGraph, index: usize, flux: f64) -> (usize, usize, f64) {
    let face = &grid.faces[index];
    let weight = face.owner_weight();
    if flux >= 0.0 {
        (face.owner, face.neighbour, 1.0 - weight)
    } else {
        (face.neighbour, face.owner, weight)
    }
}

/// From the centre upstream of an internal face to the one downstream, in m.
#[inline]
fn downstream(grid: &MeshGraph, index: usize, flux: f64) -> Vec3 {
    let line = grid.between(index);
    if flux >= 0.0 { line } else { -line }
}

/// A scalar in the cells, as schemes of convection see it; those without a limiter do not look at the bounds.
#[derive(Clone, Copy, Debug)]
pub struct ConvectedScalar<'a> {
    /// Values of the cells.
    pub values: &'a [f64],
    /// Their gradients.
    pub gradients: &'a [Vec3],
    /// The least and the largest value of each cell and what is beside it.
    pub bounds: &'a [[f64; 2]],
}

impl ConvectedScalar<'_> {
    /// q_C less what the gradient leads to at the mirror image of the cell downstream, as far as that lies within the bounds.
    #[inline]
    fn behind(&self, grid: &MeshGraph, index: usize, flux: f64) -> f64 {
        let (up, down, _) = sides(grid, index, flux);
        let along = self.gradients[up].dot(&downstream(grid, index, flux));
        let [least, largest] = self.bounds[up];
        // Not `clamp`, which panics where a diverging flow is not a number.
        self.values[up] - (self.values[down] - 2.0 * along).max(least).min(largest)
    }
}

/// Finds the least and the largest value of each cell and what is beside it; `boundary(face, value of its cell)` is the value on the
/// boundary where one is given. There the difference counts twice: a cell beside would lie as far behind the face.
pub fn bounds(
    grid: &MeshGraph,
    values: &[f64],
    boundary: impl Fn(usize, f64) -> Option<f64> + Sync,
    bounds: &mut [[f64; 2]],
) {
    fill(bounds, |cell| {
        let own = values[cell];
        let beside = |link: &CellFace| match link.is_boundary() {
            true => boundary(link.face as usize, own).map_or(own, |value| 2.0 * value - own),
            false => values[link.other as usize],
        };
        let widen = |[least, largest]: [f64; 2], value: f64| [least.min(value), largest.max(value)];
        grid.links(cell).iter().map(beside).fold([own; 2], widen)
    });
}

/// What an internal face's value of a scalar is beyond the upwind one.
#[inline]
pub fn beyond_upwind(
    scheme: Convection,
    grid: &MeshGraph,
    index: usize,
    flux: f64,
    field: ConvectedScalar<'_>,
) -> f64 {
    let (values, gradients) = (field.values, field.gradients);
    let (up, down, weight) = sides(grid, index, flux);
    if let Convection::Central(share) = scheme {
        let face = &grid.faces[index];
        let (owner, miss) = (face.owner_weight(), face.miss());
        let own = values[face.owner] + gradients[face.owner].dot(&miss);
        let other = values[face.neighbour] + gradients[face.neighbour].dot(&miss);
        return share * (owner * own + (1.0 - owner) * other - values[up]);
    }
    if scheme == Convection::Upwind {
        return 0.0;
    }
    let difference = values[down] - values[up];
    let other = field.behind(grid, index, flux);
    if other * difference <= 0.0 {
        return 0.0;
    }
    weight
        * match scheme {
            Convection::LimitedLinear(k) if 2.0 * other.abs() < k * difference.abs() => {
                2.0 * other / k
            }
            Convection::LimitedLinear(_) => difference,
            _ => 2.0 * other * difference / (other + difference),
        }
}

/// The limiter ψ of an internal face for a scalar, in [0, 2]. Where there is noise, differences Δ well below it limit nobody, so that a
/// field that is uniform but for what solvers leave does not steer others that share its limiter: ψ s + 2 (1 − s), s = Δ²/(Δ² + noise²).
#[inline]
pub fn limiter(
    grid: &MeshGraph,
    index: usize,
    flux: f64,
    field: ConvectedScalar<'_>,
    noise: f64,
) -> f64 {
    let (up, down, _) = sides(grid, index, flux);
    let difference = field.values[down] - field.values[up];
    let other = field.behind(grid, index, flux);
    let limiting = if other * difference > 0.0 {
        2.0 * other / (other + difference)
    } else if difference == 0.0 && other == 0.0 {
        // A uniform field limits nobody.
        2.0
    } else {
        0.0
    };
    if noise == 0.0 {
        return limiting;
    }
    let square = difference * difference;
    let share = square / (square + noise * noise);
    limiting * share + 2.0 * (1.0 - share)
}

/// What a limiter ψ adds to an internal face's upwind value of a scalar.
#[inline]
pub fn limited(grid: &MeshGraph, index: usize, flux: f64, values: &[f64], limiter: f64) -> f64 {
    let (up, down, weight) = sides(grid, index, flux);
    weight * limiter * (values[down] - values[up])
}

/// What an internal face's value of a vector is beyond the upwind one. One limiter for all
/// components, taken along the difference Δ: r = 2 Δ·(∇u_C d)/(Δ·Δ) − 1, so that the result does not depend
/// on the axes. `gradients[(i, j)]` is ∂u_i/∂x_j.
#[inline]
pub fn vector_beyond_upwind(
    scheme: Convection,
    grid: &MeshGraph,
    index: usize,
    flux: f64,
    values: &[Vec3],
    gradients: &[Matrix3<f64>],
) -> Vec3 {
    let (up, down, weight) = sides(grid, index, flux);
    if let Convection::Central(share) = scheme {
        let face = &grid.faces[index];
        let (owner, miss) = (face.owner_weight(), face.miss());
        let own = values[face.owner] + gradients[face.owner] * miss;
        let other = values[face.neighbour] + gradients[face.neighbour] * miss;
        return share * (owner * own + (1.0 - owner) * other - values[up]);
    }
    if scheme == Convection::Upwind {
        return Vec3::zeros();
    }
    let difference = values[down] - values[up];
    let square = difference.norm_squared();
    let along = gradients[up] * downstream(grid, index, flux);
    let other = 2.0 * along.dot(&difference) - square;
    if other <= 0.0 || square <= 0.0 {
        return Vec3::zeros();
    }
    let limiting = match scheme {
        Convection::LimitedLinear(k) if 2.0 * other < k * square => 2.0 * other / (k * square),
        Convection::LimitedLinear(_) => 1.0,
        _ => 2.0 * other / (other + square),
    };
    (weight * limiting) * difference
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::mesh::Mesh;
    use calcine_coupler::mesh::block::{BoxSpec, box_mesh};

    fn chain() -> MeshGraph {
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(3.0, 1.0, 1.0),
            cells: [3, 1, 1],
            patches: ["a", "b", "c", "d", "e", "f"].map(str::to_owned),
        };
        MeshGraph::new(&box_mesh(&spec).unwrap())
    }

    /// Without bounds.
    const ANY: [[f64; 2]; 6] = [[f64::NEG_INFINITY, f64::INFINITY]; 6];

    fn field<'a>(values: &'a [f64], gradients: &'a [Vec3]) -> ConvectedScalar<'a> {
        ConvectedScalar {
            values,
            gradients,
            bounds: &ANY,
        }
    }

    #[test]
    fn a_linear_field_is_interpolated_exactly_and_an_extremum_stays_upwind() {
        let grid = chain();
        let slope = vec![Vec3::new(2.0, 0.0, 0.0); 3];
        for flux in [1.0, -1.0] {
            let values = [1.0, 3.0, 5.0];
            let beyond = beyond_upwind(Convection::VanLeer, &grid, 0, flux, field(&values, &slope));
            assert!((beyond - flux).abs() < 1e-14);
            assert!((limiter(&grid, 0, flux, field(&values, &slope), 0.0) - 1.0).abs() < 1e-14);
        }
        let flat = vec![Vec3::zeros(); 3];
        let values = [1.0, 3.0, 1.0];
        let beyond = beyond_upwind(Convection::VanLeer, &grid, 0, 1.0, field(&values, &flat));
        assert_eq!(beyond, 0.0);
    }

    /// Cells 1, 3, 5 whose gradient leads to −1 behind the second: not below the 1 that is there.
    #[test]
    fn what_a_gradient_leads_to_is_bounded_by_the_cells_beside() {
        let grid = chain();
        let (values, slope) = ([1.0, 3.0, 5.0], [Vec3::new(3.0, 0.0, 0.0); 3]);
        let mut found = [[0.0; 2]; 3];
        bounds(
            &grid,
            &values,
            |face, _| (face == grid.internal).then_some(0.5),
            &mut found,
        );
        assert_eq!(found, [[0.0, 3.0], [1.0, 5.0], [3.0, 5.0]]);
        let scheme = Convection::VanLeer;
        // a = 2 and Δ = 2, for 4 and 2 without bounds.
        let bounded = ConvectedScalar {
            values: &values,
            gradients: &slope,
            bounds: &found,
        };
        assert!((beyond_upwind(scheme, &grid, 1, 1.0, bounded) - 1.0).abs() < 1e-14);
        let free = beyond_upwind(scheme, &grid, 1, 1.0, field(&values, &slope));
        assert!((free - 4.0 / 3.0).abs() < 1e-14, "{free}");
    }

    #[test]
    fn the_face_value_stays_between_the_two_cells() {
        let grid = chain();
        for k in 0..100 {
            let slope = vec![Vec3::new(f64::from(k) - 50.0, 0.0, 0.0); 3];
            let beyond = beyond_upwind(
                Convection::VanLeer,
                &grid,
                0,
                1.0,
                field(&[1.0, 3.0, 5.0], &slope),
            );
            assert!((0.0..=2.0).contains(&beyond), "{beyond}");
        }
    }

    /// Of ψ = min(2 r/k, 1) on cells 1, 3, 5 whose upstream gradient g makes r = g − 1, by hand.
    #[test]
    fn limited_linear_interpolation_has_the_limiter_of_its_coefficient() {
        let grid = chain();
        let values = [1.0, 3.0, 5.0];
        for (k, gradient, psi) in [
            (1.0, 1.25, 0.5),
            (0.5, 1.25, 1.0),
            (0.5, 1.1, 0.4),
            (1.0, 2.0, 1.0),
            (0.0, 1.01, 1.0),
            (0.0, 0.99, 0.0),
            (1.0, 0.5, 0.0),
        ] {
            let scheme = Convection::LimitedLinear(k);
            // r = 2 g d/Δ − 1 with d = 1 and Δ = 2.
            let slope = vec![Vec3::new(gradient, 0.0, 0.0); 3];
            let beyond = beyond_upwind(scheme, &grid, 0, 1.0, field(&values, &slope));
            assert!((beyond - psi).abs() < 1e-14, "{k} {gradient}: {beyond}");
            // A vector of two such components has the same limiter.
            let vectors = values.map(|value| Vec3::new(value, 0.0, -value));
            let mut tensor = Matrix3::zeros();
            (tensor[(0, 0)], tensor[(2, 0)]) = (gradient, -gradient);
            let beyond = vector_beyond_upwind(scheme, &grid, 0, 1.0, &vectors, &[tensor; 3]);
            assert!((beyond - Vec3::new(psi, 0.0, -psi)).norm() < 1e-14);
        }
    }

    #[test]
    fn a_vector_is_limited_along_its_difference() {
        let grid = chain();
        // u = (0, 2 x, −x): linear, so that the linear value results
        let gradient = Matrix3::new(0.0, 0.0, 0.0, 2.0, 0.0, 0.0, -1.0, 0.0, 0.0);
        let velocity = |x: f64| Vec3::new(0.0, 2.0 * x, -x);
        let values = [velocity(0.5), velocity(1.5), velocity(2.5)];
        let beyond =
            vector_beyond_upwind(Convection::VanLeer, &grid, 0, 1.0, &values, &[gradient; 3]);
        assert!((beyond - Vec3::new(0.0, 1.0, -0.5)).norm() < 1e-14);
    }

    #[test]
    fn central_values_of_linear_fields_are_exact_on_a_leaning_block_and_mix_with_upwind_by_their_share()
     {
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(3.0, 2.0, 1.0),
            cells: [3, 2, 1],
            patches: ["a", "b", "c", "d", "e", "f"].map(str::to_owned),
        };
        let mut topology = box_mesh(&spec).unwrap().topology().clone();
        for point in &mut topology.points {
            point.x += 0.3 * point.y * point.y;
        }
        let grid = MeshGraph::new(&Mesh::new(topology).unwrap());
        let slope = Vec3::new(2.0, -3.0, 0.5);
        let values: Vec<f64> = grid.centre.iter().map(|at| slope.dot(at)).collect();
        let vectors: Vec<Vec3> = values
            .iter()
            .map(|value| Vec3::new(*value, 0.0, -value))
            .collect();
        let tensor = Matrix3::from_rows(&[
            slope.transpose(),
            Vec3::zeros().transpose(),
            -slope.transpose(),
        ]);
        let (slopes, tensors) = (vec![slope; 6], vec![tensor; 6]);
        assert!(!grid.orthogonal);
        for index in 0..grid.internal {
            let face = &grid.faces[index];
            let at = grid.centre[face.owner] + face.owner_distance * face.normal + face.owner_skew;
            for (flux, up) in [(1.0, face.owner), (-1.0, face.neighbour)] {
                for share in [1.0, 0.75] {
                    let scheme = Convection::Central(share);
                    let beyond = beyond_upwind(scheme, &grid, index, flux, field(&values, &slopes));
                    let wanted = share * (slope.dot(&at) - values[up]);
                    assert!((beyond - wanted).abs() < 1e-13, "{beyond} {wanted}");
                    let beyond =
                        vector_beyond_upwind(scheme, &grid, index, flux, &vectors, &tensors);
                    assert!((beyond - Vec3::new(wanted, 0.0, -wanted)).norm() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn what_a_solver_leaves_of_a_uniform_field_limits_nobody() {
        let grid = chain();
        let flat = vec![Vec3::zeros(); 3];
        let limits = |values: [f64; 3]| limiter(&grid, 0, 1.0, field(&values, &flat), 1e-8);
        assert_eq!(limits([0.3, 0.3, 0.3]), 2.0);
        for noise in [1e-16, 1e-12, 1e-10] {
            assert!(limits([0.3, 0.3 + noise, 0.3 - noise]) > 1.99);
        }
        assert!(limits([0.3, 0.3 + 1e-6, 0.3]) < 1e-3);
    }
}
