//! A day of load: a bed with feed and discharge in short windows, with checkpoints all along, natively, and some hours of it with
//! OpenFOAM and LIGGGHTS. Memory and handles stay what they are, and nothing is left in shared memory or the temporary folder.

use std::collections::BTreeSet;
use std::fs;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use crate::{program, shipped};

/// How often processes are looked at.
const LOOK: Duration = Duration::from_millis(250);
/// How long what other runs hold in shared memory may be there.
const PATIENCE: Duration = Duration::from_secs(300);
/// Growth of the largest memory from the second fifth of a run to its last; allocators keep what they had.
const GROWTH: f64 = 1.02;

/// Process time at 500 times the motion, in windows of 2.5 s; the bed is drawn off and fed anew some twelve times a day.
const SET: [&str; 7] = [
    "time.acceleration=500",
    "time.motion_window=5 ms",
    "time.checkpoint.every=5 min",
    "output.every=30 min",
    "output.series_every=20 s",
    "feeds[0].mass_rate=0.05 g/s",
    "outlets[0].mass_rate=0.05 g/s",
];

/// What all processes of a run hold at one moment.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    /// Resident memory in MB.
    memory: f64,
    /// Open files, sockets and pipes.
    handles: usize,
    /// Threads.
    threads: usize,
}

pub fn run() {
    println!(
        "  | pairing | process time | samples | MB, second fifth | MB, last fifth | handles | threads |"
    );
    let mut missed = Vec::new();
    for (pairing, words, end) in [
        ("native+native", &[][..], "24 h"),
        (
            "openfoam+liggghts",
            &["--gas", "openfoam", "--particles", "liggghts"][..],
            "2 h",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let before = left();
        let end_of_run = format!("time.end={end}");
        let set = [&SET[..], &[end_of_run.as_str()]].concat();
        let out = folder.path().join("out");
        let mut command = program::command(&shipped("moving-bed"), &out, words, &set);
        let temporary = folder.path().join("tmp");
        fs::create_dir(&temporary).unwrap();
        command.env("TMPDIR", &temporary);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        let mut run = command.spawn().unwrap();
        let samples = watch(&mut run);
        let output = run.wait_with_output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{pairing}: {told}");
        let fifth = samples.len() / 5;
        assert!(fifth > 3, "{pairing}: only {} samples", samples.len());
        // The very end writes the report, whose memory is that of the results.
        let last = &samples[4 * fifth - 1..samples.len() - 2];
        let [early, late] = [&samples[fifth..2 * fifth], last].map(most);
        println!(
            "  | {pairing} | {end} | {} | {:.1} | {:.1} | {} and {} | {} and {} |",
            samples.len(),
            early.memory,
            late.memory,
            early.handles,
            late.handles,
            early.threads,
            late.threads
        );
        let grew = late.memory > GROWTH * early.memory;
        if grew || late.handles > early.handles || late.threads > early.threads {
            missed.push(format!("{pairing}: {early:?} {late:?}"));
        }
        let files: Vec<_> = fs::read_dir(&temporary).unwrap().collect();
        assert!(files.is_empty(), "{pairing}: left {files:?}");
        // Other runs on this machine come and go.
        let begun = Instant::now();
        let mut more = left();
        while !more.is_subset(&before) && begun.elapsed() < PATIENCE {
            std::thread::sleep(LOOK);
            more.retain(|name| left().contains(name));
        }
        more.retain(|name| !before.contains(name));
        assert!(more.is_empty(), "{pairing}: left {more:?}");
    }
    assert!(missed.is_empty(), "{missed:?}");
}

fn most(samples: &[Held]) -> Held {
    samples.iter().fold(Held::default(), |all, one| Held {
        memory: all.memory.max(one.memory),
        handles: all.handles.max(one.handles),
        threads: all.threads.max(one.threads),
    })
}

/// Looks at a run and all that it started until it ends.
fn watch(run: &mut Child) -> Vec<Held> {
    let mut samples = Vec::new();
    while run.try_wait().unwrap().is_none() {
        samples.push(held(run.id()));
        std::thread::sleep(LOOK);
    }
    samples
}

/// What a process and its descendants hold.
fn held(pid: u32) -> Held {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let number = |key: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(key));
        let word = line.and_then(|line| line.split_whitespace().next());
        word.and_then(|word| word.parse::<f64>().ok())
            .unwrap_or(0.0)
    };
    let handles = fs::read_dir(format!("/proc/{pid}/fd")).map_or(0, Iterator::count);
    let mut all = Held {
        memory: number("VmRSS:") / 1024.0,
        handles,
        threads: number("Threads:") as usize,
    };
    let tasks = fs::read_dir(format!("/proc/{pid}/task"))
        .into_iter()
        .flatten();
    for task in tasks.flatten() {
        let children = fs::read_to_string(task.path().join("children")).unwrap_or_default();
        for child in children
            .split_whitespace()
            .filter_map(|word| word.parse().ok())
        {
            let below = held(child);
            all.memory += below.memory;
            all.handles += below.handles;
            all.threads += below.threads;
        }
    }
    all
}

/// Names in shared memory.
fn left() -> BTreeSet<String> {
    let entries = fs::read_dir("/dev/shm").into_iter().flatten().flatten();
    entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect()
}
