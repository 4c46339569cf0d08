//! Windows whose length follows the gas: bounds are held, a run that is killed goes on with the same bits, and no output or checkpoint
//! changes the path.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use std::process::Command;

use calcine::results::Summary;

use crate::support::killed;
use crate::support::program::{self, shipped};

const BOUNDS: &str =
    "time.motion_window={ min = \"0.2 ms\", max = \"20 ms\", courant = 1.5, error = 2e-3 }";
/// The air gets hotter over a short ramp at 8 s.
const RAMP: &str = "gas.patch.bottom.inlet.temperature=[[\"0 s\", \"400 K\"], [\"8 s\", \"400 K\"], [\"8.02 s\", \"500 K\"]]";

/// The heated column with bounds, a ramp and a change of its acceleration.
fn command(pairing: [&str; 2], out: &Path, set: &[&str]) -> Command {
    let words = ["--gas", pairing[0], "--particles", pairing[1]];
    let mut all = vec![
        BOUNDS,
        RAMP,
        "time.acceleration=[[\"0 s\", 1], [\"2 s\", 5]]",
        "time.end=12 s",
    ];
    all.extend(set);
    program::command(&shipped("heated-column"), out, &words, &all)
}

fn killed_and_resumed(pairing: [&str; 2], every: &str, rows: &[usize]) {
    let directory = tempfile::tempdir().unwrap();
    let every = format!("time.checkpoint.every={every}");
    let set = [
        every.as_str(),
        "output.every=7 s",
        "output.series_every=10 ms",
    ];
    let whole =
        killed::resumes_to_the_same_bits(directory.path(), rows, |out| command(pairing, out, &set));
    let steps = Summary::read(&whole).unwrap().steps;
    println!("{pairing:?}: {steps:?}");
    assert!(steps.longest_window_s > 4.0 * steps.shortest_window_s);
}

#[test]
fn a_native_run_resumes_to_the_same_bits() {
    killed_and_resumed(["native", "native"], "0.2 s", &[60, 150, 260]);
}

#[test]
fn a_run_with_liggghts_resumes_to_the_same_bits() {
    killed_and_resumed(["native", "liggghts"], "1.1 s", &[150]);
}

#[test]
fn a_run_with_openfoam_resumes_to_the_same_bits() {
    killed_and_resumed(["openfoam", "native"], "1.1 s", &[150]);
}

#[test]
fn no_output_and_no_checkpoint_changes_the_path() {
    let directory = tempfile::tempdir().unwrap();
    let schedules: [&[&str]; 2] = [
        &["output.every=12 s", "output.series_every=12 s"],
        &[
            "output.every=0.7 s",
            "output.series_every=3 ms",
            "time.checkpoint.every=0.37 s",
        ],
    ];
    let last = [0, 1].map(|number: usize| {
        let out = directory.path().join(number.to_string());
        let done = command(["native", "native"], &out, schedules[number]).output();
        let done = done.unwrap();
        assert!(done.status.success(), "{done:?}");
        let summary = Summary::read(&out).unwrap();
        println!("{} windows, {:?}", summary.windows, summary.steps);
        // The ledger closes, whatever the lengths.
        for name in ["mass", "energy"] {
            let line = &summary.ledger.lines[name];
            assert!(line.relative_error < 1e-10, "{name}: {line:?}");
        }
        assert_eq!(
            (summary.steps.above_error, summary.steps.above_courant),
            (0, 0)
        );
        let series = std::fs::read_to_string(out.join("series.csv")).unwrap();
        let row = series.lines().last().unwrap().to_owned();
        (row, summary.windows, summary.steps)
    });
    assert_eq!(last[0], last[1]);
}
