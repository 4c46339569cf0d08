//! Momentum of the gas, for its interstitial velocity u, in the form that subtracts u times the
//! continuity residual (docs/theory.md, TSM-8), per cell:
//!
//! m_old (u − u_old)/Δt + Σ φ_f u_f − u Σ φ_f − Σ (εμ)_f (∇u + ∇uᵀ − ⅔ ∇·u)·S
//!     = −χ ∇p V + χ ρ V g + S_d − K_d u
//!
//! (docs/theory.md, FLO-5, Newtonian), χ the share of the pressure gradient: ε by model A, 1 by model B. Implicit Euler; u_f upwind, what a second-order value has beyond it
//! explicitly from the last iterate; of the viscous stress the part ∇u·S implicitly, the rest explicitly;
//! on free-slip walls and planes of symmetry the normal viscous stress alone ([`super::normal_friction`]); gas leaves an outlet as if the flow
//! were developed there.

use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::Convection;
use nalgebra::Matrix3;

use super::attempt::{AttemptFrame, CellProperties};
use super::boundary::FaceCondition;
use super::normal_friction::NormalFriction;
use super::state::GasState;
use super::tolerance;
use super::turbulence::wall;
use crate::numerics::convection::vector_beyond_upwind;
use crate::numerics::gradient::{self, Beside, FreeCells};
use crate::numerics::grid::{Face, MeshGraph};
use crate::numerics::krylov::{Krylov, SolveTolerance};
use crate::numerics::matrix::Matrix;
use crate::numerics::operators::{conductance, follow, interpolate};
use crate::numerics::parallel::{fill, largest, sums, update};
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// The predictor need not be solved closer than this share of its initial residual, because the
/// pressure corrections change it again.
const PREDICTOR: f64 = 1e-3;
/// Iterations of a predictor at most; it converges in a few, or the outer loop shows that it
/// does not.
const ITERATIONS: u32 = 200;
/// Gas that moves by less than this share of a cell in a window counts as still.
const STILL: f64 = 1e-5;

/// Matrix and right-hand side, the pressure left out: (A + N) u = b − χ V ∇p.
#[derive(Debug)]
pub struct Momentum {
    /// A, the same for each component.
    pub matrix: Matrix,
    /// N, of walls without friction.
    pub normal: NormalFriction,
    /// b in N.
    pub source: Vec<Vec3>,
    /// Viscous conductance of each face in kg/s.
    viscous: Vec<f64>,
    preconditioner: Incomplete,
    /// Diagonal of A, while a component has its own.
    diagonal: Vec<f64>,
    component: Vec<f64>,
    right: Vec<f64>,
    /// ∂u_i/∂x_j of each cell in 1/s.
    gradients: Vec<Matrix3<f64>>,
    /// Memory for values on faces.
    on_faces: Vec<Vec3>,
    /// Momentum that leaves the owner of each face in N, of what the equation takes explicitly.
    explicit: Vec<Vec3>,
    free: Option<FreeCells>,
    /// Of each cell what its equation misses, and its terms, in N.
    errors: Vec<[f64; 2]>,
}

/// Velocity of the gas at a boundary face, interstitial, where it is given.
#[inline]
pub fn given_velocity(frame: &AttemptFrame<'_>, index: usize) -> Option<Vec3> {
    let face = &frame.grid.faces[index];
    match *frame.boundary.at(index) {
        FaceCondition::Inlet {
            superficial_velocity,
            ..
        } => Some(-superficial_velocity / frame.void_fraction[face.owner] * face.normal),
        FaceCondition::Wall { sticks, .. } => sticks,
        FaceCondition::Outlet { .. } => None,
    }
}

