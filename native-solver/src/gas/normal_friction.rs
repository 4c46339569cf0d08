//! Normal viscous stress of walls without friction and planes of symmetry. Gas moves along them alone, u·n = 0 at the face, so that the
//! stress on the cell behind has the one part
//!
//! τ_n = μ (2 ∂u_n/∂n − ⅔ ∇·u) = μ (4/3 ∂u_n/∂n − ⅔ ∇_t·u),   ∂u_n/∂n = −(u·n + t·∇u_n)/d,
//!
//! d the distance of the centre along the normal, t from below the face's centre to it, ∇_t·u the divergence along the face. What it owes to the
//! cell's own velocity is implicit in all steps, a tensor beside the diagonal of the momentum equation,
//!
//! N = Σ w n nᵀ,   w = 4/3 μ A/d,
//!
//! which damps each component by what it has of the normal: with that explicit, outer iterations diverge where ν Δt/d² is large.

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

use super::attempt::{AttemptFrame, CellProperties};
use super::boundary::FaceCondition;
use crate::numerics::grid::MeshGraph;

/// Share of the normal derivative of the normal velocity in the normal stress, 2 − ⅔.
const NORMAL: f64 = 4.0 / 3.0;

/// N of the cells at walls without friction.
#[derive(Debug, Default)]
pub struct NormalFriction {
    /// w of each face of the boundary in kg/s; zero elsewhere.
    stiffness: Vec<f64>,
    /// Where N of each cell is, or beyond all; empty where no wall is without friction.
    place: Vec<u32>,
    tensors: Vec<Matrix3<f64>>,
    slipping: Option<SlippingFaces>,
}

/// The faces of walls without friction, which stay as they are.
#[derive(Debug, Default)]
struct SlippingFaces {
    /// Faces of the boundary, from its first one on, each with the place of its cell's tensor.
    faces: Vec<[u32; 2]>,
    /// True where cells have faces that are oblique to them.
    oblique: bool,
}

/// Cosine of the angle between two faces below which they count as at right angles.
const SQUARE: f64 = 1e-9;

/// Whether gas slips along a face of the boundary.
#[inline]
fn slips(frame: &AttemptFrame<'_>, index: usize) -> bool {
    matches!(
        frame.boundary.at(index),
        FaceCondition::Wall { sticks: None, .. }
    )
}

/// Whether the cell behind a face of a wall has faces that are oblique to it.
fn is_oblique(grid: &MeshGraph, wall: usize) -> bool {
    let wall = &grid.faces[wall];
    grid.links(wall.owner).iter().any(|link| {
        let normal = &grid.faces[link.face as usize].normal;
        let cosine = normal.dot(&wall.normal).abs();
        cosine > SQUARE && cosine < 1.0 - SQUARE
    })
}

impl NormalFriction {
    fn find(&mut self, frame: &AttemptFrame<'_>) -> SlippingFaces {
        let grid = frame.grid;
        let mut found = SlippingFaces::default();
        self.stiffness = vec![0.0; grid.faces.len() - grid.internal];
        for boundary in 0..self.stiffness.len() {
            let index = grid.internal + boundary;
            if !slips(frame, index) {
                continue;
            }
            self.place.resize(grid.cells(), u32::MAX);
            let place = &mut self.place[grid.faces[index].owner];
            if *place == u32::MAX {
                *place = self.tensors.len() as u32;
                self.tensors.push(Matrix3::zeros());
            }
            found.faces.push([boundary as u32, *place]);
            found.oblique |= is_oblique(grid, index);
        }
        found
    }

    /// Takes up the viscosity at hand.
    pub fn update(&mut self, frame: &AttemptFrame<'_>, material: &CellProperties) {
        let grid = frame.grid;
        let slipping = match self.slipping.take() {
            Some(slipping) => slipping,
            None => self.find(frame),
        };
        self.tensors.fill(Matrix3::zeros());
        for &[boundary, place] in &slipping.faces {
            let face = &grid.faces[grid.internal + boundary as usize];
            let stiffness =
                NORMAL * material.viscosity[face.owner] * face.area / face.owner_distance;
            self.stiffness[boundary as usize] = stiffness;
            self.tensors[place as usize] += stiffness * face.normal * face.normal.transpose();
        }
        self.slipping = Some(slipping);
    }

