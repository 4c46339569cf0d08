//! SIGTERM at 50 random moments of five native runs, and `--resume`: the same bits in every dataset and in the series as
//! without, with scheduled checkpoints in every second run. Each third run is stopped a second time after it resumed.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::random::Random;
use crate::results_equal::values_that_differ;
use crate::stopped::{Stopped, finish, rows, stop};
use crate::{program, shipped};

/// The seed of the moments.
const SEED: u64 = 20_261_123;
/// Stops of each case.
const STOPS: u64 = 10;

/// Cases, shortened, with an interval of checkpoints that is no multiple of the output's.
const CASES: [(&str, &[&str], &str); 5] = [
    ("settled-bed", &["time.end=0.3 s"], "37 ms"),
    (
        "fluidised-bed",
        &["time.end=0.4 s", "output.series_every=2 ms"],
        "53 ms",
    ),
    (
        "rotating-drum",
        &["time.end=0.8 s", "output.series_every=5 ms"],
        "95 ms",
    ),
    (
        "moving-bed",
        &[
            "time.end=60 s",
            "output.series_every=0.5 s",
            "feeds[0].mass_rate=4 g/s",
            "outlets[0].mass_rate=4 g/s",
        ],
        "7 s",
    ),
    (
        "ore-reduction",
        &[
            "time.end=30 min",
            "output.series_every=20 s",
            "mesh.box.size=36 36 132 mm",
            "mesh.box.cells=[3, 3, 11]",
            "particles[0].place.grid.counts=[3, 3, 8]",
        ],
        "7 min",
    ),
];

pub fn run() {
    println!("  | case | run s | stopped after rows of series | same bits |");
    let mut failed = Vec::new();
    for (case, (name, set, every)) in CASES.into_iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let command = |out: &Path, set: &[&str]| program::command(&shipped(name), out, &[], set);
        let whole = folder.path().join("whole");
        let begun = Instant::now();
        finish(command(&whole, set));
        let length = begun.elapsed();
        let schedule = format!("time.checkpoint.every={every}");
        let scheduled = [set, &[schedule.as_str()]].concat();
        let (mut alike, mut moments) = (0, Vec::new());
        for number in 0..STOPS {
            let mut random = Random::of(SEED, STOPS * case as u64 + number);
            let out = folder.path().join(format!("stopped-{number}"));
            let set = if number % 2 == 0 { set } else { &scheduled };
            let times = if number % 3 == 2 { 2 } else { 1 };
            moments.push(interrupt(
                || command(&out, set),
                &out,
                length,
                times,
                &mut random,
            ));
            let differing = values_that_differ(&whole, &out);
            match differing.is_empty() {
                true => alike += 1,
                false => failed.push(format!("{name}, stop {number}: {differing:?}")),
            }
        }
        let length = length.as_secs_f64();
        println!(
            "  | {name} | {length:.1} | {} | {alike} of {STOPS} |",
            moments.join(", ")
        );
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Stops a run so many times, at random moments within the length of the whole one, and resumes it; the rows of the series
/// that were there each time.
fn interrupt(
    command: impl Fn() -> Command,
    out: &Path,
    length: Duration,
    times: u32,
    random: &mut Random,
) -> String {
    let mut found = Vec::new();
    let mut resumes = false;
    for _ in 0..times {
        let share = random.below(1000) as f64 / 1000.0;
        let moment = length.mul_f64(share / f64::from(times));
        let mut next = command();
        if resumes {
            next.arg("--resume");
        }
        // Not before the run has begun: without a folder there is nothing to stop.
        let stopped = stop(next, |elapsed| {
            elapsed >= moment && out.join("series.csv").is_file()
        });
        found.push(match stopped {
            Stopped::AtItsEnd => {
                found.push("end".to_owned());
                return found.join("+");
            }
            Stopped::Checkpointed => rows(out).to_string(),
            // Only a run that resumes has a series before it listens to signals.
            Stopped::BeforeItBegan => {
                assert!(resumes, "{}: no checkpoint", out.display());
                "0".to_owned()
            }
        });
        resumes = true;
    }
    let mut last = command();
    last.arg("--resume");
    finish(last);
    found.join("+")
}