/// Interstitial velocity of the gas that passes a boundary face at a mass flux in kg/s, where it is not the cell's: the
/// given one, and at an opening that of gas of the surroundings, straight in.
#[inline]
fn carried_velocity(frame: &AttemptFrame<'_>, index: usize, flux: f64) -> Option<Vec3> {
    match *frame.boundary.at(index) {
        FaceCondition::Outlet {
            surroundings: Some(surroundings),
            ..
        } if flux < 0.0 => {
            let face = &frame.grid.faces[index];
            let held = surroundings.density * frame.void_fraction[face.owner];
            Some(flux / (held * face.area) * face.normal)
        }
        _ => given_velocity(frame, index),
    }
}

/// Viscous conductance of a face in kg/s, eddies included, and on the boundary only where the velocity is given.
#[inline]
fn viscous(
    frame: &AttemptFrame<'_>,
    material: &CellProperties,
    now: &GasState,
    index: usize,
) -> f64 {
    let face = &frame.grid.faces[index];
    if index < frame.grid.internal {
        return conductance(face, interpolate(face, &material.viscosity));
    }
    let pores = frame.void_fraction[face.owner];
    match *frame.boundary.at(index) {
        FaceCondition::Inlet { gas, .. } => {
            conductance(face, pores * gas.viscosity + frame.eddies_at(index))
        }
        FaceCondition::Wall {
            sticks: Some(_), ..
        } => {
            let laminar = wall::viscosity(frame.boundary, frame.properties, now, index, face.owner);
            conductance(face, laminar + frame.eddies_at(index))
        }
        FaceCondition::Wall { sticks: None, .. } | FaceCondition::Outlet { .. } => 0.0,
    }
}

impl Momentum {
    /// An empty system on a matrix's graph.
    pub fn new(matrix: Matrix) -> Self {
        let (cells, faces) = (matrix.grid().cells(), matrix.grid().faces.len());
        Self {
            matrix,
            normal: NormalFriction::default(),
            viscous: vec![0.0; faces],
            source: vec![Vec3::zeros(); cells],
            preconditioner: Incomplete::default(),
            diagonal: Vec::new(),
            component: vec![0.0; cells],
            right: vec![0.0; cells],
            gradients: vec![Matrix3::zeros(); cells],
            on_faces: vec![Vec3::zeros(); faces],
            explicit: vec![Vec3::zeros(); faces],
            free: None,
            errors: vec![[0.0; 2]; cells],
        }
    }

    /// Assembles A and b for the fluxes and properties at hand.
    /// Of what is explicit a share follows the fields.
    pub fn assemble(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        share: f64,
        now: &GasState,
    ) {
        let grid = frame.grid;
        fill(&mut self.viscous, |index| {
            viscous(frame, material, now, index)
        });
        self.normal.update(frame, material);
        self.update_gradients(frame, &now.velocity);
        self.update_explicit(frame, material, share, now);
        let viscous = &self.viscous;
        let inertia = |cell: usize| frame.old.mass[cell] / frame.motion_span;
        self.matrix.assemble(|cell, diagonal, neighbours| {
            *diagonal = inertia(cell) + frame.exchange.drag_coefficient[cell];
            for link in grid.links(cell) {
                let index = link.face as usize;
                let inflow = (-link.sign * now.flux[index]).max(0.0);
                let weight = viscous[index] + inflow;
                if weight == 0.0 {
                    continue;
                }
                if !link.is_boundary() {
                    neighbours[link.slot as usize] -= weight;
                    *diagonal += weight;
                } else if carried_velocity(frame, index, now.flux[index]).is_some() {
                    *diagonal += weight;
                }
            }
        });
        let explicit = &self.explicit;
        fill(&mut self.source, |cell| {
            let share = frame.pressure_share[cell] * grid.volume[cell];
            let weight = share * material.density[cell];
            let mut source = inertia(cell) * frame.old.velocity[cell]
                + frame.exchange.drag_source[cell]
                + weight * frame.gravity
                - share * frame.mean_gradient;
            for link in grid.links(cell) {
                let index = link.face as usize;
                if link.is_boundary() {
                    let inflow = (-link.sign * now.flux[index]).max(0.0);
                    let weight = viscous[index] + inflow;
                    if weight > 0.0
                        && let Some(velocity) = carried_velocity(frame, index, now.flux[index])
                    {
                        source += weight * velocity;
                    }
                }
                source -= link.sign * explicit[index];
            }
            source
        });
    }

