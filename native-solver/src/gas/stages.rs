//! Stages of a window: each is a step of implicit Euler over a share of it, from a state of its own.
//!
//! Implicit Euler has one. The second-order scheme is the singly diagonally implicit one of two stages, L-stable and stiffly accurate
//! (Alexander 1977, doi 10.1137/0714068), γ = 1 − 1/√2:
//!
//! U₁ = U₀ + γ Δt f(U₁),   U₂ = U₀ + (1 − γ) Δt f(U₁) + γ Δt f(U₂)
//!
//! As Δt f(U₁) = (U₁ − U₀)/γ, the second is a step over γ Δt from U₀ + (1 − γ)/γ (U₁ − U₀), taken for what a cell holds of mass,
//! momentum, enthalpy and species. What passes faces over the window is (1 − γ) Δt of the first stage's flows and γ Δt of the second's: amounts of
//! a stage, which are over γ Δt, count (1 − γ)/γ times and once.

use calcine_coupler::part::{Balance, CellReceived};
use calcine_coupler::setup::TimeScheme;

use super::state::GasState;
use crate::numerics::parallel::{fill, update};

/// γ = 1 − 1/√2.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// One stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// Its span as a share of the window's.
    pub span: f64,
    /// Where it ends, as a share of the window.
    pub end: f64,
    /// How far beyond the first stage's change the state lies from which it begins; zero: at the window's start.
    pub beyond: f64,
    /// How much its mean rates count in those of the window.
    pub rate: f64,
    /// How often its amounts count in those of the window.
    pub amount: f64,
}

const EULER: [Stage; 1] = [Stage {
    span: 1.0,
    end: 1.0,
    beyond: 0.0,
    rate: 1.0,
    amount: 1.0,
}];

const SDIRK2: [Stage; 2] = [
    Stage {
        span: GAMMA,
        end: GAMMA,
        beyond: 0.0,
        rate: 1.0 - GAMMA,
        amount: (1.0 - GAMMA) / GAMMA,
    },
    Stage {
        span: GAMMA,
        end: 1.0,
        beyond: (1.0 - GAMMA) / GAMMA,
        rate: GAMMA,
        amount: 1.0,
    },
];

/// What a scheme of several stages keeps; empty with one.
#[derive(Debug, Default)]
pub struct StageStates {
    /// What the last attempt found at the end of its first stage.
    pub first: GasState,
    /// From where the second stage steps.
    pub between: GasState,
    /// What a stage received.
    pub received: CellReceived,
    /// Void fraction at the end of the stage.
    pub void_fraction: Vec<f64>,
}

/// The stages of a scheme.
pub fn stages(scheme: TimeScheme) -> &'static [Stage] {
    match scheme {
        TimeScheme::ImplicitEuler => &EULER,
        TimeScheme::Sdirk2 => &SDIRK2,
    }
}

/// Sets `between` to what lies `beyond` times the change from `start` to `first` away from `start`: linear in what cells hold, and in the
/// mass flux of the faces and the base pressure.
pub fn extrapolate(start: &GasState, first: &GasState, beyond: f64, between: &mut GasState) {
    let line = |from: f64, to: f64| from + beyond * (to - from);
    between.take(start);
    fill(&mut between.mass, |cell| {
        line(start.mass[cell], first.mass[cell])
    });
    let mass = &between.mass;
    fill(&mut between.velocity, |cell| {
        let from = start.mass[cell] * start.velocity[cell];
        let to = first.mass[cell] * first.velocity[cell];
        (from + beyond * (to - from)) / mass[cell]
    });
    fill(&mut between.enthalpy, |cell| {
        let from = start.mass[cell] * start.enthalpy[cell];
        let to = first.mass[cell] * first.enthalpy[cell];
        line(from, to) / mass[cell]
    });
    let species = between.composition.len() / mass.len().max(1);
    fill(&mut between.composition, |place| {
        let cell = place / species;
        let from = start.mass[cell] * start.composition[place];
        let to = first.mass[cell] * first.composition[place];
        line(from, to) / mass[cell]
    });
    fill(&mut between.remainder, |place| {
        line(start.remainder[place], first.remainder[place])
    });
    fill(&mut between.heat_remainder, |cell| {
        line(start.heat_remainder[cell], first.heat_remainder[cell])
    });
    fill(&mut between.flux, |face| {
        line(start.flux[face], first.flux[face])
    });
    between.base_pressure = line(start.base_pressure, first.base_pressure);
}

/// Adds what a stage received, which is scaled, to what the window has received so far; with the first stage it begins.
pub fn add(total: &mut CellReceived, part: &mut CellReceived, stage: &Stage, first: bool) {
    update(&mut part.heat, |_, heat| *heat *= stage.rate);
    update(&mut part.drag, |_, drag| *drag *= stage.rate);
    part.patches
        .iter_mut()
        .for_each(|flow| flow.scale(stage.rate));
    part.storage_clock *= stage.amount;
    for balance in balances(part) {
        *balance = scaled(balance, stage.amount);
    }
    if first {
        std::mem::swap(total, part);
        return;
    }
    update(&mut total.heat, |cell, heat| *heat += part.heat[cell]);
    update(&mut total.drag, |cell, drag| *drag += part.drag[cell]);
    let flows = total.patches.iter_mut().zip(&part.patches);
    flows.for_each(|(flow, part)| flow.add(part));
    total.storage_clock += part.storage_clock;
    for (balance, part) in balances(total).into_iter().zip(balances(part)) {
        *balance = sum(balance, part);
    }
}

/// All balances of what a gas received.
fn balances(received: &mut CellReceived) -> Vec<&mut Balance> {
    let CellReceived {
        mass,
        species,
        energy,
        momentum,
        ..
    } = received;
    let single = [mass, energy].into_iter().chain(momentum);
    single.chain(species).collect()
}

fn combined(one: &Balance, other: &Balance, term: impl Fn(f64, f64) -> f64) -> Balance {
    Balance {
        stored: term(one.stored, other.stored),
        stored_magnitude: term(one.stored_magnitude, other.stored_magnitude),
        boundary: term(one.boundary, other.boundary),
        boundary_magnitude: term(one.boundary_magnitude, other.boundary_magnitude),
        exchange: term(one.exchange, other.exchange),
        source: term(one.source, other.source),
        source_magnitude: term(one.source_magnitude, other.source_magnitude),
        reservoir: term(one.reservoir, other.reservoir),
    }
}

fn scaled(balance: &Balance, factor: f64) -> Balance {
    combined(balance, balance, |value, _| factor * value)
}

fn sum(one: &Balance, other: &Balance) -> Balance {
    combined(one, other, |one, other| one + other)
}
