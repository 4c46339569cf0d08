//! Species of the gas, as mass fractions Y_k, with exactly the fluxes and masses of continuity, per cell:
//!
//! (m Y − m_old Y_old)/Δτ + Σ φ_f Y_f − Σ (εμ/Sc + μ_t/Sc_t)_f ∇Y·S = S − C Y + m w
//!
//! with what particles give and take, S − C Y (continuity has their sum), and what reactions make (chemistry.rs),
//! (docs/theory.md, SPC-1; all species diffuse alike, so that Fick's fluxes sum to zero). Implicit Euler,
//! Y_f upwind, what a second-order value has beyond it explicitly from the last iterate, with one limiter
//! for all species, so that the fractions go on summing to one. The last species is what the others leave. What the linear solver
//! leaves of an equation the next window begins with (balances.rs).

mod balances;
mod conserved;

use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::Convection;

use super::attempt::{AttemptFrame, CellProperties};
use super::boundary::{FaceCondition, HeatCondition};
use super::chemistry::ReactionSource;
use super::inflow;
use super::state::GasState;
use super::tolerance::{Assembled, ScalarTolerance};
use crate::numerics::convection::{ConvectedScalar, beyond_upwind, bounds, limited, limiter};
use crate::numerics::krylov::{Krylov, SolveTolerance};
use crate::numerics::matrix::Matrix;
use crate::numerics::operators::{conductance, displacement, follow, gradients, interpolate};
use crate::numerics::parallel::{fill, sums, update};
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// Iterations of a solve at most.
const ITERATIONS: u32 = 1000;

/// The equations of all species, which share one matrix.
#[derive(Debug)]
pub struct SpeciesEquations {
    matrix: Matrix,
    preconditioner: Incomplete,
    /// Diffusive conductance of each face in kg/s.
    diffusion: Vec<f64>,
    /// Mass fractions of the iterate, species by species: one list of cells each.
    fractions: Vec<Vec<f64>>,
    gradients: Vec<Vec<Vec3>>,
    bounds: Vec<Vec<[f64; 2]>>,
    limiters: Vec<f64>,
    faces: Vec<f64>,
    /// Flow of each species out of the owner of each face in kg/s, of what is taken explicitly.
    explicit: Vec<Vec<f64>>,
    source: Vec<f64>,
    /// What reactions of the gas add.
    pub reactions: ReactionSource,
    /// Enthalpy that species carry out of the owner of each face in W beyond what the upwind cell's enthalpy
    /// does: by diffusion, Σ_k h_k J_k, and by second-order convection, φ (h(T_f, Y_f) − h_up). The latter
    /// follows temperature and fractions at the face apart: a limited enthalpy would heat gas where
    /// compositions mix at one temperature.
    pub carried: Vec<f64>,
    temperature_gradients: Vec<Vec3>,
    temperature_bounds: Vec<[f64; 2]>,
    /// Flow of each species into the domain in kg/s through each patch of the mesh and the sum of its magnitudes over the faces, as
    /// the last solve took them.
    pub patches: Vec<Vec<[f64; 2]>>,
}

impl SpeciesEquations {
    /// Empty equations on a matrix's graph.
    pub fn new(matrix: Matrix) -> Self {
        Self {
            matrix,
            preconditioner: Incomplete::default(),
            diffusion: Vec::new(),
            fractions: Vec::new(),
            gradients: Vec::new(),
            bounds: Vec::new(),
            limiters: Vec::new(),
            faces: Vec::new(),
            explicit: Vec::new(),
            source: Vec::new(),
            reactions: ReactionSource::default(),
            carried: Vec::new(),
            temperature_gradients: Vec::new(),
            temperature_bounds: Vec::new(),
            patches: Vec::new(),
        }
    }

