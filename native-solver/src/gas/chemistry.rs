//! Reactions of the gas with itself by balanced splitting (docs/theory.md, CHM-2), in species and enthalpy alike.
//!
//! The equation of each species, with what reactions make of it as M_k, is per cell
//!
//! m_old (Y − Y_old)/Δτ + D′ Y = b′ + M,
//!
//! D′ Y what leaves the cell with its own gas and by diffusion from it, b′ what enters, the neighbours' share included. M is
//! what a stirred reactor makes in the mean of the window, which starts with the cell's old gas and into which b′ flows:
//!
//! dY/dt = w(Y, T) + (b′ − D′ Y)/m,   M = ∫ m w dt/Δτ,   m = m_old (1 + θ (ρ/ρ_old − 1)),
//!
//! θ = F/(m_old/Δτ + F), F what flows in and comes from particles, as flow fills a cell whose gas contracts and carries away
//! what expands, which diffusion does not; and the same with the enthalpy, whose source is −Σ_k h°_k M_k with the enthalpies of
//! formation h° as the gas' own enthalpy is the sensible one. So a steady cell is a stirred reactor at any span and storage, a
//! cell without flow a closed one, whatever diffuses between cells, what a cell reaches of several states is what the reactor
//! reaches from the window's start, and no cell gives what it does not have. M is free of every element to round-off.
//!
//! b′ is found by nonlinear Gauss–Seidel iteration: cells are visited downstream ([`order`]), each with the newest
//! gas of those above it.

mod equations;
mod newton;
mod order;

use calcine_coupler::gas_chemistry::ReactingGas;
use calcine_coupler::physics::kinetics::elements::Elements;
use calcine_coupler::physics::kinetics::{MixtureState, Reactor, ReactorWorkspace, Throughflow};
use calcine_coupler::physics::thermo::mixture::MOST_SPECIES;
use rayon::prelude::*;

pub use self::equations::ScalarEquations;
use self::newton::NewtonStep;
use self::order::DownstreamOrder;
use super::attempt::AttemptFrame;
use super::failure::{GasFailure, Place};
use super::state::GasState;
use super::stirring::mixing_time;
use crate::numerics::matrix::Matrix;
use crate::numerics::parallel::{fill, largest};

/// Cells that a thread takes at a time at least: a reactor costs some ten to hundred microseconds.
const GRAIN: usize = 4;
/// What the elements of a cell may be off by at the end of a correction, as a share of its gas.
const ELEMENTS_KEPT: f64 = 1e-14;
/// Share of what leaves a cell that is round-off of what diffuses through it.
const ROUND_OFF: f64 = 1e-12;
/// A reactor is not run again while what enters has changed by less than this share of the outer tolerance.
const SAME: f64 = 0.1;

/// What reactions add to an equation.
#[derive(Clone, Debug, Default)]
pub struct ReactionSource {
    /// In the unit of the equation's value times kg/s, in the order of the values; empty where nothing reacts.
    gain: Vec<f64>,
}

impl ReactionSource {
    /// What reactions give to a value; zero where nothing reacts.
    #[inline]
    pub fn gain(&self, at: usize) -> f64 {
        self.gain.get(at).copied().unwrap_or(0.0)
    }

    /// True where nothing reacts.
    pub fn is_none(&self) -> bool {
        self.gain.is_empty()
    }
}

/// What reactions make in all cells.
#[derive(Debug, Default)]
pub struct CellChemistry {
    /// M in kg/s, species by species within each cell.
    made: Vec<f64>,
    /// What cells were last run with: for each the gas that would be there without reactions, its enthalpy and the
    /// diagonals of both equations; empty before the first run.
    seen: Vec<f64>,
    order: DownstreamOrder,
    /// Enthalpies of formation in J/kg.
    formation: Vec<f64>,
    elements: Option<Elements>,
    /// Values at the start of the last iteration.
    before: [Vec<f64>; 2],
    newton: NewtonStep,
    /// Largest c_p T of the window's start in J/kg, the unit of enthalpies.
    unit: f64,
    /// Largest change by the last iteration: of a mass fraction, or of an enthalpy over c_p T.
    pub change: f64,
}

/// A cell at the end of its reactor's window.
struct CellEnd {
    fractions: [f64; MOST_SPECIES],
    made: [f64; MOST_SPECIES],
    enthalpy: f64,
    temperature: f64,
    seen: [f64; MOST_SPECIES + 3],
    /// What would be there without reactions.
    inert: [f64; MOST_SPECIES + 1],
    /// How it follows that; of a cell that was run.
    response: Option<Vec<f64>>,
}

