//! Faults of runs on several ranks and over MPI: each kind of process is killed or stopped; the message
//! names it, everything ends, nothing stays behind. And the ways to start ranks.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout
)]

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use rustix::process::Signal;

use crate::processes::{
    alive, case, command_line, descendants, kill, leftovers, signal, start_with, wait_for_windows,
    wait_until,
};

const RANKS: [&str; 4] = ["--ranks-gas", "2", "--ranks-particles", "2"];

/// Waits until a run has ended; its exit code and what it said.
fn end_of(run: &mut Child) -> (i32, String, Duration) {
    let taken = wait_until(Duration::from_secs(30), || {
        run.try_wait().unwrap().is_some()
    });
    if run.try_wait().unwrap().is_none() {
        run.kill().unwrap();
    }
    let code = run.wait().unwrap().code().unwrap_or(-1);
    let mut text = String::new();
    let mut said = run.stderr.take().unwrap();
    said.read_to_string(&mut text).unwrap();
    (code, text, taken)
}

/// No process of a run lives, and none of its files is there.
fn assert_nothing_left(coordinator: u32, peers: &[u32]) {
    wait_until(Duration::from_secs(5), || {
        !peers.iter().any(|&pid| alive(pid)) && leftovers(coordinator).is_empty()
    });
    for &pid in peers {
        assert!(!alive(pid), "{pid} is still there: {}", command_line(pid));
    }
    assert_eq!(leftovers(coordinator), Vec::<String>::new());
}

/// Sends a signal to the last process whose command line begins with a word that ends so.
fn strike(words: &[&str], victim: &str, sent: Signal) -> (u32, i32, String) {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let mut run = start_with(&out, words);
    let coordinator = run.id();
    wait_for_windows(&mut run, &out);
    let peers = descendants(coordinator);
    let is_victim = |pid: &&u32| {
        let line = command_line(**pid);
        line.split(' ')
            .next()
            .is_some_and(|word| word.ends_with(victim))
    };
    let found = *peers
        .iter()
        .rfind(is_victim)
        .unwrap_or_else(|| panic!("no process `{victim}` among {peers:?}"));
    signal(found, sent);
    let (code, text, taken) = end_of(&mut run);
    println!("{victim}: ended {taken:?} after the signal; message:\n{text}");
    assert_nothing_left(coordinator, &peers);
    (found, code, text)
}