    /// How far velocities and pressures are from solving the equation, the larger of two measures: Σ over cells of |b − χ V ∇p − (A + N) u|, relative to the
    /// magnitudes of its terms; and by how much that, and what is `unsettled` in m/s, moves the velocity of the worst cell, relative to the fastest gas, over
    /// [`tolerance::WORST`]: the first hardly sees an error in few small cells.
    pub fn residual(&mut self, frame: &AttemptFrame<'_>, now: &GasState, unsettled: f64) -> f64 {
        let (grid, cells) = (frame.grid, self.source.len());
        let mut errors = std::mem::take(&mut self.errors);
        fill(&mut errors, |cell| {
            let velocity = &now.velocity[cell];
            let own = self.matrix.diagonal()[cell] * velocity + self.normal.pull(cell, velocity);
            let push = frame.pressure_share[cell] * grid.volume[cell];
            let pressure = push * now.pressure_gradient[cell];
            let force = self.without_pressure(cell, &now.velocity);
            let error = (force - pressure - own).norm();
            [error, own.norm() + pressure.norm() + force.norm()]
        });
        let still = STILL / frame.motion_span;
        let size = |cell: usize| grid.volume[cell].cbrt();
        let diagonal = self.matrix.diagonal();
        let [error, terms, length] = sums(cells, |cell| {
            let [error, terms] = errors[cell];
            [
                error,
                terms + diagonal[cell] * still * size(cell),
                size(cell),
            ]
        });
        let (_, fastest) = largest(cells, |cell| now.velocity[cell].norm_squared());
        let fastest = fastest.sqrt() + still * length / cells as f64;
        let (_, moved) = largest(cells, |cell| errors[cell][0] / diagonal[cell]);
        self.errors = errors;
        (error / terms).max((moved + unsettled) / (tolerance::WORST * fastest))
    }

    /// Right-hand side and neighbours' pull of a cell, without the pressure, in N.
    #[inline]
    pub fn without_pressure(&self, cell: usize, velocity: &[Vec3]) -> Vec3 {
        let (columns, values) = self.matrix.row(cell);
        let mut force = self.source[cell];
        for (&column, &value) in columns.iter().zip(values) {
            force -= value * velocity[column as usize];
        }
        force
    }

    /// The part of a cell's diagonal in A that is friction and convection, in kg/s.
    #[inline]
    pub fn transport(&self, frame: &AttemptFrame<'_>, cell: usize) -> f64 {
        let inertia = frame.old.mass[cell] / frame.motion_span;
        self.matrix.diagonal()[cell] - inertia - frame.exchange.drag_coefficient[cell]
    }

    /// Friction between a face of the boundary and the cell behind it, in kg/s; zero where no velocity is given.
    #[inline]
    pub fn friction(&self, index: usize) -> f64 {
        self.viscous[index]
    }

