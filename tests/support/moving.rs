//! Runs of moving particles with real LIGGGHTS: the program, its series, its summary.

#![allow(clippy::unwrap_used, dead_code)]

use std::path::{Path, PathBuf};
use std::process::Command;

/// A shipped case.
pub fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{name}.toml"))
}

/// The command of a run with LIGGGHTS.
pub fn command(case: &Path, out: &Path, set: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.arg("run").arg(case).arg("--out").arg(out);
    command.args(["--particles", "liggghts", "--quiet"]);
    for setting in set {
        command.args(["--set", setting]);
    }
    command
}

/// Runs to the end; what it said where it failed.
pub fn run(case: &Path, out: &Path, set: &[&str]) {
    let output = command(case, out, set).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {text}", case.display());
}

/// What a run says that must fail.
pub fn refused(case: &Path, out: &Path, set: &[&str]) -> String {
    let output = command(case, out, set).output().unwrap();
    assert!(!output.status.success(), "{}", case.display());
    String::from_utf8_lossy(&output.stderr).into_owned()
}
