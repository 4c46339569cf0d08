//! Conduction and radiation in beds that move: the same bits after kill -9 and `--resume`, and the same heat
//! whoever moves the particles.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::killed;
use crate::support::program;

const CASE: &str = "tests/inputs/good/moving-heat.toml";

fn case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(CASE)
}

fn command(particles: &str, out: &Path) -> Command {
    // Views hold for 3 s: checkpoints lie at other times.
    let set = [
        "time.checkpoint.every=5 s",
        "time.end=30 s",
        "output.every=10 s",
        "output.series_every=0.5 s",
    ];
    program::command(&case(), out, &["--particles", particles], &set)
}

/// Kills a run when its series is so many rows long, resumes it, and compares.
fn resumes(particles: &str, rows: usize) {
    let directory = tempfile::tempdir().unwrap();
    let whole =
        killed::resumes_to_the_same_bits(directory.path(), &[rows], |out| command(particles, out));
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

/// Means over the last 10 s of the gas that leaves, at each time from 10 s on, in K.
fn top_gas(run: &Path) -> Vec<f64> {
    let series = Series::read(run).unwrap();
    let (times, gas) = (
        series.column("process_time"),
        series.column("quantities.top_gas"),
    );
    let rows = (times[1] > 0.0).then(|| (10.0 / times[1]).round() as usize);
    gas[1..]
        .windows(rows.unwrap())
        .map(|last| last.iter().sum::<f64>() / last.len() as f64)
        .collect()
}

/// Bands of the case for each bed; and the gas at the top, in which single particles that fall elsewhere show by 3.3 K (deviation
/// of a pair), as the mean difference over beds.
#[test]
fn native_particles_and_liggghts_conduct_and_radiate_alike_while_they_move() {
    let directory = tempfile::tempdir().unwrap();
    let pairings = "native+native,native+liggghts";
    let mut apart = Vec::new();
    for seed in 1..=4 {
        let out = directory.path().join(format!("comparison{seed}"));
        let set = ["particles[0].place.seed", "feeds[0].seed"].map(|key| format!("{key}={seed}"));
        let comparison = program::compare(&case(), &out, pairings, &set);
        for quantity in comparison["quantities"].as_array().unwrap() {
            println!("{seed}: {}: {}", quantity["name"], quantity["largest"]);
        }
        let [native, liggghts] =
            ["native+native", "native+liggghts"].map(|pairing| top_gas(&out.join(pairing)));
        apart.resize(native.len(), 0.0);
        assert_eq!(native.len(), liggghts.len());
        for (sum, (a, b)) in apart.iter_mut().zip(native.iter().zip(&liggghts)) {
            *sum += 0.25 * (b - a);
        }
    }
    let most = apart
        .iter()
        .fold(0.0f64, |most, apart| most.max(apart.abs()));
    println!("gas at the top, mean of four beds: {most:.2} K apart at most");
    assert!(apart.len() > 20 && most < 5.0, "{most} K of {apart:?}");
}
