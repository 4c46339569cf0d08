//! Operators on cell values: interpolation, divergence, gradient, and the diffusion of a scalar,
//! with corrections where the line between two centres is not normal to their face.

use std::ops::{Add, Mul, Sub};

use calcine_coupler::physics::Vec3;

use super::gradient::{self, Beside};
use super::grid::{Face, MeshGraph};
use super::parallel::fill;

/// Linear interpolation of cell values onto a face; on the boundary the cell's own value.
#[inline]
pub fn interpolate(face: &Face, values: &[f64]) -> f64 {
    if face.neighbour == usize::MAX {
        return values[face.owner];
    }
    let weight = face.owner_weight();
    weight * values[face.owner] + (1.0 - weight) * values[face.neighbour]
}

/// Net outflow of a cell: Σ of the fluxes through its faces, out of the cell.
#[inline]
pub fn outflow(grid: &MeshGraph, flux: &[f64], cell: usize) -> f64 {
    let links = grid.links(cell).iter();
    links.fold(0.0, |sum, link| sum + link.sign * flux[link.face as usize])
}

/// The gradient of a cell from values on its faces (Gauss): Σ value S / V.
#[inline]
pub fn by_gauss(grid: &MeshGraph, face_values: &[f64], cell: usize) -> Vec3 {
    let mut sum = Vec3::zeros();
    for link in grid.links(cell) {
        let face = &grid.faces[link.face as usize];
        sum += (link.sign * face.area * face_values[link.face as usize]) * face.normal;
    }
    sum / grid.volume[cell]
}

/// Gradients of cell values; `boundary(face, owner's value)` is the value on the boundary where one is given, and nothing where the
/// slope along the normal is zero. By Gauss' theorem where lines between centres are normal to faces, elsewhere by least squares
/// ([`super::gradient`]). `faces` is memory for values on faces.
pub fn gradients(
    grid: &MeshGraph,
    values: &[f64],
    boundary: impl Fn(usize, f64) -> Option<f64> + Sync,
    gradients: &mut [Vec3],
    faces: &mut [f64],
) {
    if !grid.orthogonal {
        let beside = |index: usize, inner: f64| match boundary(index, inner) {
            Some(value) => Beside::AtFace(value),
            None => Beside::AtFoot(inner),
        };
        return gradient::scalar(grid, values, beside, gradients);
    }
    fill(faces, |index| {
        let face = &grid.faces[index];
        if index >= grid.internal {
            let inner = values[face.owner];
            return boundary(index, inner).unwrap_or(inner);
        }
        interpolate(face, values)
    });
    let faces = &*faces;
    fill(gradients, |cell| by_gauss(grid, faces, cell));
}

/// Explicit part of n·∇ at a face, times the face's distance: what the plain difference across
/// the face has too much because the centres are displaced along the face.
#[inline]
pub fn displacement(grid: &MeshGraph, face: &Face, gradients: &[Vec3]) -> f64 {
    if grid.orthogonal {
        return 0.0;
    }
    let mut sum = face.owner_skew.dot(&gradients[face.owner]);
    if face.neighbour != usize::MAX {
        sum += face.neighbour_skew.dot(&gradients[face.neighbour]);
    }
    sum
}

/// Moves a value towards a new one by a share; with all of it what was there leaves no trace.
#[inline]
pub fn follow<T>(value: &mut T, new: T, share: f64)
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
{
    *value = if share == 1.0 {
        new
    } else {
        *value + (new - *value) * share
    };
}

/// Conductance of a face, coefficient · area / distance.
#[inline]
pub fn conductance(face: &Face, coefficient: f64) -> f64 {
    coefficient * face.conductance()
}