    /// Solves for the velocity with the pressure gradient at hand; returns the iterations.
    pub fn predict(
        &mut self,
        frame: &AttemptFrame<'_>,
        krylov: &mut Krylov,
        tolerance: f64,
        now: &mut GasState,
    ) -> u32 {
        let mut iterations = 0;
        // True where the factors at hand are not of A.
        let mut stale = true;
        self.diagonal.clear();
        self.diagonal.extend_from_slice(self.matrix.diagonal());
        for axis in 0..3 {
            let (source, normal, velocity) = (&self.source, &self.normal, &now.velocity);
            let gradient = &now.pressure_gradient;
            fill(&mut self.right, |cell| {
                let push = frame.pressure_share[cell] * frame.grid.volume[cell];
                source[cell][axis]
                    - push * gradient[cell][axis]
                    - normal.by_others(cell, axis, &velocity[cell])
            });
            fill(&mut self.component, |cell| velocity[cell][axis]);
            // Nothing moves this way, nor is it pushed.
            let mut all = self.right.iter().chain(&self.component);
            if all.all(|value| *value == 0.0) {
                continue;
            }
            let damps = self.normal.damps(axis);
            if damps {
                self.normal.add(axis, self.matrix.diagonal_mut());
            }
            if stale || damps {
                self.preconditioner.expire();
            }
            stale = damps;
            let target = SolveTolerance {
                absolute: 0.0,
                of_terms: tolerance,
                relative: PREDICTOR,
                iterations: ITERATIONS,
            };
            let solved = krylov.general(
                &self.matrix,
                &mut self.preconditioner,
                &self.right,
                &mut self.component,
                target,
            );
            tracing::debug!("velocity {axis}: {} linear iterations", solved.iterations);
            if solved.iterations > 0 {
                let component = &self.component;
                let put = |cell: usize, u: &mut Vec3| u[axis] = component[cell];
                update(&mut now.velocity, put);
            }
            iterations += solved.iterations;
            self.matrix.diagonal_mut().copy_from_slice(&self.diagonal);
        }
        iterations
    }

    /// Flow of momentum into the domain through a boundary face in N, pressure excluded.
    pub fn inflow(&self, frame: &AttemptFrame<'_>, now: &GasState, index: usize) -> Vec3 {
        let face = &frame.grid.faces[index];
        let (inner, flux) = (now.velocity[face.owner], now.flux[index]);
        if flux == 0.0 && self.viscous[index] == 0.0 {
            return -self.normal.leaving(frame.grid, index, &inner) - self.explicit[index];
        }
        let Some(velocity) = carried_velocity(frame, index, flux) else {
            return -flux * inner - self.explicit[index];
        };
        let carried = if flux < 0.0 { velocity } else { inner };
        -flux * carried + self.viscous[index] * (velocity - inner) - self.explicit[index]
    }

    /// ∂u_i/∂x_j of each cell in 1/s, as made last.
    pub fn gradients(&self) -> &[Matrix3<f64>] {
        &self.gradients
    }

    /// Makes the gradients of a velocity.
    pub fn update_gradients(&mut self, frame: &AttemptFrame<'_>, velocity: &[Vec3]) {
        let grid = frame.grid;
        if grid.orthogonal {
            let value = |index: usize, face: &Face| face_velocity(frame, index, face, velocity);
            return tensors(grid, value, &mut self.on_faces, &mut self.gradients);
        }
        let boundary = |index: usize, _: Vec3| match *frame.boundary.at(index) {
            FaceCondition::Wall { sticks: None, .. } | FaceCondition::Outlet { .. } => {
                Beside::AtFoot(face_velocity(frame, index, &grid.faces[index], velocity))
            }
            _ => Beside::AtFace(face_velocity(frame, index, &grid.faces[index], velocity)),
        };
        gradient::vector(grid, velocity, boundary, &mut self.gradients);
        let free = self
            .free
            .get_or_insert_with(|| frame.boundary.free_cells(grid));
        free.mix(grid, &mut self.gradients);
    }