    /// Takes up the start of an attempt; what earlier attempts left is forgotten.
    pub fn begin(&mut self, frame: &AttemptFrame<'_>) {
        let (cells, faces) = (frame.grid.cells(), frame.grid.faces.len());
        let species = frame.species();
        if species == 0 {
            return;
        }
        self.fractions.resize(species, vec![0.0; cells]);
        self.gradients.resize(species, vec![Vec3::zeros(); cells]);
        self.bounds.resize(species, vec![[0.0; 2]; cells]);
        self.explicit.resize(species, vec![0.0; faces]);
        self.diffusion.resize(faces, 0.0);
        self.limiters.resize(faces, 0.0);
        self.faces.resize(faces, 0.0);
        self.source.resize(cells, 0.0);
        self.carried.resize(faces, 0.0);
        fill(&mut self.carried, |_| 0.0);
        for (k, fractions) in self.fractions.iter_mut().enumerate() {
            fill(fractions, |cell| frame.old.composition[cell * species + k]);
        }
        self.temperature_gradients.resize(cells, Vec3::zeros());
        self.temperature_bounds.resize(cells, [0.0; 2]);
        for gradients in &mut self.gradients {
            fill(gradients, |_| Vec3::zeros());
        }
        fill(&mut self.temperature_gradients, |_| Vec3::zeros());
    }

    /// Solves the equations, assembled anew where they are not those at hand; returns the linear iterations.
    pub fn solve(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        krylov: &mut Krylov,
        (goal, share, assembled): (ScalarTolerance, f64, Assembled),
        now: &mut GasState,
    ) -> u32 {
        let species = frame.species();
        if species == 0 {
            return 0;
        }
        let own = !frame.exchange.species.is_none();
        if assembled == Assembled::No {
            self.update_diffusion(frame, material);
            self.update_explicit(frame, share, now);
        }
        if assembled == Assembled::No || own {
            self.assemble(frame, now, 0);
        }
        self.preconditioner.expire();
        let mut iterations = 0;
        for k in 0..species - 1 {
            if own && k > 0 {
                self.assemble(frame, now, k);
                self.preconditioner.expire();
            }
            self.fill_source(frame, now, k);
            let target = SolveTolerance {
                absolute: goal.absolute * self.throughput(frame, now, k),
                of_terms: 0.0,
                relative: goal.relative,
                iterations: ITERATIONS,
            };
            let solved = krylov.general(
                &self.matrix,
                &mut self.preconditioner,
                &self.source,
                &mut self.fractions[k],
                target,
            );
            iterations += solved.iterations;
        }
        if let Some((last, others)) = self.fractions.split_last_mut() {
            fill(last, |cell| {
                1.0 - others.iter().map(|list| list[cell]).sum::<f64>()
            });
        }
        let fractions = &self.fractions;
        update(&mut now.composition, |i, fraction| {
            *fraction = fractions[i % species][i / species];
        });
        self.record(frame, now);
        self.update_carried(frame, now);
        iterations
    }

    /// Largest change of a mass fraction that the equations at hand still ask for: their residual
    /// relative to what the cells hold and what flows through them,.
    pub fn residual(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        share: f64,
        now: &GasState,
    ) -> f64 {
        if frame.species() == 0 {
            return 0.0;
        }
        self.update_diffusion(frame, material);
        self.assemble(frame, now, 0);
        self.update_explicit(frame, share, now);
        let own = !frame.exchange.species.is_none();
        let mut worst: f64 = 0.0;
        for k in 0..frame.species() - 1 {
            if own && k > 0 {
                self.assemble(frame, now, k);
            }
            self.fill_source(frame, now, k);
            let [error, content] = sums(now.mass.len(), |cell| {
                let error = self.source[cell] - self.matrix.row_times(cell, &self.fractions[k]);
                [error.abs(), self.matrix.diagonal()[cell]]
            });
            worst = worst.max(error / content);
        }
        worst
    }

    fn update_diffusion(&mut self, frame: &AttemptFrame<'_>, material: &CellProperties) {
        let grid = frame.grid;
        fill(&mut self.diffusion, |index| {
            let face = &grid.faces[index];
            if index < grid.internal {
                return conductance(face, interpolate(face, &material.diffusivity));
            }
            inflow::diffusion(frame, index)
        });
    }

