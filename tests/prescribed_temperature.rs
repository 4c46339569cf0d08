//! Particles of a prescribed temperature: gas heated along a bed of them, the ledger, a ramp, resumed runs.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine_coupler::physics::heat_transfer::{Gunn, HeatTransfer};
use calcine_coupler::physics::local::LocalGas;
use calcine_coupler::physics::numbers::VoidFraction;

use crate::support::{killed, program};

const DENSITY: f64 = 1000.0;
const HEAT_CAPACITY: f64 = 4000.0;
const VISCOSITY: f64 = 1e-3;
const CONDUCTIVITY: f64 = 0.6;
const SPEED: f64 = 0.05;
const INLET: f64 = 300.0;
const BED: f64 = 350.0;

/// Ten spheres one above the other in a stream of constant properties.
fn case(temperature: &str) -> String {
    format!(
        r#"
format = 1
title = "A stream along spheres of a prescribed temperature"

[time]
end = "20 s"
motion_window = "50 ms"
checkpoint = {{ every = "1 s" }}

[mesh]
box = {{ size = "10 10 110 mm", cells = [1, 1, 11] }}

[materials.steel]
density = "7800 kg/m^3"
heat_capacity = [["300 K", "440 J/kg/K"], ["600 K", "560 J/kg/K"]]

[gas]
mixture = "stream"
constant = {{ density = "{DENSITY} kg/m^3", viscosity = "{VISCOSITY} Pa s", heat_capacity = "{HEAT_CAPACITY} J/kg/K", conductivity = "{CONDUCTIVITY} W/m/K" }}
initial = {{ temperature = "{INLET} K", pressure = "1 atm", velocity = "0 0 {SPEED} m/s" }}
controls = {{ convection = "upwind" }}

[gas.patch.bottom]
inlet = {{ superficial_velocity = "{SPEED} m/s", temperature = "{INLET} K" }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
symmetry = {{}}

[[particles]]
name = "spheres"
material = "steel"
diameter = "10 mm"
motion = "frozen"
place = {{ grid = {{ first = "5 5 5 mm", spacing = "10 10 10 mm", counts = [1, 1, 10] }} }}
{temperature}

[laws]
drag = {{ law = "ergun-wen-yu" }}
heat_transfer = {{ law = "gunn" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}

[coupling]
mapping = "overlap"
smoother = {{ max_solid_fraction = 0.64, diffusion_length = "0 mm" }}

[output]
every = "10 s"
series_every = "50 ms"
gas = ["temperature"]
particles = ["temperature", "heat"]

[[quantities]]
name = "leaving"
measure = {{ gas = "temperature", patch = "top", statistic = "mean" }}

[[quantities]]
name = "coldest"
measure = {{ particles = "temperature", statistic = "min" }}
"#
    )
}

/// Capacity of the stream in W/K, and the transfer units of all spheres by Gunn.
fn transfer_units() -> (f64, f64) {
    let diameter = 0.01;
    let void_fraction = 1.0 - std::f64::consts::PI / 6.0;
    let local = LocalGas {
        void_fraction: VoidFraction::new(void_fraction).unwrap(),
        density: DENSITY,
        viscosity: VISCOSITY,
        conductivity: CONDUCTIVITY,
        heat_capacity: HEAT_CAPACITY,
        slip: SPEED / void_fraction,
    };
    let conductance =
        Gunn.nusselt(&local, diameter) * CONDUCTIVITY * std::f64::consts::PI * diameter;
    let capacity = DENSITY * SPEED * 1e-4 * HEAT_CAPACITY;
    (capacity, 10.0 * conductance / capacity)
}

fn run(directory: &Path, name: &str, temperature: &str, words: &[&str], end: &str) -> Summary {
    let file = directory.join(format!("{name}.toml"));
    fs::write(&file, case(temperature)).unwrap();
    let out = directory.join(name);
    let tolerance = "gas.controls.outer_tolerance=1e-8".to_owned();
    program::run(&file, &out, words, &[format!("time.end={end}"), tolerance]);
    Summary::read(&out).unwrap()
}

#[test]
fn a_stream_takes_the_temperature_of_the_bed_by_its_transfer_units_and_the_ledger_says_what_that_took()
 {
    let directory = tempfile::tempdir().unwrap();
    let (capacity, units) = transfer_units();
    for (gas, particles) in [
        ("native", "native"),
        ("native", "liggghts"),
        ("openfoam", "native"),
    ] {
        let words = ["--gas", gas, "--particles", particles];
        let held = format!("prescribed_temperature = \"{BED} K\"");
        let ends = ["20 s", "40 s"].map(|end| {
            let name = format!("{gas}-{particles}-{}", &end[..2]);
            run(directory.path(), &name, &held, &words, end)
        });
        let leaving = ends[1].quantities["leaving"].value.unwrap();
        let left = (BED - leaving) / (BED - INLET);
        // Each of ten cells is stirred: exp(−NTU) of as many cells as one likes.
        let expected = (1.0 + units / 10.0).powi(-10);
        println!("{gas} + {particles}: {left}, closed form {expected}");
        assert!((left / expected - 1.0).abs() < 1e-4, "{left} {expected}");
        assert_eq!(ends[1].quantities["coldest"].value.unwrap(), BED);
        let [short, long] = &ends.map(|one| one.ledger.lines);
        assert!(long["energy"].relative_error < 1e-12, "{long:?}");
        // What the stream carries away in 20 s of steady flow.
        let supplied = long["prescribed_heat"].drift - short["prescribed_heat"].drift;
        let carried = capacity * (leaving - INLET) * 20.0;
        println!("supplied {supplied} J, carried away {carried} J");
        assert!(
            (supplied / carried - 1.0).abs() < 1e-9,
            "{supplied} {carried}"
        );
    }
}

#[test]
fn a_ramp_is_followed_and_pays_for_what_the_spheres_store() {
    let directory = tempfile::tempdir().unwrap();
    let ramp = "prescribed_temperature = [[\"0 s\", \"300 K\"], [\"5 s\", \"400 K\"]]";
    let alone = directory.path().join("alone");
    fs::create_dir(&alone).unwrap();
    // Without heat transfer all of the heat is what they store: c = 440 + 0.4 (T − 300) J/kg/K.
    let text = case(ramp).replace("{ law = \"gunn\" }", "{ law = \"none\" }");
    let out = program::run_text(&alone, "ramp", &text, &[]);
    let summary = Summary::read(&out).unwrap();
    assert_eq!(summary.quantities["coldest"].value.unwrap(), 400.0);
    let mass = 10.0 * 7800.0 * std::f64::consts::PI / 6.0 * 1e-6;
    let stored = mass * 460.0 * 100.0;
    let supplied = summary.ledger.lines["prescribed_heat"].drift;
    assert!(
        (supplied / stored - 1.0).abs() < 1e-12,
        "{supplied} {stored}"
    );
    let energy = summary.ledger.lines["energy"].relative_error;
    assert!(energy < 1e-12, "{energy}");
}

#[test]
fn a_run_without_prescribed_temperatures_has_no_such_line() {
    let directory = tempfile::tempdir().unwrap();
    let free = run(
        directory.path(),
        "free",
        "temperature = \"350 K\"",
        &[],
        "1 s",
    );
    assert!(!free.ledger.lines.contains_key("prescribed_heat"));
}

#[test]
fn a_ramp_resumes_to_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let file: PathBuf = directory.path().join("ramp.toml");
    let ramp = "prescribed_temperature = [[\"0 s\", \"300 K\"], [\"9 s\", \"400 K\"]]";
    fs::write(&file, case(ramp)).unwrap();
    killed::resumes_to_the_same_bits(directory.path(), &[60, 130], |out| {
        program::command(&file, out, &[], &["time.end=60 s"])
    });
}