    /// True where N has nothing of velocities along the faces of cells: no wall is without friction, or the faces of the cells at
    /// them are parallel or at right angles to them.
    pub fn is_square(&self) -> bool {
        self.slipping
            .as_ref()
            .is_none_or(|slipping| !slipping.oblique)
    }

    /// N of a cell in kg/s.
    #[inline]
    pub fn tensor(&self, cell: usize) -> Option<&Matrix3<f64>> {
        self.tensors.get(*self.place.get(cell)? as usize)
    }

    /// N u of a cell in N.
    #[inline]
    pub fn pull(&self, cell: usize, velocity: &Vec3) -> Vec3 {
        self.tensor(cell)
            .map_or_else(Vec3::zeros, |tensor| tensor * velocity)
    }

    /// n·N n of a cell in kg/s.
    #[inline]
    pub fn along(&self, cell: usize, normal: &Vec3) -> f64 {
        self.tensor(cell)
            .map_or(0.0, |tensor| normal.dot(&(tensor * normal)))
    }

    /// What N has of a velocity along a plane for the plane's normal, n·N (u − n n·u) in N: nothing in cells whose faces are parallel or at
    /// right angles to their walls.
    #[inline]
    pub fn across(&self, cell: usize, normal: &Vec3, velocity: &Vec3) -> f64 {
        self.tensor(cell).map_or(0.0, |tensor| {
            let pulled = tensor * normal;
            pulled.dot(velocity) - pulled.dot(normal) * normal.dot(velocity)
        })
    }

    /// True where a component of the velocity is damped.
    pub fn damps(&self, axis: usize) -> bool {
        self.tensors
            .iter()
            .any(|tensor| tensor[(axis, axis)] != 0.0)
    }

    /// Adds N's diagonal for a component to that of the momentum equation.
    pub fn add(&self, axis: usize, diagonal: &mut [f64]) {
        for (value, &place) in diagonal.iter_mut().zip(&self.place) {
            if let Some(tensor) = self.tensors.get(place as usize) {
                *value += tensor[(axis, axis)];
            }
        }
    }

    /// What N takes from a component of the momentum by the other two, in N.
    #[inline]
    pub fn by_others(&self, cell: usize, axis: usize, velocity: &Vec3) -> f64 {
        self.tensor(cell).map_or(0.0, |tensor| {
            let others = (0..3).filter(|&other| other != axis);
            others
                .map(|other| tensor[(axis, other)] * velocity[other])
                .sum()
        })
    }

    /// Momentum that leaves the owner of a face without friction by the part of the stress that is implicit, in N.
    #[inline]
    pub fn leaving(&self, grid: &MeshGraph, index: usize, velocity: &Vec3) -> Vec3 {
        let normal = &grid.faces[index].normal;
        let stiffness = self.stiffness[index - grid.internal];
        stiffness * velocity.dot(normal) * normal
    }

    /// Momentum that leaves the owner of such a face by the rest, by the gradient ∂u_i/∂x_j of the cell.
    #[inline]
    pub fn explicit(
        &self,
        grid: &MeshGraph,
        index: usize,
        viscosity: f64,
        gradient: &Matrix3<f64>,
    ) -> Vec3 {
        let face = &grid.faces[index];
        let normal = &face.normal;
        let along = gradient.trace() - normal.dot(&(gradient * normal));
        let mut out = 2.0 / 3.0 * viscosity * face.area * along;
        if !grid.orthogonal {
            let skewed = normal.dot(&(gradient * face.owner_skew));
            out += self.stiffness[index - grid.internal] * skewed;
        }
        out * normal
    }
}