    /// The matrix of a species; that of all of them where no particle exchanges gas.
    fn assemble(&mut self, frame: &AttemptFrame<'_>, now: &GasState, k: usize) {
        let (grid, species) = (frame.grid, frame.species());
        let diffusion = &self.diffusion;
        let given = &frame.exchange.species;
        self.matrix.assemble(|cell, diagonal, neighbours| {
            *diagonal = frame.old.mass[cell] / frame.storage_span;
            if !given.is_none() {
                *diagonal += frame.mass_source(now, cell) + given.coefficient[cell * species + k];
            }
            for link in grid.links(cell) {
                let index = link.face as usize;
                let inflow = (-link.sign * now.flux[index]).max(0.0);
                let weight = inflow + diffusion[index];
                if !link.is_boundary() {
                    neighbours[link.slot as usize] -= weight;
                    *diagonal += weight;
                } else if frame.boundary.composition(index).is_some() {
                    *diagonal += weight;
                }
            }
        });
    }

    fn update_explicit(&mut self, frame: &AttemptFrame<'_>, share: f64, now: &GasState) {
        let grid = frame.grid;
        let second = frame.convection != Convection::Upwind;
        if second || !grid.orthogonal {
            for (k, fractions) in self.fractions.iter().enumerate() {
                let boundary =
                    |index: usize, inner: f64| inflow::face_fraction(frame, index, k, inner);
                let found = &mut self.gradients[k];
                gradients(grid, fractions, boundary, found, &mut self.faces);
                if second {
                    bounds(grid, fractions, boundary, &mut self.bounds[k]);
                }
            }
        }
        let (fractions, gradients, bounds) = (&self.fractions, &self.gradients, &self.bounds);
        let limiting = |index: usize| {
            if !second || index >= grid.internal {
                return 0.0;
            }
            // The last species is what the others leave, their solvers' errors included.
            let last = fractions.len() - 1;
            let one = |k: usize| {
                let noise = if k == last { frame.tolerance } else { 0.0 };
                let field = ConvectedScalar {
                    values: &fractions[k],
                    gradients: &gradients[k],
                    bounds: &bounds[k],
                };
                limiter(grid, index, now.flux[index], field, noise)
            };
            (0..fractions.len()).map(one).fold(2.0, f64::min)
        };
        update(&mut self.limiters, |index, last| {
            follow(last, limiting(index), share)
        });
        let (limiters, diffusion) = (&self.limiters, &self.diffusion);
        for (k, explicit) in self.explicit.iter_mut().enumerate() {
            fill(explicit, |index| {
                let flux = now.flux[index];
                let mut out = 0.0;
                if limiters[index] > 0.0 && flux != 0.0 {
                    out += flux * limited(grid, index, flux, &fractions[k], limiters[index]);
                }
                if !grid.orthogonal && diffusion[index] != 0.0 {
                    let face = &grid.faces[index];
                    out += diffusion[index] * displacement(grid, face, &gradients[k]);
                }
                out
            });
        }
    }

    fn fill_source(&mut self, frame: &AttemptFrame<'_>, now: &GasState, k: usize) {
        let (grid, species) = (frame.grid, frame.species());
        let (diffusion, explicit) = (&self.diffusion, &self.explicit[k]);
        let reactions = &self.reactions;
        fill(&mut self.source, |cell| {
            let mut source = frame.old.content(cell, cell * species + k) / frame.storage_span
                + reactions.gain(cell * species + k);
            if let Some(given) = frame.exchange.species.source.get(cell * species + k) {
                source += given;
            }
            for link in grid.links(cell) {
                let index = link.face as usize;
                if link.is_boundary()
                    && let Some(composition) = frame.boundary.composition(index)
                {
                    let inflow = (-link.sign * now.flux[index]).max(0.0);
                    source += (inflow + diffusion[index]) * composition[k];
                }
                source -= link.sign * explicit[index];
            }
            source
        });
    }

