//! Faults: each process of a coupled run is killed in the middle of a window; the message names
//! it, everything ends, nothing stays behind, and the next run is clean.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[path = "support/processes.rs"]
mod processes;

use std::fs;
use std::io::Read;
use std::process::Command;
use std::time::Duration;

use processes::{
    alive, case, command_line, descendants, kill, leftovers, start, wait_for_windows, wait_until,
};

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
    assert_eq!(leftovers(coordinator), Vec::<String>::new());
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
    assert_eq!(leftovers(coordinator), Vec::<String>::new());
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
