//! The program as tests run it.

#![allow(clippy::unwrap_used, dead_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A shipped case.
pub fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{name}.toml"))
}

/// The command of a run, without a progress bar, with keys of the case set.
pub fn command(case: &Path, out: &Path, words: &[&str], set: &[impl AsRef<str>]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.args(["run", "--quiet"]).arg(case).args(words);
    command.arg("--out").arg(out);
    for setting in set {
        command.args(["--set", setting.as_ref()]);
    }
    command
}

/// Runs to the end, or fails with what the program said.
pub fn run(case: &Path, out: &Path, words: &[&str], set: &[impl AsRef<str>]) {
    let output = command(case, out, words, set).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {told}", case.display());
}

/// Writes a case and runs it into a folder of its name, which is returned.
pub fn run_text(directory: &Path, name: &str, text: &str, words: &[&str]) -> PathBuf {
    let (file, out) = (directory.join(format!("{name}.toml")), directory.join(name));
    fs::write(&file, text).unwrap();
    run(&file, &out, words, &[""; 0]);
    out
}

/// Compares pairings within the case's bands, or fails with what the program said; `compare.json`.
pub fn compare(
    case: &Path,
    out: &Path,
    pairings: &str,
    set: &[impl AsRef<str>],
) -> serde_json::Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.arg("compare").arg(case).arg("--quiet");
    command.args(["--pairings", pairings]).arg("--out").arg(out);
    for setting in set {
        command.args(["--set", setting.as_ref()]);
    }
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    let table = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}: {table}{told}", case.display());
    serde_json::from_str(&fs::read_to_string(out.join("compare.json")).unwrap()).unwrap()
}
