//! Enthalpy of the gas, with exactly the fluxes and masses of continuity, per cell:
//!
//! (m h − m_old h_old)/Δτ + Σ φ_f h_f − Σ (εκ)_f ∇T·S = heat_source − heat_coefficient · T(h)
//!
//! Implicit Euler, first-order upwind h_f, T linear in h: T = T* + (h − h*)/c_p. Because
//! m + Δτ Σ φ_f = m_old, the matrix keeps a uniform temperature uniform whatever the flow does,
//! and energy closes to the linear tolerance whatever the outer loop does.

use calcine_coupler::physics::Vec3;

use super::attempt::{Frame, Material};
use super::boundary::{BoundaryGas, Value};
use super::state::State;
use crate::numerics::krylov::{Krylov, Target};
use crate::numerics::matrix::Matrix;
use crate::numerics::operators::{conductance, displacement, face_values, gradient, interpolate};
use crate::numerics::parallel::{fill, sum, sums};
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// Iterations of a solve at most.
const ITERATIONS: u32 = 1000;

/// The enthalpy equation.
#[derive(Debug)]
pub struct Enthalpy {
    matrix: Matrix,
    source: Vec<f64>,
    /// Conductance of each face for enthalpy differences in kg/s.
    conduction: Vec<f64>,
    preconditioner: Incomplete,
    /// Gradient of h for the correction of skewed faces, from the last iterate.
    gradients: Vec<Vec3>,
    face_enthalpy: Vec<f64>,
}

/// The gas at a boundary face where its temperature is given.
#[inline]
fn given(frame: &Frame<'_>, index: usize) -> Option<BoundaryGas> {
    match frame.boundary.at(index) {
        Value::Inlet { gas, .. } => Some(gas),
        Value::Wall { gas, .. } => gas,
        Value::Outlet { .. } => None,
    }
}

impl Enthalpy {
    /// An empty equation on a matrix's graph.
    pub fn new(matrix: Matrix) -> Self {
        let (cells, faces) = (matrix.grid().cells(), matrix.grid().faces.len());
        Self {
            matrix,
            conduction: vec![0.0; faces],
            source: vec![0.0; cells],
            preconditioner: Incomplete::default(),
            gradients: Vec::new(),
            face_enthalpy: Vec::new(),
        }
    }

    /// What conducts through a face because its centres are displaced along it, in W, out of the
    /// owner.
    fn skewed(&self, frame: &Frame<'_>, index: usize) -> f64 {
        if frame.grid.orthogonal {
            return 0.0;
        }
        self.conduction[index] * displacement(frame.grid, &frame.grid.faces[index], &self.gradients)
    }

    /// Assembles the equation.
    pub fn assemble(&mut self, frame: &Frame<'_>, material: &Material, now: &State) {
        let grid = frame.grid;
        if !grid.orthogonal {
            self.update_gradients(frame, &now.enthalpy);
        }
        fill(&mut self.conduction, |index| {
            conduction(frame, material, index)
        });
        let conduction = &self.conduction;
        let heat_capacity = frame.properties.heat_capacity;
        self.matrix.assemble(|cell, diagonal, neighbours| {
            *diagonal = frame.old.mass[cell] / frame.storage_span
                + frame.exchange.heat_coefficient[cell] / heat_capacity;
            for link in grid.links(cell) {
                let index = link.face as usize;
                let inflow = (-link.sign * now.flux[index]).max(0.0);
                let weight = inflow + conduction[index];
                if weight == 0.0 {
                    continue;
                }
                if !link.is_boundary() {
                    neighbours[link.slot as usize] -= weight;
                    *diagonal += weight;
                } else if given(frame, index).is_some() {
                    *diagonal += weight;
                }
            }
        });
        let mut source = std::mem::take(&mut self.source);
        fill(&mut source, |cell| {
            let fixed = now.temperature[cell] - now.enthalpy[cell] / heat_capacity;
            let mut source = frame.old.mass[cell] * frame.old.enthalpy[cell] / frame.storage_span
                + frame.exchange.heat_source[cell]
                - frame.exchange.heat_coefficient[cell] * fixed;
            for link in grid.links(cell) {
                let index = link.face as usize;
                if link.is_boundary()
                    && let Some(gas) = given(frame, index)
                {
                    let inflow = (-link.sign * now.flux[index]).max(0.0);
                    let weight = inflow + self.conduction[index];
                    source += weight * gas.enthalpy;
                }
                source -= link.sign * self.skewed(frame, index);
            }
            source
        });
        self.source = source;
    }

