//! Balances of an attempt: mass, energy and momentum of the gas, as its equations took them.

use calcine_coupler::part::{Balance, CellReceived};
use calcine_coupler::physics::Vec3;

use super::attempt::{Frame, Material};
use super::enthalpy::{Enthalpy, heat};
use super::momentum::Momentum;
use super::state::State;
use crate::numerics::operators::outflow;
use crate::numerics::parallel::{fill, sum};

/// What the gas took from the particles, and its balances.
pub fn receive(
    frame: &Frame<'_>,
    material: &Material,
    momentum: &Momentum,
    enthalpy: &Enthalpy,
    now: &State,
    received: &mut CellReceived,
) {
    let cells = frame.grid.cells();
    received.heat.resize(cells, 0.0);
    received.drag.resize(cells, Vec3::zeros());
    fill(&mut received.heat, |cell| heat(frame, now, cell));
    fill(&mut received.drag, |cell| {
        frame.exchange.drag_source[cell]
            - frame.exchange.drag_coefficient[cell] * now.velocity[cell]
    });
    received.mass = mass(frame, now);
    received.energy = energy(frame, material, enthalpy, now, &received.heat);
    received.momentum =
        [0, 1, 2].map(|axis| momentum_of(frame, material, momentum, now, &received.drag, axis));
}

/// Sums of a boundary term and of its magnitude over all boundary faces.
fn boundary(frame: &Frame<'_>, inflow: impl Fn(usize) -> f64 + Sync) -> (f64, f64) {
    let internal = frame.grid.internal;
    let faces = frame.grid.faces.len() - internal;
    (
        sum(faces, |face| inflow(internal + face)),
        sum(faces, |face| inflow(internal + face).abs()),
    )
}

fn mass(frame: &Frame<'_>, now: &State) -> Balance {
    let cells = frame.grid.cells();
    let stored = |cell: usize| now.mass[cell] - frame.old.mass[cell];
    let (inflow, magnitude) = boundary(frame, |face| -now.flux[face]);
    Balance {
        stored: sum(cells, stored),
        stored_magnitude: sum(cells, |cell| stored(cell).abs()),
        boundary: inflow * frame.storage_span,
        boundary_magnitude: magnitude * frame.storage_span,
        ..Balance::default()
    }
}

fn energy(
    frame: &Frame<'_>,
    material: &Material,
    enthalpy: &Enthalpy,
    now: &State,
    heat: &[f64],
) -> Balance {
    let cells = frame.grid.cells();
    let old = frame.old;
    let stored =
        |cell: usize| now.mass[cell] * now.enthalpy[cell] - old.mass[cell] * old.enthalpy[cell];
    let (inflow, magnitude) = boundary(frame, |face| enthalpy.inflow(frame, material, now, face));
    Balance {
        stored: sum(cells, stored),
        stored_magnitude: sum(cells, |cell| stored(cell).abs()),
        boundary: inflow * frame.storage_span,
        boundary_magnitude: magnitude * frame.storage_span,
        exchange: sum(cells, |cell| heat[cell]) * frame.storage_span,
        ..Balance::default()
    }
}

/// One component. The source is pressure, gravity, and u times the continuity residual, which the
/// form of the equation subtracts.
fn momentum_of(
    frame: &Frame<'_>,
    material: &Material,
    momentum: &Momentum,
    now: &State,
    drag: &[Vec3],
    axis: usize,
) -> Balance {
    let cells = frame.grid.cells();
    let span = frame.motion_span;
    let stored = |cell: usize| {
        frame.old.mass[cell] * (now.velocity[cell][axis] - frame.old.velocity[cell][axis])
    };
    let source = |cell: usize| {
        let pores = frame.void_fraction[cell] * frame.grid.volume[cell];
        let pressure = -pores * now.pressure_gradient[cell][axis];
        let weight = pores * material.density[cell] * frame.gravity[axis];
        let continuity = now.velocity[cell][axis] * outflow(frame.grid, &now.flux, cell);
        pressure + weight + continuity
    };
    let (inflow, magnitude) = boundary(frame, |face| {
        momentum.inflow(frame, material, now, face)[axis]
    });
    Balance {
        stored: sum(cells, stored),
        stored_magnitude: sum(cells, |cell| stored(cell).abs()),
        boundary: inflow * span,
        boundary_magnitude: magnitude * span,
        exchange: sum(cells, |cell| drag[cell][axis]) * span,
        source: sum(cells, source) * span,
        source_magnitude: sum(cells, |cell| source(cell).abs()) * span,
    }
}
