//! Reactions of the gas with itself (docs/theory.md, CHM-1, TSM-10), in species and enthalpy alike:
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
//! the rates of their own end are iterated in pseudo-steps δ (dual time stepping),
//!
//! m (Y − Y°)/δ + (m Y − m_old Y_old)/Δτ + transport = m w(Y°),   w = (R(Y°, T°; δ) − Y°)/δ,
//!
//! whose right side with m Y°/δ is m R(Y°)/δ, not negative. A converged window, and so a steady flame, has the same w
//! at any Δτ: its place does not depend on AF. After the last pseudo-step the equations are solved once more without
//! it, with m (R′ − Y)/δ in place of m w, which is what that step took in all, R′ being R(Y°) with the elements of the new Y:
//! so energy and every element close whatever the iteration did, and no cell gives what it does not have.
//!
//! δ is Δt, or a quarter of the time in which the gas that leaves a cell empties it where that is shorter: over a Δt in which the gas
//! passes many cells mean rates would spread a flame over all of them. What reacts at once is then used up to a fifth in the
//! cell that it comes into, to a twenty-fifth in the next.

use calcine_coupler::gas_chemistry::ReactingGas;
use calcine_coupler::physics::kinetics::elements::Elements;
use calcine_coupler::physics::kinetics::{self, Reactor, ReactorWorkspace};
use calcine_coupler::physics::thermo::mixture::MOST_SPECIES;
use rayon::prelude::*;

use super::attempt::{AttemptFrame, CellProperties};
use super::failure::{GasFailure, Place};
use super::state::GasState;
use super::stirring::reacting_share;
use crate::numerics::parallel::{fill, largest};

/// A pseudo-step is no longer than this share of the time in which the gas that leaves a cell empties it.
const RESIDENCE: f64 = 0.25;
/// Cells that a thread takes at a time: a reactor costs some ten to hundred microseconds.
const GRAIN: usize = 16;
/// A span is longer than the motion span beyond this share: less is round-off of clocks.
const LONGER: f64 = 1e-6;

/// What reactions add to an equation of a quantity x per kg of gas: gain + inertia (x° − x).
#[derive(Clone, Debug, Default)]
pub struct ReactionSource {
    /// In the unit of x times kg/s, in the order of the values.
    gain: Vec<f64>,
    /// That of a pseudo-step in kg/s, cell by cell; empty outside pseudo-steps.
    inertia: Vec<f64>,
    /// x° in the order of the values; empty outside pseudo-steps.
    before: Vec<f64>,
}

impl ReactionSource {
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
pub struct CellChemistry {
    /// w of the fields last evaluated in 1/s, species by species within each cell.
    rates: Vec<f64>,
    /// Spans over which they are, cell by cell, in s.
    spans: Vec<f64>,
    /// R of the start of the last pseudo-step, in the order of the rates.
    reached: Vec<f64>,
    /// Inertia of the last pseudo-step of each cell in kg/s.
    inertia: Vec<f64>,
    /// Enthalpies of formation in J/kg.
    formation: Vec<f64>,
    /// What no reaction changes; where something reacts.
    elements: Option<Elements>,
    /// True while the rates are those of the fields at hand.
    fresh: bool,
    /// Largest change by the last pseudo-step: of a mass fraction, or of an enthalpy over c_p T.
    pub change: f64,
}

/// Whether the window's reactions take pseudo-steps.
pub fn is_dual(frame: &AttemptFrame<'_>) -> bool {
    frame.chemistry.reacting().is_some() && frame.storage_span > (1.0 + LONGER) * frame.motion_span
}

impl CellChemistry {
    /// Takes up the start of an attempt, which may continue the one before: rates of the window's start are the
    /// same in all its attempts.
    pub fn begin(&mut self, frame: &AttemptFrame<'_>, continues: bool) -> Result<(), GasFailure> {
        self.fresh = false;
        self.change = 0.0;
        let Some(gas) = frame.chemistry.reacting() else {
            return Ok(());
        };
        if !continues {
            let formation = |k| frame.properties.formation_enthalpy(k);
            self.formation = (0..frame.species()).map(formation).collect();
            self.elements = Some(Elements::new(gas.mechanism.mixture()));
        }
        if is_dual(frame) {
            self.change = f64::INFINITY;
            return Ok(());
        }
        if continues {
            return Ok(());
        }
        self.evaluate(frame, gas, frame.old)
    }

    /// The fields have changed.
    pub fn spoil(&mut self) {
        self.fresh = false;
    }

    /// Follows the fields, where a window's reactions take pseudo-steps.
    pub fn follow(&mut self, frame: &AttemptFrame<'_>, now: &GasState) -> Result<(), GasFailure> {
        match frame.chemistry.reacting() {
            Some(gas) if is_dual(frame) && !self.fresh => self.evaluate(frame, gas, now),
            _ => Ok(()),
        }
    }