    /// Σ over cells of the equation's residual, relative to the cells' heat contents (from 0 K).
    pub fn residual(&self, frame: &Frame<'_>, now: &State) -> f64 {
        let heat_capacity = frame.properties.heat_capacity;
        let [error, content] = sums(now.enthalpy.len(), |cell| {
            let error = self.source[cell] - self.matrix.row_times(cell, &now.enthalpy);
            let content = self.matrix.diagonal()[cell] * heat_capacity * now.temperature[cell];
            [error.abs(), content]
        });
        error / content
    }

    /// Solves for the enthalpy, to a tolerance relative to the energy that moves; returns the
    /// iterations.
    pub fn solve(
        &mut self,
        frame: &Frame<'_>,
        krylov: &mut Krylov,
        tolerance: f64,
        now: &mut State,
    ) -> u32 {
        let target = Target {
            absolute: tolerance * self.throughput(frame, now),
            of_terms: 0.0,
            relative: 0.0,
            iterations: ITERATIONS,
        };
        self.preconditioner.update(&self.matrix);
        let solved = krylov.general(
            &self.matrix,
            &mut self.preconditioner,
            &self.source,
            &mut now.enthalpy,
            target,
        );
        let enthalpy = &now.enthalpy;
        fill(&mut now.temperature, |cell| {
            frame.properties.temperature(enthalpy[cell])
        });
        solved.iterations
    }

    /// Energy that moves, in W: through the boundary, from the particles, into storage.
    fn throughput(&self, frame: &Frame<'_>, now: &State) -> f64 {
        let boundary: f64 = frame
            .boundary
            .patches()
            .flat_map(|(faces, _)| faces)
            .map(|index| {
                let inner = now.enthalpy[frame.grid.faces[index].owner];
                let enthalpy = given(frame, index).map_or(inner, |gas| gas.enthalpy);
                (now.flux[index] * enthalpy).abs()
            })
            .sum();
        let cells = sum(now.mass.len(), |cell| {
            let stored = now.mass[cell] * now.enthalpy[cell]
                - frame.old.mass[cell] * frame.old.enthalpy[cell];
            stored.abs() / frame.storage_span + heat(frame, now, cell).abs()
        });
        boundary + cells
    }

    /// Flow of enthalpy into the domain through a boundary face in W, conduction included.
    pub fn inflow(&self, frame: &Frame<'_>, now: &State, index: usize) -> f64 {
        let inner = now.enthalpy[frame.grid.faces[index].owner];
        let flux = now.flux[index];
        let Some(gas) = given(frame, index) else {
            return -flux * inner;
        };
        let carried = if flux < 0.0 { gas.enthalpy } else { inner };
        let conducted = self.conduction[index] * (gas.enthalpy - inner);
        -flux * carried + conducted - self.skewed(frame, index)
    }

    fn update_gradients(&mut self, frame: &Frame<'_>, enthalpy: &[f64]) {
        let grid = frame.grid;
        self.gradients.resize(grid.cells(), Vec3::zeros());
        self.face_enthalpy.resize(grid.faces.len(), 0.0);
        let boundary =
            |index: usize, inner: f64| given(frame, index).map_or(inner, |gas| gas.enthalpy);
        face_values(
            grid,
            enthalpy,
            &self.gradients,
            boundary,
            &mut self.face_enthalpy,
        );
        let faces = &self.face_enthalpy;
        fill(&mut self.gradients, |cell| gradient(grid, faces, cell));
    }
}

/// Conductance of a face for enthalpy differences in kg/s; zero where no heat is conducted.
#[inline]
fn conduction(frame: &Frame<'_>, material: &Material, index: usize) -> f64 {
    let face = &frame.grid.faces[index];
    let conductivity = if index < frame.grid.internal {
        interpolate(face, &material.conductivity)
    } else {
        match given(frame, index) {
            Some(gas) => frame.void_fraction[face.owner] * gas.conductivity,
            None => return 0.0,
        }
    };
    conductance(face, conductivity) / frame.properties.heat_capacity
}

/// Heat from the particles to a cell in W, as the equation takes it.
#[inline]
pub fn heat(frame: &Frame<'_>, now: &State, cell: usize) -> f64 {
    frame.exchange.heat_source[cell] - frame.exchange.heat_coefficient[cell] * now.temperature[cell]
}
