//! Runs that are stopped by SIGTERM, which leaves a checkpoint, and resumed.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs;
use std::os::unix::process::ExitStatusExt as _;
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

/// How a run that was to be stopped came to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// It was at its end before.
    AtItsEnd,
    /// It left a checkpoint.
    Checkpointed,
    /// It had not begun to listen to signals: the signal ended it, and what was there before is what there is.
    BeforeItBegan,
}

/// Starts a run and stops it as soon as `due` says so, told how long it runs.
pub fn stop(command: Command, due: impl Fn(Duration) -> bool) -> Stopped {
    stop_by(Signal::TERM, command, due)
}

/// The same by a signal.
pub fn stop_by(by: Signal, mut command: Command, due: impl Fn(Duration) -> bool) -> Stopped {
    command.stdin(Stdio::null()).stdout(Stdio::null());
    let mut run = command.stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !due(begun.elapsed()) && run.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < PATIENCE, "no moment to stop in time");
        std::thread::sleep(Duration::from_micros(200));
    }
    if run.try_wait().unwrap().is_none() {
        let pid = Pid::from_raw(run.id().cast_signed()).unwrap();
        kill_process(pid, by).unwrap();
    }
    let output = run.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    let status = output.status;
    match (status.code(), status.signal()) {
        (Some(0), _) => Stopped::AtItsEnd,
        (Some(CHECKPOINTED), _) => Stopped::Checkpointed,
        (None, Some(signal)) if signal == by.as_raw() => Stopped::BeforeItBegan,
        _ => panic!("{status}: {told}"),
    }
}

/// Number of rows of the series of a run so far.
pub fn rows(out: &Path) -> usize {
    let text = fs::read_to_string(out.join("series.csv"));
    text.map_or(0, |text| text.lines().count().saturating_sub(1))
}

/// Stops a run when its series has so many rows, and resumes it to its end.
pub fn stop_and_resume(command: impl Fn() -> Command, out: &Path, at: usize) {
    let stopped = stop(command(), |_| rows(out) >= at);
    assert_eq!(stopped, Stopped::Checkpointed);
    println!("stopped after {} rows", rows(out));
    let mut resumed = command();
    resumed.arg("--resume");
    finish(resumed);
}

/// Interrupts a run by SIGINT, as Ctrl-C does, each time its series has grown by so many rows, resumes it after each, and lets it come
/// to its end. `command` makes the run's command for each stretch by its number. How often it left a checkpoint.
pub fn interrupt_often(command: impl Fn(usize) -> Command, out: &Path, growths: &[usize]) -> usize {
    let mut left = 0;
    let stretch = |number: usize| {
        let mut next = command(number);
        if number > 0 {
            next.arg("--resume");
        }
        next
    };
    for (number, growth) in growths.iter().enumerate() {
        let had = rows(out);
        match stop_by(Signal::INT, stretch(number), |_| rows(out) >= had + growth) {
            Stopped::Checkpointed => left += 1,
            Stopped::AtItsEnd => return left,
            Stopped::BeforeItBegan => panic!("stretch {number} did not listen to SIGINT"),
        }
    }
    finish(stretch(growths.len()));
    left
}
