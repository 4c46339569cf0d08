//! Enthalpy of the gas, with exactly the fluxes and masses of continuity, per cell:
//!
//! (m h − m_old h_old)/Δτ + Σ φ_f h_f − Σ (εκ)_f ∇T·S + Σ Σ_k h_k J_k·S
//!     = heat_source − heat_coefficient · T + ε V (p₀ − p₀_old)/Δτ + H − Σ_k D_k h_k(T) + m q
//!
//! with the enthalpy H of gas that particles set free and the gas D_k that they take at the cell's temperature,
//! h_k linear in T like T in h (below), and the heat q of the gas' own reactions (chemistry.rs).
//! Implicit Euler, h_f upwind, what a second-order value has beyond it and the enthalpy that diffusing
//! species carry explicitly from the last iterate (species.rs); T linear in h: T = θ + h/c_p, θ = T* − h*/c_p. Because
//! m + Δτ Σ φ_f = m_old, the matrix keeps a uniform temperature uniform whatever the flow does,
//! and energy closes to the linear tolerance whatever the outer loop does. p₀ is the base pressure
//! (it changes in a closed domain alone).

use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{Convection, Turbulence};

use super::attempt::{AttemptFrame, CellProperties};
use super::boundary::{FaceCondition, HeatCondition};
use super::chemistry::ReactionSource;
use super::inflow;
use super::state::GasState;
use super::tolerance::ScalarTolerance;
use crate::numerics::convection::{ConvectedScalar, beyond_upwind, bounds};
use crate::numerics::krylov::{Krylov, SolveTolerance};
use crate::numerics::matrix::Matrix;
use crate::numerics::operators::{conductance, displacement, follow, gradients, interpolate};
use crate::numerics::parallel::{fill, sum, sums, update};
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// Share of the terms of a cell's equation that is round-off of their sum.
const ROUND_OFF: f64 = 2e-15;

/// Iterations of a solve at most.
const ITERATIONS: u32 = 1000;

/// The enthalpy equation.
#[derive(Debug)]
pub struct Enthalpy {
    matrix: Matrix,
    source: Vec<f64>,
    /// What reactions of the gas add.
    pub reactions: ReactionSource,
    /// Thermal conductance of each face in W/K; on the boundary to what `outer` says.
    conduction: Vec<f64>,
    /// θ of each cell in K.
    base: Vec<f64>,
    /// c_p of each cell in J/kg/K.
    heat_capacity: Vec<f64>,
    /// Enthalpy that leaves the owner of each face in W, of what the equation takes explicitly.
    explicit: Vec<f64>,
    /// Heat from particles to each cell as source − coefficient · T in W and W/K, with that of the gas that
    /// they give and take.
    given: [Vec<f64>; 2],
    preconditioner: Incomplete,
    /// Gradients of h and T, from the last iterate.
    gradients: [Vec<Vec3>; 2],
    bounds: Vec<[f64; 2]>,
    /// True where they are of the enthalpy at hand: of a single gas nothing but a solve changes it in an attempt.
    hold: bool,
    faces: Vec<f64>,
    /// What the last solve took and gave.
    pub taken: EnthalpyFlows,
}

/// What the equation, as it was solved, took and gave.
#[derive(Clone, Debug, Default)]
pub struct EnthalpyFlows {
    /// Heat from the particles to each cell in W.
    pub heat: Vec<f64>,
    /// Flow of enthalpy into the domain in W through each patch of the mesh, and the sum of its magnitudes over the faces.
    pub patches: Vec<[f64; 2]>,
    /// Σ ε V (p₀ − p₀_old)/Δτ in W.
    pub compression: f64,
}

