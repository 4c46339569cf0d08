//! A solver's life: repeats, checkpoints, refusals and death.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use calcine_coupler::error::FailureKind;
use calcine_coupler::part::{CellExchange, Gas, Part};
use rustix::process::{Pid, Signal, kill_process};

use crate::openfoam_support::{CELLS, Duct, bed, mesh, no_exchange, setup};

fn heating() -> CellExchange {
    let mut exchange = no_exchange();
    exchange.heat_coefficient.fill(0.01);
    exchange.heat_source.fill(0.01 * 350.0);
    exchange.drag_coefficient.fill(1e-4);
    exchange
}

#[test]
fn a_repeated_attempt_gives_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let mut duct = Duct::launch(&setup(), folder.path());
    duct.advance(3, &bed(0.5), &heating());
    duct.attempt(&bed(0.5), &heating());
    let first = duct.bits();
    duct.window.attempt = 1;
    duct.attempt(&bed(0.5), &no_exchange());
    assert_ne!(duct.bits(), first);
    duct.window.attempt = 2;
    duct.attempt(&bed(0.5), &heating());
    assert_eq!(duct.bits(), first);
}

#[test]
fn a_resumed_run_goes_on_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = folder.path().join("checkpoint/gas");
    let mut duct = Duct::launch(&setup(), folder.path());
    duct.advance(5, &bed(0.5), &heating());
    duct.gas.checkpoint(&checkpoint).unwrap();
    let window = duct.window;
    duct.advance(5, &bed(0.5), &heating());
    let expected = duct.bits();
    drop(duct);

    let other = folder.path().join("resumed");
    let mut resumed =
        Duct::try_launch(mesh([1, 1, CELLS]), &setup(), &other, Some(&checkpoint)).unwrap();
    resumed.window = window;
    resumed.advance(5, &bed(0.5), &heating());
    assert_eq!(resumed.bits(), expected);
    resumed.gas.finish_run(&resumed.supervisor).unwrap();
}

#[test]
fn a_checkpoint_does_not_change_what_follows() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, checkpoint: bool| {
        let folder = folder.path().join(name);
        let mut duct = Duct::launch(&setup(), &folder);
        duct.advance(4, &bed(0.5), &heating());
        if checkpoint {
            duct.gas.checkpoint(&folder.join("kept")).unwrap();
        }
        duct.advance(4, &bed(0.5), &heating());
        duct.bits()
    };
    assert_eq!(run("with", true), run("without", false));
}

#[test]
fn a_damaged_checkpoint_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("nothing");
    let error = Duct::try_launch(mesh([1, 1, CELLS]), &setup(), folder.path(), Some(&missing))
        .err()
        .unwrap();
    assert!(error.to_string().contains("calcineGasState"), "{error}");
    assert!(error.to_string().contains("missing"), "{error}");
}

#[test]
fn a_killed_solver_is_noticed_within_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let mut duct = Duct::launch(&setup(), folder.path());
    duct.advance(2, &bed(0.5), &heating());
    let pid = i32::try_from(duct.gas.pid()).ok().and_then(Pid::from_raw);
    kill_process(pid.unwrap(), Signal::KILL).unwrap();
    let begun = Instant::now();
    let started = duct.gas.start(&duct.window, &bed(0.5), &heating());
    let finished = started.and_then(|()| {
        duct.gas
            .finish(&duct.supervisor, &mut duct.received)
            .map(|_| ())
    });
    let error = finished.unwrap_err();
    assert!(begun.elapsed() < Duration::from_secs(1));
    assert_eq!(error.kind, FailureKind::Died, "{error}");
    let text = error.to_string();
    for part in ["OpenFOAM (gas)", "pid", "SIGKILL", "window 1 attempt 0"] {
        assert!(text.contains(part), "{text}");
    }
}

/// Stands in for a coordinator: what the next test starts as a process of its own, and kills.
#[test]
fn a_coordinator_that_waits_to_be_killed() {
    let Some(folder) = std::env::var_os("CALCINE_TEST_COORDINATOR").map(PathBuf::from) else {
        return;
    };
    let mut duct = Duct::launch(&setup(), &folder);
    duct.advance(2, &bed(0.5), &heating());
    let words = format!("{}", duct.gas.pid());
    std::fs::write(folder.join("part"), words).unwrap();
    std::fs::rename(folder.join("part"), folder.join("pid")).unwrap();
    std::thread::sleep(Duration::from_secs(60));
}

#[test]
fn a_solver_ends_within_a_second_of_its_coordinator() {
    let folder = tempfile::tempdir().unwrap();
    let mut coordinator = Command::new(std::env::current_exe().unwrap())
        .args([
            "--exact",
            "openfoam_life::a_coordinator_that_waits_to_be_killed",
        ])
        .env("CALCINE_TEST_COORDINATOR", folder.path())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let pid = loop {
        if let Ok(pid) = std::fs::read_to_string(folder.path().join("pid")) {
            break pid;
        }
        assert!(begun.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(5));
    };
    coordinator.kill().unwrap();
    coordinator.wait().unwrap();
    let killed = Instant::now();
    // An orphan is reaped by init; a zombie has ended, too.
    let lives = || {
        std::fs::read_to_string(format!("/proc/{pid}/stat"))
            .is_ok_and(|stat| !stat.contains(") Z "))
    };
    while lives() {
        assert!(killed.elapsed() < Duration::from_secs(1), "it still runs");
        std::thread::sleep(Duration::from_millis(5));
    }
    let log = std::fs::read_to_string(folder.path().join("log")).unwrap();
    assert!(log.contains("died"), "{log}");
}

#[test]
fn a_diverging_attempt_is_told_with_cell_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let mut duct = Duct::launch(&setup(), folder.path());
    let mut exchange = no_exchange();
    exchange.heat_source[5] = 1e9;
    duct.gas.start(&duct.window, &bed(0.5), &exchange).unwrap();
    let error = duct
        .gas
        .finish(&duct.supervisor, &mut duct.received)
        .unwrap_err();
    assert_eq!(error.kind, FailureKind::Diverged, "{error}");
    assert!(error.message.contains("temperature"), "{error}");
    assert!(error.message.contains("cell"), "{error}");
}

#[test]
fn the_log_of_five_hundred_windows_stays_short() {
    let folder = tempfile::tempdir().unwrap();
    let mut practical = setup();
    practical.controls.outer_iterations = 3;
    practical.controls.outer_tolerance = 1e-6;
    practical.controls.linear_tolerance = Some(1e-10);
    let mut duct = Duct::launch(&practical, folder.path());
    duct.advance(500, &bed(0.5), &heating());
    let log = std::fs::read_to_string(folder.path().join("log")).unwrap();
    assert!(log.lines().count() < 100, "{} lines", log.lines().count());
}
