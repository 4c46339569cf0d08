//! Runs that are stopped by SIGTERM, which leaves a checkpoint, and resumed.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

/// Exit code of a run that left a checkpoint.
const CHECKPOINTED: i32 = 75;
/// A watchdog: the runs take seconds.
const PATIENCE: Duration = Duration::from_secs(600);

/// Runs to the end.
pub fn finish(mut command: Command) {
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
}

/// Starts a run and stops it as soon as `due` says so, told how long it runs; false where it came to its end before.
pub fn stop(mut command: Command, due: impl Fn(Duration) -> bool) -> bool {
    command.stdin(Stdio::null()).stdout(Stdio::null());
    let mut run = command.stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !due(begun.elapsed()) && run.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < PATIENCE, "no moment to stop in time");
        std::thread::sleep(Duration::from_micros(200));
    }
    if run.try_wait().unwrap().is_none() {
        let pid = Pid::from_raw(run.id().cast_signed()).unwrap();
        kill_process(pid, Signal::TERM).unwrap();
    }
    let output = run.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    let code = output.status.code();
    assert!(
        matches!(code, Some(0 | CHECKPOINTED)),
        "{}: {told}",
        output.status
    );
    code == Some(CHECKPOINTED)
}

/// Number of rows of the series of a run so far.
pub fn rows(out: &Path) -> usize {
    let text = fs::read_to_string(out.join("series.csv"));
    text.map_or(0, |text| text.lines().count().saturating_sub(1))
}

/// Stops a run when its series has so many rows, and resumes it to its end.
pub fn stop_and_resume(command: impl Fn() -> Command, out: &Path, at: usize) {
    let stopped = stop(command(), |_| rows(out) >= at);
    assert!(stopped, "it came to its end before it was stopped");
    println!("stopped after {} rows", rows(out));
    let mut resumed = command();
    resumed.arg("--resume");
    finish(resumed);
}