    fn evaluate(
        &mut self,
        frame: &AttemptFrame<'_>,
        gas: &ReactingGas,
        at: &GasState,
    ) -> Result<(), GasFailure> {
        let species = frame.species();
        let dual = is_dual(frame);
        self.spans.resize(frame.grid.cells(), 0.0);
        fill(&mut self.spans, |cell| match dual {
            true => pseudo_step(frame, at, cell),
            false => frame.motion_span,
        });
        let spans = &self.spans;
        self.rates.resize(frame.grid.cells() * species, 0.0);
        let reactor = Reactor::new(&gas.mechanism, gas.tolerances);
        let one = |cell: usize, rates: &mut [f64], workspace: &mut ReactorWorkspace| {
            let mut before = [0.0; MOST_SPECIES];
            let before = &mut before[..species];
            before.copy_from_slice(at.composition_of(cell, species));
            valid(before);
            let mut after = [0.0; MOST_SPECIES];
            let after = &mut after[..species];
            after.copy_from_slice(before);
            let mut temperature = at.temperature[cell];
            let pressure = at.base_pressure;
            let state = kinetics::MixtureState {
                pressure,
                temperature,
                fractions: before,
            };
            let share = reacting_share(frame, gas, cell, state);
            let span = spans[cell];
            let reacted = reactor.advance_in(workspace, pressure, &mut temperature, after, span);
            for (rate, (after, before)) in rates.iter_mut().zip(after.iter().zip(before.iter())) {
                *rate = share * (after - before) / span;
            }
            reacted.map(|_| ()).map_err(|cause| GasFailure::Reactions {
                place: Place {
                    cell,
                    centre: frame.grid.centre[cell],
                },
                cause,
            })
        };
        let failed: Vec<GasFailure> = self
            .rates
            .par_chunks_mut(GRAIN * species)
            .enumerate()
            .map_init(ReactorWorkspace::default, |workspace, (k, rates)| {
                let mut cells = rates.chunks_mut(species).enumerate();
                cells.try_for_each(|(i, rates)| one(k * GRAIN + i, rates, workspace))
            })
            .filter_map(Result::err)
            .collect();
        self.fresh = true;
        match failed.into_iter().next() {
            Some(failure) => Err(failure),
            None => Ok(()),
        }
    }

    /// Sets what the equations of species and enthalpy take, with the pseudo-step or without.
    pub fn apply(
        &self,
        frame: &AttemptFrame<'_>,
        material: &CellProperties,
        pseudo: bool,
        now: &GasState,
        [composition, enthalpy]: [&mut ReactionSource; 2],
    ) {
        if frame.chemistry.reacting().is_none() {
            return;
        }
        let (cells, species) = (frame.grid.cells(), frame.species());
        let dual = is_dual(frame);
        let mass = |cell: usize| match dual {
            true => held(frame, material, cell),
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
                // Where nothing reacts nothing need be held back.
                let rates = |cell: usize| &self.rates[cell * species..(cell + 1) * species];
                let inertia = |cell: usize| match rates(cell).iter().all(|rate| *rate == 0.0) {
                    true => 0.0,
                    false => mass(cell) / self.spans[cell],
                };
                source.inertia.extend((0..cells).map(inertia));
                source.before.extend_from_slice(values);
            }
        }
    }

    /// What no reaction changes, where pseudo-steps are taken.
    pub fn elements(&self) -> Option<&Elements> {
        self.elements.as_ref()
    }

    /// Source of the enthalpy by what is made of each species in kg/s.
    pub fn source_of(&self, species: usize, made: &[f64]) -> ReactionSource {
        let mut source = ReactionSource::default();
        self.heat(species, made, &mut source.gain);
        source
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
        frame: &AttemptFrame<'_>,
        elements: &Elements,
        now: &GasState,
        [composition, enthalpy]: [&mut ReactionSource; 2],
    ) {
        let (cells, species) = (frame.grid.cells(), frame.species());
        let one = |(cell, gain): (usize, &mut [f64])| {
            let inertia = self.inertia[cell];
            let here = now.composition_of(cell, species);
            let mut reached = [0.0; MOST_SPECIES];
            let reached = &mut reached[..species];
            reached.copy_from_slice(&self.reached[cell * species..][..species]);
            elements.restore(&elements.of(here), reached);
            for (gain, (after, before)) in gain.iter_mut().zip(reached.iter().zip(here)) {
                *gain = inertia * (after - before);
            }
        };
        composition.gain.resize(cells * species, 0.0);
        let gains = composition.gain.par_chunks_mut(species);
        gains.enumerate().for_each(one);
        self.heat(species, &composition.gain, &mut enthalpy.gain);
        for source in [composition, enthalpy] {
            source.inertia.clear();
            source.before.clear();
        }
    }

    /// Books what the pseudo-step changed, and what its reactors reached.
    pub fn measure(
        &mut self,
        [composition, enthalpy]: [&ReactionSource; 2],
        heat: &[f64],
        now: &GasState,
    ) {
        self.reached.resize(self.rates.len(), 0.0);
        self.inertia.clone_from(&composition.inertia);
        let (rates, spans) = (&self.rates, &self.spans);
        let species = rates.len() / spans.len();
        fill(&mut self.reached, |at| {
            composition.before[at] + rates[at] * spans[at / species]
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

/// Gas of a cell in kg by the equation of state: in an early iterate the masses of continuity may be no masses of a gas.
fn held(frame: &AttemptFrame<'_>, material: &CellProperties, cell: usize) -> f64 {
    material.density[cell] * frame.void_fraction[cell] * frame.grid.volume[cell]
}

/// Span of a cell's pseudo-step in s, for the fluxes at hand.
fn pseudo_step(frame: &AttemptFrame<'_>, now: &GasState, cell: usize) -> f64 {
    let composition = now.composition_of(cell, frame.species());
    let density = frame
        .properties
        .density(now.base_pressure, now.temperature[cell], composition);
    let links = frame.grid.links(cell).iter();
    let leaving = links.fold(0.0, |sum, link| {
        sum + (link.sign * now.flux[link.face as usize]).max(0.0)
    });
    let held = RESIDENCE * density * frame.void_fraction[cell] * frame.grid.volume[cell];
    if leaving * frame.motion_span > held {
        held / leaving
    } else {
        frame.motion_span
    }
}

/// Makes fractions of what iteration leaves: none below zero, their sum one.
fn valid(fractions: &mut [f64]) {
    fractions.iter_mut().for_each(|y| *y = y.max(0.0));
    let sum: f64 = fractions.iter().sum();
    fractions.iter_mut().for_each(|y| *y /= sum);
}
