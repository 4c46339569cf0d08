//! `calcine conform`: the laws of the conformance suite against programs that are not ours.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use std::process::{Command, Output};

use crate::support::c_solver;

/// The column of the suite in the words of `column_gas.c`.
const COLUMN: [&str; 6] = [
    "width=0.01",
    "depth=0.01",
    "height=0.11",
    "cells=11",
    "velocity=0.5",
    "inlet_temperature=350",
];
/// The box of the suite in the words of `ballistic_particles.c`.
const BOX: [&str; 3] = ["width=0.1", "depth=0.1", "height=0.1"];

fn conform(role: &str, program: &Path, words: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["conform", role])
        .arg(program)
        .arg("--out")
        .arg(folder.path().join("conform"))
        .arg("--")
        .args(words)
        .output()
        .unwrap();
    println!("{}", String::from_utf8_lossy(&output.stdout));
    println!("{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn a_gas_in_plain_c_obeys_all_laws_of_a_gas() {
    let output = conform("--gas", c_solver::gas(), &COLUMN);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output).contains("12 of 12 laws hold"));
}

#[test]
fn particles_in_plain_c_obey_all_laws_of_particles() {
    let output = conform("--particles", c_solver::particles(), &BOX);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output).contains("13 of 13 laws hold"));
}

#[test]
fn a_broken_law_is_named_with_its_figures_and_the_others_are_still_run() {
    // The box of the suite has no gravity.
    let output = conform(
        "--particles",
        c_solver::particles(),
        &[&BOX[..], &["gravity=-9.81"]].concat(),
    );
    assert_eq!(output.status.code(), Some(5));
    let text = text(&output);
    let broken = text
        .lines()
        .find(|line| line.starts_with("BROKEN"))
        .unwrap();
    assert!(
        broken.contains("a free particle gains its impulse and a held one stays")
            && broken.contains("N s"),
        "{broken}"
    );
    assert!(text.contains("11 of 13 laws hold"), "{text}");
}

#[test]
fn a_program_that_is_not_there_is_refused() {
    let output = conform("--gas", Path::new("nowhere/gas"), &[]);
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        told.contains("nowhere/gas is neither native nor openfoam nor a program"),
        "{told}"
    );
}