    fn update_explicit(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        share: f64,
        now: &GasState,
    ) {
        let grid = frame.grid;
        let (gradients, viscous, normal) = (&self.gradients, &self.viscous, &self.normal);
        let second = frame.convection != Convection::Upwind;
        let explicit = |index: usize| {
            let face = &grid.faces[index];
            if index >= grid.internal {
                let own = &gradients[face.owner];
                let viscosity = material.viscosity[face.owner];
                return match *frame.boundary.at(index) {
                    FaceCondition::Outlet { .. } => {
                        let developed = own - (own * face.normal) * face.normal.transpose();
                        -face.area * viscosity * transposed(&developed, &face.normal)
                    }
                    FaceCondition::Wall { sticks: None, .. } => {
                        normal.explicit(grid, index, viscosity, own)
                    }
                    FaceCondition::Wall {
                        sticks: Some(_), ..
                    }
                    | FaceCondition::Inlet { .. } => {
                        explicit_at_boundary(frame, index, own, viscous[index], now)
                    }
                };
            }
            let flux = now.flux[index];
            let mut out = Vec3::zeros();
            if second && flux != 0.0 {
                let (scheme, values) = (frame.convection, &now.velocity);
                let beyond = vector_beyond_upwind(scheme, grid, index, flux, values, gradients);
                out += flux * beyond;
            }
            let (own, other) = (&gradients[face.owner], &gradients[face.neighbour]);
            if !grid.orthogonal {
                let skewed = own * face.owner_skew + other * face.neighbour_skew;
                out += viscous[index] * skewed;
            }
            let weight = face.owner_weight();
            let stress = transposed(own, &face.normal) * (weight * material.viscosity[face.owner])
                + transposed(other, &face.normal)
                    * ((1.0 - weight) * material.viscosity[face.neighbour]);
            out - face.area * stress
        };
        update(&mut self.explicit, |index, last| {
            follow(last, explicit(index), share)
        });
    }
}

/// Velocity on a face by linear interpolation; on the boundary the given or the cell's own, of which
/// walls without friction let the tangential part pass.
#[inline]
fn face_velocity(frame: &AttemptFrame<'_>, index: usize, face: &Face, velocity: &[Vec3]) -> Vec3 {
    if index < frame.grid.internal {
        let weight = face.owner_weight();
        weight * velocity[face.owner] + (1.0 - weight) * velocity[face.neighbour]
    } else {
        let own = velocity[face.owner];
        match *frame.boundary.at(index) {
            FaceCondition::Wall { sticks: None, .. } => own - own.dot(&face.normal) * face.normal,
            _ => given_velocity(frame, index).unwrap_or(own),
        }
    }
}

/// Σ u_f S / V (Gauss): ∂u_i/∂x_j of each cell. `faces` is memory for values on faces.
pub fn tensors(
    grid: &MeshGraph,
    value: impl Fn(usize, &Face) -> Vec3 + Sync,
    faces: &mut [Vec3],
    gradients: &mut [Matrix3<f64>],
) {
    fill(faces, |index| {
        let face = &grid.faces[index];
        face.area * value(index, face)
    });
    let faces = &*faces;
    fill(gradients, |cell| {
        let mut sum = Matrix3::zeros();
        for link in grid.links(cell) {
            let index = link.face as usize;
            let weighted = link.sign * faces[index];
            sum += weighted * grid.faces[index].normal.transpose();
        }
        sum / grid.volume[cell]
    });
}

/// (∇uᵀ − ⅔ ∇·u)·n in 1/s.
#[inline]
fn transposed(gradient: &Matrix3<f64>, normal: &Vec3) -> Vec3 {
    gradient.tr_mul(normal) - (2.0 / 3.0 * gradient.trace()) * normal
}

/// Explicit momentum flow out of the owner through a boundary face in N: skewness and the transposed
/// stress, where the velocity is given; its normal derivative is then that of the face.
fn explicit_at_boundary(
    frame: &AttemptFrame<'_>,
    index: usize,
    inner: &Matrix3<f64>,
    viscous: f64,
    now: &GasState,
) -> Vec3 {
    let face = &frame.grid.faces[index];
    let Some(velocity) = given_velocity(frame, index) else {
        return Vec3::zeros();
    };
    let skewed = if frame.grid.orthogonal {
        Vec3::zeros()
    } else {
        inner * face.owner_skew
    };
    let along = (velocity - now.velocity[face.owner] - skewed) / face.distance();
    let corrected = inner + (along - inner * face.normal) * face.normal.transpose();
    // The conductance is viscosity × area / distance.
    viscous * (skewed - face.distance() * transposed(&corrected, &face.normal))
}
