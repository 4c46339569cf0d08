//! Reactions of the gas with itself (requirements CHM-1, TSM-10), in species and enthalpy alike:
//!
//! w_k = (R_k(Y, T; Δt) − Y_k)/Δt,   q = −Σ_k h°_k w_k,
//!
//! per kg of gas, with what a closed adiabatic reactor of constant pressure makes of the cell's gas over the motion
//! span, R, and the enthalpies of formation h°: the gas' own enthalpy is the sensible one.
//!
//! Where the gas stores over the motion span (AF = 1, or `accelerated` storage) the window takes the rates of its
//! start once, and its first half is the reactor itself: what reacts is there, whatever the rates.
//!
//! Where it stores over a longer span Δτ, such a source would take more than there is. Then the equations with
//! the rates of their own end are iterated in pseudo-steps of Δt (dual time stepping),
//!
//! m (Y − Y°)/Δt + (m Y − m_old Y_old)/Δτ + transport = m w(Y°),
//!
//! whose right side with m Y°/Δt is m R(Y°)/Δt, not negative. A converged window, and so a steady flame, has the same w
//! at any Δτ: its place does not depend on AF. After the last pseudo-step the equations are solved once more without
//! it, with m (R′ − Y)/Δt in place of m w, which is what that step took in all, R′ being R(Y°) with the elements of the new Y:
//! so energy and every element close whatever the iteration did, and no cell gives what it does not have.

use calcine_coupler::gas_chemistry::ReactingGas;
use calcine_coupler::physics::kinetics::elements::Elements;
use calcine_coupler::physics::kinetics::{self, Reactor};
use calcine_coupler::physics::thermo::mixture::MOST_SPECIES;
use rayon::prelude::*;

use super::attempt::{Frame, Material};
use super::state::State;
use super::stirring::reacting_share;
use crate::numerics::parallel::{fill, largest};

/// Cells that a thread takes at a time: a reactor costs some ten to hundred microseconds.
const GRAIN: usize = 16;
/// A span is longer than the motion span beyond this share: less is round-off of clocks.
const LONGER: f64 = 1e-6;

/// What reactions add to an equation of a quantity x per kg of gas: gain + inertia (x° − x).
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// In the unit of x times kg/s, in the order of the values.
    gain: Vec<f64>,
    /// That of a pseudo-step in kg/s, cell by cell; empty outside pseudo-steps.
    inertia: Vec<f64>,
    /// x° in the order of the values; empty outside pseudo-steps.
    before: Vec<f64>,
}

impl Source {
    /// What reactions give to a value, without the pseudo-step; zero where nothing reacts.
    #[inline]
    pub fn gain(&self, at: usize) -> f64 {
        self.gain.get(at).copied().unwrap_or(0.0)
    }

    /// Inertia of the pseudo-step of a cell in kg/s.
    #[inline]
    pub fn inertia(&self, cell: usize) -> f64 {
        self.inertia.get(cell).copied().unwrap_or(0.0)
    }

    /// All that does not depend on the new value, at `at` of a cell.
    #[inline]
    pub fn explicit(&self, cell: usize, at: usize) -> f64 {
        match self.inertia.get(cell) {
            Some(inertia) => self.gain[at] + inertia * self.before[at],
            None => self.gain(at),
        }
    }

    /// True where nothing reacts.
    pub fn is_none(&self) -> bool {
        self.gain.is_empty()
    }
}

/// The rates of all cells.
#[derive(Debug, Default)]
pub struct Chemistry {
    /// w of the fields last evaluated in 1/s, species by species within each cell.
    rates: Vec<f64>,
    /// R of the start of the last pseudo-step, likewise.
    reached: Vec<f64>,
    /// Enthalpies of formation in J/kg.
    formation: Vec<f64>,
    /// True while the rates are those of the fields at hand.
    fresh: bool,
    /// Largest change by the last pseudo-step: of a mass fraction, or of an enthalpy over c_p T.
    pub change: f64,
}

/// Whether the window's reactions take pseudo-steps.
pub fn is_dual(frame: &Frame<'_>) -> bool {
    frame.chemistry.reacting().is_some() && frame.storage_span > (1.0 + LONGER) * frame.motion_span
}

impl Chemistry {
    /// Takes up the start of an attempt.
    pub fn begin(&mut self, frame: &Frame<'_>) -> Result<(), String> {
        self.fresh = false;
        self.change = 0.0;
        let Some(gas) = frame.chemistry.reacting() else {
            return Ok(());
        };
        let species = frame.species();
        let formation = |k| frame.properties.formation_enthalpy(k);
        self.formation = (0..species).map(formation).collect();
        if is_dual(frame) {
            self.change = f64::INFINITY;
            return Ok(());
        }
        self.evaluate(frame, gas, frame.old)
    }

    /// The fields have changed.
    pub fn spoil(&mut self) {
        self.fresh = false;
    }

    /// Follows the fields, where a window's reactions take pseudo-steps.
    pub fn follow(&mut self, frame: &Frame<'_>, now: &State) -> Result<(), String> {
        match frame.chemistry.reacting() {
            Some(gas) if is_dual(frame) && !self.fresh => self.evaluate(frame, gas, now),
            _ => Ok(()),
        }
    }