impl CellChemistry {
    /// Takes up the start of an attempt, which may continue the one before.
    pub fn begin(&mut self, frame: &AttemptFrame<'_>, continues: bool) {
        self.change = 0.0;
        let Some(gas) = frame.chemistry.reacting() else {
            return;
        };
        self.change = f64::INFINITY;
        if continues {
            return;
        }
        let formation = |k| frame.properties.formation_enthalpy(k);
        self.formation = (0..frame.species()).map(formation).collect();
        self.elements = Some(Elements::new(gas.mechanism.mixture()));
        let heat = |cell: usize| {
            let (old, species) = (frame.old, frame.species());
            let temperature = old.temperature[cell];
            let composition = old.composition_of(cell, species);
            temperature * frame.properties.heat_capacity(temperature, composition)
        };
        self.unit = largest(frame.grid.cells(), heat).1;
        self.newton.begin(frame.grid.cells(), frame.species() + 1);
        self.made.clear();
        self.made.resize(frame.grid.cells() * frame.species(), 0.0);
        self.seen.clear();
    }

    /// What no reaction changes, where something reacts.
    pub fn elements(&self) -> Option<&Elements> {
        self.elements.as_ref()
    }

    /// Takes up the start of an iteration.
    pub fn start(&mut self, now: &GasState) {
        self.before[0].clone_from(&now.composition);
        self.before[1].clone_from(&now.enthalpy);
    }

    /// Follows the fluxes.
    pub fn follow(&mut self, frame: &AttemptFrame<'_>, now: &GasState) {
        self.order.update(frame.grid, &now.flux);
    }

    /// Runs the reactors of all cells downstream; the fields become what they reach. What enters a cell and changes by
    /// less than a share of the tolerance counts as the same.
    pub fn sweep(
        &mut self,
        frame: &AttemptFrame<'_>,
        gas: &ReactingGas,
        equations: ScalarEquations<'_>,
        tolerance: f64,
        now: &mut GasState,
    ) -> Result<(), GasFailure> {
        let species = frame.species();
        let width = species + 3;
        let reactor = Reactor::new(&gas.mechanism, gas.tolerances);
        let known = !self.seen.is_empty();
        self.seen.resize(frame.grid.cells() * width, f64::NAN);
        for level in self.order.levels() {
            let run = |workspace: &mut ReactorWorkspace, &cell: &u32| {
                let cell = cell as usize;
                let seen = known.then(|| &self.seen[cell * width..(cell + 1) * width]);
                let made = &self.made[cell * species..(cell + 1) * species];
                let cell_run = CellRun {
                    frame,
                    gas,
                    reactor: &reactor,
                    equations,
                    formation: &self.formation,
                    unit: self.unit,
                    same: SAME * tolerance,
                };
                cell_run.run(workspace, cell, seen, made, now)
            };
            let ends: Result<Vec<CellEnd>, GasFailure> = if level.len() < 2 * GRAIN {
                let mut workspace = ReactorWorkspace::default();
                level.iter().map(|cell| run(&mut workspace, cell)).collect()
            } else {
                let cells = level.par_iter().with_min_len(GRAIN);
                cells.map_init(ReactorWorkspace::default, run).collect()
            };
            for (&cell, end) in level.iter().zip(ends?) {
                let cell = cell as usize;
                let own = cell * species..(cell + 1) * species;
                now.composition[own.clone()].copy_from_slice(&end.fractions[..species]);
                now.enthalpy[cell] = end.enthalpy;
                now.temperature[cell] = end.temperature;
                self.made[own].copy_from_slice(&end.made[..species]);
                self.seen[cell * width..(cell + 1) * width].copy_from_slice(&end.seen[..width]);
                self.newton.note(cell, &end.inert[..=species], end.response);
            }
        }
        Ok(())
    }

    /// How far the fields are from those at the start of the iteration.
    pub fn measure(&mut self, heat_capacity: &[f64], now: &GasState) {
        let [composition, enthalpy] = &self.before;
        let fractions = |at: usize| (now.composition[at] - composition[at]).abs();
        let warmth = |cell: usize| {
            let content = heat_capacity[cell] * now.temperature[cell];
            (now.enthalpy[cell] - enthalpy[cell]).abs() / content
        };
        let (_, changed) = largest(now.composition.len(), fractions);
        let (_, warmed) = largest(now.enthalpy.len(), warmth);
        self.change = changed.max(warmed);
    }

    /// Goes on from what the sweep found by a Newton step of all cells.
    pub fn correct(
        &mut self,
        frame: &AttemptFrame<'_>,
        equations: ScalarEquations<'_>,
        now: &mut GasState,
    ) {
        self.newton
            .correct(frame, equations, self.order.cells(), self.unit, now);
    }