fn assert_named(pid: u32, code: i32, text: &str, words: &[&str]) {
    assert_eq!(code, 4, "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
    assert!(text.contains(&format!("pid {pid}")), "{pid}: {text}");
    assert!(text.contains("the end of its log"), "{text}");
}

#[test]
fn a_killed_rank_of_openfoam_is_named() {
    let (pid, code, text) = strike(&RANKS, "calcineGasFoam", Signal::KILL);
    assert_named(pid, code, &text, &["OpenFOAM (gas, rank", "died"]);
}

#[test]
fn a_killed_mpirun_is_named_and_its_ranks_and_their_memory_go_with_it() {
    let (pid, code, text) = strike(&RANKS, "mpirun", Signal::KILL);
    assert_named(pid, code, &text, &["launcher)", "SIGKILL"]);
}

#[test]
fn a_stopped_rank_is_silent_and_says_for_how_long() {
    let deadline = ["--set", "coupling.deadline=10 s"];
    let words = [&RANKS[..], &deadline].concat();
    let (_, code, text) = strike(&words, "calcine-liggghts", Signal::STOP);
    assert_eq!(code, 4, "{text}");
    assert!(text.contains("LIGGGHTS"), "{text}");
    assert!(text.contains("silent for 10 s"), "{text}");
}

#[test]
fn over_mpi_a_killed_rank_is_named() {
    let words = [&RANKS[..], &["--transport", "mpi"]].concat();
    let (pid, code, text) = strike(&words, "calcineGasFoam", Signal::KILL);
    assert_named(pid, code, &text, &["OpenFOAM (gas, rank", "died"]);
}

/// The ranks end by themselves soon after it, and Open MPI ends the coordinator after a second, which both would hide
/// who was first.
#[test]
fn over_mpi_a_killed_daemon_is_named() {
    let words = [&RANKS[..], &["--transport", "mpi"]].concat();
    let (pid, code, text) = strike(&words, "orted", Signal::KILL);
    let named = format!("MPI's daemon (orted), pid {pid}: died: ");
    assert_named(pid, code, &text, &[&named]);
}

/// A rank between the start of MPI and its introduction has no launcher that would end with it.
#[test]
fn over_mpi_a_rank_that_dies_before_it_introduces_itself_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap();
    let case = read("cases/settled-bed.toml");
    let own = case.replace("[liggghts]\n", "[liggghts]\ntemplate = \"in.bed\"\n");
    fs::write(folder.path().join("case.toml"), own).unwrap();
    // Nothing is heard of the host while its script sleeps.
    let script = read("liggghts-inputs/own-bed.in") + "\nshell sleep 30\n";
    fs::write(folder.path().join("in.bed"), script).unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("run")
        .arg(folder.path().join("case.toml"))
        .args(["--particles", "liggghts", "--transport", "mpi", "--quiet"])
        .arg("--out")
        .arg(folder.path().join("out"))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let coordinator = run.id();
    let rank_that_sleeps = || {
        let peers = descendants(coordinator);
        let sleeps = peers
            .iter()
            .any(|&pid| command_line(pid).contains("sleep 30"));
        let host = |pid: &&u32| {
            let line = command_line(**pid);
            let program = line.split(' ').next().unwrap_or_default();
            program.ends_with("calcine-liggghts")
        };
        peers.iter().find(host).copied().filter(|_| sleeps)
    };
    wait_until(Duration::from_secs(60), || rank_that_sleeps().is_some());
    let victim = rank_that_sleeps().expect("no host sleeps");
    let peers = descendants(coordinator);
    kill(victim);
    let (code, text, taken) = end_of(&mut run);
    println!("ended {taken:?} after the signal; message:\n{text}");
    assert_eq!(code, 4, "{text}");
    // It has not written to its log yet.
    for word in ["LIGGGHTS (particles", "died", &format!("pid {victim}")] {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
    assert!(taken < Duration::from_secs(5), "{taken:?}");
    // What the script started is nobody's process of ours.
    let sleeps = |pid: u32| command_line(pid).contains("sleep 30");
    let (asleep, ours): (Vec<u32>, Vec<u32>) = peers.into_iter().partition(|&pid| sleeps(pid));
    assert_nothing_left(coordinator, &ours);
    for pid in asleep.into_iter().filter(|&pid| alive(pid)) {
        kill(pid);
    }
}

#[test]
fn a_killed_coordinator_leaves_no_rank_and_no_file_by_either_transport() {
    for transport in ["shared-memory", "mpi"] {
        let directory = tempfile::tempdir().unwrap();
        let out = directory.path().join("run");
        let words = [&RANKS[..], &["--transport", transport]].concat();
        let mut run = start_with(&out, &words);
        let coordinator = run.id();
        wait_for_windows(&mut run, &out);
        let peers = descendants(coordinator);
        assert!(peers.len() >= 5, "{peers:?}");
        kill(coordinator);
        run.wait().unwrap();
        let taken = wait_until(Duration::from_secs(20), || {
            !peers.iter().any(|&pid| alive(pid))
        });
        println!("{transport}: all ended {taken:?} after the kill of the coordinator");
        assert!(taken < Duration::from_secs(5), "{taken:?}");
        assert_nothing_left(coordinator, &peers);
    }
}

/// A short run; its series.
fn series(out: &Path, words: &[&str]) -> String {
    let outcome = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("run")
        .arg(case())
        .args(["--gas", "openfoam", "--particles", "liggghts", "--quiet"])
        .args(["--set", "time.acceleration=50", "--set", "time.end=2 s"])
        .args(words)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&outcome.stderr);
    assert!(outcome.status.success(), "{words:?}: {said}");
    fs::read_to_string(out.join("series.csv")).unwrap()
}

