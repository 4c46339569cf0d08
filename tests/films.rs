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

/// Share of film temperature that is the gas' by the name of the key, and d(d²)/dt in m²/s of the law.
fn law(film: &str, particle: f64) -> f64 {
    let share = match film {
        "gas" => 1.0,
        "mean" => 0.5,
        _ => 1.0 / 3.0,
    };
    let kelvin = particle + share * (HOT - particle);
    let air = Mixture::new(["O2", "N2"]).unwrap();
    let weight = OXYGEN * 31.998e-3 + (1.0 - OXYGEN) * 28.014e-3;
    let density = PRESSURE * weight / (GAS_CONSTANT * kelvin);
    let spalding = OXYGEN * 12.011e-3 / weight;
    let diffusivity = air.pair_diffusivity((0, 1), PRESSURE, kelvin);
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
