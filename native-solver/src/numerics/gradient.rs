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
