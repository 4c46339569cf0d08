//! Vectors of cells from what passes their faces, where lines between centres are oblique to faces. With m_f what passes a face
//! along its normal n, r the way to it from a cell's centre, d = n·r, and the gradient G of the vector there,
//!
//! m = (Σ A d n nᵀ)⁻¹ Σ A d n (m_f − n·G r)
//!
//! is the value at the centre of fields that are linear. Without n·G r, the reach, it would be that of uniform ones alone, but for cells
//! whose opposite faces are alike, where the reaches cancel.

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

use crate::numerics::grid::{Face, MeshGraph};
use crate::numerics::parallel::fill;

/// V (Σ A d n nᵀ)⁻¹ of each cell, the sum over its faces, d the distance of its centre from their planes; empty where it is the
/// identity.
#[derive(Debug)]
pub struct Recovery(Vec<Matrix3<f64>>);

impl Recovery {
    /// Of a mesh.
    pub fn new(grid: &MeshGraph) -> Self {
        if grid.orthogonal {
            return Self(Vec::new());
        }
        let mut inverse = vec![Matrix3::identity(); grid.cells()];
        fill(&mut inverse, |cell| {
            let mut sum = Matrix3::zeros();
            for link in grid.links(cell) {
                let face = &grid.faces[link.face as usize];
                let distance = distance(face, side(link.sign));
                sum += (face.area * distance) * face.normal * face.normal.transpose();
            }
            (sum / grid.volume[cell])
                .try_inverse()
                .unwrap_or_else(Matrix3::identity)
        });
        Self(inverse)
    }

    /// The vector of a cell whose parts along the normals of its faces are `normal_part(face, side)`, side 0 where the cell owns the face.
    #[inline]
    pub fn vector(
        &self,
        grid: &MeshGraph,
        cell: usize,
        normal_part: impl Fn(usize, usize) -> f64,
    ) -> Vec3 {
        let mut sum = Vec3::zeros();
        for link in grid.links(cell) {
            let face = &grid.faces[link.face as usize];
            let side = side(link.sign);
            let part = normal_part(link.face as usize, side);
            sum += (face.area * distance(face, side) * part) * face.normal;
        }
        sum /= grid.volume[cell];
        match self.0.get(cell) {
            Some(inverse) => inverse * sum,
            None => sum,
        }
    }
}

/// 0 of a face's owner, 1 of its neighbour.
#[inline]
fn side(sign: f64) -> usize {
    usize::from(sign < 0.0)
}

#[inline]
fn distance(face: &Face, side: usize) -> f64 {
    match side {
        0 => face.owner_distance,
        _ => face.neighbour_distance,
    }
}

/// n·G r of the owner and the neighbour of a face.
#[inline]
pub fn reach(grid: &MeshGraph, index: usize, gradients: &[Matrix3<f64>]) -> [f64; 2] {
    let face = &grid.faces[index];
    let to_owner_face = face.owner_distance * face.normal + face.owner_skew;
    let own = face.normal.dot(&(gradients[face.owner] * to_owner_face));
    if index >= grid.internal {
        return [own, 0.0];
    }
    let from_face = face.neighbour_distance * face.normal + face.neighbour_skew;
    let other = face.normal.dot(&(gradients[face.neighbour] * from_face));
    [own, -other]
}
