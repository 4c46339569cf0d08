//! Particles that are not ours, in plain C against the wire's header alone
//! (`adapters/wire/examples/ballistic_particles.c`): coupled with the native gas and with a gas in C, resumed.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};

use calcine::results::Summary;

use crate::support::c_solver;
use crate::support::killed;
use crate::support::program;

const PARTICLES: [&str; 2] = ["--particles", "external"];

const EXTERNAL: &str = r#"
[external.particles]
program = "ballistic-particles"
arguments = ["width=0.016", "depth=0.016", "height=0.12", "gravity=-9.81"]

[external.gas]
program = "column-gas"
arguments = ["width=0.016", "depth=0.016", "height=0.12", "cells=15", "gravity=-9.81"]
"#;

/// Beads fall through gas, for as long as none reaches the bottom.
fn falling(folder: &Path) -> PathBuf {
    for (from, name) in [
        (c_solver::particles(), "ballistic-particles"),
        (c_solver::gas(), "column-gas"),
    ] {
        fs::copy(from, folder.join(name)).unwrap();
    }
    let text = fs::read_to_string(program::shipped("settled-bed")).unwrap();
    let text = text
        .replace("cells = [2, 2, 15]", "cells = [1, 1, 15]")
        .replace(
            "end = \"0.4 s\"",
            "end = \"0.04 s\"\ncheckpoint = { every = \"5 ms\" }",
        );
    let case = folder.join("falling.toml");
    fs::write(&case, text + EXTERNAL).unwrap();
    case
}

fn closes(out: &Path, gas: &str) {
    let summary = Summary::read(out).unwrap();
    for (name, line) in &summary.ledger.lines {
        println!("{gas} {name:18} {:.1e}", line.relative_error);
    }
    for name in [
        "mass",
        "energy",
        "momentum",
        "gas_momentum",
        "particle_momentum",
    ] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-12, "{gas}: {name}: {error:e}");
    }
    assert_eq!(summary.backend.particles, "external");
}

#[test]
fn particles_in_plain_c_fall_through_native_gas_and_gas_in_c_and_the_ledger_closes() {
    for gas in ["native", "external"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let words = [&PARTICLES[..], &["--gas", gas]].concat();
        let set = [
            "gas.controls.outer_tolerance=1e-13",
            "gas.controls.linear_tolerance=1e-14",
        ];
        program::run(&falling(folder.path()), &out, &words, &set);
        closes(&out, gas);
        for name in ["case.toml", "particles.csv"] {
            let file = out.join("solvers/external-particles").join(name);
            assert!(file.is_file(), "{name}");
        }
    }
}

#[test]
fn a_run_with_them_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = falling(folder.path());
    killed::resumes_to_the_same_bits(folder.path(), &[8], |out| {
        program::command(&case, out, &PARTICLES, &[""; 0])
    });
}

#[test]
fn a_particle_that_leaves_the_box_ends_the_run_with_its_id_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let output = program::command(
        &falling(folder.path()),
        &out,
        &PARTICLES,
        &["time.end=0.2 s"],
    )
    .output()
    .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{text}");
    assert_eq!(output.status.code(), Some(3), "{text}");
    assert!(
        text.contains("external particles") && text.contains("outside the box"),
        "{text}"
    );
    assert!(text.contains("the last checkpoint is in"), "{text}");
}

#[test]
fn a_case_without_them_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let case = program::shipped("heated-column");
    let output = program::command(&case, &out, &PARTICLES, &[""; 0])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("[external.particles]"), "{text}");
}
