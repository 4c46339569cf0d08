//! The partially stirred reactor against its law: what reacts in a window is the laminar change times the share that
//! eddies mix.
#![allow(clippy::unwrap_used)]

mod common;

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, State, Tolerances, pasr};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::physics::turbulence::KEpsilon;
use calcine_coupler::setup::Turbulence;
use common::*;

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"];
const MIXING: f64 = 0.01;
const ENERGY: f64 = 1.0;
const SCALE: f64 = 0.01;

fn mixture() -> Mixture {
    Mixture::new(SPECIES).unwrap()
}

fn fresh() -> Vec<f64> {
    mixture().mass_fractions(&[1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52])
}

/// What a window takes of the methane in a closed box of 1500 K with eddies.
fn taken(combustion: Combustion, void_fraction: f64) -> f64 {
    let mut setup = setup(&[("side", slip()), ("bottom", slip()), ("top", slip())]);
    setup.turbulence = Turbulence::KEpsilon {
        energy: ENERGY,
        length_scale: SCALE,
        prandtl: 0.85,
        schmidt: 0.7,
    };
    setup.temperature = 1500.0;
    setup.composition = fresh();
    setup.properties = GasModel::Mixture(mixture());
    setup.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism: Mechanism::jones_lindstedt(&mixture()).unwrap(),
        tolerances: Tolerances::default(),
        combustion,
    }));
    let mut driver = Driver::new(&duct([0.1, 0.1, 0.1], [1, 1, 2]), &setup);
    driver.bed.void_fraction.fill(void_fraction);
    driver.window(1e-7, 1.0);
    fresh()[0] - driver.gas.fields().composition[0]
}

#[test]
fn the_share_that_eddies_mix_reacts() {
    let gas = mixture();
    let y = fresh();
    let state = State {
        pressure: ATMOSPHERE,
        temperature: 1500.0,
        fractions: &y,
    };
    let dissipation = KEpsilon::STANDARD.dissipation(ENERGY, SCALE);
    let density = gas.density(ATMOSPHERE, 1500.0, &y);
    let eddies = density * KEpsilon::STANDARD.eddy_viscosity(ENERGY, dissipation);
    let viscosity = gas.viscosity(1500.0, &y) + eddies;
    let mixing = pasr::mixing_time(MIXING, viscosity, density, dissipation);
    let jl4 = Mechanism::jones_lindstedt(&gas).unwrap();
    let share = pasr::reacting_fraction(pasr::chemical_time(&jl4, state), mixing);
    assert!(share > 0.2 && share < 0.8, "{share}");
    let stirred = Combustion::Pasr {
        mixing_constant: MIXING,
    };
    let laminar = taken(Combustion::Laminar, 1.0);
    assert!(laminar > 1e-5);
    let ratio = taken(stirred, 1.0) / laminar;
    assert!((ratio / share - 1.0).abs() < 1e-4, "{ratio} {share}");
    // The bed has no eddies: its pores mix.
    let ratio = taken(stirred, 0.5) / taken(Combustion::Laminar, 0.5);
    assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
}
