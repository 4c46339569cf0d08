//! The worker: executes one input after the other until its time is over.

use std::collections::BTreeMap;
use std::fs::File;
use std::os::unix::fs::FileExt;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use rustix::process::{Resource, Rlimit, Signal, set_parent_process_death_signal, setrlimit};

use crate::random::Random;
use crate::{parent, target};

/// Address space in bytes; a small file that asks for more is a finding.
const MEMORY: u64 = 2 << 30;

/// Findings of one place in the code that are saved.
const OF_ONE_PLACE: u32 = 2;

/// Where the last panic was and what it said.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// Runs with the words of [`words`]: target, seed, first input, seconds, file of the progress.
pub fn run(words: &[String]) -> ExitCode {
    let [name, seed, first, seconds, progress] = words else {
        return ExitCode::FAILURE;
    };
    let limit = Rlimit {
        current: Some(MEMORY),
        maximum: Some(MEMORY),
    };
    setrlimit(Resource::As, limit).unwrap();
    // Nobody would watch it any more.
    set_parent_process_death_signal(Some(Signal::KILL)).unwrap();
    panic::set_hook(Box::new(|info| {
        if let Ok(mut last) = PANIC.lock() {
            *last = info.to_string();
        }
    }));
    let seed: u64 = seed.parse().unwrap();
    let first: u64 = first.parse().unwrap();
    let time = Duration::from_secs_f64(seconds.parse().unwrap());
    let progress = File::options().write(true).open(progress).unwrap();
    let mut target = target(name);
    let mut places: BTreeMap<String, u32> = BTreeMap::new();
    let mut accepted = 0u64;
    let begun = Instant::now();
    for input in first.. {
        // What the parent blames if this process dies or stands still.
        let record = [
            input,
            accepted,
            places.values().map(|&n| u64::from(n)).sum(),
        ];
        let bytes: Vec<u8> = record.iter().flat_map(|n| n.to_le_bytes()).collect();
        progress.write_all_at(&bytes, 0).unwrap();
        if begun.elapsed() > time {
            break;
        }
        let files = target.input(&mut Random::of(seed, input));
        match panic::catch_unwind(AssertUnwindSafe(|| target.execute(&files))) {
            Ok(good) => accepted += u64::from(good),
            Err(_) => {
                let message = PANIC.lock().unwrap().clone();
                let place = message.lines().next().unwrap_or_default().to_owned();
                let count = places.entry(place).or_default();
                *count += 1;
                if *count <= OF_ONE_PLACE {
                    parent::save(name, seed, input, &files, &message);
                }
            }
        }
    }
    ExitCode::SUCCESS
}

/// The words that start a worker.
pub fn words(name: &str, seed: u64, first: u64, time: Duration, progress: &Path) -> Vec<String> {
    vec![
        "--worker".into(),
        name.into(),
        seed.to_string(),
        first.to_string(),
        time.as_secs_f64().to_string(),
        progress.to_string_lossy().into_owned(),
    ]
}
