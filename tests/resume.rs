//! `--resume` after kill -9: the same values in every dataset as the uninterrupted run.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/results_equal.rs"]
mod results_equal;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A run with checkpoints each 2 s of process time; long enough to be killed in its middle.
fn command(pairing: [&str; 2], out: &Path, end: &str) -> Command {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-column.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command
        .arg("run")
        .arg(case)
        .args(["--gas", pairing[0], "--particles", pairing[1], "--quiet"])
        .args([
            "--set",
            "time.acceleration=5",
            "--set",
            &format!("time.end={end}"),
        ])
        .args(["--set", "time.checkpoint.every=2 s"])
        .args([
            "--set",
            "output.every=7 s",
            "--set",
            "output.series_every=0.1 s",
        ])
        .arg("--out")
        .arg(out)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command
}

/// Kills a run when its series is so many rows long, resumes it, and compares.
fn killed_and_resumed(pairing: [&str; 2], end: &str, rows: &[usize]) {
    let directory = tempfile::tempdir().unwrap();
    let whole = directory.path().join("whole");
    assert!(command(pairing, &whole, end).status().unwrap().success());
    for &limit in rows {
        let out: PathBuf = directory.path().join(format!("killed-{limit}"));
        let mut run = command(pairing, &out, end).spawn().unwrap();
        let begun = Instant::now();
        loop {
            let written =
                fs::read_to_string(out.join("series.csv")).map_or(0, |text| text.lines().count());
            let ready = out.join("checkpoint/coordinator.state").is_file();
            if (written >= limit && ready) || run.try_wait().unwrap().is_some() {
                break;
            }
            assert!(
                begun.elapsed() < Duration::from_secs(120),
                "no checkpoint in time"
            );
            std::thread::sleep(Duration::from_micros(200));
        }
        let killed = run.kill().is_ok();
        let status = run.wait().unwrap();
        println!("{pairing:?}: killed after {limit} rows: {killed}, {status}");
        let mut resumed = command(pairing, &out, end);
        let output = resumed.arg("--resume").output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let differing = results_equal::differences(&whole, &out);
        assert!(differing.is_empty(), "after {limit} rows: {differing:?}");
    }
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
    assert!(text.contains("its case differs from this one"), "{text}");
    assert_eq!(
        fs::read_to_string(out.join("summary.json")).unwrap(),
        summary
    );

    let verdict = summary.replacen("\"verdict\": \"none\"", "\"verdict\": \"running\"", 1);
    assert_ne!(verdict, summary);
    fs::write(out.join("summary.json"), &verdict).unwrap();
    // A finished run leaves a checkpoint at its end, a killed one does not.
    fs::remove_dir_all(out.join("checkpoint")).unwrap();
    let other = native(&out, "1.8 s").arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&other.stderr).into_owned();
    assert_eq!(other.status.code(), Some(2), "{text}");
    assert!(text.contains("this case has"), "{text}");
    let resumed = native(&out, "1.9 s").arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&resumed.stderr).into_owned();
    assert!(resumed.status.success(), "{text}");
    assert_eq!(results_equal::differences(&whole, &out), [""; 0]);

    // Where no run ever began there is nothing to go on from.
    let nowhere = directory.path().join("nowhere");
    let refused = native(&nowhere, "1.9 s").arg("--resume").output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}
