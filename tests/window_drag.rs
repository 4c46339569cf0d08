//! Drag that follows the particles within windows (`coupling.window_drag = "following"`, docs/theory.md, DRG-3), as whole
//! runs: balances, windows of several relaxation times, resumed runs, pairings.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::Summary;

use crate::support::results_equal;
use crate::support::{c_solver, killed, program};

const FOLLOWING: &str = "coupling.window_drag=following";
/// What closes the gas' own balances to round-off.
const CLOSED: [&str; 2] = [
    "gas.controls.outer_tolerance=1e-13",
    "gas.controls.linear_tolerance=1e-14",
];

/// Light spheres that fall through still gas from rest; a window is some relaxation times of theirs.
fn light(folder: &Path) -> PathBuf {
    let text = fs::read_to_string(program::shipped("settled-bed")).unwrap();
    let text = text
        .replace("16 16 120 mm", "8 8 64 mm")
        .replace("cells = [2, 2, 15]", "cells = [1, 1, 8]")
        .replace(
            "end = \"0.4 s\"",
            "end = \"0.16 s\"\ncheckpoint = { every = \"40 ms\" }",
        )
        .replace("motion_window = \"2 ms\"", "motion_window = \"40 ms\"")
        .replace("density = \"2500 kg/m^3\"", "density = \"8 kg/m^3\"")
        .replace("5 MPa", "50 kPa")
        .replace("diameter = \"2 mm\"", "diameter = \"1 mm\"")
        .replace(
            "from = \"10 mm\", to = \"90 mm\"",
            "from = \"35 mm\", to = \"60 mm\"",
        )
        .replace("solid_fraction = 0.2", "solid_fraction = 0.02")
        .replace("every = \"0.05 s\"", "every = \"40 ms\"")
        .replace("series_every = \"2 ms\"", "series_every = \"40 ms\"")
        .replace("0.35 s", "0.15 s");
    fs::copy(c_solver::particles(), folder.join("ballistic-particles")).unwrap();
    let external = r#"
[external.particles]
program = "ballistic-particles"
arguments = ["width=0.008", "depth=0.008", "height=0.064", "gravity=-9.81"]
"#;
    let case = folder.join("light.toml");
    fs::write(&case, text + external).unwrap();
    case
}

fn run(folder: &Path, name: &str, words: &[&str], set: &[&str]) -> Summary {
    let out = folder.join(name);
    program::run(&light(folder), &out, words, set);
    Summary::read(&out).unwrap()
}

fn closes(summary: &Summary, what: &str, lines: &[&str]) {
    for (name, line) in &summary.ledger.lines {
        println!("{what} {name:18} {:.1e}", line.relative_error);
    }
    for name in lines {
        let error = summary.ledger.lines[*name].relative_error;
        assert!(error < 1e-12, "{what}: {name}: {error:e}");
    }
}

const LINES: [&str; 5] = [
    "mass",
    "energy",
    "momentum",
    "gas_momentum",
    "particle_momentum",
];

#[test]
fn the_momentum_of_gas_and_particles_closes_with_what_is_carried_over() {
    for particles in ["native", "external", "liggghts"] {
        let folder = tempfile::tempdir().unwrap();
        let set = [&CLOSED[..], &[FOLLOWING]].concat();
        let words = ["--particles", particles];
        let summary = run(folder.path(), "run", &words, &set);
        closes(&summary, particles, &LINES);
        // Something is carried: particles that start from rest are not expected to be where they get to.
        let carry = &summary.ledger.lines["drag_carry"];
        assert!(carry.relative_error > 1e-6, "{particles}: {carry:?}");
    }
    // And with OpenFOAM's gas, whose own balance ends at its solvers' tolerances.
    let folder = tempfile::tempdir().unwrap();
    let summary = run(folder.path(), "run", &["--gas", "openfoam"], &[FOLLOWING]);
    closes(&summary, "openfoam", &["momentum", "particle_momentum"]);
    let constant = run(folder.path(), "constant", &[], &CLOSED);
    assert!(!constant.ledger.lines.contains_key("drag_carry"));
}

#[test]
fn it_closes_with_time_splitting_feeds_and_a_bed_that_is_held_for_a_time() {
    let folder = tempfile::tempdir().unwrap();
    // Held, the bed takes what the gas owes it of the window before; at another pace, the next one is as long as it likes.
    let held = [
        FOLLOWING,
        CLOSED[0],
        CLOSED[1],
        "time.end=0.16 s",
        "time.acceleration=[[\"0 s\", 1], [\"0.05 s\", 20], [\"0.15 s\", 1]]",
        "motion.held=[[\"0.05 s\", \"0.15 s\"]]",
        "materials.glass.density=67 kg/m^3",
    ];
    for particles in ["native", "liggghts"] {
        let out = folder.path().join(particles);
        let case = program::shipped("settled-bed");
        program::run(&case, &out, &["--particles", particles], &held);
        closes(&Summary::read(&out).unwrap(), particles, &LINES);
    }
    let out = folder.path().join("fed");
    let case = program::shipped("moving-bed");
    program::run(&case, &out, &[], &["time.end=20 s", FOLLOWING]);
    let lines = ["mass", "energy", "momentum", "particle_momentum"];
    closes(&Summary::read(&out).unwrap(), "fed", &lines);
}