    /// Sets what the equations of species and enthalpy take.
    pub fn apply(
        &self,
        frame: &AttemptFrame<'_>,
        [composition, enthalpy]: [&mut ReactionSource; 2],
    ) {
        if frame.chemistry.reacting().is_none() {
            return;
        }
        composition.gain.clone_from(&self.made);
        *enthalpy = self.source_of(frame.species(), &self.made);
    }

    /// Takes what the last solve left below zero out of what is made, in the cells that react and where it begins, the elements
    /// kept; whether there was any.
    pub fn keep_positive(&mut self, matrix: &Matrix, now: &GasState) -> bool {
        let Some(elements) = &self.elements else {
            return false;
        };
        let species = self.formation.len();
        let mut any = false;
        for (cell, made) in self.made.chunks_mut(species).enumerate() {
            let mut own = [0.0; MOST_SPECIES];
            let own = &mut own[..species];
            own.copy_from_slice(now.composition_of(cell, species));
            // Fractions that transport itself leaves below zero stay.
            let below = |(y, made): (&f64, &f64)| *y < 0.0 && *made < 0.0;
            if !own.iter().zip(made.iter()).any(below) {
                continue;
            }
            // What comes in below zero begins elsewhere.
            let diagonal = matrix.diagonal()[cell];
            let (columns, values) = matrix.row(cell);
            for (&other, value) in columns.iter().zip(values) {
                let beside = now.composition_of(other as usize, species);
                for (own, y) in own.iter_mut().zip(beside) {
                    *own += value / diagonal * y.min(0.0);
                }
            }
            if !own.iter().any(|y| *y < 0.0) {
                continue;
            }
            let mut positive = [0.0; MOST_SPECIES];
            let positive = &mut positive[..species];
            positive.copy_from_slice(own);
            // Elements of which there is less than nothing no species can give back.
            if elements.restore(&elements.of(own), positive) > ELEMENTS_KEPT {
                continue;
            }
            any = true;
            for (made, (after, before)) in made.iter_mut().zip(positive.iter().zip(own.iter())) {
                *made += diagonal * (after - before);
            }
        }
        any
    }

    /// Source of the enthalpy by what is made of each species in kg/s.
    pub fn source_of(&self, species: usize, made: &[f64]) -> ReactionSource {
        let mut source = ReactionSource::default();
        source.gain.resize(made.len() / species, 0.0);
        fill(&mut source.gain, |cell| {
            let own = self.formation.iter().zip(&made[cell * species..]);
            -own.map(|(formation, made)| formation * made).sum::<f64>()
        });
        source
    }
}

/// What the run of a cell's reactor looks at.
struct CellRun<'a> {
    frame: &'a AttemptFrame<'a>,
    gas: &'a ReactingGas,
    reactor: &'a Reactor,
    equations: ScalarEquations<'a>,
    formation: &'a [f64],
    unit: f64,
    same: f64,
}