/// What a boundary face exchanges heat with: its temperature in K, where it has one.
#[inline]
fn outer(frame: &AttemptFrame<'_>, index: usize) -> Option<f64> {
    match *frame.boundary.at(index) {
        FaceCondition::Inlet { gas, .. } => Some(gas.temperature),
        FaceCondition::Wall { heat, .. } => match heat {
            HeatCondition::Temperature(temperature) => Some(temperature),
            HeatCondition::Convective { ambient, .. } => Some(ambient),
            HeatCondition::Adiabatic | HeatCondition::Flux(_) => None,
        },
        FaceCondition::Outlet { .. } => None,
    }
}

/// Enthalpy of the gas that flows in through a boundary face in J/kg, where it is stated.
#[inline]
fn inlet(frame: &AttemptFrame<'_>, index: usize) -> Option<f64> {
    let gas = frame.boundary.at(index).entering()?;
    Some(gas.enthalpy)
}

/// Heat that flows in through a boundary face whatever the gas does, in W.
#[inline]
fn imposed(frame: &AttemptFrame<'_>, index: usize) -> f64 {
    match *frame.boundary.at(index) {
        FaceCondition::Wall {
            heat: HeatCondition::Flux(flux),
            ..
        } => flux * frame.grid.faces[index].area,
        _ => 0.0,
    }
}

/// Thermal conductance of a face in W/K; zero where no heat is conducted.
#[inline]
fn conduction(
    frame: &AttemptFrame<'_>,
    material: &CellProperties,
    now: &GasState,
    index: usize,
) -> f64 {
    let face = &frame.grid.faces[index];
    if index < frame.grid.internal {
        return conductance(face, interpolate(face, &material.conductivity));
    }
    let pores = frame.void_fraction[face.owner];
    let eddies = frame.heat_eddies_at(index);
    match *frame.boundary.at(index) {
        FaceCondition::Inlet { gas, .. } => inflow::conduction(frame, index, &gas),
        FaceCondition::Wall { heat, .. } => match heat {
            HeatCondition::Temperature(temperature) => {
                let composition = now.composition_of(face.owner, frame.species());
                let gas = frame.properties;
                let conductivity = gas.conductivity(temperature, composition);
                let carried = if eddies > 0.0 {
                    eddies * gas.heat_capacity(temperature, composition)
                } else {
                    0.0
                };
                conductance(face, pores * conductivity + carried)
            }
            // The half cell and the wall in series.
            HeatCondition::Convective { coefficient, .. } if coefficient > 0.0 => {
                let gas = face.distance() / at_wall(frame, material, index, face.owner);
                face.area / (1.0 / coefficient + gas)
            }
            HeatCondition::Convective { .. }
            | HeatCondition::Adiabatic
            | HeatCondition::Flux(_) => 0.0,
        },
        FaceCondition::Outlet { .. } => 0.0,
    }
}

/// Void fraction × conductivity of the gas at a wall in W/m/K, with the eddies there in place of the cell's.
#[inline]
fn at_wall(frame: &AttemptFrame<'_>, material: &CellProperties, index: usize, cell: usize) -> f64 {
    let Turbulence::KEpsilon { prandtl, .. } = frame.turbulence else {
        return material.conductivity[cell];
    };
    let more = frame.heat_eddies_at(index) - frame.old.turbulence.viscosity[cell] / prandtl;
    material.conductivity[cell] + material.heat_capacity[cell] * more
}

impl Enthalpy {
    /// An empty equation on a matrix's graph.
    pub fn new(matrix: Matrix) -> Self {
        let (cells, faces) = (matrix.grid().cells(), matrix.grid().faces.len());
        Self {
            matrix,
            source: vec![0.0; cells],
            reactions: ReactionSource::default(),
            conduction: vec![0.0; faces],
            base: vec![0.0; cells],
            heat_capacity: vec![0.0; cells],
            explicit: vec![0.0; faces],
            given: [vec![0.0; cells], vec![0.0; cells]],
            preconditioner: Incomplete::default(),
            gradients: [vec![Vec3::zeros(); cells], vec![Vec3::zeros(); cells]],
            bounds: vec![[0.0; 2]; cells],
            hold: false,
            faces: vec![0.0; faces],
            taken: EnthalpyFlows::default(),
        }
    }

