//! A premixed flame of methane on a burner: its place and its peak do not depend on the acceleration factor.
#![allow(clippy::unwrap_used)]

mod common;

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, Tolerances};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{CompositionSchedule, Convection, GasPatch, InletFlow, Schedule};
use calcine_coupler::time::GasStorage;
use common::*;

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"];
const METHANE: usize = 0;
/// Height of the duct in m and its cells.
const HEIGHT: f64 = 8e-3;
const CELLS: usize = 80;
/// Motion window in s: burnt gas crosses a fifth of a cell.
const WINDOW: f64 = 1.5e-5;

/// Mass fractions of methane in air (O2 with 3.76 N2) of an equivalence ratio.
fn fresh(mixture: &Mixture, ratio: f64) -> Vec<f64> {
    mixture.mass_fractions(&[ratio, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52])
}

/// The same, burnt to CO2 and H2O (lean mixtures).
fn burnt(mixture: &Mixture, ratio: f64) -> Vec<f64> {
    mixture.mass_fractions(&[0.0, 2.0 - 2.0 * ratio, 0.0, 0.0, ratio, 2.0 * ratio, 7.52])
}

/// Temperature in K of what burns completely from 300 K without loss: no more heat can be had of a lean mixture.
fn adiabatic(mixture: &Mixture, ratio: f64) -> f64 {
    let (before, after) = (fresh(mixture, ratio), burnt(mixture, ratio));
    let heat = mixture.formation_enthalpy(&before) - mixture.formation_enthalpy(&after);
    let enthalpy = mixture.enthalpy(300.0, &before) + heat;
    mixture.temperature(enthalpy, &after, 2000.0).unwrap()
}

/// A duct into which cold lean gas flows, slower than the flame would run; the inlet, which holds 300 K, takes heat out of the
/// flame. It starts filled with hot burnt gas.
fn burner(storage: GasStorage) -> (Driver, Mixture) {
    let mixture = Mixture::new(SPECIES).unwrap();
    let bottom = GasPatch::Inlet {
        flow: InletFlow::SuperficialVelocity(Schedule::constant(0.15)),
        temperature: Schedule::constant(300.0),
        composition: Some(CompositionSchedule(vec![(0.0, fresh(&mixture, 0.8))])),
        turbulence: None,
    };
    let mut setup = setup(&[("bottom", bottom), ("top", outlet()), ("side", slip())]);
    setup.temperature = 1800.0;
    setup.composition = burnt(&mixture, 0.8);
    setup.schmidt = std::env::var("SC").map_or(1.0, |s| s.parse().unwrap());
    setup.storage = storage;
    setup.controls.convection = if std::env::var_os("VL").is_some() {
        Convection::VanLeer
    } else {
        Convection::Upwind
    };
    setup.controls.outer_tolerance = 1e-8;
    setup.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism: Mechanism::jones_lindstedt(&mixture).unwrap(),
        tolerances: Tolerances::default(),
        combustion: Combustion::Laminar,
    }));
    setup.properties = GasModel::Mixture(mixture.clone());
    let mesh = duct([1e-3, 1e-3, HEIGHT], [1, 1, CELLS]);
    (Driver::new(&mesh, &setup), mixture)
}

/// What is told of a steady flame.
#[derive(Debug)]
struct Flame {
    /// Height in m at which half of the methane is left.
    place: f64,
    /// Highest temperature in K.
    peak: f64,
    /// Heat that the inlet takes in W.
    windows: u64,
}

/// Runs windows until temperature changes by less than 1e-6 K/s of process time times the residence time; checks bounds and
/// balances on the way.
fn steady(factor: f64, storage: GasStorage, most: u64) -> Flame {
    let (mut burner, mixture) = burner(storage);
    let inlet = fresh(&mixture, 0.8);
    let elements = mixture.elements();
    let mut before = burner.gas.fields().temperature.to_vec();
    loop {
        let convergence = burner.window(WINDOW, factor);
        let fields = burner.gas.fields();
        for &y in fields.composition {
            assert!(
                (-1e-8..=1.0 + 1e-8).contains(&y),
                "AF {factor}: a mass fraction of {y}"
            );
        }
        let received = &burner.received;
        let energy = &received.energy;
        assert!(closure(energy) < 1e-10, "AF {factor}: energy {energy:?}");
        // Of an element all that species gained and brought, whatever reacted.
        for (name, shares) in &elements {
            let each = || shares.iter().zip(&received.species);
            let sum: f64 = each().map(|(s, b)| s * (b.stored - b.boundary)).sum();
            let all: f64 = each()
                .map(|(s, b)| s * (b.stored_magnitude + b.boundary_magnitude))
                .sum();
            assert!(
                sum.abs() < 1e-10 * all,
                "AF {factor}: {name} {sum} of {all}"
            );
        }
        let now = fields.temperature.to_vec();
        let change = now
            .iter()
            .zip(&before)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        before = now;
        if std::env::var_os("FLAME").is_some()
            && burner.index % (if factor > 1.0 { 1 } else { 50 }) == 0
        {
            eprintln!(
                "AF {factor} window {} change {change:.3e} K peak {:.2} K outer {} residual {:.2e}",
                burner.index,
                before.iter().copied().fold(0.0, f64::max),
                convergence.outer_iterations,
                convergence.residual
            );
        }
        if change < std::env::var("TOL").map_or(1e-3, |s| s.parse().unwrap())
            || burner.index == most
        {
            assert!(convergence.converged, "AF {factor}: {convergence:?}");
            assert!(
                burner.index < most,
                "AF {factor}: not steady, {change} K a window"
            );
            break;
        }
    }
    let fields = burner.gas.fields();
    let methane = |cell: usize| fields.composition[cell * SPECIES.len() + METHANE];
    let half = 0.5 * inlet[METHANE];
    let above = (0..CELLS).find(|&cell| methane(cell) < half).unwrap();
    assert!(above > 0);
    let share = (methane(above - 1) - half) / (methane(above - 1) - methane(above));
    Flame {
        place: (above as f64 - 0.5 + share) * HEIGHT / CELLS as f64,
        peak: before.iter().copied().fold(0.0, f64::max),
        windows: burner.index,
    }
}

#[test]
fn a_flame_stands_where_it_stands_whatever_the_acceleration() {
    let mixture = Mixture::new(SPECIES).unwrap();
    let limit = adiabatic(&mixture, 0.8);
    if let Ok(list) = std::env::var("AF") {
        for factor in list.split(',') {
            let start = std::time::Instant::now();
            let flame = steady(factor.parse().unwrap(), GasStorage::Process, 6000);
            eprintln!(
                "AF {factor} {flame:?} limit {limit} in {:?}",
                start.elapsed()
            );
        }
        return;
    }
    let unsplit = steady(1.0, GasStorage::Process, 6000);
    eprintln!("{unsplit:?} {limit}");
    for factor in [5.0, 20.0, 200.0, 678.0] {
        let split = steady(factor, GasStorage::Process, 2000);
        eprintln!("AF {factor} {split:?}");
        assert!((split.place - unsplit.place).abs() < 1e-3 * unsplit.place);
        assert!((split.peak - unsplit.peak).abs() < 0.1);
        assert!(split.peak < limit);
    }
}
