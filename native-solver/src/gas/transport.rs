//! What friction and convection do at a face. Of the diagonal a of the momentum equation, with N along the face's normal, the part a_t of
//! friction and convection multiplies the cell's own velocity, not that of the half cell that drag and
//! inertia meet at the face: the balance of the half cell (see [`super::pressure`]) has
//! a_t times the flux there only to damp oscillations between faces, and gets back
//!
//! c_P = a_t/(ρ ε χ V) (M̂_f − M_P·n),  M = ρ ε u,
//!
//! where M̂_f is the flux per area that the cells around the face stand for. A cell's velocity is the
//! mean of its faces, so that to fourth order of smooth fields, with g = n·∇M n,
//!
//! M̂_f = (d_N M_P + d_P M_N)·n/(d_P + d_N) − d_P d_N (g_N − g_P)/(d_P + d_N).
//!
//! Where the flux does not vary along itself, as in a bed in a duct, c is zero and resistances in series
//! stay exact. Without c an excess a_t d² ∂²u_n/∂n² of friction would remain on every mesh.

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

use super::attempt::{AttemptFrame, CellProperties};
use super::momentum::{Momentum, tensor};
use super::state::GasState;
use crate::numerics::grid::Face;
use crate::numerics::parallel::fill;

/// c of the half cells at each internal face, and what it needs.
#[derive(Debug)]
pub struct FaceTransport {
    /// c of the half cells of each internal face's owner and neighbour, along its normal, in N/m³.
    pub force: Vec<[f64; 2]>,
    /// ρ ε u of each cell in kg/m²/s.
    mass_velocity: Vec<Vec3>,
    /// Its gradient in kg/m³/s.
    gradients: Vec<Matrix3<f64>>,
}

impl FaceTransport {
    /// No transport.
    pub fn new(cells: usize, faces: usize) -> Self {
        Self {
            force: vec![[0.0; 2]; faces],
            mass_velocity: vec![Vec3::zeros(); cells],
            gradients: vec![Matrix3::zeros(); cells],
        }
    }

    /// Evaluates c for the velocity at hand.
    pub fn update(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        momentum: &Momentum,
        now: &GasState,
    ) {
        let grid = frame.grid;
        fill(&mut self.mass_velocity, |cell| {
            material.density[cell] * frame.void_fraction[cell] * now.velocity[cell]
        });
        let mass_velocity = &self.mass_velocity;
        // On the boundary the cell's own, its normal part that of the flux.
        let value = |index: usize, face: &Face| {
            let own = mass_velocity[face.owner];
            if index < grid.internal {
                let weight = face.owner_weight();
                weight * own + (1.0 - weight) * mass_velocity[face.neighbour]
            } else {
                own + (now.flux[index] / face.area - own.dot(&face.normal)) * face.normal
            }
        };
        fill(&mut self.gradients, |cell| tensor(grid, cell, value));
        let gradients = &self.gradients;
        let per_flux = |cell: usize, normal: &Vec3| {
            let density = material.density[cell];
            let shares = frame.void_fraction[cell] * frame.pressure_share[cell];
            let transport = momentum.transport(frame, cell) + momentum.normal.along(cell, normal);
            transport / (density * shares * grid.volume[cell])
        };
        fill(&mut self.force[..grid.internal], |index| {
            let face = &grid.faces[index];
            let (own, other) = (face.owner, face.neighbour);
            let weight = face.owner_weight();
            let along = |cell: usize| face.normal.dot(&(gradients[cell] * face.normal));
            let here = mass_velocity[own].dot(&face.normal);
            let there = mass_velocity[other].dot(&face.normal);
            let bend = face.owner_distance * weight * (along(other) - along(own));
            let mut mean = weight * here + (1.0 - weight) * there - bend;
            if !grid.orthogonal {
                let miss = weight * face.owner_skew - (1.0 - weight) * face.neighbour_skew;
                let slope = gradients[own] * weight + gradients[other] * (1.0 - weight);
                mean += face.normal.dot(&(slope * miss));
            }
            [
                per_flux(own, &face.normal) * (mean - here),
                per_flux(other, &face.normal) * (mean - there),
            ]
        });
    }
}
