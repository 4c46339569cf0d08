//! Species of the gas: mixing at one temperature, diffusion against its exact solution, balances.
#![allow(clippy::unwrap_used)]

use calcine_coupler::part::{Balance, Gas};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{
    CompositionSchedule, Convection, GasPatch, GasStart, InletFlow, InletScalars, Schedule,
};

use crate::common::*;

/// A duct along z, filled with the first of two gases at four fifths, into which flows mostly the second.
fn duct_of(
    species: [&str; 2],
    convection: Convection,
    velocity: f64,
    temperature: f64,
    cells: usize,
    scalars: InletScalars,
) -> (Driver, GasSetup) {
    let bottom = GasPatch::Inlet {
        flow: InletFlow::SuperficialVelocity(Schedule::constant(velocity)),
        temperature: Schedule::constant(temperature),
        composition: Some(CompositionSchedule(vec![(0.0, vec![0.1, 0.9])])),
        turbulence: None,
        scalars,
    };
    let mut setup = setup(&[("bottom", bottom), ("top", outlet()), ("side", slip())]);
    setup.properties = GasModel::Mixture(Mixture::new(species).unwrap());
    setup.composition = vec![0.8, 0.2];
    setup.schmidt = 0.7;
    setup.controls.convection = convection;
    let mesh = duct([0.01, 0.01, 0.12], [1, 1, cells]);
    (Driver::new(&mesh, &setup), setup)
}

fn closed(balance: &Balance) -> f64 {
    let open = balance.stored - balance.boundary - balance.exchange - balance.source;
    open.abs() / (balance.stored_magnitude + balance.boundary_magnitude)
}

#[test]
fn gases_that_mix_at_one_temperature_stay_at_it_and_every_species_closes() {
    for convection in [Convection::Upwind, Convection::VanLeer] {
        let (mut duct, _) = duct_of(
            ["N2", "CO2"],
            convection,
            0.5,
            300.0,
            24,
            InletScalars::Flux,
        );
        for _ in 0..40 {
            let convergence = duct.window(2e-3, 3.0);
            assert!(convergence.converged);
            for balance in &duct.received.species {
                assert!(closed(balance) < 1e-11, "{balance:?}");
            }
            assert!(closed(&duct.received.energy) < 1e-10);
        }
        let fields = duct.gas.fields();
        for (cell, temperature) in fields.temperature.iter().enumerate() {
            assert!(
                (temperature - 300.0).abs() < 1e-6,
                "{convection:?} {temperature} K"
            );
            let [nitrogen, dioxide] = [0, 1].map(|k| fields.composition[2 * cell + k]);
            assert!((nitrogen + dioxide - 1.0).abs() < 1e-14);
            assert!((0.1 - 1e-9..=0.8 + 1e-9).contains(&nitrogen), "{nitrogen}");
        }
        // The front is on its way: the inlet's gas behind, the old gas before it.
        assert!(fields.composition[0] < 0.11 && fields.composition[46] > 0.1 + 1e-6);
    }
}

#[test]
fn species_close_to_round_off_however_loosely_they_are_solved() {
    let (_, mut setup) = duct_of(
        ["CO2", "N2"],
        Convection::VanLeer,
        0.5,
        300.0,
        24,
        InletScalars::Flux,
    );
    setup.controls.linear_tolerance = Some(1e-6);
    setup.composition = vec![1e-4, 1.0 - 1e-4];
    let mut duct = Driver::new(&duct([0.01, 0.01, 0.12], [1, 1, 24]), &setup);
    let content = |duct: &Driver, k: usize| {
        let fields = duct.gas.fields();
        let cells = fields.density.iter().enumerate();
        let volume = 1e-4 * 0.12 / 24.0;
        cells
            .map(|(cell, density)| density * volume * fields.composition[2 * cell + k])
            .sum::<f64>()
    };
    let (mut open, mut moved, mut brought) = ([0.0; 2], [0.0; 2], 0.0);
    duct.window(2e-3, 3.0);
    let first = content(&duct, 0);
    for _ in 0..40 {
        duct.window(2e-3, 3.0);
        for (k, balance) in duct.received.species.iter().enumerate() {
            open[k] += balance.stored - balance.boundary - balance.exchange - balance.source;
            moved[k] += balance.stored_magnitude + balance.boundary_magnitude;
        }
        brought += duct.received.species[0].boundary;
    }
    for k in 0..2 {
        assert!(open[k].abs() < 1e-13 * moved[k], "{k}: {open:?} {moved:?}");
    }
    // What the cells hold by their mass fractions lags by one window's remainder at most.
    let gained = content(&duct, 0) - first;
    assert!(
        (gained - brought).abs() < 1e-5 * moved[0],
        "{gained} {brought}"
    );
}

