//! Balances of an attempt: mass, energy and momentum of the gas, as its equations took them.

use calcine_coupler::part::{Balance, CellReceived, PatchFlow};
use calcine_coupler::physics::Vec3;

use super::attempt::{AttemptFrame, CellProperties};
use super::boundary::of_all;
use super::enthalpy::EnthalpyFlows;
use super::momentum::Momentum;
use super::species::SpeciesEquations;
use super::state::GasState;
use crate::numerics::operators::outflow;
use crate::numerics::parallel::{fill, sums};

/// What the gas took from the particles, and its balances.
pub fn receive(
    frame: &AttemptFrame<'_>,
    material: &CellProperties,
    momentum: &Momentum,
    taken: &EnthalpyFlows,
    species: &SpeciesEquations,
    now: &GasState,
    received: &mut CellReceived,
) {
    let cells = frame.grid.cells();
    received.heat.clone_from(&taken.heat);
    received.drag.resize(cells, Vec3::zeros());
    fill(&mut received.drag, |cell| {
        frame.exchange.drag_source[cell]
            - frame.exchange.drag_coefficient[cell] * now.velocity[cell]
    });
    let flows = frame.boundary.flows_by_patch(|face| -now.flux[face]);
    let forces: Vec<[f64; 6]> = frame.boundary.by_patch(|face| {
        let inflow = momentum.inflow(frame, now, face);
        side_by_side([inflow, inflow.abs()])
    });
    received.mass = mass(frame, now, of_all(&flows));
    species.balances(frame, now, &mut received.species);
    received.energy = energy(frame, taken, &received.species, now);
    received.momentum = momenta(frame, material, now, of_all(&forces), &received.drag);
    received.storage_clock = storage_clock(frame, now);
    received.patches.clear();
    received.patches.extend((0..flows.len()).map(|patch| {
        let [x, y, z, ..] = forces[patch];
        PatchFlow {
            heat: taken.patches[patch][0],
            mass: flows[patch][0],
            momentum: Vec3::new(x, y, z),
            species: species.patches.iter().map(|of| of[patch][0]).collect(),
        }
    }));
}

/// What passes the boundary; where nothing does, the magnitude is what circulates through the faces
/// within, because the rounding of that is all that the cells of a fluid of constant density store.
fn mass(frame: &AttemptFrame<'_>, now: &GasState, [inflow, mut magnitude]: [f64; 2]) -> Balance {
    let [stored, stored_magnitude] = sums(frame.grid.cells(), |cell| {
        let stored = now.mass[cell] - frame.old.mass[cell];
        [stored, stored.abs()]
    });
    if magnitude == 0.0 {
        [magnitude] = sums(frame.grid.internal, |face| [now.flux[face].abs()]);
    }
    let exchanged = match frame.exchange.species.is_none() {
        true => 0.0,
        false => sums(frame.grid.cells(), |cell| [frame.mass_source(now, cell)])[0],
    };
    Balance {
        stored,
        stored_magnitude,
        boundary: inflow * frame.storage_span,
        boundary_magnitude: magnitude * frame.storage_span,
        exchange: exchanged * frame.storage_span,
        ..Balance::default()
    }
}

/// Heat of the gas' own reactions in J, from what the equations of the species say that they made.
fn reacted(frame: &AttemptFrame<'_>, species: &[Balance]) -> f64 {
    let each = species.iter().enumerate();
    -each
        .map(|(k, made)| frame.properties.formation_enthalpy(k) * made.source)
        .sum::<f64>()
}

fn energy(
    frame: &AttemptFrame<'_>,
    taken: &EnthalpyFlows,
    species: &[Balance],
    now: &GasState,
) -> Balance {
    let old = frame.old;
    let [stored, stored_magnitude, exchange] = sums(frame.grid.cells(), |cell| {
        let stored = now.heat(cell) - old.heat(cell);
        [stored, stored.abs(), taken.heat[cell]]
    });
    let [inflow, magnitude] = of_all(&taken.patches);
    let compression = taken.compression * frame.storage_span;
    let reacted = reacted(frame, species);
    Balance {
        stored,
        stored_magnitude,
        boundary: inflow * frame.storage_span,
        boundary_magnitude: magnitude * frame.storage_span,
        exchange: exchange * frame.storage_span,
        source: compression + reacted,
        source_magnitude: compression.abs() + reacted.abs(),
        ..Balance::default()
    }
}

/// All three components. The source is pressure, gravity, and what the form of the equation subtracts: u times the
/// continuity residual of the motion clock, in which gas of particles, which comes and goes with u, and
/// [`storage_clock`] are.
fn momenta(
    frame: &AttemptFrame<'_>,
    material: &CellProperties,
    now: &GasState,
    faces: [f64; 6],
    drag: &[Vec3],
) -> [Balance; 3] {
    let (grid, old, span) = (frame.grid, frame.old, frame.motion_span);
    let cells: [f64; 15] = sums(grid.cells(), |cell| {
        let velocity = now.velocity[cell];
        let stored = now.mass[cell] * velocity - old.mass[cell] * old.velocity[cell];
        let share = frame.pressure_share[cell] * grid.volume[cell];
        let gradient = now.pressure_gradient[cell] + frame.mean_gradient;
        let force = share * (material.density[cell] * frame.gravity - gradient);
        let gained = now.mass[cell] - old.mass[cell];
        let residual = span * outflow(grid, &now.flux, cell) + gained;
        let source = span * force + residual * velocity;
        side_by_side([stored, stored.abs(), drag[cell], source, source.abs()])
    });
    [0, 1, 2].map(|axis| Balance {
        stored: cells[axis],
        stored_magnitude: cells[3 + axis],
        exchange: cells[6 + axis] * span,
        source: cells[9 + axis],
        source_magnitude: cells[12 + axis],
        boundary: faces[axis] * span,
        boundary_magnitude: faces[3 + axis] * span,
        ..Balance::default()
    })
}

/// Σ u (1 − Δt/Δτ) Δ(ε ρ V): what momentum on the motion clock and mass on the storage clock leave between them
/// (docs/theory.md, TSM-8).
fn storage_clock(frame: &AttemptFrame<'_>, now: &GasState) -> Vec3 {
    let share = 1.0 - frame.motion_span / frame.storage_span;
    let sum: [f64; 3] = sums(frame.grid.cells(), |cell| {
        let gained = now.mass[cell] - frame.old.mass[cell];
        (share * gained * now.velocity[cell]).into()
    });
    sum.into()
}

/// The components of vectors, one vector after the other.
fn side_by_side<const V: usize, const N: usize>(vectors: [Vec3; V]) -> [f64; N] {
    std::array::from_fn(|i| vectors[i / 3][i % 3])
}
