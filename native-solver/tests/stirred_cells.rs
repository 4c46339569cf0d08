//! Cells of reacting gas are stirred reactors whatever the window, the storage and the acceleration are (docs/theory.md, CHM-2 and CHM-3),
//! against Cantera's reactors (`coupler/physics/tests/reference/stirred.csv`). With OpenFOAM: `adapters/tests/openfoam_stirred_cells.rs`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, RateConstant, ReactionStatement, Tolerances};
use calcine_coupler::physics::reaction::{Arrhenius, Equation};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{CompositionSchedule, GasPatch, InletFlow, Schedule};
use calcine_coupler::time::GasStorage;

use crate::common::*;

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"];
const TABLE: &str = include_str!("../../coupler/physics/tests/reference/stirred.csv");

fn mixture() -> Mixture {
    Mixture::new(SPECIES).unwrap()
}

/// A line of the table: residence time in s of gas of the inlet's density, cell, temperature in K, mass fractions.
struct Reference {
    residence: f64,
    cell: usize,
    temperature: f64,
    fractions: Vec<f64>,
}

fn references(case: &str) -> Vec<Reference> {
    let lines = TABLE.lines().filter(|line| line.starts_with(case));
    lines
        .map(|line| {
            let values: Vec<f64> = line
                .split(',')
                .skip(1)
                .map(|word| word.parse().unwrap())
                .collect();
            Reference {
                residence: values[0],
                cell: values[1] as usize,
                temperature: values[2],
                fractions: values[3..].to_vec(),
            }
        })
        .collect()
}

/// Cells in a row, and what flows in.
struct Chain {
    cells: usize,
    /// Residence time in s of a cell of gas of the inlet's density.
    residence: f64,
    /// Length of a cell in units of √(0.4 m²/s · residence).
    length: f64,
    mechanism: Mechanism,
    /// Temperatures in K and mass fractions of the inlet and the start.
    inlet: (f64, Vec<f64>),
    start: (f64, Vec<f64>),
    storage: GasStorage,
    outer_iterations: u32,
}

impl Chain {
    /// With a length of 1 diffusion is 2e4 times slower than the flow in cold gas, 7e3 times in burnt gas.
    fn driver(&self) -> Driver {
        let length = self.length * (0.4 * self.residence).sqrt();
        let bottom = GasPatch::Inlet {
            flow: InletFlow::SuperficialVelocity(Schedule::constant(length / self.residence)),
            temperature: Schedule::constant(self.inlet.0),
            composition: Some(CompositionSchedule(vec![(0.0, self.inlet.1.clone())])),
            turbulence: None,
            scalars: Default::default(),
        };
        let mut setup = setup(&[("bottom", bottom), ("top", outlet()), ("side", slip())]);
        setup.temperature = self.start.0;
        setup.composition = self.start.1.clone();
        setup.storage = self.storage;
        setup.controls.outer_iterations = self.outer_iterations;
        setup.controls.outer_tolerance = 1e-8;
        setup.properties = GasModel::Mixture(mixture());
        setup.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
            mechanism: self.mechanism.clone(),
            tolerances: Tolerances::default(),
            combustion: Combustion::Laminar,
        }));
        let mesh = duct(
            [length, length, length * self.cells as f64],
            [1, 1, self.cells],
        );
        Driver::new(&mesh, &setup)
    }
}

fn state(driver: &Driver, cell: usize) -> (f64, Vec<f64>) {
    let fields = driver.gas.fields();
    let own = cell * SPECIES.len()..(cell + 1) * SPECIES.len();
    (fields.temperature[cell], fields.composition[own].to_vec())
}

/// Methane with φ 0.8, and what it has burnt to at 1800 K.
fn burner(residence: f64, storage: GasStorage) -> Chain {
    let gas = mixture();
    Chain {
        cells: 3,
        residence,
        length: 1.0,
        mechanism: Mechanism::jones_lindstedt(&gas).unwrap(),
        inlet: (
            300.0,
            gas.mass_fractions(&[0.8, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52]),
        ),
        start: (
            1800.0,
            gas.mass_fractions(&[0.0, 0.4, 0.0, 0.0, 1.6, 0.8, 7.52]),
        ),
        storage,
        outer_iterations: 50,
    }
}

