//! A gas that is not ours, in plain C against the wire's header alone (`adapters/wire/examples/column_gas.c`): coupled
//! with every kind of particles, refused where it has another mesh, resumed, and started by hand.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use calcine::results::Summary;

use crate::support::c_solver::{self, examples};
use crate::support::killed;
use crate::support::program;

const GAS: [&str; 2] = ["--gas", "external"];

/// The example's case with the gas beside it.
fn column(folder: &Path) -> PathBuf {
    fs::copy(c_solver::gas(), folder.join("column-gas")).unwrap();
    let case = folder.join("column.toml");
    fs::copy(examples().join("column.toml"), &case).unwrap();
    case
}

fn closes(out: &Path) {
    let summary = Summary::read(out).unwrap();
    for (name, line) in &summary.ledger.lines {
        println!("{name:18} {:.1e}", line.relative_error);
    }
    for name in [
        "mass",
        "energy",
        "energy_exchange",
        "momentum",
        "gas_momentum",
    ] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-12, "{name}: {error:e}");
    }
    assert_eq!(summary.convergence.unconverged_windows, 0);
    assert_eq!(summary.backend.gas, "external");
}

fn closes_with(particles: &str) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let words = [&GAS[..], &["--particles", particles]].concat();
    program::run(&column(folder.path()), &out, &words, &[""; 0]);
    closes(&out);
    // What the solver may use of the case lies where it runs.
    for name in ["case.toml", "constant/polyMesh/points"] {
        assert!(
            out.join("solvers/external-gas").join(name).is_file(),
            "{name}"
        );
    }
}

#[test]
fn a_gas_in_plain_c_couples_with_native_particles_and_its_ledger_closes() {
    closes_with("native");
}

#[test]
fn a_gas_in_plain_c_couples_with_liggghts_and_its_ledger_closes() {
    closes_with("liggghts");
}

/// Beads fall through gas whose bottom is closed: they displace it upwards and drag it along downwards.
fn falling(folder: &Path) -> PathBuf {
    fs::copy(c_solver::gas(), folder.join("column-gas")).unwrap();
    let text = fs::read_to_string(program::shipped("settled-bed")).unwrap();
    let text = text
        .replace("cells = [2, 2, 15]", "cells = [1, 1, 15]")
        .replace("end = \"0.4 s\"", "end = \"0.1 s\"");
    let external = "[external.gas]\nprogram = \"column-gas\"\narguments = [\"width=0.016\", \"depth=0.016\", \
                    \"height=0.12\", \"cells=15\", \"gravity=-9.81\"]\n";
    let case = folder.join("falling.toml");
    fs::write(&case, text + external).unwrap();
    case
}

#[test]
fn its_ledger_closes_while_beads_fall_through_it_natively_and_in_liggghts() {
    for particles in ["native", "liggghts"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let words = [&GAS[..], &["--particles", particles]].concat();
        program::run(&falling(folder.path()), &out, &words, &[""; 0]);
        closes(&out);
    }
}

#[test]
fn it_agrees_with_the_native_gas_but_for_the_conduction_that_it_leaves_out() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("compare");
    let pairings = "native+native,external+native";
    program::compare(&column(folder.path()), &out, pairings, &[""; 0]);
}

#[test]
fn a_run_with_it_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = column(folder.path());
    killed::resumes_to_the_same_bits(folder.path(), &[60], |out| {
        program::command(&case, out, &GAS, &["time.acceleration=10"])
    });
}

fn refused(folder: &Path, set: &[&str], code: i32) -> String {
    let out = folder.join("refused");
    let output = program::command(&column(folder), &out, &GAS, set)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{text}");
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

#[test]
fn another_mesh_is_refused_with_the_cell_and_both_volumes() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["mesh.box.size=10 10 111 mm"];
    let text = refused(folder.path(), &set, 4);
    assert!(
        text.contains("external gas") && text.contains("its cell 0 has"),
        "{text}"
    );
    let set = ["mesh.box.cells=[1, 1, 12]"];
    let text = refused(folder.path(), &set, 4);
    assert!(text.contains("is 12 here, but 11"), "{text}");
}

#[test]
fn its_failure_arrives_with_its_kind_and_words() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["external.gas.arguments=[\"width=wide\"]"];
    let text = refused(folder.path(), &set, 4);
    assert!(text.contains("`width=wide` has no number"), "{text}");
    // The density of gas so cold is beyond any number.
    let list = "\"width=0.01\", \"depth=0.01\", \"height=0.11\", \"cells=11\", \"velocity=0.5\"";
    let set = format!("external.gas.arguments=[{list}, \"inlet_temperature=1e-310\"]");
    let text = refused(folder.path(), &[&set], 3);
    assert!(
        text.contains("not finite in cell 0 at z = 0.005 m"),
        "{text}"
    );
}

#[test]
fn a_case_without_it_or_with_a_file_that_cannot_run_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let case = program::shipped("heated-column");
    let output = program::command(&case, &out, &GAS, &[""; 0])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("[external.gas]"), "{text}");

    let case = column(folder.path());
    let set = ["external.gas.program=column.toml"];
    let output = program::command(&case, &out, &GAS, &set).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("no executable file"), "{text}");
}

#[test]
fn it_may_be_started_by_hand() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut run = program::command(&column(folder.path()), &out, &GAS, &["time.end=1 s"]);
    run.arg("--attach")
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let mut run = run.spawn().unwrap();
    let mut said = BufReader::new(run.stderr.take().unwrap());
    let mut line = String::new();
    while !line.trim_start().starts_with("(cd ") {
        line.clear();
        assert!(
            said.read_line(&mut line).unwrap() > 0,
            "it ended without a line to start"
        );
    }
    let by_hand = Command::new("sh").args(["-c", &line]).status().unwrap();
    assert!(by_hand.success() && run.wait().unwrap().success());
}
