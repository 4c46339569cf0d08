//! Cells of reacting gas are stirred reactors whatever the window and the acceleration are (docs/theory.md, CHM-2 and CHM-3), with OpenFOAM's
//! rates, against Cantera's reactors. The native ones, at more windows: `native-solver/tests/stirred_cells.rs`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{Bed, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, RateConstant, ReactionStatement, Tolerances};
use calcine_coupler::physics::reaction::{Arrhenius, Equation};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{CompositionSchedule, GasPatch, InletFlow, Schedule};
use calcine_coupler::time::{Clocks, Ticks};

use crate::openfoam_support::{Duct, exchange_of_nothing, setup};

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"];
const TABLE: &str = include_str!("../../coupler/physics/tests/reference/stirred.csv");
const ATMOSPHERE: f64 = 101_325.0;

fn mixture() -> Mixture {
    Mixture::new(SPECIES).unwrap()
}

/// Residence time in s, cell, temperature in K and mass fractions of the table's lines of a case.
fn references(case: &str) -> Vec<Vec<f64>> {
    let lines = TABLE.lines().filter(|line| line.starts_with(case));
    lines
        .map(|line| {
            line.split(',')
                .skip(1)
                .map(|word| word.parse().unwrap())
                .collect()
        })
        .collect()
}

/// Cells in a row, so long that the flow is much faster than diffusion, with inlet and start in K and mass fractions.
fn launch(
    folder: &Path,
    (cells, residence): (usize, f64),
    mechanism: Mechanism,
    inlet: (f64, Vec<f64>),
    start: (f64, Vec<f64>),
) -> Duct {
    let length = (0.4 * residence).sqrt();
    let mut gas = setup();
    for (name, patch) in &mut gas.patches {
        match name.as_str() {
            "bottom" => {
                *patch = GasPatch::Inlet {
                    flow: InletFlow::SuperficialVelocity(Schedule::constant(length / residence)),
                    temperature: Schedule::constant(inlet.0),
                    composition: Some(CompositionSchedule(vec![(0.0, inlet.1.clone())])),
                    turbulence: None,
                    scalars: Default::default(),
                }
            }
            "top" => *patch = GasPatch::outlet(Schedule::constant(ATMOSPHERE)),
            _ => {}
        }
    }
    gas.pressure = ATMOSPHERE;
    gas.gravity = Vec3::zeros();
    gas.velocity = Vec3::zeros();
    gas.temperature = start.0;
    gas.composition = start.1;
    gas.controls.outer_tolerance = 1e-8;
    gas.controls.outer_iterations = 50;
    gas.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism,
        tolerances: Tolerances::default(),
        combustion: Combustion::Laminar,
    }));
    gas.properties = GasModel::Mixture(mixture());
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(length, length, length * cells as f64),
        cells: [1, 1, cells],
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    })
    .unwrap();
    Duct::launch_on(mesh, &gas, folder)
}

fn run(duct: &mut Duct, cells: usize, motion: f64, factor: f64, windows: u32) {
    duct.window.span = Clocks {
        motion: Ticks::from_seconds(motion).unwrap(),
        process: Ticks::from_seconds(motion * factor).unwrap(),
    };
    let bed = Bed {
        void_fraction: vec![1.0; cells],
    };
    for _ in 0..windows {
        duct.advance(1, &bed, &exchange_of_nothing(cells));
    }
}

fn state(duct: &Duct, cell: usize) -> (f64, Vec<f64>) {
    let fields = duct.gas.fields();
    let own = cell * SPECIES.len()..(cell + 1) * SPECIES.len();
    (fields.temperature[cell], fields.composition[own].to_vec())
}