#[test]
fn a_chain_of_cells_is_a_chain_of_stirred_reactors() {
    let mut largest = [0.0_f64; 2];
    for reference in references("chain").chunks(3) {
        let residence = reference[0].residence;
        // Windows of a fifth and of ten residence times unsplit, accelerated and with process storage.
        for (storage, motion, factor, windows) in [
            (GasStorage::Process, 0.2, 1.0, 150),
            (GasStorage::Process, 10.0, 1.0, 12),
            (GasStorage::Accelerated, 10.0, 678.0, 12),
            (GasStorage::Process, 10.0, 20.0, 6),
            (GasStorage::Process, 10.0, 678.0, 5),
        ] {
            let mut driver = burner(residence, storage).driver();
            for _ in 0..windows {
                driver.window(motion * residence, factor);
            }
            for line in reference {
                let (temperature, fractions) = state(&driver, line.cell);
                let what = format!(
                    "{residence} s, cell {}, {storage:?}, {motion}, AF {factor}",
                    line.cell
                );
                let error = (temperature / line.temperature - 1.0).abs();
                largest[0] = largest[0].max(error);
                assert!(
                    error < 5e-3,
                    "{what}: {temperature} K, {}",
                    line.temperature
                );
                for (k, (found, wanted)) in fractions.iter().zip(&line.fractions).enumerate() {
                    // Half a per cent of what is there; of traces of the whole gas that diffusion beside the flow brings.
                    let error = (found - wanted).abs() / wanted.max(2e-3);
                    largest[1] = largest[1].max(error);
                    assert!(error < 5e-3, "{what}, {}: {found} {wanted}", SPECIES[k]);
                }
            }
        }
    }
    println!(
        "temperature {:.1e}, fractions {:.1e}",
        largest[0], largest[1]
    );
}

#[test]
fn a_cell_goes_out_where_the_stirred_reactor_does() {
    for line in references("blow-out") {
        for (motion, factor, windows) in [(0.1, 1.0, 800), (10.0, 1.0, 20), (10.0, 678.0, 20)] {
            let mut driver = burner(line.residence, GasStorage::Process).driver();
            for _ in 0..windows {
                driver.window(motion * line.residence, factor);
            }
            let (temperature, _) = state(&driver, 0);
            println!(
                "{:.4e} s, {motion} residence times, AF {factor}: {temperature} K, Cantera {} K",
                line.residence, line.temperature
            );
            assert!((temperature / line.temperature - 1.0).abs() < 5e-3);
        }
    }
}

/// A reaction of an order of one in each of these, k in mol, m³, s, with an activation energy in J/mol.
fn step(
    name: &str,
    equation: &str,
    orders: &[&str],
    factor: f64,
    energy: f64,
) -> ReactionStatement {
    ReactionStatement {
        name: name.into(),
        equation: Equation::parse(equation).unwrap(),
        orders: Some(orders.iter().map(|one| ((*one).to_owned(), 1.0)).collect()),
        rate: RateConstant::Arrhenius(Arrhenius {
            factor,
            exponent: 0.0,
            activation_energy: energy,
        }),
        collider: None,
    }
}

/// Carbon monoxide that decays with k in 1/s in gas of 1000 K.
fn tracer(number: f64, start: &[f64; 7], outer_iterations: u32) -> Chain {
    let gas = mixture();
    let decay = step("decay", "CO + H2O => CO2 + H2", &["CO"], number, 0.0);
    Chain {
        cells: 3,
        residence: 1.0,
        length: 10.0,
        mechanism: Mechanism::new(&gas, &[decay]).unwrap(),
        inlet: (
            1000.0,
            gas.mass_fractions(&[0.0, 0.0, 1e-5, 0.0, 1e-5, 0.0, 1.0]),
        ),
        start: (1000.0, gas.mass_fractions(start)),
        storage: GasStorage::Process,
        outer_iterations,
    }
}

#[test]
fn a_tracer_decays_as_its_damkoehler_number_says_at_any_window() {
    let mut largest = 0.0_f64;
    for number in [0.1, 1.0, 10.0, 1000.0] {
        for (motion, factor) in [
            (1.0, 1.0),
            (10.0, 1.0),
            (1e3, 1.0),
            (10.0, 678.0),
            (1e3, 1e3),
        ] {
            let mut driver = tracer(number, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 50).driver();
            for _ in 0..if motion * factor < 100.0 { 40 } else { 5 } {
                driver.window(motion, factor);
            }
            let inlet = tracer(number, &[0.0; 7].map(|_| 1.0), 1).inlet.1[2];
            let found = state(&driver, 0).1[2] / inlet;
            let error = found * (1.0 + number) - 1.0;
            println!("Da {number}, {motion} x {factor}: {found}, {error:.1e}");
            largest = largest.max(error.abs());
        }
    }
    // Diffusion beside the flow makes 2e-5.
    assert!(largest < 1e-3, "{largest}");
}