    /// Matrix and right side in W as assembled.
    pub fn equation(&self) -> (&Matrix, &[f64]) {
        (&self.matrix, &self.source)
    }

    /// Takes up another state.
    pub fn begin(&mut self) {
        self.hold = false;
    }

    /// Assembles the equation; `carried` is the enthalpy that species carry out of the owner of each face in W
    /// beyond the upwind enthalpy (empty for a single gas). Of what is
    /// explicit a share follows the fields.
    pub fn assemble(
        &mut self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        carried: &[f64],
        share: f64,
        now: &GasState,
    ) {
        let grid = frame.grid;
        self.heat_capacity.clone_from(&material.heat_capacity);
        let heat_capacity = &self.heat_capacity;
        fill(&mut self.base, |cell| {
            now.temperature[cell] - now.enthalpy[cell] / heat_capacity[cell]
        });
        fill(&mut self.conduction, |index| {
            conduction(frame, material, now, index)
        });
        self.update_explicit(frame, carried, share, now);
        self.update_given(frame, now);
        let (conduction, heat_capacity) = (&self.conduction, &self.heat_capacity);
        let [_, coefficient] = &self.given;
        self.matrix.assemble(|cell, diagonal, neighbours| {
            let own = heat_capacity[cell];
            *diagonal = frame.old.mass[cell] / frame.storage_span
                + frame.mass_source(now, cell)
                + coefficient[cell] / own;
            for link in grid.links(cell) {
                let index = link.face as usize;
                let inflow = (-link.sign * now.flux[index]).max(0.0);
                let conducted = conduction[index];
                if inflow == 0.0 && conducted == 0.0 {
                    continue;
                }
                *diagonal += conducted / own;
                if !link.is_boundary() {
                    *diagonal += inflow;
                    neighbours[link.slot as usize] -=
                        inflow + conducted / heat_capacity[link.other as usize];
                } else if inlet(frame, index).is_some() {
                    *diagonal += inflow;
                }
            }
        });
        let compression = (now.base_pressure - frame.old.base_pressure) / frame.storage_span;
        let (base, explicit) = (&self.base, &self.explicit);
        let [given, coefficient] = &self.given;
        let reactions = &self.reactions;
        fill(&mut self.source, |cell| {
            let mut source =
                frame.old.heat(cell) / frame.storage_span + given[cell] + reactions.gain(cell)
                    - coefficient[cell] * base[cell]
                    + compression * frame.void_fraction[cell] * grid.volume[cell];
            for link in grid.links(cell) {
                let index = link.face as usize;
                if link.is_boundary() {
                    if let Some(temperature) = outer(frame, index) {
                        source += conduction[index] * (temperature - base[cell]);
                    }
                    if let Some(enthalpy) = inlet(frame, index) {
                        source += (-link.sign * now.flux[index]).max(0.0) * enthalpy;
                    }
                    source += imposed(frame, index);
                } else {
                    source -= conduction[index] * (base[cell] - base[link.other as usize]);
                }
                source -= link.sign * explicit[index];
            }
            source
        });
    }

    fn update_given(&mut self, frame: &AttemptFrame<'_>, now: &GasState) {
        let exchange = frame.exchange;
        let [given, coefficient] = &mut self.given;
        given.clone_from(&exchange.heat_source);
        coefficient.clone_from(&exchange.heat_coefficient);
        let species = &exchange.species;
        if species.is_none() {
            return;
        }
        let count = frame.species();
        let gas = frame.properties;
        update(given, |cell, heat| {
            let temperature = now.temperature[cell];
            let sum = |k: usize| {
                let slope = gas.species_heat_capacity(k, temperature);
                let beyond = gas.species_enthalpy(k, temperature) - slope * temperature;
                species.taken[cell * count + k] * beyond
            };
            *heat += species.heat[cell] - (0..count).map(sum).sum::<f64>();
        });
        update(coefficient, |cell, slope| {
            let temperature = now.temperature[cell];
            let one = |k: usize| {
                species.taken[cell * count + k] * gas.species_heat_capacity(k, temperature)
            };
            *slope += (0..count).map(one).sum::<f64>();
        });
    }

