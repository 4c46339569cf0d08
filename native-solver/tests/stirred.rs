//! Eddies and species: the partially stirred reactor against its law (what reacts in a window is the laminar change
//! times the share that eddies mix), and what eddies carry.
#![allow(clippy::unwrap_used)]

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, MixtureState, Tolerances, pasr};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::physics::turbulence::KEpsilon;
use calcine_coupler::setup::{
    CompositionSchedule, GasPatch, InletFlow, InletTurbulence, Schedule, Turbulence,
};

use crate::common::*;

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

/// What a window takes of the methane in a closed box of 1500 K with eddies, which go on in a bed or end at it.
fn taken(combustion: Combustion, void_fraction: f64, in_bed: bool) -> f64 {
    let mut setup = setup(&[("side", slip()), ("bottom", slip()), ("top", slip())]);
    setup.turbulence = Turbulence::KEpsilon {
        energy: ENERGY,
        length_scale: SCALE,
        prandtl: 0.85,
        schmidt: 0.7,
        iterations: 1000,
        in_bed,
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
    // So short that the share stays that of the start.
    driver.window(1e-9, 1.0);
    fresh()[0] - driver.gas.fields().composition[0]
}

#[test]
fn the_share_that_eddies_mix_reacts() {
    let gas = mixture();
    let y = fresh();
    let state = MixtureState {
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
    let share = pasr::reacting_fraction(jl4.chemical_time(state), mixing);
    assert!(share > 0.2 && share < 0.8, "{share}");
    let stirred = Combustion::Pasr {
        mixing_constant: MIXING,
    };
    let laminar = taken(Combustion::Laminar, 1.0, false);
    assert!(laminar > 1e-7);
    let ratio = taken(stirred, 1.0, false) / laminar;
    assert!((ratio / share - 1.0).abs() < 1e-4, "{ratio} {share}");
    // Where eddies end at the bed its pores count as mixed; where they do not, it is as elsewhere.
    for (in_bed, share) in [(false, 1.0), (true, share)] {
        let ratio = taken(stirred, 0.5, in_bed) / taken(Combustion::Laminar, 0.5, in_bed);
        assert!((ratio / share - 1.0).abs() < 1e-4, "{ratio} {share}");
    }
}

/// Nitrogen along a duct of still carbon monoxide into which it flows, after a window, with eddies of a length
/// scale in m and a turbulent Schmidt number.
fn carried(length_scale: f64, schmidt: f64) -> Vec<f64> {
    let bottom = GasPatch::Inlet {
        flow: InletFlow::SuperficialVelocity(Schedule::constant(0.1)),
        temperature: Schedule::constant(300.0),
        composition: Some(CompositionSchedule(vec![(0.0, vec![1.0, 0.0])])),
        turbulence: Some(InletTurbulence {
            intensity: 1.0,
            length_scale,
        }),
        scalars: Default::default(),
    };
    let mut setup = setup(&[("side", slip()), ("bottom", bottom), ("top", outlet())]);
    setup.turbulence = Turbulence::KEpsilon {
        energy: 0.015,
        length_scale,
        prandtl: 0.85,
        schmidt,
        iterations: 1000,
        in_bed: false,
    };
    setup.properties = GasModel::Mixture(Mixture::new(["N2", "CO"]).unwrap());
    setup.schmidt = 0.7;
    setup.composition = vec![0.0, 1.0];
    let mut driver = Driver::new(&duct([0.01, 0.01, 0.1], [1, 1, 20]), &setup);
    driver.window(0.05, 1.0);
    let fields = driver.gas.fields();
    fields.composition.iter().step_by(2).copied().collect()
}

#[test]
fn eddies_carry_species_with_their_viscosity_over_the_turbulent_schmidt_number() {
    // μ_t = ρ C_μ^¼ √k L over Sc_t: both doubled carry the same, one of them does not.
    let once = carried(5e-3, 0.7);
    let both = carried(1e-2, 1.4);
    let apart = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(once[0] > 0.2 && once[10] > 1e-6, "{once:?}");
    assert!(apart(&once, &both) < 1e-9, "{once:?} {both:?}");
    let less = carried(5e-3, 0.707);
    assert!(apart(&once, &less) > 1e-4, "{once:?} {less:?}");
}
