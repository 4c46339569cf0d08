//! Runs of moving particles with real LIGGGHTS.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::Command;

use super::program;

pub use super::program::shipped as case;

const WITH: [&str; 2] = ["--particles", "liggghts"];

/// The command of a run with LIGGGHTS.
pub fn command(case: &Path, out: &Path, set: &[&str]) -> Command {
    program::command(case, out, &WITH, set)
}

/// Runs to the end; what it said where it failed.
pub fn run(case: &Path, out: &Path, set: &[&str]) {
    program::run(case, out, &WITH, set);
}

/// What a run says that must fail.
pub fn refused(case: &Path, out: &Path, set: &[&str]) -> String {
    let output = command(case, out, set).output().unwrap();
    assert!(!output.status.success(), "{}", case.display());
    String::from_utf8_lossy(&output.stderr).into_owned()
}