    fn evaluate(&mut self, frame: &Frame<'_>, gas: &ReactingGas, at: &State) -> Result<(), String> {
        let species = frame.species();
        let span = frame.motion_span;
        self.rates.resize(frame.grid.cells() * species, 0.0);
        let new = || Reactor::new(&gas.mechanism, gas.tolerances);
        let one = |reactor: &mut Reactor, cell: usize, rates: &mut [f64]| {
            let mut before = [0.0; MOST_SPECIES];
            let before = &mut before[..species];
            before.copy_from_slice(at.composition_of(cell, species));
            valid(before);
            let mut after = [0.0; MOST_SPECIES];
            let after = &mut after[..species];
            after.copy_from_slice(before);
            let mut temperature = at.temperature[cell];
            let pressure = at.base_pressure;
            let state = kinetics::State {
                pressure,
                temperature,
                fractions: before,
            };
            let share = reacting_share(frame, gas, cell, state);
            let reacted = reactor.advance(pressure, &mut temperature, after, span);
            for (rate, (after, before)) in rates.iter_mut().zip(after.iter().zip(before.iter())) {
                *rate = share * (after - before) / span;
            }
            reacted.map(|_| ()).map_err(|error| {
                let place = frame.grid.centre[cell];
                format!(
                    "the reactions of the gas in cell {cell} at ({:.6}, {:.6}, {:.6}) m: {error}",
                    place.x, place.y, place.z
                )
            })
        };
        let failed: Vec<String> = self
            .rates
            .par_chunks_mut(GRAIN * species)
            .enumerate()
            .map_init(new, |reactor, (k, rates)| {
                let mut cells = rates.chunks_mut(species).enumerate();
                cells.try_for_each(|(i, rates)| one(reactor, k * GRAIN + i, rates))
            })
            .filter_map(Result::err)
            .collect();
        self.fresh = true;
        match failed.into_iter().next() {
            Some(words) => Err(words),
            None => Ok(()),
        }
    }

    /// Sets what the equations of species and enthalpy take, with the pseudo-step or without.
    pub fn apply(
        &self,
        frame: &Frame<'_>,
        material: &Material,
        pseudo: bool,
        now: &State,
        [composition, enthalpy]: [&mut Source; 2],
    ) {
        if frame.chemistry.reacting().is_none() {
            return;
        }
        let (cells, species) = (frame.grid.cells(), frame.species());
        let dual = is_dual(frame);
        // In an early iterate the masses of continuity may be no masses of a gas.
        let mass = |cell: usize| match dual {
            true => material.density[cell] * frame.void_fraction[cell] * frame.grid.volume[cell],
            false => frame.old.mass[cell],
        };
        composition.gain.resize(cells * species, 0.0);
        fill(&mut composition.gain, |at| {
            let cell = at / species;
            mass(cell) * self.rates[at]
        });
        self.heat(species, &composition.gain, &mut enthalpy.gain);
        for (source, values) in [(composition, &now.composition), (enthalpy, &now.enthalpy)] {
            source.inertia.clear();
            source.before.clear();
            if pseudo {
                let inertia = |cell| mass(cell) / frame.motion_span;
                source.inertia.extend((0..cells).map(inertia));
                source.before.extend_from_slice(values);
            }
        }
    }

    /// Heat of what is made, in W.
    fn heat(&self, species: usize, made: &[f64], heat: &mut Vec<f64>) {
        heat.resize(made.len() / species, 0.0);
        fill(heat, |cell| {
            let own = self.formation.iter().zip(&made[cell * species..]);
            -own.map(|(formation, made)| formation * made).sum::<f64>()
        });
    }

    /// Sets what the equations take at the end of the iteration.
    pub fn conclude(
        &self,
        frame: &Frame<'_>,
        gas: &ReactingGas,
        now: &State,
        [composition, enthalpy]: [&mut Source; 2],
    ) {
        let species = frame.species();
        let elements = Elements::new(gas.mechanism.mixture());
        for (cell, inertia) in composition.inertia.iter().enumerate() {
            let here = now.composition_of(cell, species);
            let own = cell * species..(cell + 1) * species;
            let mut reached = [0.0; MOST_SPECIES];
            let reached = &mut reached[..species];
            reached.copy_from_slice(&self.reached[own.clone()]);
            elements.restore(&elements.of(here), reached);
            let gain = &mut composition.gain[own];
            for (gain, (after, before)) in gain.iter_mut().zip(reached.iter().zip(here)) {
                *gain = inertia * (after - before);
            }
        }
        self.heat(species, &composition.gain, &mut enthalpy.gain);
        for source in [composition, enthalpy] {
            source.inertia.clear();
            source.before.clear();
        }
    }

    /// Books what the pseudo-step changed, and what its reactors reached.
    pub fn measure(
        &mut self,
        frame: &Frame<'_>,
        [composition, enthalpy]: [&Source; 2],
        heat: &[f64],
        now: &State,
    ) {
        self.reached.resize(self.rates.len(), 0.0);
        let rates = &self.rates;
        fill(&mut self.reached, |at| {
            composition.before[at] + rates[at] * frame.motion_span
        });
        let fractions = |at: usize| (now.composition[at] - composition.before[at]).abs();
        let warmth = |cell: usize| {
            let content = heat[cell] * now.temperature[cell];
            (now.enthalpy[cell] - enthalpy.before[cell]).abs() / content
        };
        let (_, changed) = largest(now.composition.len(), fractions);
        let (_, warmed) = largest(now.enthalpy.len(), warmth);
        self.change = changed.max(warmed);
    }
}

/// Makes fractions of what iteration leaves: none below zero, their sum one.
fn valid(fractions: &mut [f64]) {
    fractions.iter_mut().for_each(|y| *y = y.max(0.0));
    let sum: f64 = fractions.iter().sum();
    fractions.iter_mut().for_each(|y| *y /= sum);
}
