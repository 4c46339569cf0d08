//! Faults: each process of a coupled run is killed as it starts, in the middle of a window and in output; the
//! message names it, everything ends, nothing stays behind, and the next run is clean.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use crate::processes::{
    alive, belonging, case, command_line, descendants, kill, leftovers, start, start_with,
    wait_for_windows, wait_until,
};

/// Within which everything must have ended.
const LIMIT: Duration = Duration::from_secs(5);
/// After which a run counts as hanging.
const PATIENCE: Duration = Duration::from_secs(60);

/// Where a run stands when a process of it is killed.
#[derive(Clone, Copy, Debug)]
enum Moment {
    /// The process has just been started.
    Handshake,
    /// Windows are being committed.
    Window,
    /// A checkpoint is being written.
    Output,
}

/// Starts a run and waits for the moment; gives its descendants and the first whose command line has a mark.
fn come_to(moment: Moment, mark: &str, out: &Path) -> (Child, Vec<u32>, u32) {
    let often = [
        "--set",
        "output.every=0.01 s",
        "--set",
        "time.checkpoint.every=0.01 s",
    ];
    let words: &[&str] = match moment {
        Moment::Output => &often,
        _ => &[],
    };
    let mut run = start_with(out, words);
    let coordinator = run.id();
    if !matches!(moment, Moment::Handshake) {
        wait_for_windows(&mut run, out);
    }
    if matches!(moment, Moment::Output) {
        wait_until(PATIENCE, || out.join("checkpoint.part").exists());
    }
    let mut found = None;
    wait_until(PATIENCE, || {
        let peers = descendants(coordinator);
        let victim = peers
            .iter()
            .copied()
            .find(|&pid| command_line(pid).contains(mark));
        found = victim.map(|victim| (peers, victim));
        found.is_some() || run.try_wait().unwrap().is_some()
    });
    let (peers, victim) = found.unwrap_or_else(|| panic!("no process `{mark}`"));
    (run, peers, victim)
}

/// Nothing of a run is there within 5 s.
fn assert_all_gone(coordinator: u32, peers: &[u32]) {
    wait_until(LIMIT, || {
        !peers.iter().any(|&pid| alive(pid))
            && belonging(coordinator).is_empty()
            && leftovers(coordinator).is_empty()
    });
    for &pid in peers {
        assert!(!alive(pid), "{pid} is still there: {}", command_line(pid));
    }
    assert_eq!(belonging(coordinator), Vec::<u32>::new());
    assert_eq!(leftovers(coordinator), Vec::<String>::new());
}

/// Kills the first descendant whose command line contains `mark`, and returns the message.
fn kill_peer(moment: Moment, mark: &str) -> (String, Duration, i32) {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let (mut run, peers, victim) = come_to(moment, mark, &out);
    let coordinator = run.id();
    kill(victim);
    let taken = wait_until(PATIENCE, || run.try_wait().unwrap().is_some());
    let code = run.wait().unwrap().code().unwrap_or(-1);
    let mut text = String::new();
    run.stderr
        .take()
        .unwrap()
        .read_to_string(&mut text)
        .unwrap();
    println!("{moment:?}: ended {taken:?} after the kill; message:\n{text}");
    assert!(
        text.contains(&format!("pid {victim}")),
        "the message does not name pid {victim}: {text}"
    );
    assert!(taken < LIMIT, "{taken:?}");
    assert_eq!(code, 4);
    assert_all_gone(coordinator, &peers);
    (text, taken, code)
}

/// Kills it in a window and in output, where it has written a log, and as it starts.
fn killed_at_every_moment(mark: &str, name: &str) {
    for moment in [Moment::Handshake, Moment::Window, Moment::Output] {
        let (text, ..) = kill_peer(moment, mark);
        assert!(text.contains(name), "{text}");
        assert!(text.contains("SIGKILL"), "{text}");
        // One that is killed at once may have written nothing.
        let begun = !matches!(moment, Moment::Handshake);
        assert!(!begun || text.contains("the end of its log"), "{text}");
    }
}

#[test]
fn openfoam_killed_in_handshake_window_or_output_is_named_with_its_log_and_everything_ends() {
    killed_at_every_moment("calcineGasFoam", "OpenFOAM");
}

#[test]
fn liggghts_killed_in_handshake_window_or_output_is_named_with_its_log_and_everything_ends() {
    killed_at_every_moment("calcine-liggghts", "LIGGGHTS");
}

#[test]
fn when_the_coordinator_is_killed_in_handshake_or_output_nothing_stays_behind() {
    for (moment, mark) in [
        (Moment::Handshake, "calcineGasFoam"),
        (Moment::Handshake, "calcine-liggghts"),
        (Moment::Output, "calcineGasFoam"),
    ] {
        let directory = tempfile::tempdir().unwrap();
        let out = directory.path().join("run");
        let (mut run, peers, _) = come_to(moment, mark, &out);
        let coordinator = run.id();
        kill(coordinator);
        run.wait().unwrap();
        let taken = wait_until(PATIENCE, || !peers.iter().any(|&pid| alive(pid)));
        println!("{moment:?}: the solvers had ended {taken:?} after the kill of the coordinator");
        assert!(taken < LIMIT, "{taken:?}");
        assert_all_gone(coordinator, &peers);
    }
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

/// A moment of a few milliseconds, in which only the run's guard is there to remove its files.
#[test]
fn when_the_coordinator_is_killed_before_it_has_a_solver_nothing_stays_behind() {
    for _ in 0..5 {
        let directory = tempfile::tempdir().unwrap();
        let mut run = start(&directory.path().join("run"));
        let coordinator = run.id();
        let begun = Instant::now();
        while leftovers(coordinator).is_empty() && begun.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_micros(100));
        }
        kill(coordinator);
        run.wait().unwrap();
        assert_all_gone(coordinator, &[]);
    }
}
