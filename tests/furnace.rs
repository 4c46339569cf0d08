//! Bodies that store heat, cut out of the mesh of the gas, through the program: balances, pairings, interrupts, an exact course.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::{killed, program};

fn crucible() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/crucible.toml")
}

/// Runs the crucible; its temperature and the lime in it over time, its ledger closed.
fn burnt(out: &Path, words: &[&str], set: &[&str]) -> [Vec<f64>; 2] {
    program::run(&crucible(), out, words, set);
    let summary = Summary::read(out).unwrap();
    for name in [
        "mass",
        "energy",
        "energy_exchange",
        "body_energy",
        "particle_mass",
    ] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-10, "{words:?}: {name}: {error}");
    }
    assert_eq!(summary.convergence.unsettled_windows, 0);
    let series = Series::read(out).unwrap();
    ["crucible_temperature", "lime"]
        .map(|name| series.column(&format!("quantities.{name}")).to_vec())
}

fn largest(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let pairs = one.iter().zip(other);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_crucible_takes_part_alike_in_every_pairing_and_its_ledger_closes() {
    let folder = tempfile::tempdir().unwrap();
    let native = burnt(&folder.path().join("native"), &[], &[]);
    let lime = native[1].last().unwrap();
    assert!(*lime > 0.9, "{lime}");
    for (gas, particles) in [
        ("native", "liggghts"),
        ("openfoam", "native"),
        ("openfoam", "liggghts"),
    ] {
        let out = folder.path().join(format!("{gas}-{particles}"));
        let other = burnt(&out, &["--gas", gas, "--particles", particles], &[]);
        let apart = [0, 1].map(|k| largest(&native[k], &other[k]));
        println!("{gas} {particles}: {} K, {} of lime", apart[0], apart[1]);
        // Attempts end at 1e-6 of the heat that is exchanged.
        assert!(apart[0] < 1e-3 && apart[1] < 1e-5, "{apart:?}");
    }
}

#[test]
fn a_run_killed_while_a_crucible_heats_up_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let settings = [
        "time.process_step=4 s",
        "output.series_every=4 s",
        "time.checkpoint.every=20 s",
    ];
    killed::resumes_to_the_same_bits(folder.path(), &[10, 30], |out| {
        program::command(&crucible(), out, &[], &settings)
    });
}

/// The crucible alone with a furnace that it sees, beside a gas without conductivity: m c dT/dt = e σ A (T_s⁴ − T⁴), by Runge
/// and Kutta's fourth order, as a separate integration.
fn alone(end: f64) -> f64 {
    const RATE: f64 = 0.15 * 5.670_374_419e-8 * 3e-4 / 5e-3;
    let capacity = |kelvin: f64| 133.0 + (kelvin - 300.0) / 1200.0 * 31.0;
    let slope = |time: f64, kelvin: f64| {
        let furnace = 960.0 + 2.0 * time.min(100.0);
        RATE * (furnace.powi(4) - kelvin.powi(4)) / capacity(kelvin)
    };
    let (mut time, mut kelvin, step) = (0.0, 960.0, 0.01);
    while time < end - 0.5 * step {
        let a = slope(time, kelvin);
        let b = slope(time + 0.5 * step, kelvin + 0.5 * step * a);
        let c = slope(time + 0.5 * step, kelvin + 0.5 * step * b);
        let d = slope(time + step, kelvin + step * c);
        kelvin += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        time += step;
    }
    kelvin
}

#[test]
fn a_crucible_that_only_radiates_converges_to_its_exact_course_by_first_order() {
    let folder = tempfile::tempdir().unwrap();
    let error = |step: f64| {
        let out = folder.path().join(format!("{step}"));
        let step = format!("time.process_step={step} s");
        // No surface to the gas, no wall to particles.
        let set = [
            &*step,
            "time.end=60 s",
            "gas.patch.crucible.wall.heat=adiabatic",
            "laws.conduction={ law = \"none\" }",
            "laws.radiation={ law = \"none\" }",
            "gas.held=true",
            "bodies.crucible.mass=5 g",
        ];
        let [kelvin, _] = burnt(&out, &[], &set);
        kelvin.last().unwrap() - alone(60.0)
    };
    let [coarse, fine] = [10.0, 5.0].map(error);
    println!("{coarse} K, {fine} K");
    assert!(coarse.abs() < 5.0, "{coarse}");
    let order = (coarse / fine).log2();
    assert!((0.9..1.1).contains(&order), "{order}");
}

