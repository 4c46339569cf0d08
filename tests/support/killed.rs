//! Runs that are killed in their middle and resumed.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::results_equal;

/// A watchdog: the runs take seconds.
const PATIENCE: Duration = Duration::from_secs(120);

fn finish(mut command: Command) {
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
}

/// Runs into a folder without interruption, then, for each of `rows`, into another one in which `kill -9` strikes when
/// the series is so many rows long and a checkpoint is there; resumes it, and compares every value. Returns the folder of
/// the uninterrupted run.
pub fn resumes_to_the_same_bits(
    directory: &Path,
    rows: &[usize],
    command: impl Fn(&Path) -> Command,
) -> PathBuf {
    let whole = directory.join("whole");
    finish(command(&whole));
    for &limit in rows {
        let out = directory.join(format!("killed-{limit}"));
        let mut started = command(&out);
        started.stdin(Stdio::null()).stdout(Stdio::null());
        let mut run = started.stderr(Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        let written = || {
            let text = fs::read_to_string(out.join("series.csv"));
            text.map_or(0, |text| text.lines().count())
        };
        while written() < limit || !out.join("checkpoint/coordinator.state").is_file() {
            let ended = run.try_wait().unwrap();
            assert!(ended.is_none(), "it ended before it was killed: {ended:?}");
            assert!(begun.elapsed() < PATIENCE, "no checkpoint in time");
            std::thread::sleep(Duration::from_micros(200));
        }
        run.kill().unwrap();
        let status = run.wait().unwrap();
        assert!(!status.success(), "it ended before it was killed");
        println!("killed after {limit} rows: {status}");
        let mut resumed = command(&out);
        resumed.arg("--resume");
        finish(resumed);
        let differing = results_equal::differences(&whole, &out);
        assert!(differing.is_empty(), "after {limit} rows: {differing:?}");
    }
    whole
}
