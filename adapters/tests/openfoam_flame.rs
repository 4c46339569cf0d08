//! A premixed flame of methane on a burner with OpenFOAM's own chemistry: whatever the acceleration factor, and with a
//! ledger that closes.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[cfg(test)]
mod openfoam_support;

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{Bed, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, Tolerances};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{CompositionSchedule, GasPatch, GasSetup, InletFlow, Schedule};
use calcine_coupler::time::{Clocks, Ticks};
use openfoam_support::{Duct, exchange_of_nothing, setup};

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"];
/// As in the native gas' own test: cells along 24 mm, motion window in s, pressure in Pa.
const CELLS: usize = 60;
const HEIGHT: f64 = 24e-3;
const WINDOW: f64 = 3e-5;
const PRESSURE: f64 = 10_132.5;

fn mesh() -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(1e-3, 1e-3, HEIGHT),
        cells: [1, 1, CELLS],
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    })
    .unwrap()
}

/// Lean gas of 300 K at 0.4 m/s into a duct of hot burnt gas.
fn burner() -> GasSetup {
    let mixture = Mixture::new(SPECIES).unwrap();
    let mut burner = setup();
    let fresh = mixture.mass_fractions(&[0.8, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52]);
    for (name, patch) in &mut burner.patches {
        match name.as_str() {
            "bottom" => {
                *patch = GasPatch::Inlet {
                    flow: InletFlow::SuperficialVelocity(Schedule::constant(0.4)),
                    temperature: Schedule::constant(300.0),
                    composition: Some(CompositionSchedule(vec![(0.0, fresh.clone())])),
                    turbulence: None,
                }
            }
            "top" => {
                *patch = GasPatch::Outlet {
                    pressure: Schedule::constant(PRESSURE),
                }
            }
            _ => {}
        }
    }
    burner.pressure = PRESSURE;
    burner.temperature = 1800.0;
    burner.velocity = Vec3::zeros();
    burner.composition = mixture.mass_fractions(&[0.0, 0.4, 0.0, 0.0, 0.8, 1.6, 7.52]);
    burner.controls.outer_tolerance = 1e-8;
    burner.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism: Mechanism::jones_lindstedt(&mixture).unwrap(),
        tolerances: Tolerances::default(),
        combustion: Combustion::Laminar,
    }));
    burner.properties = GasModel::Mixture(mixture);
    burner
}

/// Place in m and peak in K of the steady flame, and the windows it took.
fn steady(factor: f64, most: usize) -> (f64, f64, usize) {
    let folder = tempfile::tempdir().unwrap();
    let mut duct = Duct::launch_on(mesh(), &burner(), folder.path());
    duct.window.span = Clocks {
        motion: Ticks::from_seconds(WINDOW).unwrap(),
        process: Ticks::from_seconds(WINDOW * factor).unwrap(),
    };
    let bed = Bed {
        void_fraction: vec![1.0; CELLS],
    };
    let exchange = exchange_of_nothing(CELLS);
    let elements = Mixture::new(SPECIES).unwrap().elements();
    let mut before = vec![1800.0; CELLS];
    let mut windows = 0;
    loop {
        let convergence = duct.advance(1, &bed, &exchange);
        windows += 1;
        let energy = &duct.received.energy;
        let open = energy.stored - energy.boundary - energy.exchange - energy.source;
        let moved = energy.stored_magnitude + energy.boundary_magnitude + energy.source_magnitude;
        assert!(open.abs() < 1e-10 * moved, "AF {factor}: energy {energy:?}");
        for (name, shares) in &elements {
            let each = || shares.iter().zip(&duct.received.species);
            let open: f64 = each().map(|(s, b)| s * (b.stored - b.boundary)).sum();
            let all: f64 = each()
                .map(|(s, b)| s * (b.stored_magnitude + b.boundary_magnitude))
                .sum();
            assert!(
                open.abs() < 1e-10 * all,
                "AF {factor}: {name} {open:e} of {all:e}"
            );
        }
        let now = duct.gas.fields().temperature.to_vec();
        let change = now
            .iter()
            .zip(&before)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        before = now;
        if change < 1e-4 {
            assert!(convergence.converged, "AF {factor}: {convergence:?}");
            break;
        }
        assert!(windows < most, "AF {factor}: {change} K in a window");
    }
    let fields = duct.gas.fields();
    let methane = |cell: usize| fields.composition[cell * SPECIES.len()];
    let Some(GasPatch::Inlet {
        composition: Some(fresh),
        ..
    }) = burner()
        .patches
        .iter()
        .map(|(_, patch)| patch.clone())
        .find(|patch| matches!(patch, GasPatch::Inlet { .. }))
    else {
        panic!("no inlet");
    };
    let half = 0.5 * fresh.at(0.0)[0];
    let above = (0..CELLS).find(|&cell| methane(cell) < half).unwrap();
    let share = (methane(above - 1) - half) / (methane(above - 1) - methane(above));
    let peak = before.iter().copied().fold(0.0, f64::max);
    duct.gas.finish_run(&duct.supervisor).unwrap();
    (
        (above as f64 - 0.5 + share) * HEIGHT / CELLS as f64,
        peak,
        windows,
    )
}

#[test]
fn openfoam_s_flame_stands_where_it_stands_whatever_the_acceleration() {
    let slow = steady(20.0, 500);
    let fast = steady(678.0, 200);
    println!("AF 20 {slow:?}, AF 678 {fast:?}");
    assert!((slow.0 / fast.0 - 1.0).abs() < 1e-5, "{slow:?} {fast:?}");
    assert!((slow.1 - fast.1).abs() < 0.02, "{slow:?} {fast:?}");
}