#[test]
fn a_heavy_crucible_stays_behind_a_light_one() {
    let folder = tempfile::tempdir().unwrap();
    let at = |mass: &str| {
        let set = [&*format!("bodies.crucible.mass={mass}"), "time.end=60 s"];
        let [kelvin, _] = burnt(&folder.path().join(mass), &[], &set);
        *kelvin.last().unwrap()
    };
    let [light, heavy] = ["50 mg", "5 g"].map(at);
    // The furnace has 1080 K by then.
    assert!(
        light > heavy + 5.0 && light < 1080.0 && heavy > 960.0,
        "{light} {heavy}"
    );
}

#[test]
fn grains_that_get_shells_where_they_need_them_burn_as_those_that_have_them_from_the_start() {
    let folder = tempfile::tempdir().unwrap();
    let lime = |inside: &str, diameter: &str, permeability: &str| {
        let set = [
            format!("materials.calcite.inside={inside}"),
            format!("particles.grains.diameter={diameter}"),
            "materials.calcite.radial.true_densities={ CaCO3 = \"2711 kg/m^3\", CaO = \"3340 kg/m^3\" }"
                .into(),
            "materials.calcite.radial.pore_diameter=1 um".into(),
            "materials.calcite.radial.tortuosity=2".into(),
            format!("materials.calcite.radial.permeability={{ law = \"constant\", value = \"{permeability}\" }}"),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let out = folder.path().join(format!("{inside}-{diameter}"));
        let [_, lime] = burnt(&out, &[], &set);
        lime
    };
    for (diameter, permeability) in [("0.156 mm", "1e-16 m^2"), ("0.7 mm", "1e-13 m^2")] {
        let [auto, radial] = ["auto", "radial"].map(|inside| lime(inside, diameter, permeability));
        let off = largest(&auto, &radial);
        println!("{diameter}: {off} of lime");
        // Requirement: 0.1 %.
        assert!(
            off < 1e-3 && *radial.last().unwrap() > 0.99,
            "{diameter}: {off}"
        );
    }
}

/// Burnt grains whose pores begin with a trace of carbon dioxide, on a floor of the crucible that is swept and heated further.
fn glow(out: &Path, set: &[&str]) -> Summary {
    const RAMP: &str = r#"[["0 s", "1060 K"], ["1000 s", "1160 K"]]"#;
    let ramped = [
        "gas.patch.bottom.inlet.temperature",
        "gas.patch.side.wall.heat.temperature",
        "bodies.crucible.radiation.surroundings",
    ];
    let ramps: Vec<String> = ramped.iter().map(|key| format!("{key}={RAMP}")).collect();
    let fixed = [
        "time.process_step=10 s",
        "bodies.crucible.mass=0.05 g",
        "bodies.crucible.temperature=1060 K",
        "gas.initial.temperature=1060 K",
        "gas.initial.composition={ mole = { CO2 = 1e-9, N2 = 0.999999999 } }",
        "particles.grains.temperature=1060 K",
        "particles.grains.diameter=0.4 mm",
        "particles.grains.place={ grid = { first = \"5 5 8.199 mm\", spacing = \"0.4 0.4 0.4 mm\", counts = [5, 5, 3] } }",
        "materials.calcite.density=1367 kg/m^3",
        "materials.calcite.composition={ mass = { CaO = 1 } }",
        "materials.calcite.inside=radial",
        "materials.calcite.radial.shells=4",
        "materials.calcite.radial.true_densities={ CaCO3 = \"2711 kg/m^3\", CaO = \"3340 kg/m^3\" }",
        "materials.calcite.radial.pore_diameter=1 um",
        "materials.calcite.radial.tortuosity=2",
        "materials.calcite.radial.permeability={ law = \"constant\", value = \"1e-14 m^2\" }",
    ];
    let all: Vec<&str> = ramps.iter().map(String::as_str).collect();
    burnt(out, &[], &[&all[..], &fixed, set].concat());
    Summary::read(out).unwrap()
}

#[test]
fn burnt_grains_settle_with_the_last_trace_of_what_their_pores_held() {
    let folder = tempfile::tempdir().unwrap();
    // 16 attempts in the first window, 12 in the others. Where traces hold back the temperatures of the gas it takes 440.
    let summary = glow(folder.path(), &[]);
    println!("{:?}", summary.convergence);
    assert_eq!(summary.convergence.cuts, 0);
    assert!(summary.convergence.attempts < 300);
}
