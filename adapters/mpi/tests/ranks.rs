//! Which processes a coordinator takes for ranks that MPI has started.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use calcine_mpi::{MpiNetwork, end};
use calcine_wire::run::VARIABLE;
use calcine_wire::{SolverNetwork, WireError};

const FOLDER: &str = "CALCINE_TEST_RANKS";

/// Has MPI start a rank that starts another process and dies; notes what is said, and who are taken for ranks.
fn coordinate(folder: &Path) -> ! {
    // Open MPI ends this process a second after the rank; guarded, it waits longer.
    let (network, universe) = MpiNetwork::start_guarded().unwrap();
    let address = network.address("particles").to_text();
    let pids = folder.join("pids");
    let script = format!(
        "sleep 20 & echo $$ $! >{}; sleep 1; kill -9 $$",
        pids.display()
    );
    let line = format!("exec env {VARIABLE}='{address}' /bin/sh -c '{script}'");
    let line = ["/bin/sh".into(), "-c".into(), line.into()];
    let died = network.spawn(&line, 1, Duration::from_secs(60), &|| false);
    let died = died.err().expect("nobody joined MPI");
    assert!(
        matches!(died, WireError::DiedStarting { ranks: 1, left: 0 }),
        "{died}"
    );
    let roles = ["particles", "gas"].map(|role| network.ranks_here(role));
    fs::write(folder.join("ranks"), format!("{roles:?}")).unwrap();
    drop(network);
    end(false, universe, 0)
}

/// What a rank starts inherits all its variables. MPI may end the coordinator, so that it is a process of its own.
#[test]
fn a_rank_that_died_is_remembered_and_what_it_started_is_no_rank() {
    if let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) {
        coordinate(&folder);
    }
    let folder = tempfile::tempdir().unwrap();
    let name = "a_rank_that_died_is_remembered_and_what_it_started_is_no_rank";
    let coordinator = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", name, "--nocapture"])
        .env(FOLDER, folder.path())
        .output()
        .unwrap();
    let pids = fs::read_to_string(folder.path().join("pids")).unwrap();
    let pids: Vec<i32> = pids
        .split_ascii_whitespace()
        .map(|pid| pid.parse().unwrap())
        .collect();
    let orphan = rustix::process::Pid::from_raw(pids[1]).unwrap();
    // It may have ended with its rank.
    let _ = rustix::process::kill_process(orphan, rustix::process::Signal::KILL);
    assert!(coordinator.status.success(), "{coordinator:?}");
    let ranks = fs::read_to_string(folder.path().join("ranks")).unwrap();
    assert_eq!(ranks, format!("[[(0, {})], []]", pids[0]));
}
