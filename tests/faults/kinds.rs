//! Faults that are no death, through the program: a gas that diverges, particles that are lost, another mesh or
//! version at the other end, too little shared memory, two runs at once, an ordinary user, Ctrl-C.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Output, Stdio};
use std::time::Duration;

use calcine_wire::record::VERSION;
use calcine_wire::shared_memory::LinkEnd;
use calcine_wire::{Header, LinkAddress, MessageKind, SharedMemory, Transport};
use rustix::process::Signal;

use crate::processes::{
    alive, belonging, case, descendants, is_solver, leftovers, signal, start_with,
    wait_for_windows, wait_until,
};

const LIMIT: Duration = Duration::from_secs(5);
const BOTH: [&str; 4] = ["--gas", "openfoam", "--particles", "liggghts"];
/// A run of few windows.
const SHORT: [&str; 4] = ["--set", "time.acceleration=50", "--set", "time.end=1 s"];

/// `calcine run CASE WORDS --out OUT`.
fn calcine(case: &Path, words: &[&str], out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.arg("run").arg(case).arg("--quiet").args(words);
    command.arg("--out").arg(out).stdin(Stdio::null());
    command
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// No process and no file of a run is left, at the latest after [`LIMIT`].
fn assert_clean(coordinator: u32, peers: &[u32]) {
    wait_until(LIMIT, || {
        !peers.iter().any(|&pid| alive(pid))
            && belonging(coordinator).is_empty()
            && leftovers(coordinator).is_empty()
    });
    assert!(!peers.iter().any(|&pid| alive(pid)));
    assert_eq!(belonging(coordinator), Vec::<u32>::new());
    assert_eq!(leftovers(coordinator), Vec::<String>::new());
}

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("cases")
        .join(name)
}