    /// Mass of a species that moves, in kg/s: through the boundary and into storage.
    fn throughput(&self, frame: &AttemptFrame<'_>, now: &GasState, k: usize) -> f64 {
        let internal = frame.grid.internal;
        let boundary = sums(frame.grid.faces.len() - internal, |face| {
            [now.flux[internal + face].abs()]
        })[0];
        let species = frame.species();
        let stored = sums(now.mass.len(), |cell| {
            let old = frame.old.content(cell, cell * species + k);
            [(now.mass[cell] * self.fractions[k][cell] - old).abs()]
        })[0];
        let given = &frame.exchange.species.source;
        let exchanged = given.iter().skip(k).step_by(species);
        boundary + stored / frame.storage_span + exchanged.map(|flow| flow.abs()).sum::<f64>()
    }

    /// Sets `carried`, h_k at the face's temperature.
    fn update_carried(&mut self, frame: &AttemptFrame<'_>, now: &GasState) {
        let grid = frame.grid;
        let second = frame.convection != Convection::Upwind;
        let given = |index: usize| match *frame.boundary.at(index) {
            FaceCondition::Inlet { gas, .. } => Some(gas.temperature),
            FaceCondition::Wall { .. } | FaceCondition::Outlet { .. } => None,
        };
        if second {
            let boundary = |index: usize, inner: f64| match *frame.boundary.at(index) {
                FaceCondition::Wall {
                    heat: HeatCondition::Temperature(temperature),
                    ..
                } => Some(temperature),
                _ => inflow::face_heat(frame, index, inner, |gas| gas.temperature),
            };
            let (found, faces) = (&mut self.temperature_gradients, &mut self.faces);
            gradients(grid, &now.temperature, boundary, found, faces);
            if frame.convection.limits() {
                let found = &mut self.temperature_bounds;
                bounds(grid, &now.temperature, boundary, found);
            }
        }
        let mut carried = std::mem::take(&mut self.carried);
        fill(&mut carried, |index| {
            let inner = index < grid.internal;
            let temperature = if inner {
                interpolate(&grid.faces[index], &now.temperature)
            } else if let Some(temperature) = given(index) {
                temperature
            } else {
                return 0.0;
            };
            let convected = if inner && second {
                self.convected(frame, now, index)
            } else {
                0.0
            };
            convected + self.diffused(frame, index, temperature)
        });
        self.carried = carried;
    }

    /// Σ_k h_k J_k of a face in W, out of its owner, at a temperature in K.
    fn diffused(&self, frame: &AttemptFrame<'_>, index: usize, temperature: f64) -> f64 {
        let face = &frame.grid.faces[index];
        let given = (index >= frame.grid.internal)
            .then(|| frame.boundary.composition(index))
            .flatten();
        let one = |k: usize| {
            let outer = given.map_or_else(|| self.fractions[k][face.neighbour], |y| y[k]);
            let fall = self.fractions[k][face.owner] - outer;
            let flow =
                self.diffusion[index] * (fall + displacement(frame.grid, face, &self.gradients[k]));
            flow * frame.properties.species_enthalpy(k, temperature)
        };
        (0..self.fractions.len()).map(one).sum()
    }

    /// φ (h(T_f, Y_f) − h(T_up, Y_up)) of an internal face in W, out of its owner.
    fn convected(&self, frame: &AttemptFrame<'_>, now: &GasState, index: usize) -> f64 {
        let (grid, flux) = (frame.grid, now.flux[index]);
        if flux == 0.0 {
            return 0.0;
        }
        let face = &grid.faces[index];
        let up = if flux > 0.0 {
            face.owner
        } else {
            face.neighbour
        };
        let before = now.temperature[up];
        let field = ConvectedScalar {
            values: &now.temperature,
            gradients: &self.temperature_gradients,
            bounds: &self.temperature_bounds,
        };
        let temperature = before + beyond_upwind(frame.convection, grid, index, flux, field);
        let one = |k: usize| {
            let fraction = self.fractions[k][up];
            let more = limited(grid, index, flux, &self.fractions[k], self.limiters[index]);
            (fraction + more) * frame.properties.species_enthalpy(k, temperature)
                - fraction * frame.properties.species_enthalpy(k, before)
        };
        flux * (0..self.fractions.len()).map(one).sum::<f64>()
    }
}