    fn update_explicit(
        &mut self,
        frame: &AttemptFrame<'_>,
        species: &[f64],
        share: f64,
        now: &GasState,
    ) {
        let grid = frame.grid;
        let second = frame.convection != Convection::Upwind && species.is_empty();
        if !self.hold {
            self.update_gradients(frame, second, now);
            self.hold = frame.species() == 0;
        }
        let [carried, conducted] = &self.gradients;
        let conduction = &self.conduction;
        let field = ConvectedScalar {
            values: &now.enthalpy,
            gradients: carried,
            bounds: &self.bounds,
        };
        let explicit = |index: usize| {
            let mut out = species.get(index).copied().unwrap_or(0.0);
            let flux = now.flux[index];
            if second && index < grid.internal && flux != 0.0 {
                out += flux * beyond_upwind(frame.convection, grid, index, flux, field);
            }
            if !grid.orthogonal && conduction[index] != 0.0 {
                out += conduction[index] * displacement(grid, &grid.faces[index], conducted);
            }
            out
        };
        update(&mut self.explicit, |index, last| {
            follow(last, explicit(index), share)
        });
    }

    fn update_gradients(&mut self, frame: &AttemptFrame<'_>, second: bool, now: &GasState) {
        let grid = frame.grid;
        if second {
            let boundary = |index: usize, inner: f64| match *frame.boundary.at(index) {
                FaceCondition::Wall {
                    heat: HeatCondition::Temperature(temperature),
                    ..
                } => Some(frame.properties.enthalpy(
                    temperature,
                    now.composition_of(grid.faces[index].owner, frame.species()),
                )),
                _ => inflow::face_heat(frame, index, inner, |gas| gas.enthalpy),
            };
            let (found, faces) = (&mut self.gradients[0], &mut self.faces);
            gradients(grid, &now.enthalpy, boundary, found, faces);
            if frame.convection.limits() {
                bounds(grid, &now.enthalpy, boundary, &mut self.bounds);
            }
        }
        if !grid.orthogonal {
            let boundary = |index: usize, inner: f64| match *frame.boundary.at(index) {
                FaceCondition::Wall {
                    heat: HeatCondition::Temperature(temperature),
                    ..
                } => Some(temperature),
                _ => inflow::face_heat(frame, index, inner, |gas| gas.temperature),
            };
            let (found, faces) = (&mut self.gradients[1], &mut self.faces);
            gradients(grid, &now.temperature, boundary, found, faces);
        }
    }

    /// Σ over cells of the equation's residual, relative to the cells' heat contents (from 0 K).
    pub fn residual(&self, now: &GasState) -> f64 {
        let [error, content] = sums(now.enthalpy.len(), |cell| {
            let error = self.source[cell] - self.matrix.row_times(cell, &now.enthalpy);
            let capacity = self.matrix.diagonal()[cell] * self.heat_capacity[cell];
            [error.abs(), capacity * now.temperature[cell]]
        });
        error / content
    }

    /// Solves for the enthalpy; returns the iterations.
    pub fn solve(
        &mut self,
        frame: &AttemptFrame<'_>,
        krylov: &mut Krylov,
        goal: ScalarTolerance,
        now: &mut GasState,
    ) -> u32 {
        let target = SolveTolerance {
            absolute: goal.absolute * self.throughput(frame, now),
            of_terms: 0.0,
            relative: goal.relative,
            iterations: ITERATIONS,
        };
        self.preconditioner.expire();
        self.hold = false;
        let solved = krylov.general(
            &self.matrix,
            &mut self.preconditioner,
            &self.source,
            &mut now.enthalpy,
            target,
        );
        let species = frame.species();
        let GasState {
            temperature,
            enthalpy,
            composition,
            ..
        } = now;
        update(temperature, |cell, temperature| {
            let composition = &composition[cell * species..(cell + 1) * species];
            *temperature = frame
                .properties
                .temperature(enthalpy[cell], composition, *temperature);
        });
        solved.iterations
    }