#[test]
fn iterates_are_bounded_whatever_the_window() {
    for number in [0.1, 1.0, 10.0, 1000.0] {
        for span in [0.1, 10.0, 1e3, 1e6] {
            for outer in [1, 2, 5] {
                let mut driver =
                    tracer(number, &[0.0, 0.0, 2e-5, 0.0, 2e-5, 0.0, 1.0], outer).driver();
                let most = tracer(number, &[1.0; 7], 1).inlet.1[2].max(state(&driver, 0).1[2]);
                for _ in 0..5 {
                    driver.window(f64::min(span, 10.0), f64::max(span / 10.0, 1.0));
                    for cell in 0..3 {
                        let tracer = state(&driver, cell).1[2];
                        assert!(
                            (-1e-15..=most * (1.0 + 1e-9)).contains(&tracer),
                            "Da {number}, {span} residence times, {outer} iterations: {tracer} of {most}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_flame_from_a_hot_start_stands_in_the_first_cell_at_any_window() {
    let gas = mixture();
    let oxygen = (0.7 * 2.0 + 0.3 * 0.5) / 0.8;
    let steps = [
        step(
            "methane",
            "CH4 + 2 O2 => CO2 + 2 H2O",
            &["CH4", "O2"],
            1e9,
            1e5,
        ),
        step("hydrogen", "H2 + 0.5 O2 => H2O", &["H2", "O2"], 1e9, 1e5),
    ];
    let line = &references("flame")[1];
    for (window, windows) in [(1e-3, 300), (1e-2, 60), (0.1, 20), (1.0, 8), (10.0, 6)] {
        let chain = Chain {
            cells: 20,
            residence: line.residence,
            length: 1.0,
            mechanism: Mechanism::new(&gas, &steps).unwrap(),
            inlet: (
                500.0,
                gas.mass_fractions(&[0.7, oxygen, 0.0, 0.3, 0.0, 0.0, 3.76 * oxygen]),
            ),
            start: (
                2000.0,
                gas.mass_fractions(&[0.0, oxygen - 1.55, 0.0, 0.0, 1.7, 0.7, 3.76 * oxygen]),
            ),
            storage: GasStorage::Process,
            outer_iterations: 50,
        };
        let mut driver = chain.driver();
        for _ in 0..windows {
            driver.window(window, 1.0);
        }
        let (temperature, fractions) = state(&driver, 0);
        let left = fractions[0] / chain.inlet.1[0];
        println!("windows of {window} s: {temperature} K, {left:.3e} of the fuel left");
        assert!(
            (temperature / line.temperature - 1.0).abs() < 1e-3,
            "{temperature}"
        );
        assert!(
            (fractions[0] / line.fractions[0] - 1.0).abs() < 5e-3,
            "{left}"
        );
    }
}

/// Temperature in K of a cell alone at a time in s, by so many windows.
fn after(chain: &Chain, time: f64, windows: u32) -> f64 {
    let mut driver = chain.driver();
    for _ in 0..windows {
        driver.window(time / f64::from(windows), 1.0);
    }
    state(&driver, 0).0
}

#[test]
fn ignition_and_blow_out_converge_with_the_window() {
    let gas = mixture();
    let mut igniting = burner(1e-3, GasStorage::Process);
    igniting.cells = 1;
    // Hot air into which methane comes, and burnt gas that cold methane flushes out.
    igniting.inlet.0 = 1300.0;
    igniting.start = (
        1300.0,
        gas.mass_fractions(&[0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52]),
    );
    let mut blown = burner(2e-4, GasStorage::Process);
    blown.cells = 1;
    for (what, chain, time) in [("ignition", igniting, 1e-3), ("blow-out", blown, 6e-4)] {
        let found = [8, 16, 32, 64, 128].map(|windows| after(&chain, time, windows));
        let apart: Vec<f64> = found
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).abs())
            .collect();
        let orders = orders(&apart);
        println!("{what}: {found:?}, orders {orders:?}");
        // Implicit Euler's first order.
        let last = orders.last().unwrap();
        assert!((0.7..1.5).contains(last), "{what}: {orders:?}");
        assert!(
            apart.last().unwrap() < &(0.02 * found[4]),
            "{what}: {apart:?}"
        );
    }
}
