//! Steps that OpenFOAM's integration of reactions tries in vain.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::Path;

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::part::{Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, Reactor, Tolerances};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{GasPatch, WallHeat, WallVelocity};
use calcine_coupler::time::{Clocks, Ticks};

use crate::openfoam_support::{Duct, bed, no_exchange, setup};

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"];
/// Mass fractions and temperature in K of a burner's cell in the shaft furnace.
const STATE: [f64; 7] = [
    0.010079811978808728,
    0.062_724_116_527_939_81,
    0.0024253703678642504,
    5.3413774741901775e-05,
    0.10647156497659191,
    0.089_810_374_669_517_79,
    0.728_435_347_704_535_5,
];
const TEMPERATURE: f64 = 1807.0476115669605;

fn mechanism() -> Mechanism {
    Mechanism::jones_lindstedt(&Mixture::new(SPECIES).unwrap()).unwrap()
}

/// Temperature in K of a parcel of that gas that burns at the column's pressure, by Calcine's own reactor.
fn parcel(time: f64) -> f64 {
    let (mut temperature, mut fractions) = (TEMPERATURE, STATE);
    Reactor::new(&mechanism(), Tolerances::default())
        .advance(setup().pressure, &mut temperature, &mut fractions, time)
        .unwrap();
    temperature
}

/// A column of such gas that burns alike everywhere, closed below: at one pressure it only expands.
fn column(folder: &Path) -> Duct {
    let mut gas = setup();
    for (name, patch) in &mut gas.patches {
        if name == "bottom" {
            *patch = GasPatch::Wall {
                velocity: WallVelocity::Slip,
                heat: WallHeat::Adiabatic,
            };
        }
    }
    gas.velocity = Vec3::zeros();
    gas.temperature = TEMPERATURE;
    gas.composition = STATE.to_vec();
    gas.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism: mechanism(),
        tolerances: Tolerances::default(),
        combustion: Combustion::Laminar,
    }));
    gas.properties = GasModel::Mixture(Mixture::new(SPECIES).unwrap());
    Duct::launch(&gas, folder)
}

fn set_span(duct: &mut Duct, span: f64) {
    let ticks = Ticks::from_seconds(span).unwrap();
    duct.window.span = Clocks {
        motion: ticks,
        process: ticks,
    };
}

/// The whole span is tried first. From this state the equations of such a step of a closed cell are all but singular at a span of
/// 1.1281e-4 s, and its stages overflow: an integration that took NaN for a result would put the flame out.
#[test]
fn a_step_whose_stages_overflow_is_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut duct = column(folder.path());
    let mut last: Option<f64> = None;
    let spans = (0..40).map(|k| 1.12e-4 + 4e-8 * f64::from(k));
    let mut spans: Vec<f64> = spans.chain([1.12811145e-4]).collect();
    spans.sort_by(f64::total_cmp);
    for span in spans {
        set_span(&mut duct, span);
        duct.attempt(&bed(0.5), &no_exchange());
        // Nothing flows into the lowest cell: a parcel, 336 K above its start and still warming.
        let (here, alone) = (duct.gas.fields().temperature[0], parcel(span));
        let gains = |last: f64| (0.0..0.1).contains(&(here - last));
        assert!(
            last.is_none_or(gains) && (here - alone).abs() < 0.05,
            "{here} K after {span} s, {last:?} before, {alone} K by Calcine's reactor"
        );
        last = Some(here);
    }
}

/// Into the cells above comes gas of those below, by implicit Euler as it is at the end of the window: further burnt than the cell's own
/// is until then. What that takes of the heat vanishes with the window, at first order or faster.
#[test]
fn gas_that_expands_through_cells_burns_as_a_parcel_in_short_windows() {
    let folder = tempfile::tempdir().unwrap();
    let span = 1.12e-4;
    let alone = parcel(span);
    let lost = [1, 2, 4, 8].map(|windows| {
        let mut duct = column(&folder.path().join(windows.to_string()));
        set_span(&mut duct, span / windows as f64);
        duct.advance(windows, &bed(0.5), &no_exchange());
        let lost = alone - duct.gas.fields().temperature[5];
        duct.gas.finish_run(&duct.supervisor).unwrap();
        lost
    });
    println!("below {alone} K by {lost:?} K");
    // The window as long as burning takes: 23 K of 336 K, of which gas from below takes 15 K, and gas that expands out of a cell's reactor
    // before it has burnt the rest.
    assert!((22.0..25.0).contains(&lost[0]), "{lost:?}");
    for pair in lost.windows(2) {
        assert!(pair[1] > 0.0 && pair[1] < 0.5 * pair[0], "{lost:?}");
    }
}
