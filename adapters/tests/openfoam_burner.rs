//! A burner in a duct of hot gas with OpenFOAM's chemistry whose windows are long against the time in which gas crosses a cell, as
//! in a shaft furnace: what no reaction changes is at the outlet within a window. The native one: `native-solver/tests/burner.rs`.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::Path;

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{Bed, Convergence, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, Tolerances};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{CompositionSchedule, GasPatch, GasSetup, InletFlow, Schedule};
use calcine_coupler::time::{Clocks, Ticks};

use crate::openfoam_support::{self, Duct, exchange_of_nothing, setup};

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"];
/// Moles of methane and air at λ = 1.1, of these species.
const FRESH: [f64; 7] = [1.0, 2.2, 0.0, 0.0, 0.0, 0.0, 2.2 * 3.76];
/// What a mole of methane has burnt to at λ = 2.
const LEAN: [f64; 7] = [0.0, 2.0, 0.0, 0.0, 1.0, 2.0, 4.0 * 3.76];
/// Cells of 10 mm, which burnt gas of 14 m/s crosses in 0.7 ms.
const CELLS: usize = 20;
/// Motion window in s, fourteen of these times, and how many the gas stores over.
const WINDOW: f64 = 10e-3;
const FACTOR: f64 = 678.0;
/// Outer iterations at most: of five pseudo-steps each, in which a cell exchanges its gas to four fifths at most.
const OUTER: u32 = 10;

fn mixture() -> Mixture {
    Mixture::new(SPECIES).unwrap()
}

fn mesh() -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(10e-3, 10e-3, 10e-3 * CELLS as f64),
        cells: [1, 1, CELLS],
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    })
    .unwrap()
}

/// Fresh gas of 300 K at 2 m/s into a duct full of what a leaner gas has burnt to, at 1800 K: neither its elements nor its heat are there.
fn burner() -> GasSetup {
    let mixture = mixture();
    let mut burner = setup();
    for (name, patch) in &mut burner.patches {
        if name == "bottom" {
            *patch = GasPatch::Inlet {
                flow: InletFlow::SuperficialVelocity(Schedule::constant(2.0)),
                temperature: Schedule::constant(300.0),
                composition: Some(CompositionSchedule(vec![(
                    0.0,
                    mixture.mass_fractions(&FRESH),
                )])),
                turbulence: None,
                scalars: Default::default(),
            }
        }
    }
    burner.temperature = 1800.0;
    burner.composition = mixture.mass_fractions(&LEAN);
    burner.controls.outer_tolerance = 1e-8;
    burner.controls.outer_iterations = OUTER;
    burner.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism: Mechanism::jones_lindstedt(&mixture).unwrap(),
        tolerances: Tolerances::default(),
        combustion: Combustion::Laminar,
    }));
    burner.properties = GasModel::Mixture(mixture);
    burner
}

fn launch(ranks: u32, folder: &Path) -> Duct {
    let own = folder.join(ranks.to_string());
    let mut duct = Duct::try_launch_on_ranks(ranks, mesh(), &burner(), &own, None)
        .unwrap_or_else(|error| panic!("{error}"));
    duct.window.span = Clocks {
        motion: Ticks::from_seconds(WINDOW).unwrap(),
        process: Ticks::from_seconds(WINDOW * FACTOR).unwrap(),
    };
    duct
}

fn window(duct: &mut Duct) -> Convergence {
    let bed = Bed {
        void_fraction: vec![1.0; CELLS],
    };
    duct.advance(1, &bed, &exchange_of_nothing(CELLS))
}

/// Largest difference of an element's mass fraction in the last cell from that of the gas that flows in.
fn lack(duct: &Duct) -> f64 {
    let fields = duct.gas.fields();
    let fresh = mixture().mass_fractions(&FRESH);
    let last = &fields.composition[(CELLS - 1) * SPECIES.len()..];
    let of = |row: &[f64], y: &[f64]| row.iter().zip(y).map(|(a, y)| a * y).sum::<f64>();
    let elements = mixture().elements();
    let each = elements
        .iter()
        .map(|(_, row)| (of(row, last) - of(row, &fresh)).abs());
    each.fold(0.0, f64::max)
}

