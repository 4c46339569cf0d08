//! 200 random faults while checkpoints are written or lie on the disk: writers killed, full disks, files cut short, bits
//! changed, files lost. Each time `--resume` goes on to the same bits in every dataset and in the series, from the last checkpoint
//! or, where that is damaged, from the one before it, and says so.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::checkpoint_harm::Harm;
use crate::random::Random;
use crate::results_equal::values_that_differ;
use crate::stopped::{Stopped, finish, stop};
use crate::{program, shipped};

/// The seed of the faults.
const SEED: u64 = 18_002;
const FAULTS: u64 = 200;
/// Draws of faults at most.
const MOST: u64 = 3 * FAULTS;
/// A watchdog: a run takes a second.
const PATIENCE: Duration = Duration::from_secs(300);
/// A checkpoint every few windows.
const SET: [&str; 7] = [
    "time.end=20 min",
    "output.every=2 min",
    "output.series_every=20 s",
    "time.checkpoint.every=30 s",
    "mesh.box.size=24 24 132 mm",
    "mesh.box.cells=[2, 2, 11]",
    "particles[0].place.grid.counts=[2, 2, 8]",
];

fn command(out: &Path, words: &[&str]) -> Command {
    program::command(&shipped("ore-reduction"), out, words, &SET)
}

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole");
    let begun = Instant::now();
    finish(command(&whole, &[]));
    let length = begun.elapsed();
    let size = bytes(&whole);
    let disk = Disk::new(&folder.path().join("disk"));
    if disk.is_none() {
        println!("  without root no disk can be made to fill: those faults are kills in place");
    }
    let mut counts = std::collections::BTreeMap::<&str, [u32; 3]>::new();
    let mut met = 0;
    // A run may be at its end before its fault: that one is drawn anew.
    for number in 0..MOST {
        if met == FAULTS {
            break;
        }
        let mut random = Random::of(SEED, number);
        let place = disk
            .as_ref()
            .map_or(folder.path(), |disk| disk.path.as_path());
        let (kind, out) = match (met % 4, &disk) {
            (0, Some(_)) => ("full disk", place.join("out")),
            (1, _) => ("changed or lost", folder.path().join("out")),
            (2, _) => ("cut short", folder.path().join("out")),
            _ => ("killed", folder.path().join("out")),
        };
        let _ = fs::remove_dir_all(&out);
        let share = |random: &mut Random| random.below(1000) as f64 / 1000.0;
        match (kind, &disk) {
            ("full disk", Some(disk)) => {
                disk.resize(size / 4 + random.below(1000) as u64 * size / 1000);
                let output = command(&out, &[]).output().unwrap();
                let told = String::from_utf8_lossy(&output.stderr);
                disk.resize(8 * size);
                assert!(
                    output.status.success() || told.contains("No space left on device"),
                    "{number}: {}: {told}",
                    output.status
                );
            }
            ("killed", _) => {
                if !kill_at(&out, length.mul_f64(share(&mut random)), &mut random) {
                    continue;
                }
            }
            _ => {
                let moment = length.mul_f64(share(&mut random));
                let before = out.join("checkpoint.before");
                let stopped = stop(command(&out, &[]), |elapsed| {
                    elapsed >= moment && before.is_dir()
                });
                if stopped != Stopped::Checkpointed {
                    continue;
                }
                let at = random.below(1000) as u64;
                let harm = match (kind, random.below(3)) {
                    ("cut short", _) => Harm::Truncated(at),
                    (_, 0) => Harm::Removed,
                    _ => Harm::Flipped(at),
                };
                harm.to_one_of(&out.join("checkpoint"), random.below(1000) as u64);
            }
        }
        let count = counts.entry(kind).or_default();
        count[0] += 1;
        met += 1;
        if !out.join("lock").exists() {
            continue;
        }
        let resumed = command(&out, &["--resume"]).output().unwrap();
        let told = String::from_utf8_lossy(&resumed.stderr);
        assert!(resumed.status.success(), "{number}, {kind}: {told}");
        count[1] += u32::from(told.contains("the run goes on from the checkpoint before it"));
        let differing = values_that_differ(&whole, &out);
        assert!(differing.is_empty(), "{number}, {kind}: {differing:?}");
        count[2] += 1;
    }
    println!("  | fault | number | went back to the one before | same bits |");
    for (kind, [number, back, alike]) in &counts {
        println!("  | {kind} | {number} | {back} | {alike} |");
    }
    assert_eq!(met, FAULTS, "of {MOST} draws");
    // What is damaged is noticed.
    for kind in ["changed or lost", "cut short"] {
        let [number, back, alike] = counts[kind];
        assert!(back == number && alike == number, "{kind}");
    }
}

/// Kills a run after a time, once a checkpoint is being written; false where it was at its end before.
fn kill_at(out: &Path, moment: Duration, random: &mut Random) -> bool {
    let mut killed = command(out, &[]);
    killed.stdout(Stdio::null()).stderr(Stdio::null());
    let mut run = killed.spawn().unwrap();
    let begun = Instant::now();
    let part = out.join("checkpoint.part");
    wait(&mut run, || begun.elapsed() >= moment && part.exists());
    std::thread::sleep(Duration::from_micros(random.below(3000) as u64));
    let going_on = run.try_wait().unwrap().is_none();
    let _ = run.kill();
    run.wait().unwrap();
    going_on
}

fn wait(run: &mut Child, mut ready: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !ready() && run.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < PATIENCE, "the run stands still");
        std::thread::sleep(Duration::from_micros(50));
    }
}

/// Bytes of all files below a folder.
fn bytes(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).unwrap();
    entries
        .map(|entry| {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => bytes(&path),
                false => fs::metadata(&path).unwrap().len(),
            }
        })
        .sum()
}

/// A file system in memory whose size can be set.
struct Disk {
    path: std::path::PathBuf,
}

impl Disk {
    fn new(path: &Path) -> Option<Self> {
        fs::create_dir_all(path).unwrap();
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=1m", "tmpfs"])
            .arg(path)
            .output()
            .is_ok_and(|output| output.status.success());
        mounted.then(|| Self {
            path: path.to_owned(),
        })
    }

    fn resize(&self, bytes: u64) {
        let done = Command::new("mount")
            .args(["-o", &format!("remount,size={bytes}")])
            .arg(&self.path)
            .status()
            .unwrap();
        assert!(done.success());
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.path).status();
    }
}