#[test]
fn a_steady_duct_holds_what_flows_in() {
    let (mut duct, _) = duct_of(
        ["N2", "CO2"],
        Convection::VanLeer,
        0.5,
        400.0,
        12,
        InletScalars::Flux,
    );
    for _ in 0..100 {
        duct.window(1e-3, 200.0);
    }
    for (i, fraction) in duct.gas.fields().composition.iter().enumerate() {
        assert!((fraction - [0.1, 0.9][i % 2]).abs() < 1e-10);
    }
    assert!(
        duct.gas
            .fields()
            .temperature
            .iter()
            .all(|t| (t - 400.0).abs() < 1e-7)
    );
}

/// Largest error of the mass fraction in gas at rest after 4 s, where the inlet holds another composition:
/// an error function. Of two gases of unlike molar masses one would move the other; N2 and CO have one.
fn front_error(cells: usize) -> f64 {
    let (mut duct, setup) = duct_of(
        ["N2", "CO"],
        Convection::VanLeer,
        0.0,
        300.0,
        cells,
        InletScalars::Value,
    );
    let (gas, y) = (&setup.properties, &setup.composition);
    let diffusivity = gas.viscosity(300.0, y) / 0.7 / gas.density(ATMOSPHERE, 300.0, y);
    let steps = 400;
    let time = 4.0;
    for _ in 0..steps {
        duct.window(time / f64::from(steps), 1.0);
    }
    let height = 0.12 / cells as f64;
    let mut worst: f64 = 0.0;
    for cell in 0..cells / 2 {
        let z = (cell as f64 + 0.5) * height;
        let exact = 0.8 - 0.7 * erfc(z / (2.0 * (diffusivity * time).sqrt()));
        worst = worst.max((duct.gas.fields().composition[2 * cell] - exact).abs());
    }
    worst
}

/// The complementary error function by its continued fraction or series (Abramowitz and Stegun 7.1.5, 7.1.14).
fn erfc(x: f64) -> f64 {
    let root = std::f64::consts::PI.sqrt();
    if x < 2.0 {
        let (mut term, mut sum) = (x, x);
        for n in 1..60 {
            term *= -x * x / f64::from(n);
            sum += term / f64::from(2 * n + 1);
        }
        return 1.0 - 2.0 / root * sum;
    }
    let mut fraction = 0.0;
    for n in (1..60).rev() {
        fraction = f64::from(n) / 2.0 / (x + fraction);
    }
    (-x * x).exp() / root / (x + fraction)
}

#[test]
fn a_species_diffuses_into_gas_at_rest_as_the_error_function() {
    assert!(
        (erfc(0.5) - 0.479_500_122).abs() < 1e-9 && (erfc(2.5) - 4.069_520_17e-4).abs() < 1e-11
    );
    let errors = [12, 24].map(front_error);
    // Second order in space (0.0296, 0.0082 of a front of 0.7: order 1.86).
    assert!(errors[1] < 0.012 * 0.7, "{errors:?}");
    assert!(errors[0] / errors[1] > 3.0, "{errors:?}");
}

/// One limiter serves all species and takes the side of the one that varies most: it switches from iterate to iterate where several meet.
#[test]
fn windows_converge_where_a_limiter_serves_several_species() {
    const CELLS: usize = 24;
    let patches = ["in", "out", "side", "side", "side", "side"];
    let mesh = named_box([0.1, 0.1, 0.01], [CELLS, CELLS, 1], patches);
    let bottom = GasPatch::Inlet {
        flow: InletFlow::SuperficialVelocity(Schedule::constant(0.5)),
        temperature: Schedule::constant(300.0),
        composition: Some(CompositionSchedule(vec![(
            0.0,
            vec![0.02, 0.05, 0.23, 0.7],
        )])),
        turbulence: None,
        scalars: InletScalars::Flux,
    };
    let mut setup = setup(&[("in", bottom), ("out", outlet()), ("side", slip())]);
    setup.properties = GasModel::Mixture(Mixture::new(["CH4", "CO2", "O2", "N2"]).unwrap());
    setup.composition = vec![0.0, 0.0, 0.23, 0.77];
    setup.schmidt = 0.7;
    setup.controls.convection = Convection::VanLeer;
    setup.controls.outer_tolerance = 1e-8;
    setup.controls.linear_tolerance = None;
    setup.velocity = Vec3::new(0.5, 0.0, 0.0);
    let mut driver = Driver::new(&mesh, &setup);
    // Two clouds that overlap, of 10 % each.
    let cloud = |at: &Vec3, x: f64, y: f64| {
        0.1 * (-((at.x - x).powi(2) + (at.y - y).powi(2)) / 0.02f64.powi(2)).exp()
    };
    let composition = mesh.cell_centre().iter().flat_map(|at| {
        let (fuel, burnt) = (cloud(at, 0.03, 0.045), cloud(at, 0.04, 0.06));
        [fuel, burnt, 0.23, 0.77 - fuel - burnt]
    });
    driver.gas.start_from(&GasStart {
        temperature: vec![300.0; mesh.cells()],
        velocity: vec![setup.velocity; mesh.cells()],
        pressure: vec![101_325.0; mesh.cells()],
        composition: composition.collect(),
    });
    for _ in 0..10 {
        let convergence = driver.window(5e-3, 1.0);
        assert!(convergence.converged && convergence.outer_iterations <= 20);
    }
}
