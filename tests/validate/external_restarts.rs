//! Restarts with OpenFOAM and LIGGGHTS, with what holds of them: killed at random moments and resumed from their scheduled
//! checkpoints, the same bits as the uninterrupted run with the same schedule; stopped by SIGTERM without a schedule, the same bits up
//! to the stop, and after it what solvers leave that read anew what they wrote.

use std::path::Path;
use std::time::{Duration, Instant};

use calcine::results::read::Series;

use crate::random::Random;
use crate::results_equal::values_that_differ;
use crate::stopped::{Stopped, finish, rows, stop};
use crate::{program, shipped};

/// The seed of the moments.
const SEED: u64 = 20_261_125;
/// Kills, and stops, of each pairing.
const TIMES: u64 = 4;
/// What a stop without a schedule may change of a frozen bed, relative to the larger value.
pub const FROZEN: f64 = 1e-7;
/// The same of the first row after it of a bed that moves in LIGGGHTS; collisions amplify it from there on.
const MOVING: f64 = 1e-9;

const PAIRINGS: [[&str; 2]; 3] = [
    ["native", "liggghts"],
    ["openfoam", "native"],
    ["openfoam", "liggghts"],
];

pub fn run() {
    let mut failed = Vec::new();
    println!(
        "  | pairing, heated-column | killed, same bits | stopped: largest relative difference after the stop |"
    );
    for (index, pairing) in PAIRINGS.iter().enumerate() {
        let name = pairing.join("+");
        let (alike, of_kills) = killed(pairing, index as u64);
        failed.extend(
            of_kills
                .into_iter()
                .map(|what| format!("{name}, killed: {what}")),
        );
        let set = [
            "time.end=20 s",
            "output.every=7 s",
            "output.series_every=0.1 s",
        ];
        let after = stopped(
            "heated-column",
            pairing,
            &set,
            index as u64 + 10,
            usize::MAX,
        );
        println!("  | {name} | {alike} of {TIMES} | {after:.1e} |");
        if after > FROZEN {
            failed.push(format!("{name}: {after:e} after a stop"));
        }
    }
    let set = [
        "time.end=0.2 s",
        "output.every=0.1 s",
        "output.series_every=1 ms",
    ];
    let after = stopped("settled-bed", &["native", "liggghts"], &set, 20, 1);
    println!("  settled-bed, native+liggghts, the first row after a stop: {after:.1e}");
    if after > MOVING {
        failed.push(format!(
            "settled-bed: {after:e} in the first row after a stop"
        ));
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

fn words<'a>(pairing: &[&'a str; 2]) -> [&'a str; 4] {
    ["--gas", pairing[0], "--particles", pairing[1]]
}

/// Runs that are killed at random moments and resumed: how many have the same bits, and what of the others differs.
fn killed(pairing: &[&str; 2], seed: u64) -> (u64, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "time.end=20 s",
        "time.acceleration=5",
        "time.checkpoint.every=2 s",
        "output.every=7 s",
        "output.series_every=0.1 s",
    ];
    let command =
        |out: &Path| program::command(&shipped("heated-column"), out, &words(pairing), &set);
    let whole = folder.path().join("whole");
    let begun = Instant::now();
    finish(command(&whole));
    let length = begun.elapsed();
    let (mut alike, mut failed) = (0, Vec::new());
    for number in 0..TIMES {
        let mut random = Random::of(SEED, TIMES * seed + number);
        let out = folder.path().join(format!("killed-{number}"));
        let mut run = command(&out).spawn().unwrap();
        let begun = Instant::now();
        let moment = length.mul_f64(random.below(1000) as f64 / 1000.0);
        while begun.elapsed() < moment && run.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        run.kill().unwrap();
        run.wait().unwrap();
        let mut next = command(&out);
        if out.join("lock").exists() {
            next.arg("--resume");
        }
        finish(next);
        match values_that_differ(&whole, &out) {
            differing if differing.is_empty() => alike += 1,
            differing => failed.push(format!("{number}: {differing:?}")),
        }
    }
    (alike, failed)
}

/// The largest relative difference, over so many rows after a stop at a random moment, of temperatures and pressures.
fn stopped(case: &str, pairing: &[&str; 2], set: &[&str], seed: u64, count: usize) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let command = |out: &Path| program::command(&shipped(case), out, &words(pairing), set);
    let whole = folder.path().join("whole");
    finish(command(&whole));
    let all = rows(&whole);
    let mut largest = 0.0f64;
    for number in 0..TIMES {
        let mut random = Random::of(SEED, TIMES * seed + number);
        let at = 1 + random.below(9 * all / 10);
        let out = folder.path().join(format!("stopped-{number}"));
        match stop(command(&out), |_| rows(&out) >= at) {
            Stopped::AtItsEnd => continue,
            stopped => assert_eq!(stopped, Stopped::Checkpointed),
        }
        let before = rows(&out);
        let mut resumed = command(&out);
        resumed.arg("--resume");
        finish(resumed);
        largest = largest.max(largest_difference(&whole, &out, before, count));
    }
    largest
}

/// The largest relative difference of temperatures and pressures, over so many rows after those that must be the same.
pub fn largest_difference(whole: &Path, out: &Path, same: usize, count: usize) -> f64 {
    let [one, other] = [whole, out].map(|out| Series::read(out).unwrap());
    let shown = |name: &&String| {
        ["temperature", "pressure", "height"]
            .iter()
            .any(|word| name.contains(word))
    };
    let mut largest = 0.0f64;
    for name in one.names.iter().filter(shown) {
        let pairs: Vec<_> = one.column(name).iter().zip(other.column(name)).collect();
        let apart = |(a, b): &(&f64, &f64)| match a == b || a.is_nan() {
            true => 0.0,
            false => (*a - *b).abs() / a.abs().max(b.abs()),
        };
        assert!(
            pairs[..same].iter().all(|pair| apart(pair) == 0.0),
            "{name}, in the first {same} rows"
        );
        let after = pairs[same..].iter().take(count).map(apart);
        largest = largest.max(after.fold(0.0, f64::max));
    }
    largest
}
