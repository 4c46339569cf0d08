//! Vectors of cells from what passes their faces, where lines between centres are oblique to faces. With m_f what passes a face
//! along its normal n, r the way to it from a cell's centre, d = n·r, and the gradient G of the vector there,
//!
//! m = (Σ A d n nᵀ)⁻¹ Σ A d n (m_f − n·G r)
//!
//! is the value at the centre of fields that are linear. Without n·G r, the reach, it would be that of uniform ones alone, but for cells
//! whose opposite faces are alike, where the reaches cancel.
//!
//! The sides of wedges, across which nothing varies but the axes turn, are left out of the sums: along the normal of its middle plane a cell
//! of a wedge has nothing.

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

use crate::numerics::grid::{Face, MeshGraph};
use crate::numerics::parallel::fill;

/// How the vectors of cells are recovered.
#[derive(Debug)]
pub struct Recovery {
    /// V (Σ A d n nᵀ)⁻¹ of each cell, the sum over its faces, d the distance of its centre from their planes; empty where it is the
    /// identity.
    inverse: Vec<Matrix3<f64>>,
    /// Faces of the boundary that are sides of wedges; empty where none is.
    wedge: Vec<bool>,
}

impl Recovery {
    /// Of a mesh, with which of the boundary's faces are sides of wedges; empty where none is.
    pub fn new(grid: &MeshGraph, wedge: Vec<bool>) -> Self {
        let mut made = Self {
            inverse: Vec::new(),
            wedge,
        };
        if grid.orthogonal {
            return made;
        }
        let mut inverse = vec![Matrix3::identity(); grid.cells()];
        fill(&mut inverse, |cell| {
            let mut sum = Matrix3::zeros();
            let mut between = Vec3::zeros();
            for link in grid.links(cell) {
                let face = &grid.faces[link.face as usize];
                if made.turns(grid, link.face as usize) {
                    // The normals of the two sides are opposite but for the angle between them.
                    between = match between == Vec3::zeros() {
                        true => face.normal,
                        false => (between - face.normal).normalize(),
                    };
                    continue;
                }
                let distance = distance(face, side(link.sign));
                sum += (face.area * distance) * face.normal * face.normal.transpose();
            }
            (sum / grid.volume[cell] + between * between.transpose())
                .try_inverse()
                .unwrap_or_else(Matrix3::identity)
        });
        made.inverse = inverse;
        made
    }

    /// True where a face is a side of a wedge.
    pub fn has_wedges(&self) -> bool {
        !self.wedge.is_empty()
    }

    /// True of a side of a wedge.
    #[inline]
    pub fn turns(&self, grid: &MeshGraph, index: usize) -> bool {
        index >= grid.internal && self.wedge.get(index - grid.internal) == Some(&true)
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
            if self.turns(grid, link.face as usize) {
                continue;
            }
            let side = side(link.sign);
            let part = normal_part(link.face as usize, side);
            sum += (face.area * distance(face, side) * part) * face.normal;
        }
        sum /= grid.volume[cell];
        match self.inverse.get(cell) {
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
