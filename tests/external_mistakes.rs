//! Mistakes of those who attach a solver, made by variants of the gas in C (`tests/support/mistakes.h`): each is told
//! with the column or the cause, ends with the documented exit code, and leaves the last checkpoint whole.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::c_solver::{self, examples};
use crate::support::program;
use crate::support::results_equal;

const GAS: [&str; 2] = ["--gas", "external"];
/// 80 windows of 50 ms, with a checkpoint each 20 windows.
const SET: [&str; 2] = ["time.end=4 s", "time.checkpoint={ every = \"1 s\" }"];

/// The gas with a mistake.
fn mistaken(folder: &Path, mistake: &str) -> PathBuf {
    let program = folder.join("column-gas");
    let wrapper = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/mistakes.h");
    let made = format!("-DMISTAKE={mistake}");
    let words = ["-include", wrapper.to_str().unwrap(), &made];
    c_solver::compile("column_gas.c", &c_solver::header(), &words, &program);
    program
}

fn case(folder: &Path) -> PathBuf {
    let case = folder.join("column.toml");
    fs::copy(examples().join("column.toml"), &case).unwrap();
    case
}

/// What a run says of its failure.
fn failure(case: &Path, out: &Path, code: i32) -> String {
    let output = program::command(case, out, &GAS, &SET).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{text}");
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

/// A mistake in window 50 is told with these words and exit code, and the run goes on from its last checkpoint, with
/// the right gas, to the bits of a run without the mistake.
fn told(mistake: &str, code: i32, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let (case, out) = (case(folder.path()), folder.path().join("run"));
    let program = mistaken(folder.path(), mistake);
    let text = failure(&case, &out, code);
    for word in words
        .iter()
        .chain(&["external gas", "the last checkpoint is in"])
    {
        assert!(text.contains(word), "{mistake}: `{word}` is not in {text}");
    }
    fs::copy(c_solver::gas(), &program).unwrap();
    program::run(&case, &out, &[&GAS[..], &["--resume"]].concat(), &SET);
    let whole = folder.path().join("whole");
    program::run(&case, &whole, &GAS, &SET);
    let differing = results_equal::differences(&whole, &out);
    assert!(differing.is_empty(), "{mistake}: {differing:?}");
}

#[test]
fn columns_of_another_length_are_told_with_both_lengths() {
    let words = "the columns of its FINISHED are of 12 cells, but it has 11";
    told("another_length", 4, &[words, "window 50"]);
}

#[test]
fn an_unknown_column_is_told_by_its_name() {
    let words = ["exit code 1", "has no column `temprature`"];
    told("unknown_column", 4, &words);
}

#[test]
fn a_column_that_was_forgotten_is_told_by_its_name() {
    let words = ["exit code 1", "its column `temperature` was never filled"];
    told("forgotten_column", 4, &words);
}

#[test]
fn death_within_a_window_is_told_with_its_signal() {
    told("death", 4, &["signal 9", "window 50"]);
}

#[test]
fn a_value_that_is_not_finite_is_told_with_column_and_cell() {
    told(
        "nan_value",
        3,
        &["its column temperature of cell 3 is NaN", "window 50"],
    );
    // What the energy stores: the first number of the second balance.
    told(
        "infinite_balance",
        3,
        &["its column balances[7] is inf", "window 50"],
    );
}

#[test]
fn answers_out_of_order_are_told_with_what_was_expected() {
    let words = "a message CHECKPOINTED (7) arrived where FINISHED was expected";
    told("another_kind", 4, &[words, "window 50"]);
    let words = "it answers window 50, attempt 0, where window 51, attempt 0 was asked for";
    told("twice", 4, &[words]);
}

#[test]
fn another_catalogue_is_told_with_the_column_before_the_run_begins() {
    let folder = tempfile::tempdir().unwrap();
    mistaken(folder.path(), "components");
    let text = failure(&case(folder.path()), &folder.path().join("run"), 4);
    let words = "start drag_coefficient 1 kg/s item here, but start drag_coefficient 3 kg/s item";
    assert!(text.contains(words), "{text}");
}

#[test]
fn the_header_of_another_version_is_told_with_both_versions() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(c_solver::header().join("calcine_wire.h")).unwrap();
    let version = calcine_wire::record::VERSION;
    let line = |version: u32| format!("#define CALCINE_WIRE_VERSION {version}u");
    assert!(text.contains(&line(version)));
    let other = text.replace(&line(version), &line(version - 1));
    fs::write(folder.path().join("calcine_wire.h"), other).unwrap();
    let program = folder.path().join("column-gas");
    c_solver::compile("column_gas.c", folder.path(), &[], &program);
    let text = failure(&case(folder.path()), &folder.path().join("run"), 4);
    let words = format!(
        "protocol version {}, the library of version {version}",
        version - 1
    );
    assert!(text.contains(&words), "{text}");
}
