//! Momentum of the gas, for its interstitial velocity u, in the form that subtracts u times the
//! continuity residual (requirements TSM-8), per cell:
//!
//! m_old (u − u_old)/Δt + Σ φ_f u_f − u Σ φ_f − Σ (εμ)_f ∇u·S
//!     = −ε ∇p V + ε ρ V g + S_d − K_d u
//!
//! Implicit Euler; first-order upwind u_f; the viscous stress without its transposed part, which
//! vanishes for uniform properties; no viscous normal stress on free-slip walls.

use calcine_coupler::physics::Vec3;

use super::attempt::{Frame, Material};
use super::boundary::Value;
use super::state::State;
use crate::numerics::grid::{Face, Grid};
use crate::numerics::krylov::{Krylov, Target};
use crate::numerics::matrix::Matrix;
use crate::numerics::operators::{conductance, displacement, face_values, gradient, interpolate};
use crate::numerics::parallel::{fill, sums, update};
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// The predictor need not be solved closer than this share of its initial residual, because the
/// pressure corrections change it again.
const PREDICTOR: f64 = 1e-3;
/// Iterations of a predictor at most; it converges in a few, or the outer loop shows that it
/// does not.
const ITERATIONS: u32 = 200;

/// Matrix and right-hand side, the pressure left out: A u = b − ε V ∇p.
#[derive(Debug)]
pub struct Momentum {
    /// A, the same for each component.
    pub matrix: Matrix,
    /// b in N.
    pub source: Vec<Vec3>,
    /// Viscous conductance of each face in kg/s.
    viscous: Vec<f64>,
    preconditioner: Incomplete,
    component: Vec<f64>,
    right: Vec<f64>,
    gradients: [Vec<Vec3>; 3],
    face_velocity: Vec<f64>,
}

/// Velocity of the gas at a boundary face, interstitial, where it is given.
#[inline]
pub fn given_velocity(frame: &Frame<'_>, index: usize) -> Option<Vec3> {
    let face = &frame.grid.faces[index];
    match frame.boundary.at(index) {
        Value::Inlet {
            superficial_velocity,
            ..
        } => Some(-superficial_velocity / frame.void_fraction[face.owner] * face.normal),
        Value::Wall { no_slip: true, .. } => Some(Vec3::zeros()),
        Value::Wall { no_slip: false, .. } | Value::Outlet { .. } => None,
    }
}

/// Viscous conductance of a face in kg/s, and on the boundary only where the velocity is given.
#[inline]
fn viscous(frame: &Frame<'_>, material: &Material, index: usize) -> f64 {
    let face = &frame.grid.faces[index];
    if index < frame.grid.internal {
        return conductance(face, interpolate(face, &material.viscosity));
    }
    let pores = frame.void_fraction[face.owner];
    match frame.boundary.at(index) {
        Value::Inlet { gas, .. }
        | Value::Wall {
            no_slip: true,
            gas: Some(gas),
        } => conductance(face, pores * gas.viscosity),
        Value::Wall { no_slip: true, .. } => conductance(face, material.viscosity[face.owner]),
        Value::Wall { no_slip: false, .. } | Value::Outlet { .. } => 0.0,
    }
}

impl Momentum {
    /// An empty system on a matrix's graph.
    pub fn new(matrix: Matrix) -> Self {
        let (cells, faces) = (matrix.grid().cells(), matrix.grid().faces.len());
        Self {
            matrix,
            viscous: vec![0.0; faces],
            source: vec![Vec3::zeros(); cells],
            preconditioner: Incomplete::default(),
            component: vec![0.0; cells],
            right: vec![0.0; cells],
            gradients: [Vec::new(), Vec::new(), Vec::new()],
            face_velocity: Vec::new(),
        }
    }