#[test]
fn a_chain_of_openfoam_s_cells_is_a_chain_of_stirred_reactors() {
    let gas = mixture();
    let folder = tempfile::tempdir().unwrap();
    let mut largest = [0.0_f64; 2];
    let cases = references("chain")
        .into_iter()
        .chain(references("blow-out"));
    let cases: Vec<Vec<f64>> = cases.collect();
    let mut residences: Vec<f64> = cases.iter().map(|line| line[0]).collect();
    residences.dedup();
    for residence in residences {
        for factor in [1.0, 678.0] {
            let own = folder.path().join(format!("{residence:e}-{factor}"));
            let mechanism = Mechanism::jones_lindstedt(&gas).unwrap();
            let inlet = (
                300.0,
                gas.mass_fractions(&[0.8, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52]),
            );
            let start = (
                1800.0,
                gas.mass_fractions(&[0.0, 0.4, 0.0, 0.0, 1.6, 0.8, 7.52]),
            );
            let mut duct = launch(&own, (3, residence), mechanism, inlet, start);
            run(&mut duct, 3, 10.0 * residence, factor, 12);
            for line in cases.iter().filter(|line| line[0] == residence) {
                let cell = line[1] as usize;
                let (temperature, fractions) = state(&duct, cell);
                let what = format!("{residence} s, cell {cell}, AF {factor}");
                let error = (temperature / line[2] - 1.0).abs();
                largest[0] = largest[0].max(error);
                assert!(error < 5e-3, "{what}: {temperature} K, {}", line[2]);
                for (k, (found, wanted)) in fractions.iter().zip(&line[3..]).enumerate() {
                    // Half a per cent of what is there; of traces of the whole gas that diffusion beside the flow brings.
                    let error = (found - wanted).abs() / wanted.max(2e-3);
                    largest[1] = largest[1].max(error);
                    assert!(error < 5e-3, "{what}, {}: {found} {wanted}", SPECIES[k]);
                }
            }
            duct.gas.finish_run(&duct.supervisor).unwrap();
        }
    }
    println!(
        "temperature {:.1e}, fractions {:.1e}",
        largest[0], largest[1]
    );
}

/// A reaction of first order in a fuel and in oxygen, k = 1e9 m³/mol/s exp(−100 kJ/mol/RT).
fn step(equation: &str, fuel: &str) -> ReactionStatement {
    ReactionStatement {
        name: fuel.into(),
        equation: Equation::parse(equation).unwrap(),
        orders: Some(vec![(fuel.into(), 1.0), ("O2".into(), 1.0)]),
        rate: RateConstant::Arrhenius(Arrhenius {
            factor: 1e9,
            exponent: 0.0,
            activation_energy: 1e5,
        }),
        collider: None,
    }
}

#[test]
fn a_flame_of_openfoam_from_a_hot_start_stands_in_the_first_cell_at_any_window() {
    let gas = mixture();
    let oxygen = (0.7 * 2.0 + 0.3 * 0.5) / 0.8;
    let steps = [
        step("CH4 + 2 O2 => CO2 + 2 H2O", "CH4"),
        step("H2 + 0.5 O2 => H2O", "H2"),
    ];
    let folder = tempfile::tempdir().unwrap();
    let line = &references("flame")[1];
    for (window, windows) in [(1e-3, 300), (1e-2, 60), (0.1, 20), (1.0, 8), (10.0, 6)] {
        let own = folder.path().join(format!("{window}"));
        let inlet = gas.mass_fractions(&[0.7, oxygen, 0.0, 0.3, 0.0, 0.0, 3.76 * oxygen]);
        let burnt = gas.mass_fractions(&[0.0, oxygen - 1.55, 0.0, 0.0, 1.7, 0.7, 3.76 * oxygen]);
        let mechanism = Mechanism::new(&gas, &steps).unwrap();
        let mut duct = launch(
            &own,
            (10, line[0]),
            mechanism,
            (500.0, inlet.clone()),
            (2000.0, burnt),
        );
        run(&mut duct, 10, window, 1.0, windows);
        let (temperature, fractions) = state(&duct, 0);
        let left = fractions[0] / inlet[0];
        println!("windows of {window} s: {temperature} K, {left:.3e} of the fuel left");
        assert!((temperature / line[2] - 1.0).abs() < 1e-3, "{temperature}");
        assert!((fractions[0] / line[3] - 1.0).abs() < 5e-3, "{left}");
        duct.gas.finish_run(&duct.supervisor).unwrap();
    }
}