/// Shared memory and MPI move the same columns: nothing may depend on which.
#[test]
fn both_transports_and_a_launcher_of_one_s_own_give_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, more: &[&str]| {
        let words = [&RANKS[..], more].concat();
        series(&folder.path().join(name), &words)
    };
    let shared = run("shared", &[]);
    assert!(shared.lines().count() > 2, "{shared}");
    assert_eq!(run("mpi", &["--transport", "mpi"]), shared);
    let own = "env CALCINE_TEST=1 mpirun --allow-run-as-root --bind-to none -n 2";
    assert_eq!(run("launched", &["--launch-gas", own]), shared);
}

#[test]
fn what_attach_prints_can_be_started_by_hand() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut run = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("run")
        .arg(case())
        .args([
            "--gas",
            "openfoam",
            "--attach",
            "--ranks-gas",
            "2",
            "--quiet",
        ])
        .args(["--set", "time.acceleration=50", "--set", "time.end=1 s"])
        .arg("--out")
        .arg(&out)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(run.stderr.take().unwrap());
    let mut line = String::new();
    while !line.trim_start().starts_with("(cd ") {
        line.clear();
        assert!(
            said.read_line(&mut line).unwrap() > 0,
            "it ended without a line to start"
        );
    }
    let mut by_hand = Command::new("sh")
        .args(["-c", line.trim()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut rest = String::new();
    said.read_to_string(&mut rest).unwrap();
    assert!(run.wait().unwrap().success(), "{rest}");
    assert!(by_hand.wait().unwrap().success());
}

/// The script for one node in docs/how-to/parallel.md, as it stands there but for its numbers, with a stand-in
/// for srun that hands its tasks to mpirun: this machine has no SLURM.
#[test]
fn the_script_for_a_queue_in_the_docs_runs_and_resumes_with_a_stand_in_for_srun() {
    use std::os::unix::fs::PermissionsExt;
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/how-to/parallel.md");
    let docs = fs::read_to_string(docs).unwrap();
    let blocks = docs.split("```sh\n").skip(1);
    let mut blocks = blocks.filter_map(|block| block.split("```").next());
    let script = blocks
        .find(|block| block.contains("--launch-gas \"srun --overlap"))
        .unwrap();
    let folder = tempfile::tempdir().unwrap();
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    let program = |name: &str, text: &str| {
        fs::write(bin.join(name), text).unwrap();
        fs::set_permissions(bin.join(name), fs::Permissions::from_mode(0o755)).unwrap();
    };
    program(
        "srun",
        "#!/bin/sh\n[ \"$1\" = --overlap ] && [ \"$2\" = -n ] || exit 9\nranks=$3; shift 3\n\
         echo \"$ranks\" >> \"$STARTED\"\n\
         exec mpirun --allow-run-as-root --oversubscribe --bind-to none -n \"$ranks\" \"$@\"\n",
    );
    let calcine = env!("CARGO_BIN_EXE_calcine");
    program(
        "calcine",
        &format!("#!/bin/sh\nexec \"{calcine}\" \"$@\"\n"),
    );
    // A row a window, and an end that is far away.
    let words = "--quiet --set time.acceleration=1 --set 'output.series_every=1 ms'";
    let case = format!("'{}' {words}", case().display());
    let script = script
        .replace("CASE", &case)
        .replace("-gas 12", "-gas 2")
        .replace("-n 12", "-n 2")
        .replace("-particles 4", "-particles 2")
        .replace("-n 4", "-n 2")
        .replace("results/bed $resume", "results/bed $resume --stop-after 3s");
    program("job", &script);
    let out = folder.path().join("results/bed");
    let rows = || fs::read_to_string(out.join("series.csv")).map_or(0, |text| text.lines().count());
    // As sbatch does it: the script as a program, in the folder that it was handed in.
    let job = || {
        let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
        let outcome = Command::new(bin.join("job"))
            .current_dir(folder.path())
            .env("PATH", path)
            .env("STARTED", folder.path().join("started"))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&outcome.stderr).into_owned();
        assert_eq!(outcome.status.code(), Some(75), "{said}");
        rows()
    };
    let first = job();
    assert!(first > 1);
    assert!(job() > first);
    let started = fs::read_to_string(folder.path().join("started")).unwrap();
    assert_eq!(started, "2\n".repeat(4));
}
