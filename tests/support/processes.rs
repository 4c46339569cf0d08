//! Processes of a coupled run: started, found, killed, and looked for afterwards.

// Each test file uses its own part of this.
#![allow(dead_code, clippy::unwrap_used)]

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

/// How long a run may take to get under way on a busy machine.
const PATIENCE: Duration = Duration::from_secs(90);

pub fn case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-column.toml")
}

/// A coupled run with both external solvers that would take minutes.
pub fn start(out: &Path) -> Child {
    start_with(out, &[])
}

/// The same with more words on the command line.
pub fn start_with(out: &Path, words: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("run")
        .arg(case())
        .args(["--gas", "openfoam", "--particles", "liggghts", "--quiet"])
        .args([
            "--set",
            "time.acceleration=1",
            "--set",
            "output.series_every=0.01 s",
        ])
        .args(words)
        .arg("--out")
        .arg(out)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

pub fn command_line(pid: u32) -> String {
    fs::read(format!("/proc/{pid}/cmdline"))
        .map(|bytes| String::from_utf8_lossy(&bytes).replace('\0', " "))
        .unwrap_or_default()
}

/// All living descendants of a process.
pub fn descendants(pid: u32) -> Vec<u32> {
    let mut found = Vec::new();
    for entry in fs::read_dir("/proc").unwrap().flatten() {
        let Ok(other) = entry.file_name().to_string_lossy().parse::<u32>() else {
            continue;
        };
        let Ok(stat) = fs::read_to_string(format!("/proc/{other}/stat")) else {
            continue;
        };
        let Some((_, rest)) = stat.rsplit_once(')') else {
            continue;
        };
        let mut fields = rest.split_whitespace();
        let state = fields.next();
        if fields.next() == Some(&pid.to_string()) && state != Some("Z") {
            found.push(other);
            found.extend(descendants(other));
        }
    }
    found
}

pub fn alive(pid: u32) -> bool {
    fs::read_to_string(format!("/proc/{pid}/stat")).is_ok_and(|stat| {
        stat.rsplit_once(')')
            .is_some_and(|(_, rest)| !rest.starts_with(" Z"))
    })
}

/// Entries of /dev/shm and of the folder for scratch that belong to the run of this coordinator.
pub fn leftovers(pid: u32) -> Vec<String> {
    let mark = format!("calcine-{pid}-");
    let folders = [PathBuf::from("/dev/shm"), std::env::temp_dir()];
    let entries = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap().flatten());
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.contains(&mark)).collect()
}

/// True for a rank of a solver, not for what starts it.
pub fn is_solver(pid: u32) -> bool {
    let line = command_line(pid);
    let program = line.split(' ').next().unwrap_or_default();
    ["calcineGasFoam", "calcine-liggghts"]
        .iter()
        .any(|name| program.ends_with(name))
}

/// Living processes that have the run of this coordinator in their environment.
pub fn belonging(pid: u32) -> Vec<u32> {
    let mark = format!("calcine-{pid}-");
    let entries = fs::read_dir("/proc").unwrap().flatten();
    let numbers = entries.filter_map(|entry| entry.file_name().to_string_lossy().parse().ok());
    let marked = |&other: &u32| {
        let text = fs::read(format!("/proc/{other}/environ")).unwrap_or_default();
        other != pid && String::from_utf8_lossy(&text).contains(&mark) && alive(other)
    };
    numbers.filter(marked).collect()
}

/// Waits until windows are being committed.
pub fn wait_for_windows(run: &mut Child, out: &Path) {
    let begun = Instant::now();
    loop {
        let rows =
            fs::read_to_string(out.join("series.csv")).map_or(0, |text| text.lines().count());
        if rows > 4 {
            return;
        }
        if let Some(status) = run.try_wait().unwrap() {
            let mut text = String::new();
            run.stderr
                .take()
                .unwrap()
                .read_to_string(&mut text)
                .unwrap();
            panic!("the run ended early with {status}: {text}");
        }
        assert!(
            begun.elapsed() < PATIENCE,
            "no window was committed within {PATIENCE:?}"
        );
        std::thread::sleep(Duration::from_millis(50));
    }
}

pub fn kill(pid: u32) {
    signal(pid, Signal::KILL);
}

pub fn signal(pid: u32, signal: Signal) {
    let pid = Pid::from_raw(i32::try_from(pid).unwrap()).unwrap();
    kill_process(pid, signal).unwrap();
}

pub fn wait_until(limit: Duration, mut done: impl FnMut() -> bool) -> Duration {
    let begun = Instant::now();
    while !done() && begun.elapsed() < limit {
        std::thread::sleep(Duration::from_millis(10));
    }
    begun.elapsed()
}
