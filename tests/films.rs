//! Films of particles that react, through the program: the d² law at the state of the film, elements.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;
use calcine_coupler::physics::gas::GAS_CONSTANT;
use calcine_coupler::physics::thermo::Mixture;

use crate::support::program;

const PRESSURE: f64 = 101_325.0;
const HOT: f64 = 1200.0;
const OXYGEN: f64 = 0.21;

fn case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/carbon-film.toml")
}

/// d(d²)/dt in m²/s of the law with the film of a temperature by the name of the key, and mixture-averaged diffusivities.
fn law(film: &str, particle: f64) -> f64 {
    let share = match film {
        "gas" => 1.0,
        "mean" => 0.5,
        _ => 1.0 / 3.0,
    };
    let kelvin = particle + share * (HOT - particle);
    let air = Mixture::new(["O2", "N2"]).unwrap();
    slope(kelvin, air.pair_diffusivity((0, 1), PRESSURE, kelvin))
}

/// d(d²)/dt in m²/s of the law in a film of a temperature in K and a diffusivity in m²/s.
fn slope(kelvin: f64, diffusivity: f64) -> f64 {
    let weight = OXYGEN * 31.998e-3 + (1.0 - OXYGEN) * 28.014e-3;
    let density = PRESSURE * weight / (GAS_CONSTANT * kelvin);
    let spalding = OXYGEN * 12.011e-3 / weight;
    8.0 * density * diffusivity * spalding.ln_1p() / 1000.0
}

#[test]
fn carbon_follows_the_d_squared_law_whatever_its_temperature_its_window_and_its_solver() {
    let folder = tempfile::tempdir().unwrap();
    let mut runs = Vec::new();
    for particle in [600.0, 1200.0, 2400.0] {
        for film in ["two-thirds", "mean", "gas"] {
            runs.push((particle, film, 0.1, "native"));
        }
        runs.push((particle, "two-thirds", 0.01, "native"));
        runs.push((particle, "two-thirds", 0.45, "native"));
        runs.push((particle, "two-thirds", 0.1, "liggghts"));
    }
    for (particle, film, share, solver) in runs {
        let slope = law(film, particle);
        let life = 1e-6 / slope;
        let window = format!("{} s", share * life);
        let settings = [
            format!("time.end={} s", 0.9 * life),
            format!("time.process_step={window}"),
            format!("output.every={} s", 0.9 * life),
            format!("output.series_every={window}"),
            format!("particles[0].temperature={particle} K"),
            format!("laws.mass_transfer.film={film}"),
        ];
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let out = folder
            .path()
            .join(format!("{particle}-{film}-{share}-{solver}"));
        program::run(&case(), &out, &["--particles", solver], &settings);
        let summary = Summary::read(&out).unwrap();
        let series = Series::read(&out).unwrap();
        let (mass, time) = (
            series.column("quantities.mass"),
            series.column("process_time"),
        );
        let kept = 0.001 * mass[0];
        let square = |m: f64| 1e-6 * ((m - kept) / (mass[0] - kept)).powf(2.0 / 3.0);
        let last = mass.len() - 1;
        let found = (square(mass[0]) - square(mass[last])) / (time[last] - time[0]);
        println!("{particle} K {film} {share} {solver}: {}", found / slope);
        assert!(
            (found / slope - 1.0).abs() < 0.01,
            "{particle} K, {film}, windows of {share} of its life, {solver}: {found:e} {slope:e}"
        );
        let kelvin = series.column("quantities.temperature");
        assert!((kelvin[last] / particle - 1.0).abs() < 1e-3, "{kelvin:?}");
        // Of the others there is a hundred thousand times what passes.
        let carbon = summary.ledger.elements["C"].relative_error;
        assert!(carbon < 1e-12, "{carbon}");
    }
}

/// The mass of the sphere over time in a folder, with reactions in place of the case's own.
fn masses(folder: &Path, name: &str, reactions: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(case()).unwrap();
    let first = text.find("[[reactions]]").unwrap();
    let rest = text.find("[laws]").unwrap();
    let file = folder.join(format!("{name}.toml"));
    std::fs::write(
        &file,
        format!("{}{reactions}{}", &text[..first], &text[rest..]),
    )
    .unwrap();
    let out = folder.join(name);
    program::run(&file, &out, &["--particles", "native"], &[""; 0]);
    let summary = Summary::read(&out).unwrap();
    // Of the others there is a hundred thousand times what passes.
    let carbon = summary.ledger.elements["C"].relative_error;
    assert!(carbon < 1e-12, "{name}: {carbon}");
    Series::read(&out)
        .unwrap()
        .column("quantities.mass")
        .to_vec()
}

/// A reaction of a case file, of a factor and with an order of a gas.
fn reaction(name: &str, equation: &str, factor: f64, gas: &str) -> String {
    format!(
        "[[reactions]]\nname = \"{name}\"\nequation = \"{equation}\"\nlaw = \"power-law\"\n\
         rate = {{ factor = {factor:e}, orders = {{ {gas} = 1.0, C = 0.0 }} }}\n\n"
    )
}

