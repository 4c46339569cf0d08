//! Beds that dry through the program: the state of the gas that leaves them, every pairing, the ledger, resuming.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::{killed, program};

fn closes(out: &Path) -> Summary {
    let summary = Summary::read(out).unwrap();
    for name in ["mass", "energy", "energy_exchange", "particle_mass"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-11, "{name}: {error}");
    }
    for element in ["H", "O", "C"] {
        let error = summary.ledger.elements[element].relative_error;
        assert!(error < 1e-11, "{element}: {error}");
    }
    summary
}

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/inputs/good/{name}.toml"))
}

/// Pressure of saturated vapour in Pa at a temperature in K (Buck, J. Appl. Meteorol. 20 (1981) 1527).
fn saturated(kelvin: f64) -> f64 {
    let t = kelvin - 273.15;
    611.21 * ((18.678 - t / 234.5) * t / (257.14 + t)).exp()
}

/// Temperature in K at which air of a temperature in K and so many kg of vapour a kg of dry air is saturated by water that it
/// cools: of textbooks, h = 1006 t + w (2501e3 + 1860 t) J/kg, of water 4190 t, t in degrees Celsius.
fn adiabatic_saturation(kelvin: f64, vapour: f64) -> f64 {
    let (mut low, mut high) = (274.0, kelvin);
    let enthalpy = |t: f64, w: f64| 1006.0 * t + w * (2501e3 + 1860.0 * t);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        let (t, p) = (middle - 273.15, saturated(middle));
        let full = 0.622 * p / (101_325.0 - p);
        let lacks =
            enthalpy(t, full) - (full - vapour) * 4190.0 * t > enthalpy(kelvin - 273.15, vapour);
        if lacks {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}

#[test]
fn air_leaves_a_wet_bed_saturated_at_the_temperature_of_its_own_balance() {
    let folder = tempfile::tempdir().unwrap();
    // Windows that resolve how the first layers dry.
    let settings = ["time.end=4 min", "time.process_step=5 s"];
    program::run(
        &program::shipped("wood-drying"),
        folder.path(),
        &[],
        &settings,
    );
    closes(folder.path());
    let series = Series::read(folder.path()).unwrap();
    let last = |name: &str| *series.column(&format!("quantities.{name}")).last().unwrap();
    let vapour = 0.015 * 18.015 / (0.207 * 31.998 + 0.778 * 28.014);
    let expected = adiabatic_saturation(380.0, vapour);
    let (kelvin, fraction) = (last("outlet_temperature"), last("outlet_h2o"));
    println!("{kelvin} K, expected {expected} K; {fraction}");
    assert!((kelvin - expected).abs() < 0.4, "{kelvin} {expected}");
    let p = saturated(kelvin);
    let full = 0.622 * p / (101_325.0 - p);
    assert!(
        (fraction / (full / (1.0 + full)) - 1.0).abs() < 0.02,
        "{fraction} {full}"
    );
}

#[test]
fn every_pairing_dries_a_bed_alike() {
    let folder = tempfile::tempdir().unwrap();
    let settings = ["time.end=3 min", "output.every=3 min"];
    let case = program::shipped("wood-drying");
    let compared = program::compare(&case, folder.path(), "all", &settings);
    assert_eq!(compared["runs"].as_array().unwrap().len(), 4, "{compared}");
}

#[test]
fn a_bed_that_dries_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("wood-drying");
    let settings = [
        "time.end=3 min",
        "time.checkpoint.every=20 s",
        "output.series_every=10 s",
    ];
    let whole = killed::resumes_to_the_same_bits(folder.path(), &[4, 9], |out| {
        program::command(&case, out, &[], &settings)
    });
    closes(&whole);
}

#[test]
fn parcels_dry_and_give_off_volatiles_and_what_they_lose_is_in_the_gas() {
    let folder = tempfile::tempdir().unwrap();
    let runs = [("native", "native"), ("openfoam", "native")].map(|(gas, particles)| {
        let out = folder.path().join(gas);
        let words = ["--gas", gas, "--particles", particles];
        program::run(&good("drying-parcels"), &out, &words, &[""; 0]);
        let summary = closes(&out);
        ["water", "char"].map(|name| summary.quantities[name].value.unwrap())
    });
    println!("{runs:?}");
    let [[water, char], other] = runs;
    // Three quarters of them began with a fifth of water, the others without.
    assert!(water < 0.149 && char > 1e-4, "{water} {char}");
    for (one, other) in [water, char].iter().zip(other) {
        assert!((one / other - 1.0).abs() < 1e-3, "{runs:?}");
    }
}
