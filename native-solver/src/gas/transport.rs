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
use super::momentum::{Momentum, given_velocity, tensors};
use super::recovery::{Recovery, reach};
use super::state::GasState;
use crate::numerics::gradient::{self, Beside, FreeCells};
use crate::numerics::grid::{Face, MeshGraph};
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
    /// Memory for values on faces.
    on_faces: Vec<Vec3>,
    /// a_t of each cell in kg/s, and 1/(ρ ε χ V) in 1/kg.
    per_flux: Vec<[f64; 2]>,
    free: Option<FreeCells>,
    /// Memory for gradients without those of the cells beside.
    plain: Vec<Matrix3<f64>>,
    /// What ρ ε u has at each face beyond its owner's and its neighbour's, along its normal, by their gradients; in kg/m²/s.
    /// Empty where lines between centres are normal to faces.
    pub reach: Vec<[f64; 2]>,
    /// The same before [`Self::update_reach`].
    pub last_reach: Vec<[f64; 2]>,
    /// ρ ε u·n at each face: of the cells beside it, and on the boundary of the flux. Empty as `reach`.
    passing: Vec<f64>,
    /// What a cell's value would be of the values that the cells give on its faces, less its own.
    bent: Vec<Vec3>,
}

impl FaceTransport {
    /// No transport.
    pub fn new(cells: usize, faces: usize) -> Self {
        Self {
            force: vec![[0.0; 2]; faces],
            mass_velocity: vec![Vec3::zeros(); cells],
            gradients: vec![Matrix3::zeros(); cells],
            on_faces: vec![Vec3::zeros(); faces],
            per_flux: vec![[0.0; 2]; cells],
            free: None,
            plain: Vec::new(),
            reach: Vec::new(),
            last_reach: Vec::new(),
            passing: Vec::new(),
            bent: Vec::new(),
        }
    }

    /// Evaluates c for the velocity at hand.
    pub fn update(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        momentum: &Momentum,
        recovery: &Recovery,
        now: &GasState,
    ) {
        let grid = frame.grid;
        self.update_mass_velocity(frame, material, now);
        self.update_bent(frame, now, recovery);
        fill(&mut self.per_flux, |cell| {
            let density = material.density[cell];
            let shares = frame.void_fraction[cell] * frame.pressure_share[cell];
            let held = density * shares * grid.volume[cell];
            [momentum.transport(frame, cell), 1.0 / held]
        });
        let (gradients, mass_velocity, bent) = (&self.gradients, &self.mass_velocity, &self.bent);
        let passing = &self.passing;
        let per_flux = &self.per_flux;
        let per_flux = |cell: usize, normal: &Vec3| {
            let [transport, by_mass] = per_flux[cell];
            (transport + momentum.normal.along(cell, normal)) * by_mass
        };
        fill(&mut self.force[..grid.internal], |index| {
            let face = &grid.faces[index];
            let (own, other) = (face.owner, face.neighbour);
            let weight = face.owner_weight();
            let along = |cell: usize| face.normal.dot(&(gradients[cell] * face.normal));
            let here = mass_velocity[own].dot(&face.normal);
            let there = mass_velocity[other].dot(&face.normal);
            let mean = if grid.orthogonal {
                let bend = face.owner_distance * weight * (along(other) - along(own));
                weight * here + (1.0 - weight) * there - bend
            } else {
                let bend = weight * bent[own] + (1.0 - weight) * bent[other];
                passing[index] - bend.dot(&face.normal)
            };
            [
                per_flux(own, &face.normal) * (mean - here),
                per_flux(other, &face.normal) * (mean - there),
            ]
        });
    }

    /// The reach of the mass velocity at hand, beside which the last one is kept.
    pub fn update_reach(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        now: &GasState,
    ) {
        self.last_reach.clone_from(&self.reach);
        self.update_mass_velocity(frame, material, now);
    }