#[test]
fn reactions_of_one_gas_burn_through_one_film() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let burn = |name: &str, factor: f64| reaction(name, "C + O2 => CO2", factor, "O2");
    // Limited by the film, by the reaction, and by both: 300/s · r/3 is 0.05 m/s, β about 0.6 m/s.
    for factor in [1e9, 3e3, 300.0] {
        let whole = masses(folder, &format!("whole-{factor}"), &burn("burn", factor));
        let halves = burn("first", 0.5 * factor) + &burn("second", 0.5 * factor);
        let halves = masses(folder, &format!("halves-{factor}"), &halves);
        let off = whole
            .iter()
            .zip(&halves)
            .map(|(a, b)| (a - b).abs() / whole[0]);
        println!("{factor}: {}", off.fold(0.0, f64::max));
        for (one, two) in whole.iter().zip(&halves) {
            assert!(
                (one - two).abs() < 1e-12 * whole[0],
                "{factor}: {one:e} {two:e}"
            );
        }
    }
    // What is burnt to dioxide at the surface takes up carbon again: twice as much of it.
    let plain = masses(folder, "plain", &burn("burn", 1e9));
    let gasification = reaction("gasification", "C + CO2 <=> 2 CO", 1e9, "CO2");
    let both = masses(folder, "both", &(burn("burn", 1e9) + &gasification));
    let ratio = (both[0] - both[2]) / (plain[0] - plain[2]);
    println!("with gasification {ratio} times the carbon");
    assert!(ratio > 1.8 && ratio < 2.1, "{ratio}");
}

/// A particle of 600 K for 0.9 of the life that a slope in m²/s gives it: d(d²)/dt over that slope.
fn burnt(out: &Path, solver: &str, diffusivity: &str, slope: f64) -> f64 {
    let life = 1e-6 / slope;
    let settings = [
        format!("time.end={} s", 0.9 * life),
        format!("time.process_step={} s", 0.1 * life),
        format!("output.every={} s", 0.9 * life),
        format!("output.series_every={} s", 0.1 * life),
        "particles[0].temperature=600 K".to_owned(),
        format!("laws.mass_transfer.diffusivity={diffusivity}"),
    ];
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    program::run(&case(), out, &["--particles", solver], &settings);
    let series = Series::read(out).unwrap();
    let (mass, time) = (
        series.column("quantities.mass"),
        series.column("process_time"),
    );
    let kept = 0.001 * mass[0];
    let square = |m: f64| 1e-6 * ((m - kept) / (mass[0] - kept)).powf(2.0 / 3.0);
    let last = mass.len() - 1;
    (square(mass[0]) - square(mass[last])) / (time[last] - time[0]) / slope
}

#[test]
fn carbon_follows_the_d_squared_law_by_every_choice_of_diffusivities() {
    let kelvin: f64 = 600.0 + (HOT - 600.0) / 3.0;
    let air = Mixture::new(["O2", "N2"]).unwrap();
    let weight = OXYGEN * 31.998e-3 + (1.0 - OXYGEN) * 28.014e-3;
    let density = PRESSURE * weight / (GAS_CONSTANT * kelvin);
    let oxygen = OXYGEN * 31.998e-3 / weight;
    let viscosity = air.viscosity(kelvin, &[oxygen, 1.0 - oxygen]);
    // 3e-5 m²/s at 400 K and 2 bar, growing with T^1.6.
    let stated = 3e-5 * (kelvin / 400.0).powf(1.6) * 2e5 / PRESSURE;
    let value = "{ value = \"3e-5 m^2/s\", at = \"400 K\", pressure = \"2 bar\", exponent = 1.6 }";
    let own = format!("{{ species = {{ O2 = {value} }} }}");
    let other = format!(
        "{{ value = \"9e-5 m^2/s\", at = \"300 K\", species = {{ O2 = {value}, CO2 = {value} }} }}"
    );
    let folder = tempfile::tempdir().unwrap();
    for (name, diffusivity, expected, tolerance) in [
        ("fuller", "fuller", law("two-thirds", 600.0), 0.01),
        (
            "schmidt",
            "schmidt",
            slope(kelvin, viscosity / density / 0.7),
            0.01,
        ),
        ("stated", value, slope(kelvin, stated), 0.01),
        ("of-oxygen", &own, slope(kelvin, stated), 0.01),
        ("of-two", &other, slope(kelvin, stated), 0.01),
    ] {
        for solver in ["native", "liggghts"] {
            let out = folder.path().join(format!("{name}-{solver}"));
            let found = burnt(&out, solver, diffusivity, expected);
            println!("{name} {solver}: {found}");
            assert!((found - 1.0).abs() < tolerance, "{name} {solver}: {found}");
        }
    }
}
