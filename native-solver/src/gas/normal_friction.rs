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
use crate::numerics::parallel::fill;

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
}

/// Whether gas slips along a face of the boundary.
#[inline]
fn slips(frame: &AttemptFrame<'_>, index: usize) -> bool {
    matches!(
        frame.boundary.at(index),
        FaceCondition::Wall { sticks: None, .. }
    )
}

impl NormalFriction {
    /// Takes up the viscosity at hand.
    pub fn update(&mut self, frame: &AttemptFrame<'_>, material: &CellProperties) {
        let grid = frame.grid;
        self.stiffness.resize(grid.faces.len() - grid.internal, 0.0);
        fill(&mut self.stiffness, |boundary| {
            let index = grid.internal + boundary;
            if !slips(frame, index) {
                return 0.0;
            }
            let face = &grid.faces[index];
            NORMAL * material.viscosity[face.owner] * face.area / face.owner_distance
        });
        self.place.clear();
        self.tensors.clear();
        for (boundary, &stiffness) in self.stiffness.iter().enumerate() {
            if stiffness == 0.0 {
                continue;
            }
            self.place.resize(grid.cells(), u32::MAX);
            let face = &grid.faces[grid.internal + boundary];
            let place = &mut self.place[face.owner];
            if *place == u32::MAX {
                *place = self.tensors.len() as u32;
                self.tensors.push(Matrix3::zeros());
            }
            self.tensors[*place as usize] += stiffness * face.normal * face.normal.transpose();
        }
    }

    /// True where no wall is without friction.
    pub fn is_empty(&self) -> bool {
        self.tensors.is_empty()
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

    /// Momentum that leaves the owner of such a face by the rest, by the gradient ∂u_i/∂x_j of the cell; nothing at other faces.
    #[inline]
    pub fn explicit(
        &self,
        frame: &AttemptFrame<'_>,
        index: usize,
        viscosity: f64,
        gradient: &Matrix3<f64>,
    ) -> Vec3 {
        if !slips(frame, index) {
            return Vec3::zeros();
        }
        let face = &frame.grid.faces[index];
        let normal = &face.normal;
        let along = gradient.trace() - normal.dot(&(gradient * normal));
        let mut out = 2.0 / 3.0 * viscosity * face.area * along;
        if !frame.grid.orthogonal {
            let skewed = normal.dot(&(gradient * face.owner_skew));
            out += self.stiffness[index - frame.grid.internal] * skewed;
        }
        out * normal
    }
}