    fn update_mass_velocity(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        now: &GasState,
    ) {
        let held = |cell: usize| material.density[cell] * frame.void_fraction[cell];
        fill(&mut self.mass_velocity, |cell| {
            held(cell) * now.velocity[cell]
        });
        self.update_gradients(frame, held, &now.flux);
    }

    /// The reach of the old mass flux.
    pub fn old_reach(&mut self, frame: &AttemptFrame<'_>) -> &[[f64; 2]] {
        let (grid, old) = (frame.grid, frame.old);
        fill(&mut self.mass_velocity, |cell| {
            old.mass[cell] / grid.volume[cell] * old.velocity[cell]
        });
        let held = |cell: usize| old.mass[cell] / grid.volume[cell];
        self.update_gradients(frame, held, &old.flux);
        &self.reach
    }

    /// Gradients of ρ ε u, `held` being ρ ε of a cell.
    fn update_gradients(
        &mut self,
        frame: &AttemptFrame<'_>,
        held: impl Fn(usize) -> f64 + Sync,
        flux: &[f64],
    ) {
        let grid = frame.grid;
        let mass_velocity = &self.mass_velocity;
        if grid.orthogonal {
            // On the boundary the cell's own, its normal part that of the flux.
            let value = |index: usize, face: &Face| {
                let own = mass_velocity[face.owner];
                if index < grid.internal {
                    let weight = face.owner_weight();
                    weight * own + (1.0 - weight) * mass_velocity[face.neighbour]
                } else {
                    own + (flux[index] / face.area - own.dot(&face.normal)) * face.normal
                }
            };
            return tensors(grid, value, &mut self.on_faces, &mut self.gradients);
        }
        let boundary = |index: usize, own: Vec3| {
            let face = &grid.faces[index];
            let along = |velocity: Vec3| {
                velocity + (flux[index] / face.area - velocity.dot(&face.normal)) * face.normal
            };
            match given_velocity(frame, index) {
                Some(velocity) => Beside::AtFace(along(held(face.owner) * velocity)),
                None => Beside::AtFoot(along(own)),
            }
        };
        gradient::vector(grid, mass_velocity, boundary, &mut self.gradients);
        let free = self
            .free
            .get_or_insert_with(|| frame.boundary.free_cells(grid));
        gradient::averaged(grid, &mut self.gradients, free, &mut self.plain);
        let gradients = &self.gradients;
        self.reach.resize(grid.faces.len(), [0.0; 2]);
        fill(&mut self.reach, |index| reach(grid, index, gradients));
    }

    /// What smooth fields lose where cells take the mean of their faces, and faces that of cells, is lost twice by doing so once more.
    fn update_bent(&mut self, frame: &AttemptFrame<'_>, now: &GasState, recovery: &Recovery) {
        let grid = frame.grid;
        if grid.orthogonal {
            return;
        }
        let (mass_velocity, gradients, reach) = (&self.mass_velocity, &self.gradients, &self.reach);
        self.passing.resize(grid.faces.len(), 0.0);
        fill(&mut self.passing, |index| match index < grid.internal {
            true => interpolated(grid, index, mass_velocity, gradients),
            false => now.flux[index] / grid.faces[index].area,
        });
        let passing = &self.passing;
        self.bent.resize(grid.cells(), Vec3::zeros());
        fill(&mut self.bent, |cell| {
            let part = |index: usize, side: usize| passing[index] - reach[index][side];
            recovery.vector(grid, cell, part) - mass_velocity[cell]
        });
    }
}

/// ρ ε u·n at the centre of an internal face, exact for linear fields.
#[inline]
fn interpolated(
    grid: &MeshGraph,
    index: usize,
    mass_velocity: &[Vec3],
    gradients: &[Matrix3<f64>],
) -> f64 {
    let face = &grid.faces[index];
    let (own, other, weight) = (face.owner, face.neighbour, face.owner_weight());
    let mean = weight * mass_velocity[own] + (1.0 - weight) * mass_velocity[other];
    let miss = face.miss();
    let slope = gradients[own] * weight + gradients[other] * (1.0 - weight);
    face.normal.dot(&(mean + slope * miss))
}
