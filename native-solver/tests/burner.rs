//! A burner in a duct of hot gas whose windows are long against the time in which gas crosses a cell, as in a shaft
//! furnace: what reacts at once does so where it comes in, and not where gas is at the end of a window.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, Reactor, Tolerances};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{CompositionSchedule, GasPatch, InletFlow, Schedule};

use crate::common::*;

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"];
/// What a mole of methane has burnt to with λ = 1.1, in mol.
const BURNT: [f64; 7] = [0.0, 0.2, 0.0, 0.0, 1.0, 2.0, 2.2 * 3.76];
/// Cells of 10 mm, which burnt gas of 14 m/s crosses in 0.7 ms.
const CELLS: usize = 20;
/// Motion window in s: fourteen of these times.
const WINDOW: f64 = 10e-3;

fn mixture() -> Mixture {
    Mixture::new(SPECIES).unwrap()
}

/// Mass fractions of methane in air (O2 with 3.76 N2) at λ = 1.1.
fn fresh() -> Vec<f64> {
    mixture().mass_fractions(&[1.0, 2.2, 0.0, 0.0, 0.0, 0.0, 2.2 * 3.76])
}

fn mechanism() -> Mechanism {
    Mechanism::jones_lindstedt(&mixture()).unwrap()
}

/// A duct full of burnt gas of 1800 K, into which fresh gas of 300 K flows at 2 m/s.
fn burner() -> Driver {
    let bottom = GasPatch::Inlet {
        flow: InletFlow::SuperficialVelocity(Schedule::constant(2.0)),
        temperature: Schedule::constant(300.0),
        composition: Some(CompositionSchedule(vec![(0.0, fresh())])),
        turbulence: None,
        scalars: Default::default(),
    };
    let mut setup = setup(&[("bottom", bottom), ("top", outlet()), ("side", slip())]);
    setup.temperature = 1800.0;
    setup.composition = mixture().mass_fractions(&BURNT);
    setup.controls.outer_tolerance = 1e-8;
    setup.properties = GasModel::Mixture(mixture());
    setup.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism: mechanism(),
        tolerances: Tolerances::default(),
        combustion: Combustion::Laminar,
    }));
    let mesh = duct([10e-3, 10e-3, 10e-3 * CELLS as f64], [1, 1, CELLS]);
    Driver::new(&mesh, &setup)
}

#[test]
fn fresh_gas_burns_where_it_comes_in_however_long_a_window_is() {
    let mut burner = burner();
    let mut iterations = Vec::new();
    for _ in 0..4 {
        let convergence = burner.window(WINDOW, 678.0);
        iterations.push((convergence.outer_iterations, convergence.residual));
        let energy = closure(&burner.received.energy);
        assert!(energy < 1e-10, "energy {energy:e}");
    }
    println!("{iterations:?}");
    // 3, 3, 1, 1: elements and heat need not wait for a sweep through each of the twenty cells.
    assert!(iterations.iter().all(|(outer, _)| *outer < 10));
    let fields = burner.gas.fields();
    let left = |cell: usize| fields.composition[cell * SPECIES.len()] / fresh()[0];
    println!("left of the methane: {:?}", [0, 1, 2, 3].map(left));
    // A stirred reactor of 0.7 ms of burnt gas leaves some 5e-5 of what burns at once, and as much of that each cell on.
    assert!(left(0) < 1e-4, "{}", left(0));
    assert!(left(1) < 1e-4 * left(0), "{}", left(1));

    // Behind it is the adiabatic equilibrium of the fresh gas; what diffuses back into the inlet is some 1/350 of what flows.
    let last = fields.temperature[CELLS - 1];
    let adiabatic = equilibrium();
    println!("{last} K, equilibrium {adiabatic} K");
    assert!((last - adiabatic).abs() < 3.0, "{last} {adiabatic}");
}

/// Temperature in K of the fresh gas in adiabatic equilibrium: burnt completely, and then a second of reactions.
fn equilibrium() -> f64 {
    let (gas, fresh) = (mixture(), fresh());
    let mut composition = gas.mass_fractions(&BURNT);
    let heat = gas.formation_enthalpy(&fresh) - gas.formation_enthalpy(&composition);
    let enthalpy = gas.enthalpy(300.0, &fresh) + heat;
    let mut temperature = gas.temperature(enthalpy, &composition, 2000.0).unwrap();
    let reactor = Reactor::new(&mechanism(), Tolerances::default());
    reactor
        .advance(ATMOSPHERE, &mut temperature, &mut composition, 1.0)
        .unwrap();
    temperature
}
