//! Steps that OpenFOAM's integration of reactions tries in vain.

#![allow(clippy::unwrap_used, clippy::panic)]

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry, ReactingGas};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::kinetics::{Mechanism, Tolerances};
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::time::{Clocks, Ticks};

use crate::openfoam_support::{Duct, bed, no_exchange, setup, stop};

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

/// The whole span is tried first. From this state the equations of such a step are all but singular at a span of
/// 1.1281e-4 s, and its stages overflow: an integration that took NaN for a result would put the flame out.
#[test]
fn a_step_whose_stages_overflow_is_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let mixture = Mixture::new(SPECIES).unwrap();
    let mut gas = setup();
    stop(&mut gas);
    gas.temperature = TEMPERATURE;
    gas.composition = STATE.to_vec();
    gas.chemistry = GasChemistry::Reacting(Box::new(ReactingGas {
        mechanism: Mechanism::jones_lindstedt(&mixture).unwrap(),
        tolerances: Tolerances::default(),
        combustion: Combustion::Laminar,
    }));
    gas.properties = GasModel::Mixture(mixture);
    let mut duct = Duct::launch(&gas, folder.path());
    let mut last: Option<f64> = None;
    let spans = (0..40).map(|k| 1.12e-4 + 4e-8 * f64::from(k));
    let mut spans: Vec<f64> = spans.chain([1.12811145e-4]).collect();
    spans.sort_by(f64::total_cmp);
    for span in spans {
        let ticks = Ticks::from_seconds(span).unwrap();
        duct.window.span = Clocks {
            motion: ticks,
            process: ticks,
        };
        duct.attempt(&bed(0.5), &no_exchange());
        let here = duct.gas.fields().temperature[5];
        // 320 K above its start, and still warming. Gas that burns alike everywhere and only expands ends at 2147.3 K; expansion
        // through the cells within so short a window is followed to first order.
        let gains = |last: f64| (0.0..0.1).contains(&(here - last));
        assert!(
            last.is_none_or(gains) && (2127.0..2130.0).contains(&here),
            "{here} K after {span} s, {last:?} before"
        );
        last = Some(here);
    }
}