    /// Gives each cell what flows and particles brought it beyond m h: what the solve of the equation at hand left of it. So the energy that cells
    /// hold is what came and went to round-off, however closely the equation is solved; the next window begins with it.
    pub fn carry_remainder(&mut self, frame: &AttemptFrame<'_>, now: &mut GasState) {
        self.record(frame, now);
        let enthalpy = &now.enthalpy;
        fill(&mut now.heat_remainder, |cell| {
            let left = self.source[cell] - self.matrix.row_times(cell, enthalpy);
            // Carried over, round-off of a content that hardly changes would add up.
            match left.abs() > ROUND_OFF * self.matrix.diagonal()[cell] * enthalpy[cell].abs() {
                true => frame.storage_span * left,
                false => 0.0,
            }
        });
    }

    /// Heat from the particles to a cell in W, as the equation takes it.
    #[inline]
    fn heat(&self, now: &GasState, cell: usize) -> f64 {
        let temperature = self.base[cell] + now.enthalpy[cell] / self.heat_capacity[cell];
        self.given[0][cell] - self.given[1][cell] * temperature
    }

    /// Energy that moves, in W: through the boundary, from the particles, into storage.
    fn throughput(&self, frame: &AttemptFrame<'_>, now: &GasState) -> f64 {
        let internal = frame.grid.internal;
        let boundary = sum(frame.grid.faces.len() - internal, |face| {
            let index = internal + face;
            let inner = now.enthalpy[frame.grid.faces[index].owner];
            let carried = match inlet(frame, index) {
                Some(stated) if now.flux[index] < 0.0 => now.flux[index] * stated,
                _ => now.flux[index] * inner,
            };
            carried.abs() + imposed(frame, index).abs()
        });
        let cells = sum(now.mass.len(), |cell| {
            let stored = now.mass[cell] * now.enthalpy[cell]
                - frame.old.mass[cell] * frame.old.enthalpy[cell];
            stored.abs() / frame.storage_span + self.heat(now, cell).abs()
        });
        boundary + cells
    }

    /// Flow of enthalpy into the domain through a boundary face in W, conduction included.
    fn inflow(&self, frame: &AttemptFrame<'_>, now: &GasState, index: usize) -> f64 {
        let cell = frame.grid.faces[index].owner;
        let inner = now.enthalpy[cell];
        let flux = now.flux[index];
        let carried = match inlet(frame, index) {
            Some(enthalpy) if flux < 0.0 => enthalpy,
            _ => inner,
        };
        let temperature = self.base[cell] + inner / self.heat_capacity[cell];
        let conducted =
            outer(frame, index).map_or(0.0, |outer| self.conduction[index] * (outer - temperature));
        imposed(frame, index) + conducted - flux * carried - self.explicit[index]
    }

    fn record(&mut self, frame: &AttemptFrame<'_>, now: &GasState) {
        let grid = frame.grid;
        let mut taken = std::mem::take(&mut self.taken);
        taken.heat.resize(grid.cells(), 0.0);
        fill(&mut taken.heat, |cell| self.heat(now, cell));
        let inflow = |face| self.inflow(frame, now, face);
        taken.patches = frame.boundary.flows_by_patch(inflow);
        let rise = (now.base_pressure - frame.old.base_pressure) / frame.storage_span;
        let pores = |cell: usize| frame.void_fraction[cell] * grid.volume[cell];
        taken.compression = if rise == 0.0 {
            0.0
        } else {
            rise * sum(grid.cells(), pores)
        };
        self.taken = taken;
    }
}