#[test]
fn an_openfoam_that_diverges_says_where_and_ends_with_its_own_exit_code() {
    let directory = tempfile::tempdir().unwrap();
    let absurd = [
        "--set",
        "gas.patch.bottom.inlet.temperature=1e5 K",
        // By the whole flux such gas brings next to nothing: it has no density.
        "--set",
        "gas.patch.bottom.inlet.scalars=value",
        "--set",
        "time.gas_storage=process",
        "--set",
        "gas.controls.convection=central",
    ];
    let all = [&BOTH[..], &SHORT, &absurd].concat();
    let run = calcine(&case(), &all, &directory.path().join("run"))
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let coordinator = run.id();
    let output = run.wait_with_output().unwrap();
    let text = words(&output);
    println!("{text}");
    assert_eq!(output.status.code(), Some(3), "{text}");
    for word in [
        "OpenFOAM (gas)",
        "diverged",
        "has its largest Courant number, ",
        "`gas.controls.convection` is central",
        "the end of its log",
    ] {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
    assert_clean(coordinator, &[]);
}

/// Beads fall through a bottom that is no wall for them.
#[test]
fn a_liggghts_that_loses_particles_says_which_and_where() {
    let directory = tempfile::tempdir().unwrap();
    let all = [
        "--particles",
        "liggghts",
        "--set",
        "walls[0].patches=[\"side\", \"top\"]",
        // Far enough in one window to leave LIGGGHTS' box, not only the mesh.
        "--set",
        "time.motion_window=0.1 s",
    ];
    let run = calcine(
        &shipped("settled-bed.toml"),
        &all,
        &directory.path().join("run"),
    )
    .stderr(Stdio::piped())
    .spawn()
    .unwrap();
    let coordinator = run.id();
    let output = run.wait_with_output().unwrap();
    let text = words(&output);
    println!("{text}");
    assert_eq!(output.status.code(), Some(3), "{text}");
    for word in [
        "LIGGGHTS (particles)",
        "left the box",
        "last seen at",
        "the end of its log",
    ] {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
    assert_clean(coordinator, &[]);
}

/// A run that waits for its gas to be started by hand, and the line that it prints.
fn attached(out: &Path) -> (Child, BufReader<ChildStderr>, String) {
    let mut run = calcine(&case(), &["--gas", "openfoam", "--attach"], out)
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
    (run, said, line.trim().to_owned())
}

#[test]
fn a_solver_with_another_mesh_is_refused_by_both_ends() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let (mut run, mut said, line) = attached(&out);
    let coordinator = run.id();
    // The mesh of the case that was written, with one point moved.
    let points = out.join("solvers/openfoam/constant/polyMesh/points");
    let text = fs::read_to_string(&points).unwrap();
    let at = text.find("\n(").unwrap();
    let (head, tail) = text.split_at(at);
    let moved = tail.replacen("(1.0000000000000000208e-2 ", "(1.01e-2 ", 1);
    assert_ne!(moved, tail, "{}", &tail[..200]);
    fs::write(&points, format!("{head}{moved}")).unwrap();
    let by_hand = Command::new("sh").args(["-c", &line]).output().unwrap();
    let mut text = String::new();
    said.read_to_string(&mut text).unwrap();
    println!("coordinator: {text}\nsolver: {}", words(&by_hand));
    assert_eq!(run.wait().unwrap().code(), Some(4), "{text}");
    assert!(text.contains("mesh"), "{text}");
    assert!(!by_hand.status.success());
    assert_clean(coordinator, &[]);
}

/// Stands in for a solver of another version: what the next test starts as a process of its own. With the
/// coordinator it ends.
#[test]
fn a_solver_of_another_version() {
    if std::env::var_os("CALCINE_TEST_SOLVER").is_none() {
        return;
    }
    let address = LinkAddress::from_environment().unwrap();
    let mut end = SharedMemory::open(&address, 0, LinkEnd::Solver).unwrap();
    let hello = b"protocol 999\nrole gas\n";
    let header = Header {
        run: address.number(),
        bytes: hello.len() as u64,
        ..Header::of(MessageKind::Hello)
    };
    let mut padded = hello.to_vec();
    padded.resize(hello.len().next_multiple_of(8), 0);
    let payload = end.loan(header, padded.len() / 8).unwrap();
    for (word, bytes) in payload.iter_mut().zip(padded.chunks(8)) {
        *word = u64::from_ne_bytes(bytes.try_into().unwrap());
    }
    end.send().unwrap();
    // What it is answered.
    assert!(end.receive(Duration::from_secs(30)).unwrap());
}

#[test]
fn a_solver_of_another_version_is_refused_with_both_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let (mut run, mut said, line) = attached(&directory.path().join("run"));
    let coordinator = run.id();
    let (_, after) = line.split_once("CALCINE_LINK='").unwrap();
    let mut solver = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "kinds::a_solver_of_another_version"])
        .env("CALCINE_TEST_SOLVER", "1")
        .env("CALCINE_LINK", after.split_once('\'').unwrap().0)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let mut text = String::new();
    said.read_to_string(&mut text).unwrap();
    println!("{text}");
    assert_eq!(run.wait().unwrap().code(), Some(4), "{text}");
    let mismatch = format!("the protocol version is {VERSION} here, but 999");
    assert!(text.contains(&mismatch), "{text}");
    solver.wait().unwrap();
    assert_clean(coordinator, &[]);
}

/// The words that run a command with a /dev/shm of its own, of so many bytes; `None` where this user may not.
fn small_memory(size: &str) -> Option<Vec<String>> {
    let namespace = if rustix::process::geteuid().is_root() {
        "-m"
    } else {
        "-rm"
    };
    let script = format!("mount -t tmpfs -o size={size} tmpfs /dev/shm && exec \"$@\"");
    let line = ["unshare", namespace, "sh", "-c", &script, "sh"].map(str::to_owned);
    let tried = Command::new(&line[0]).args(&line[1..]).arg("true").output();
    if tried.is_ok_and(|tried| tried.status.success()) {
        return Some(line.to_vec());
    }
    println!("SKIPPED: this user cannot mount a small /dev/shm in a namespace of its own");
    None
}