    /// Assembles A and b for the fluxes and properties at hand.
    pub fn assemble(&mut self, frame: &Frame<'_>, material: &Material, now: &State) {
        let grid = frame.grid;
        if !grid.orthogonal {
            self.update_gradients(frame, &now.velocity);
        }
        fill(&mut self.viscous, |index| viscous(frame, material, index));
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
                } else if given_velocity(frame, index).is_some() {
                    *diagonal += weight;
                }
            }
        });
        let gradients = &self.gradients;
        fill(&mut self.source, |cell| {
            let weight = frame.void_fraction[cell] * material.density[cell] * grid.volume[cell];
            let mut source = inertia(cell) * frame.old.velocity[cell]
                + frame.exchange.drag_source[cell]
                + weight * frame.gravity;
            for link in grid.links(cell) {
                let index = link.face as usize;
                if link.is_boundary() {
                    let inflow = (-link.sign * now.flux[index]).max(0.0);
                    let weight = viscous[index] + inflow;
                    if weight > 0.0
                        && let Some(velocity) = given_velocity(frame, index)
                    {
                        source += weight * velocity;
                    }
                }
                if !grid.orthogonal {
                    let skewed = viscous_skew(grid, &grid.faces[index], gradients);
                    source -= link.sign * viscous[index] * skewed;
                }
            }
            source
        });
    }

    /// Σ over cells of |b − ε V ∇p − A u|, relative to the magnitudes of its terms.
    pub fn residual(&self, frame: &Frame<'_>, now: &State) -> f64 {
        let (grid, cells) = (frame.grid, self.source.len());
        let parts = |cell: usize| {
            let own = self.matrix.diagonal()[cell] * now.velocity[cell];
            let push = frame.void_fraction[cell] * grid.volume[cell];
            let pressure = push * now.pressure_gradient[cell];
            let force = self.without_pressure(cell, &now.velocity);
            (own, pressure, force)
        };
        let terms = |cell: usize| {
            let (own, pressure, force) = parts(cell);
            let error = (force - pressure - own).norm();
            [error, own.norm() + pressure.norm() + force.norm()]
        };
        let [error, magnitude] = sums(cells, terms);
        if error == 0.0 { 0.0 } else { error / magnitude }
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

    /// Solves for the velocity with the pressure gradient at hand; returns the iterations.
    pub fn predict(
        &mut self,
        frame: &Frame<'_>,
        krylov: &mut Krylov,
        tolerance: f64,
        now: &mut State,
    ) -> u32 {
        self.preconditioner.update(&self.matrix);
        let mut iterations = 0;
        for axis in 0..3 {
            let (source, velocity) = (&self.source, &now.velocity);
            let gradient = &now.pressure_gradient;
            fill(&mut self.right, |cell| {
                let push = frame.void_fraction[cell] * frame.grid.volume[cell];
                source[cell][axis] - push * gradient[cell][axis]
            });
            fill(&mut self.component, |cell| velocity[cell][axis]);
            let target = Target {
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
            if solved.iterations > 0 {
                let component = &self.component;
                let put = |cell: usize, u: &mut Vec3| u[axis] = component[cell];
                update(&mut now.velocity, put);
            }
            iterations += solved.iterations;
        }
        iterations
    }

    /// Flow of momentum into the domain through a boundary face in N, pressure excluded.
    pub fn inflow(&self, frame: &Frame<'_>, now: &State, index: usize) -> Vec3 {
        let face = &frame.grid.faces[index];
        let (inner, flux) = (now.velocity[face.owner], now.flux[index]);
        if flux == 0.0 && self.viscous[index] == 0.0 {
            return Vec3::zeros();
        }
        let Some(velocity) = given_velocity(frame, index) else {
            return -flux * inner;
        };
        let carried = if flux < 0.0 { velocity } else { inner };
        let mut difference = velocity - inner;
        if !frame.grid.orthogonal {
            difference -= viscous_skew(frame.grid, face, &self.gradients);
        }
        -flux * carried + self.viscous[index] * difference
    }

    fn update_gradients(&mut self, frame: &Frame<'_>, velocity: &[Vec3]) {
        let grid = frame.grid;
        self.face_velocity.resize(grid.faces.len(), 0.0);
        for axis in 0..3 {
            let gradients = &mut self.gradients[axis];
            gradients.resize(grid.cells(), Vec3::zeros());
            fill(&mut self.component, |cell| velocity[cell][axis]);
            let boundary = |index: usize, inner: f64| {
                given_velocity(frame, index).map_or(inner, |velocity| velocity[axis])
            };
            let (values, faces) = (&self.component, &mut self.face_velocity);
            face_values(grid, values, gradients, boundary, faces);
            fill(gradients, |cell| gradient(grid, faces, cell));
        }
    }
}

fn viscous_skew(grid: &Grid, face: &Face, gradients: &[Vec<Vec3>; 3]) -> Vec3 {
    Vec3::from_fn(|axis, _| displacement(grid, face, &gradients[axis]))
}
