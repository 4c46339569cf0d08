//! The parent: starts workers, sees them die or stand still, and counts findings.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::random::Random;
use crate::{Files, target, worker};

/// An input that takes longer hangs. Inputs take milliseconds; the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(30);

/// So many deaths are enough.
const MOST_DEATHS: usize = 20;

/// Fuzzes a target for a while; the number of findings.
pub fn run(name: &str, seed: u64, time: Duration) -> usize {
    println!(
        "fuzz {name}: seed {seed}, {:.0} s; findings go to {}",
        time.as_secs_f64(),
        folder(name).display()
    );
    let scratch = tempfile::tempdir().unwrap();
    let progress = scratch.path().join("progress");
    let begun = Instant::now();
    let (mut first, mut accepted, mut panics, mut deaths) = (0, 0, 0, 0);
    while begun.elapsed() < time && deaths < MOST_DEATHS {
        fs::write(&progress, [0; 24]).unwrap();
        let left = time.saturating_sub(begun.elapsed());
        let why = work(
            &worker::words(name, seed, first, left, &progress),
            &progress,
        );
        let [input, good, caught] = record(&progress);
        accepted += good;
        panics += caught;
        first = input;
        if let Some(why) = why {
            let files = target(name).input(&mut Random::of(seed, input));
            save(name, seed, input, &files, &why);
            deaths += 1;
            first = input + 1;
        }
    }
    println!(
        "fuzz {name}: {first} executions in {:.0} s, {accepted} inputs accepted, {panics} panics, \
         {deaths} deaths or hangs",
        begun.elapsed().as_secs_f64()
    );
    deaths + panics as usize
}

/// Runs a worker; why it died or was killed, `None` if it ended well.
fn work(words: &[String], progress: &Path) -> Option<String> {
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(words)
        .stdin(Stdio::null())
        .spawn()
        .unwrap();
    let mut last = (record(progress), Instant::now());
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return (!status.success()).then(|| format!("the process died: {status}"));
        }
        let now = record(progress);
        if now != last.0 {
            last = (now, Instant::now());
        } else if last.1.elapsed() > PATIENCE {
            child.kill().unwrap();
            child.wait().unwrap();
            return Some(format!("no end after {} s", PATIENCE.as_secs()));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Input at work, inputs accepted, panics.
fn record(progress: &Path) -> [u64; 3] {
    let bytes = fs::read(progress).unwrap();
    let number = |at: usize| {
        let eight = bytes.get(8 * at..8 * at + 8).map(<[u8; 8]>::try_from);
        eight.map_or(0, |bytes| u64::from_le_bytes(bytes.unwrap()))
    };
    [number(0), number(1), number(2)]
}

/// Where the findings of a target are kept.
fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("fuzz")
        .join(name)
}

/// Saves an input with what it did.
pub fn save(name: &str, seed: u64, input: u64, files: &Files, message: &str) {
    let folder = folder(name).join(format!("{seed}-{input}"));
    fs::create_dir_all(&folder).unwrap();
    for (file, bytes) in files {
        // Files of an input may lie in folders.
        fs::write(folder.join(file.replace('/', "%")), bytes).unwrap();
    }
    fs::write(folder.join("message"), message).unwrap();
    println!("finding {}: {message}", folder.display());
}