/// From nothing at all to what suffices: never SIGBUS, never a hang, always the fact and the remedy.
#[test]
fn a_small_shared_memory_is_refused_in_words_whatever_its_size_and_however_many_ranks() {
    let mut refused = 0;
    for (size, ranks) in [
        ("64k", 1),
        ("512k", 1),
        ("1100k", 1),
        ("1100k", 2),
        ("3m", 2),
    ] {
        let Some(line) = small_memory(size) else {
            return;
        };
        let directory = tempfile::tempdir().unwrap();
        let ranks = ranks.to_string();
        let out = directory.path().join("run");
        let all = [
            &BOTH[..],
            &SHORT,
            &["--ranks-gas", &ranks, "--ranks-particles", &ranks],
        ];
        let inner = calcine(&case(), &all.concat(), &out);
        let mut command = Command::new(&line[0]);
        command
            .args(&line[1..])
            .arg(inner.get_program())
            .args(inner.get_args());
        let begun = std::time::Instant::now();
        let run = command
            .stdin(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let coordinator = run.id();
        let output = run.wait_with_output().unwrap();
        let text = words(&output);
        println!(
            "{size}, {ranks} ranks: {} after {:?}: {text}",
            output.status,
            begun.elapsed()
        );
        assert!(begun.elapsed() < Duration::from_secs(60));
        assert!(!text.contains("SIGBUS"), "{text}");
        if !output.status.success() {
            assert_eq!(output.status.code(), Some(4), "{text}");
            assert!(text.contains("/dev/shm"), "{text}");
            refused += 1;
        }
        assert_clean(coordinator, &[]);
    }
    assert!(refused >= 2, "{refused}");
}

#[test]
fn two_runs_at_once_do_not_see_each_other_and_a_third_stays_out_of_their_folder() {
    let directory = tempfile::tempdir().unwrap();
    let long = start_with(&directory.path().join("long"), &[]);
    let mut long = Ended(long);
    wait_for_windows(&mut long.0, &directory.path().join("long"));
    let series = |out: &Path| fs::read_to_string(out.join("series.csv")).unwrap();
    let all = [&BOTH[..], &SHORT].concat();
    let (one, two) = (directory.path().join("one"), directory.path().join("two"));
    let runs = [&one, &two].map(|out| calcine(&case(), &all, out).spawn().unwrap());
    for mut run in runs {
        assert!(run.wait().unwrap().success());
    }
    assert_eq!(series(&one), series(&two));
    assert!(
        long.0.try_wait().unwrap().is_none(),
        "the first run has ended"
    );
    let third = calcine(&case(), &all, &directory.path().join("long"))
        .output()
        .unwrap();
    assert_eq!(third.status.code(), Some(2));
    assert!(words(&third).contains("another run"), "{}", words(&third));
    let peers = descendants(long.0.id());
    signal(long.0.id(), Signal::KILL);
    long.0.wait().unwrap();
    assert_clean(long.0.id(), &peers);
}

/// A run that ends with the test, however that ends.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // One that has ended is what is wanted.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn an_ordinary_user_runs_both_solvers_on_ranks_and_leaves_nothing() {
    if !rustix::process::geteuid().is_root() {
        println!("every other test of this user shows it");
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let home = directory.path().join("home");
    fs::create_dir(&home).unwrap();
    let open = |path: &Path| {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    };
    open(directory.path());
    let nobody = Some(65534);
    std::os::unix::fs::chown(&home, nobody, nobody).unwrap();
    let own = Path::new(env!("CARGO_BIN_EXE_calcine"));
    let folder = own.parent().unwrap();
    let foam = folder.join("../openfoam/bin");
    for program in [
        own.to_owned(),
        folder.join("calcine-liggghts"),
        foam.join("calcineGasFoam"),
        foam.join("libcalcineFoam.so"),
    ] {
        let copy = directory.path().join(program.file_name().unwrap());
        fs::copy(&program, &copy).unwrap();
        open(&copy);
    }
    let case_copy = directory.path().join("case.toml");
    fs::copy(case(), &case_copy).unwrap();
    let ranks = ["--ranks-gas", "2", "--ranks-particles", "2"];
    let inner = calcine(
        &case_copy,
        &[&BOTH[..], &SHORT, &ranks].concat(),
        &home.join("run"),
    );
    let run = Command::new("setpriv")
        .args(["--reuid=65534", "--regid=65534", "--clear-groups"])
        .arg(directory.path().join("calcine"))
        .args(inner.get_args())
        .current_dir(&home)
        .env("HOME", &home)
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let coordinator = run.id();
    let output = run.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", words(&output));
    assert!(home.join("run/summary.json").is_file());
    assert_clean(coordinator, &[]);
}

/// Waits for a run's end after it was told.
fn end_of(run: &mut Child) -> (Option<i32>, Duration) {
    let taken = wait_until(Duration::from_secs(30), || {
        run.try_wait().unwrap().is_some()
    });
    if run.try_wait().unwrap().is_none() {
        run.kill().unwrap();
    }
    (run.wait().unwrap().code(), taken)
}

#[test]
fn ctrl_c_writes_a_checkpoint_that_resumes_by_either_transport() {
    for transport in ["shared-memory", "mpi"] {
        let directory = tempfile::tempdir().unwrap();
        let out = directory.path().join("run");
        let transport = ["--transport", transport];
        let mut run = start_with(&out, &transport);
        let coordinator = run.id();
        wait_for_windows(&mut run, &out);
        let peers = descendants(coordinator);
        signal(coordinator, Signal::INT);
        let (code, taken) = end_of(&mut run);
        println!("{transport:?}: ended {taken:?} after Ctrl-C");
        assert_eq!(code, Some(75));
        assert!(taken < LIMIT, "{taken:?}");
        assert_clean(coordinator, &peers);
        assert!(out.join("checkpoint/coordinator.state").is_file());
        let mut resumed = start_with(&out, &[&transport[..], &["--resume"]].concat());
        let rows = fs::read_to_string(out.join("series.csv"))
            .unwrap()
            .lines()
            .count();
        wait_until(Duration::from_secs(60), || {
            let text = fs::read_to_string(out.join("series.csv")).unwrap_or_default();
            text.lines().count() > rows + 2 || resumed.try_wait().unwrap().is_some()
        });
        assert!(resumed.try_wait().unwrap().is_none(), "it did not resume");
        signal(resumed.id(), Signal::TERM);
        assert_eq!(end_of(&mut resumed).0, Some(75));
    }
}

/// The coordinator waits in shared memory for a gas that does not answer: the second Ctrl-C ends it at once.
#[test]
fn a_second_ctrl_c_ends_a_run_whose_solver_hangs() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let mut run = start_with(&out, &[]);
    let coordinator = run.id();
    wait_for_windows(&mut run, &out);
    let peers = descendants(coordinator);
    let solver = peers.iter().find(|&&pid| is_solver(pid)).unwrap();
    signal(*solver, Signal::STOP);
    std::thread::sleep(Duration::from_millis(300));
    signal(coordinator, Signal::INT);
    std::thread::sleep(Duration::from_millis(300));
    assert!(
        run.try_wait().unwrap().is_none(),
        "one Ctrl-C waits for the window"
    );
    signal(coordinator, Signal::INT);
    let (code, taken) = end_of(&mut run);
    println!("ended {taken:?} after the second Ctrl-C");
    assert_eq!(code, Some(130));
    assert!(taken < LIMIT, "{taken:?}");
    assert_clean(coordinator, &peers);
}