impl CellRun<'_> {
    fn run(
        &self,
        workspace: &mut ReactorWorkspace,
        cell: usize,
        seen: Option<&[f64]>,
        made: &[f64],
        now: &GasState,
    ) -> Result<CellEnd, GasFailure> {
        let (frame, species) = (self.frame, self.frame.species());
        let old = frame.old;
        let storage = old.mass[cell] / frame.storage_span;
        let mut diagonal = [0.0; MOST_SPECIES];
        let mut given = [0.0; MOST_SPECIES];
        let (matrix, exchange) = (self.equations.species, &frame.exchange.species);
        given[..species].copy_from_slice(&self.equations.sources[cell * species..][..species]);
        let (columns, values) = matrix.row(cell);
        for (&other, value) in columns.iter().zip(values) {
            let beside = now.composition_of(other as usize, species);
            for (given, y) in given.iter_mut().zip(beside) {
                *given -= value * y;
            }
        }
        for k in 0..species {
            diagonal[k] = matrix.diagonal()[cell];
            if !exchange.is_none() {
                let own = &exchange.coefficient[cell * species..][..species];
                diagonal[k] += own[k] - own[0];
            }
        }
        let (columns, values) = self.equations.enthalpy.row(cell);
        let beside = columns.iter().zip(values);
        let heat = beside.fold(self.equations.heat[cell], |sum, (&other, value)| {
            sum - value * now.enthalpy[other as usize]
        });
        let warmth = self.equations.enthalpy.diagonal()[cell];

        let mut end = CellEnd {
            fractions: [0.0; MOST_SPECIES],
            made: [0.0; MOST_SPECIES],
            enthalpy: 0.0,
            temperature: 0.0,
            seen: [0.0; MOST_SPECIES + 3],
            inert: [0.0; MOST_SPECIES + 1],
            response: None,
        };
        for k in 0..species {
            end.seen[k] = given[k] / diagonal[k];
        }
        end.seen[species] = heat / warmth;
        end.inert[..=species].copy_from_slice(&end.seen[..=species]);
        end.seen[species + 1] = diagonal[0];
        end.seen[species + 2] = warmth;
        let content = now.temperature[cell]
            * frame
                .properties
                .heat_capacity(now.temperature[cell], now.composition_of(cell, species));
        let (mut entering, mut leaving) = ([0.0; MOST_SPECIES], [0.0; MOST_SPECIES]);
        let start = old.composition_of(cell, species);
        let split = |diagonal: f64, given: f64, start: f64| {
            let out = diagonal - storage;
            let held = 1.0 / old.mass[cell];
            // An early iterate's fluxes may fill a cell; what leaves is then none.
            ((given - storage * start) * held, out.max(0.0) * held)
        };
        for k in 0..species {
            (entering[k], leaving[k]) = split(diagonal[k], given[k], start[k]);
        }
        let (heat_entering, heat_leaving) = split(warmth, heat, old.enthalpy[cell]);
        let flow = Throughflow {
            entering: &entering[..species],
            leaving: &leaving[..species],
            heat_entering,
            heat_leaving,
            opening: self.opening(cell, storage, leaving[0] * old.mass[cell]),
            mixing: mixing_time(frame, self.gas, cell),
        };
        let mut steps = 0;
        let fresh = !seen.is_some_and(|seen| self.is_same(seen, &end.seen[..species + 3], content));
        if fresh {
            let mut fractions = [0.0; MOST_SPECIES];
            let fractions = &mut fractions[..species];
            fractions.copy_from_slice(start);
            valid(fractions);
            let state = MixtureState {
                pressure: now.base_pressure,
                temperature: old.temperature[cell],
                fractions,
            };
            let made = &mut end.made[..species];
            let run = self
                .reactor
                .flow_through(workspace, state, &flow, frame.storage_span, made)
                .map_err(|cause| GasFailure::Reactions {
                    place: Place {
                        cell,
                        centre: frame.grid.centre[cell],
                    },
                    cause,
                })?;
            for (k, made) in made.iter_mut().enumerate() {
                *made *= storage + leaving[k] * old.mass[cell];
            }
            steps = run.steps;
        } else {
            end.made[..species].copy_from_slice(made);
            if let Some(seen) = seen {
                end.seen[..species + 3].copy_from_slice(seen);
            }
        }
        let mut released = 0.0;
        for k in 0..species {
            end.fractions[k] = (given[k] + end.made[k]) / diagonal[k];
            released -= self.formation[k] * end.made[k];
        }
        end.enthalpy = (heat + released) / warmth;
        end.temperature = frame.properties.temperature(
            end.enthalpy,
            &end.fractions[..species],
            now.temperature[cell],
        );
        if fresh {
            end.response = Some(if steps == 0 || end.temperature.is_nan() {
                Vec::new()
            } else {
                let state = MixtureState {
                    pressure: now.base_pressure,
                    temperature: end.temperature,
                    fractions: &end.fractions[..species],
                };
                let span = frame.storage_span;
                let begun =
                    frame
                        .properties
                        .density(now.base_pressure, old.temperature[cell], start);
                self.reactor
                    .response(workspace, (begun, state), &flow, span, self.unit)
            });
        }
        Ok(end)
    }

    /// θ of a cell whose gas is stored by `storage` and leaves, diffusion included, by `leaving`, in kg/s.
    fn opening(&self, cell: usize, storage: f64, leaving: f64) -> f64 {
        let links = self.frame.grid.links(cell).iter();
        let diffused: f64 = links
            .map(|link| (link, link.face as usize))
            .filter(|(link, face)| {
                !link.is_boundary() || self.frame.boundary.composition(*face).is_some()
            })
            .map(|(_, face)| self.equations.diffusion[face])
            .sum();
        let flows = (leaving - diffused).max(0.0);
        // Of what diffuses much faster, round-off is no flow.
        match flows > ROUND_OFF * leaving {
            true => flows / (storage + flows),
            false => 0.0,
        }
    }

    /// Whether a cell would be run as it was, with c_p T in J/kg.
    fn is_same(&self, seen: &[f64], now: &[f64], content: f64) -> bool {
        let species = seen.len() - 3;
        let near = |at: usize, scale: f64| (seen[at] - now[at]).abs() <= self.same * scale;
        (0..species).all(|k| near(k, 1.0))
            && near(species, content)
            && near(species + 1, seen[species + 1])
            && near(species + 2, seen[species + 2])
    }
}

/// Makes fractions of what iteration leaves: none below zero, their sum one.
fn valid(fractions: &mut [f64]) {
    fractions.iter_mut().for_each(|y| *y = y.max(0.0));
    let sum: f64 = fractions.iter().sum();
    fractions.iter_mut().for_each(|y| *y /= sum);
}
