//! Gradients of cell values by least squares: g minimises Σ (d·g − Δ)²/d² over what is beside a cell, d the way there from its
//! centre, Δ the difference. Exact for linear fields on any mesh, and without an iteration, whatever the skewness. On the
//! boundary the value at the centre of the face counts where it is given; where nothing but the slope along the normal is, zero,
//! that of the foot of the normal.

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

use super::grid::{CellFace, MeshGraph};
use super::parallel::fill;

/// What is beside a cell at a face of the boundary.
#[derive(Clone, Copy, Debug)]
pub enum Beside<T> {
    /// A value at the centre of the face.
    AtFace(T),
    /// A value where the normal through the cell's centre meets the plane of the face.
    AtFoot(T),
}

/// The way from a cell's centre to the centre of a face.
#[inline]
pub fn to_face(grid: &MeshGraph, link: &CellFace) -> Vec3 {
    let face = &grid.faces[link.face as usize];
    if link.sign > 0.0 {
        face.owner_distance * face.normal + face.owner_skew
    } else {
        -face.neighbour_distance * face.normal - face.neighbour_skew
    }
}

/// Gradients of a scalar; `boundary(face, value of its cell)` on the boundary.
pub fn scalar(
    grid: &MeshGraph,
    values: &[f64],
    boundary: impl Fn(usize, f64) -> Beside<f64> + Sync,
    gradients: &mut [Vec3],
) {
    fill(gradients, |cell| {
        let own = values[cell];
        let (mut ways, mut sum) = (Matrix3::zeros(), Vec3::zeros());
        for link in grid.links(cell) {
            let (way, value) = if link.is_boundary() {
                located(grid, link, boundary(link.face as usize, own))
            } else {
                let other = link.other as usize;
                (grid.centre[other] - grid.centre[cell], values[other])
            };
            let weighted = way / way.norm_squared();
            ways += weighted * way.transpose();
            sum += weighted * (value - own);
        }
        solve(&ways) * sum
    });
}

/// Gradients ∂f_i/∂x_j of a vector; `boundary(face, value of its cell)` on the boundary.
pub fn vector(
    grid: &MeshGraph,
    values: &[Vec3],
    boundary: impl Fn(usize, Vec3) -> Beside<Vec3> + Sync,
    gradients: &mut [Matrix3<f64>],
) {
    fill(gradients, |cell| {
        let own = values[cell];
        let (mut ways, mut sum) = (Matrix3::zeros(), Matrix3::zeros());
        for link in grid.links(cell) {
            let (way, value) = if link.is_boundary() {
                located(grid, link, boundary(link.face as usize, own))
            } else {
                let other = link.other as usize;
                (grid.centre[other] - grid.centre[cell], values[other])
            };
            let weighted = way / way.norm_squared();
            ways += weighted * way.transpose();
            sum += (value - own) * weighted.transpose();
        }
        sum * solve(&ways)
    });
}

/// What the cells beside have in [`averaged`].
const BESIDE: f64 = 0.5;

/// Mixes the gradient of each cell with the mean of those of the cells beside it, one half of each: still exact for linear fields.
/// Where a gradient of the cells beside alone is fed back into the values that it is made of, it grows without bound on tetrahedra, whose few
/// faces look to one side; with the cells next to them it does not (Haider, Croisille and Courbet, Numer. Math. 113 (2009) 555).
/// `plain` is memory for what they were.
pub fn averaged(grid: &MeshGraph, gradients: &mut [Matrix3<f64>], plain: &mut Vec<Matrix3<f64>>) {
    plain.clear();
    plain.extend_from_slice(gradients);
    let plain = &*plain;
    fill(gradients, |cell| {
        let (mut sum, mut count) = (Matrix3::zeros(), 0.0);
        for link in grid.links(cell).iter().filter(|link| !link.is_boundary()) {
            sum += plain[link.other as usize];
            count += 1.0;
        }
        match count > 0.0 {
            true => plain[cell] * (1.0 - BESIDE) + sum * (BESIDE / count),
            false => plain[cell],
        }
    });
}

/// The way to what is beside a face of the boundary, and its value.
#[inline]
fn located<T>(grid: &MeshGraph, link: &CellFace, beside: Beside<T>) -> (Vec3, T) {
    let face = &grid.faces[link.face as usize];
    match beside {
        Beside::AtFace(value) => (to_face(grid, link), value),
        Beside::AtFoot(value) => (face.owner_distance * face.normal, value),
    }
}

/// The faces of a cell look along all directions, so that the sum of their ways can be inverted.
#[inline]
fn solve(ways: &Matrix3<f64>) -> Matrix3<f64> {
    ways.try_inverse().unwrap_or_else(Matrix3::zeros)
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::conformance::manufactured::CellShape;
    use calcine_coupler::conformance::manufactured::meshes::shaped_box;

    #[test]
    fn gradients_of_linear_fields_are_exact_on_tetrahedra_with_and_without_the_cells_beside() {
        let lean = |point: Vec3| Vec3::new(point.x + 0.5 * point.z, point.y, point.z);
        let mesh = shaped_box(CellShape::Tetrahedra(0.15), 3, lean).unwrap();
        let grid = MeshGraph::new(&mesh);
        let slope = Matrix3::new(1.0, 2.0, -3.0, 0.5, 0.0, 4.0, -1.0, 1.0, 2.0);
        let at = |way: Vec3| slope * way;
        let values: Vec<Vec3> = grid.centre.iter().map(|centre| at(*centre)).collect();
        let boundary = |index: usize, _: Vec3| {
            let face = &grid.faces[index];
            let centre = grid.centre[face.owner];
            Beside::AtFace(at(centre
                + face.owner_distance * face.normal
                + face.owner_skew))
        };
        let mut gradients = vec![Matrix3::zeros(); grid.cells()];
        vector(&grid, &values, boundary, &mut gradients);
        assert!(gradients.iter().all(|found| (found - slope).norm() < 1e-11));
        averaged(&grid, &mut gradients, &mut Vec::new());
        assert!(gradients.iter().all(|found| (found - slope).norm() < 1e-11));
    }

    #[test]
    fn half_of_a_gradient_is_that_of_the_cells_beside() {
        let mesh = shaped_box(CellShape::Hexahedra(0.0), 3, |point| point).unwrap();
        let grid = MeshGraph::new(&mesh);
        let mut gradients = vec![Matrix3::zeros(); grid.cells()];
        gradients[0] = Matrix3::identity();
        averaged(&grid, &mut gradients, &mut Vec::new());
        let shares: f64 = gradients.iter().map(|found| found[(0, 0)]).sum();
        let beside = grid.links(0).iter().filter(|link| !link.is_boundary());
        let given: f64 = beside
            .map(|link| {
                let of = grid.links(link.other as usize).iter();
                0.5 / of.filter(|link| !link.is_boundary()).count() as f64
            })
            .sum();
        assert!((shares - 0.5 - given).abs() < 1e-15, "{shares}");
    }
}
