//! `--resume` after kill -9: the same values in every dataset as the uninterrupted run.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::support::killed;
use crate::support::program::{self, shipped};
use crate::support::results_equal;

/// A run with checkpoints each 2 s of process time; long enough to be killed in its middle.
fn command(pairing: [&str; 2], out: &Path, end: &str) -> Command {
    let end = format!("time.end={end}");
    let set = [
        "time.acceleration=5",
        end.as_str(),
        "time.checkpoint.every=2 s",
        "output.every=7 s",
        "output.series_every=0.1 s",
    ];
    let words = ["--gas", pairing[0], "--particles", pairing[1]];
    program::command(&shipped("heated-column"), out, &words, &set)
}

fn killed_and_resumed(pairing: [&str; 2], end: &str, rows: &[usize]) {
    let directory = tempfile::tempdir().unwrap();
    killed::resumes_to_the_same_bits(directory.path(), rows, |out| command(pairing, out, end));
}

#[test]
fn a_native_run_resumes_to_the_same_bits() {
    killed_and_resumed(["native", "native"], "40 s", &[30, 111, 250]);
}

#[test]
fn a_run_with_liggghts_resumes_to_the_same_bits() {
    killed_and_resumed(["native", "liggghts"], "20 s", &[60]);
}

#[test]
fn a_run_with_openfoam_resumes_to_the_same_bits() {
    killed_and_resumed(["openfoam", "native"], "20 s", &[60]);
}

#[test]
fn a_run_with_both_external_solvers_resumes_to_the_same_bits() {
    killed_and_resumed(["openfoam", "liggghts"], "20 s", &[90]);
}

#[test]
fn a_run_killed_before_its_first_checkpoint_starts_again_and_a_finished_one_does_not() {
    let directory = tempfile::tempdir().unwrap();
    let (whole, out) = (directory.path().join("whole"), directory.path().join("out"));
    let native = |out: &Path, end: &str| command(["native", "native"], out, end);
    assert!(native(&whole, "1.9 s").status().unwrap().success());
    // As a kill leaves it: begun, rows and snapshots written, no checkpoint (each 2 s).
    assert!(native(&out, "1.9 s").status().unwrap().success());
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    let resumed = native(&out, "1.9 s").arg("--resume").output().unwrap();
    assert!(resumed.status.success());
    let other = native(&out, "1.8 s").arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&other.stderr).into_owned();
    assert!(
        text.contains("is of another case than this: `time.end` is"),
        "{text}"
    );
    let said = [
        "or continue from it with the changes by `--from",
        "case.toml holds the case as it was run",
    ];
    assert!(said.iter().all(|words| text.contains(words)), "{text}");
    assert_eq!(
        fs::read_to_string(out.join("summary.json")).unwrap(),
        summary
    );
    // The title is for people.
    let titled = ["--resume", "--set", "title=\"Another title\""];
    assert!(
        native(&out, "1.9 s")
            .args(titled)
            .status()
            .unwrap()
            .success()
    );

    // The command that the folder keeps names a case that is gone.
    let kept = out.join("command.json");
    let command = fs::read_to_string(&kept).unwrap();
    fs::write(&kept, command.replace("heated-column.toml", "gone.toml")).unwrap();
    let gone = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["run", "--resume"])
        .arg(&out)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&gone.stderr).into_owned();
    assert_eq!(gone.status.code(), Some(2), "{text}");
    let place = format!("{} holds it as it was run", out.join("case.toml").display());
    assert!(text.contains("gone.toml, the case of the run in"), "{text}");
    assert!(text.contains(&place), "{text}");
    fs::write(&kept, command).unwrap();

    let verdict = summary.replacen("\"verdict\": \"none\"", "\"verdict\": \"running\"", 1);
    assert_ne!(verdict, summary);
    fs::write(out.join("summary.json"), &verdict).unwrap();
    // A finished run leaves a checkpoint at its end, a killed one does not.
    for name in ["checkpoint", "checkpoint.before"] {
        let _ = fs::remove_dir_all(out.join(name));
    }
    let other = native(&out, "1.8 s").arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&other.stderr).into_owned();
    assert_eq!(other.status.code(), Some(2), "{text}");
    assert!(text.contains("is of another case than this"), "{text}");
    // One that was interrupted left a checkpoint: where that is gone, nothing of its results is thrown away.
    let stopped = verdict.replacen("\"running\"", "\"stopped\"", 1);
    fs::write(out.join("summary.json"), &stopped).unwrap();
    let refused = native(&out, "1.9 s").arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{text}");
    assert!(text.contains("whose checkpoints are gone"), "{text}");
    assert_eq!(
        fs::read_to_string(out.join("summary.json")).unwrap(),
        stopped
    );
    fs::write(out.join("summary.json"), &verdict).unwrap();
    let resumed = native(&out, "1.9 s").arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&resumed.stderr).into_owned();
    assert!(resumed.status.success(), "{text}");
    assert!(
        text.contains("the run begins again from its start"),
        "{text}"
    );
    assert_eq!(results_equal::differences(&whole, &out), [""; 0]);

    // Where no run ever began there is nothing to go on from.
    let nowhere = directory.path().join("nowhere");
    let refused = native(&nowhere, "1.9 s").arg("--resume").output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}