/// Dust so thin and slow that neither the gas moves nor its drag depends much on its speed: relaxation times of 2 ms.
const DUST: [&str; 6] = [
    "particles[0].diameter=0.1 mm",
    "materials.glass.density=67 kg/m^3",
    "particles[0].place.solid_fraction=2e-5",
    "time.end=20 ms",
    "time.motion_window=10 ms",
    "output.series_every=10 ms",
];

#[test]
fn long_windows_find_the_fall_of_short_ones_where_constant_drag_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let height = |name: &str, set: &[&str]| {
        let summary = run(folder.path(), name, &[], &[&DUST[..], set].concat());
        summary.quantities["mean_height"].value.unwrap()
    };
    let start = height("start", &["time.end=1 us", "time.motion_window=1 us"]);
    let reference = height("short", &["time.motion_window=0.1 ms"]);
    let (constant, following) = (height("constant", &[]), height("following", &[FOLLOWING]));
    let fallen = start - reference;
    let [constant, following] = [constant, following].map(|one| (one - reference).abs() / fallen);
    println!("fallen {fallen} m; off by {constant:.4} constant, {following:.4} following");
    // By half of what the slip relaxes over in the first of two windows, against what the law of drag does not know of the
    // speed in the first window.
    assert!(
        constant > 0.1 && following < 0.25 * constant,
        "{following} {constant}"
    );
}

#[test]
fn check_says_where_windows_are_long_for_constant_drag() {
    let folder = tempfile::tempdir().unwrap();
    let case = light(folder.path());
    let told = |key: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
        let output = command.arg("check").arg(&case).args(["--set", key]);
        let output = output.output().unwrap();
        assert!(output.status.success());
        let remedy = "write coupling.window_drag = \"following\"";
        String::from_utf8_lossy(&output.stdout).contains(remedy)
    };
    assert!(told("coupling.window_drag=constant"));
    assert!(!told(FOLLOWING));
    assert!(!told("time.motion_window=1 ms"));
}

#[test]
fn a_run_with_it_resumes_to_the_same_bits_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let case = light(folder.path());
    let command = |threads: &'static str| {
        let case = case.clone();
        move |out: &Path| {
            let short = [
                FOLLOWING,
                "time.motion_window=10 ms",
                "time.checkpoint.every=10 ms",
                "output.series_every=10 ms",
            ];
            program::command(&case, out, &["--threads", threads], &short)
        }
    };
    let one = killed::resumes_to_the_same_bits(folder.path(), &[6], command("1"));
    let two = folder.path().join("two");
    assert!(command("2")(&two).output().unwrap().status.success());
    assert_eq!(results_equal::differences(&one, &two), [""; 0]);
}

#[test]
fn liggghts_resumes_to_the_same_bits_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let case = light(folder.path());
    killed::resumes_to_the_same_bits(folder.path(), &[6], |out| {
        let short = [
            FOLLOWING,
            "time.motion_window=10 ms",
            "time.checkpoint.every=10 ms",
            "output.series_every=10 ms",
        ];
        program::command(&case, out, &["--particles", "liggghts"], &short)
    });
}

#[test]
fn native_particles_and_liggghts_fall_alike_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let summaries = ["native", "liggghts"].map(|particles| {
        let words = ["--particles", particles];
        run(
            folder.path(),
            particles,
            &words,
            &["time.end=0.12 s", FOLLOWING],
        )
    });
    for name in ["mean_height", "mean_speed"] {
        let [native, liggghts] = [0, 1].map(|k| summaries[k].quantities[name].value.unwrap());
        let apart = (native / liggghts - 1.0).abs();
        println!("{name}: {native} and {liggghts}, {apart:.1e} apart");
        // The same kicks and the same gas, each rounded its own way, without a contact so far.
        assert!(apart < 1e-9, "{name}: {native} and {liggghts}");
    }
}

/// LIGGGHTS gets the columns of moving drag as messages; both ways give the same bits.
#[test]
fn over_mpi_particles_follow_as_over_shared_memory() {
    let folder = tempfile::tempdir().unwrap();
    let ways = ["shared-memory", "mpi"].map(|transport| {
        let words = ["--particles", "liggghts", "--transport", transport];
        let set = [&CLOSED[..], &[FOLLOWING, "time.end=80 ms"]].concat();
        let summary = run(folder.path(), transport, &words, &set);
        closes(&summary, transport, &LINES);
        summary.quantities
    });
    assert_eq!(ways[0], ways[1]);
}

#[test]
fn particles_that_do_not_take_it_are_refused_with_the_key() {
    let folder = tempfile::tempdir().unwrap();
    let case = light(folder.path());
    let source = c_solver::examples().join("ballistic_particles.c");
    let mut text = fs::read_to_string(source).unwrap();
    for (offer, without) in [
        ("weights\\nmoving_drag", "weights"),
        (
            ", {\"drag_impulse\", offsetof(particle, drag_impulse), 3}",
            "",
        ),
    ] {
        assert!(text.contains(offer), "{offer}");
        text = text.replace(offer, without);
    }
    let deaf = folder.path().join("deaf.c");
    fs::write(&deaf, text).unwrap();
    let include = c_solver::examples();
    let words = ["-I", include.to_str().unwrap()];
    let to = folder.path().join("ballistic-particles");
    c_solver::compile(deaf.to_str().unwrap(), &c_solver::header(), &words, &to);
    let out = folder.path().join("out");
    let output = program::command(&case, &out, &["--particles", "external"], &[FOLLOWING])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{told}");
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(
        told.contains("ballistic particles takes no column `drag_coefficient`")
            && told.contains("coupling.window_drag"),
        "{told}"
    );
}
