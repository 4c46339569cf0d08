//! Conduction and radiation in beds that move: the same bits after kill -9 and `--resume`, and the same heat
//! whoever moves the particles.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/results_equal.rs"]
mod results_equal;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use calcine::results::Summary;
use serde_json::Value;

const CASE: &str = "tests/inputs/good/moving-heat.toml";

fn case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(CASE)
}

fn command(particles: &str, out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.arg("run").arg(case());
    command.args(["--particles", particles, "--quiet"]);
    // Views hold for 3 s: checkpoints lie at other times.
    command.args(["--set", "time.checkpoint.every=5 s"]);
    command.args(["--set", "time.end=30 s", "--set", "output.every=10 s"]);
    command.args(["--set", "output.series_every=0.5 s"]);
    command.arg("--out").arg(out);
    command.stdin(Stdio::null()).stdout(Stdio::null());
    command.stderr(Stdio::piped());
    command
}

/// Kills a run when its series is so many rows long, resumes it, and compares.
fn resumes(particles: &str, rows: usize) {
    let directory = tempfile::tempdir().unwrap();
    let (whole, out) = (directory.path().join("whole"), directory.path().join("out"));
    let output = command(particles, &whole).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    let mut run = command(particles, &out).spawn().unwrap();
    let begun = Instant::now();
    loop {
        let written = fs::read_to_string(out.join("series.csv"));
        let written = written.map_or(0, |text| text.lines().count());
        let ready = out.join("checkpoint/coordinator.state").is_file();
        if (written >= rows && ready) || run.try_wait().unwrap().is_some() {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(120), "no checkpoint");
        std::thread::sleep(Duration::from_micros(200));
    }
    let killed = run.kill().is_ok();
    println!(
        "{particles}: killed after {rows} rows: {killed}, {}",
        run.wait().unwrap()
    );
    let output = command(particles, &out).arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    let differing = results_equal::differences(&whole, &out);
    assert!(differing.is_empty(), "{differing:?}");
    let summary = Summary::read(&whole).unwrap();
    for name in ["mass", "energy", "energy_exchange", "particle_mass"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-11, "{name}: {error}");
    }
}

#[test]
fn a_moving_bed_that_conducts_and_radiates_resumes_to_the_same_bits() {
    resumes("native", 33);
}

#[test]
fn the_same_bed_in_liggghts_resumes_to_the_same_bits() {
    resumes("liggghts", 41);
}

#[test]
fn native_particles_and_liggghts_conduct_and_radiate_alike_while_they_move() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("comparison");
    let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("compare")
        .arg(case())
        .args(["--pairings", "native+native,native+liggghts", "--quiet"])
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}");
    let text = fs::read_to_string(out.join("compare.json")).unwrap();
    let comparison: Value = serde_json::from_str(&text).unwrap();
    for quantity in comparison["quantities"].as_array().unwrap() {
        println!("{}: {}", quantity["name"], quantity["largest"]);
    }
}
