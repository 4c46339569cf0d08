//! Faults: each process of a coupled run is killed in the middle of a window; the message names
//! it, everything ends, nothing stays behind, and the next run is clean.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

/// How long a run may take to get under way on a busy machine.
const PATIENCE: Duration = Duration::from_secs(90);

fn case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-column.toml")
}

/// A coupled run with both external solvers that would take minutes.
fn start(out: &Path) -> Child {
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
        .arg("--out")
        .arg(out)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn command_line(pid: u32) -> String {
    fs::read(format!("/proc/{pid}/cmdline"))
        .map(|bytes| String::from_utf8_lossy(&bytes).replace('\0', " "))
        .unwrap_or_default()
}

/// All living descendants of a process.
fn descendants(pid: u32) -> Vec<u32> {
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

fn alive(pid: u32) -> bool {
    fs::read_to_string(format!("/proc/{pid}/stat")).is_ok_and(|stat| {
        stat.rsplit_once(')')
            .is_some_and(|(_, rest)| !rest.starts_with(" Z"))
    })
}

/// Entries of /dev/shm that belong to the run of this coordinator.
fn shared_memory(pid: u32) -> Vec<String> {
    let mark = format!("{pid}");
    fs::read_dir("/dev/shm")
        .map(|entries| {
            entries
                .flatten()
                .map(|entry| entry.file_name().to_string_lossy().into_owned())
                .filter(|name| name.contains("calcine") && name.contains(&mark))
                .collect()
        })
        .unwrap_or_default()
}

/// Waits until windows are being committed.
fn wait_for_windows(run: &mut Child, out: &Path) {
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

fn kill(pid: u32) {
    let pid = Pid::from_raw(i32::try_from(pid).unwrap()).unwrap();
    kill_process(pid, Signal::KILL).unwrap();
}

fn wait_until(limit: Duration, mut done: impl FnMut() -> bool) -> Duration {
    let begun = Instant::now();
    while !done() && begun.elapsed() < limit {
        std::thread::sleep(Duration::from_millis(10));
    }
    begun.elapsed()
}

/// Kills the first descendant whose command line contains `mark`, and returns the message.
fn kill_peer(mark: &str) -> (String, Duration, i32) {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let mut run = start(&out);
    let coordinator = run.id();
    wait_for_windows(&mut run, &out);
    let peers = descendants(coordinator);
    let victim = *peers
        .iter()
        .find(|&&pid| command_line(pid).contains(mark))
        .unwrap_or_else(|| panic!("no process `{mark}` among {peers:?}"));
    kill(victim);
    let taken = wait_until(Duration::from_secs(20), || {
        run.try_wait().unwrap().is_some()
    });
    let code = run.wait().unwrap().code().unwrap_or(-1);
    let mut text = String::new();
    run.stderr
        .take()
        .unwrap()
        .read_to_string(&mut text)
        .unwrap();
    assert!(
        text.contains(&format!("pid {victim}")),
        "the message does not name pid {victim}: {text}"
    );
    wait_until(Duration::from_secs(5), || {
        !peers.iter().any(|&pid| alive(pid))
    });
    for pid in peers {
        assert!(
            !alive(pid),
            "process {pid} is still there: {}",
            command_line(pid)
        );
    }
    assert_eq!(shared_memory(coordinator), Vec::<String>::new());
    (text, taken, code)
}

#[test]
fn a_killed_openfoam_is_named_with_its_log_and_everything_ends() {
    let (text, taken, code) = kill_peer("calcineGasFoam");
    println!("ended {taken:?} after the kill; message:\n{text}");
    assert!(text.contains("OpenFOAM"), "{text}");
    assert!(text.contains("SIGKILL"), "{text}");
    assert!(text.contains("the end of its log"), "{text}");
    assert!(taken < Duration::from_secs(5), "{taken:?}");
    assert_eq!(code, 4);
}

#[test]
fn a_killed_liggghts_is_named_with_its_log_and_everything_ends() {
    let (text, taken, code) = kill_peer("calcine-liggghts");
    println!("ended {taken:?} after the kill; message:\n{text}");
    assert!(text.contains("LIGGGHTS"), "{text}");
    assert!(text.contains("SIGKILL"), "{text}");
    assert!(text.contains("the end of its log"), "{text}");
    assert!(taken < Duration::from_secs(5), "{taken:?}");
    assert_eq!(code, 4);
}

#[test]
fn when_the_coordinator_is_killed_both_solvers_say_so_and_nothing_stays_behind() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let mut run = start(&out);
    let coordinator = run.id();
    wait_for_windows(&mut run, &out);
    let peers = descendants(coordinator);
    assert!(peers.len() >= 2, "{peers:?}");
    kill(coordinator);
    let taken = wait_until(Duration::from_secs(20), || {
        !peers.iter().any(|&pid| alive(pid))
    });
    println!("both solvers had ended {taken:?} after the kill of the coordinator");
    run.wait().unwrap();
    assert!(taken < Duration::from_secs(5), "{taken:?}");
    assert_eq!(shared_memory(coordinator), Vec::<String>::new());
    let mut named = 0;
    for entry in fs::read_dir(out.join("log")).unwrap().flatten() {
        let text = fs::read_to_string(entry.path()).unwrap_or_default();
        named += usize::from(text.contains(&format!("coordinator (pid {coordinator})")));
    }
    assert!(named >= 2, "only {named} logs name the coordinator");

    // The next run is clean, in the same folder too.
    let status = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("run")
        .arg(case())
        .args(["--gas", "openfoam", "--particles", "liggghts", "--quiet"])
        .args(["--set", "time.end=1 s"])
        .arg("--out")
        .arg(directory.path().join("next"))
        .status()
        .unwrap();
    assert!(status.success(), "{status}");
}