/// Largest difference of a field over its largest value.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let largest = one.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let pairs = one.iter().zip(other);
    pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / largest
}

#[test]
fn elements_and_heat_of_a_burner_are_at_the_outlet_at_once_on_any_number_of_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let [mut one, mut two] = [1, 2].map(|ranks| launch(ranks, folder.path()));
    // Without elements ahead of the species ten outer iterations leave 5e-3 and 4e-6 of the first two windows.
    for (number, most) in [1e-4, 1e-6, 1e-9, 1e-9].into_iter().enumerate() {
        for duct in [&mut one, &mut two] {
            let convergence = window(duct);
            let lack = lack(duct);
            println!("window {number}: lack {lack:.1e}, {convergence:?}");
            assert!(convergence.converged, "window {number}: {convergence:?}");
            assert!(lack < most, "window {number}: {lack:e}");
        }
        let (a, b) = (one.gas.fields(), two.gas.fields());
        for (name, difference) in [
            ("temperature", apart(a.temperature, b.temperature)),
            ("mass fractions", apart(a.composition, b.composition)),
        ] {
            println!("window {number}, ranks: {name} {difference:.1e}");
            // Windows end beside each other within 3e-11.
            assert!(difference < 1e-8, "{name}: {difference:e}");
        }
    }
    let fields = one.gas.fields();
    let fresh = mixture().mass_fractions(&FRESH)[0];
    let left = |cell: usize| fields.composition[cell * SPECIES.len()] / fresh;
    println!("left of the methane: {:?}", [0, 1, 2, 3].map(left));
    // As natively: a stirred reactor of 0.7 ms of burnt gas leaves some 5e-5 of what burns at once, and as much of that each cell on.
    assert!(left(0) < 1e-4, "{}", left(0));
    assert!(left(1) < 1e-4 * left(0), "{}", left(1));
    // The adiabatic equilibrium of the fresh gas is 2164.6 K; natively 2164.2 K.
    let last = fields.temperature[CELLS - 1];
    println!("{last} K");
    assert!((last - 2164.2).abs() < 1.0, "{last}");
    for duct in [&mut one, &mut two] {
        duct.gas.finish_run(&duct.supervisor).unwrap();
    }
}

#[test]
fn methane_ends_in_hot_air_and_so_does_its_integration() {
    let folder = tempfile::tempdir().unwrap();
    let mixture = mixture();
    let mut hot = burner();
    // As in a cell of the shaft furnace at whose burners the first methane comes in: a trace of it in what has burnt.
    hot.composition = mixture.mass_fractions(&[1e-5, 0.21, 1e-5, 1e-8, 1e-5, 1e-4, 0.79]);
    hot.temperature = 1815.0;
    hot.velocity = Vec3::zeros();
    openfoam_support::stop(&mut hot);
    let mut duct = Duct::launch_on(mesh(), &hot, folder.path());
    let span = Ticks::from_seconds(1.33e-3).unwrap();
    duct.window.span = Clocks {
        motion: span,
        process: span,
    };
    let bed = Bed {
        void_fraction: vec![1.0; CELLS],
    };
    duct.advance(2, &bed, &exchange_of_nothing(CELLS));
    let fields = duct.gas.fields();
    // Away from the inlet, through which methane diffuses.
    let left = fields.composition[(CELLS - 1) * SPECIES.len()] / hot.composition[0];
    println!(
        "left of the methane: {left:.1e}, {} K",
        fields.temperature[CELLS - 1]
    );
    assert!((0.0..1e-6).contains(&left), "{left:e}");
    duct.gas.finish_run(&duct.supervisor).unwrap();
}
