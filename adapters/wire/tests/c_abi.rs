//! A solver in C++ against header and static library.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use calcine_wire::hello::NEW;
use calcine_wire::run::VARIABLE;
use calcine_wire::shared_memory::LinkEnd;
use calcine_wire::{
    Catalogue, Header, Hello, Link, LinkAddress, MessageKind, RunDirectory, SharedMemory,
    SolverFailure, TransportKind, WireError,
};

/// The directory of the test's own binaries' parent, where the static library lies.
fn target() -> PathBuf {
    let own = std::env::current_exe().unwrap();
    own.parent().unwrap().parent().unwrap().to_owned()
}

/// The static library as it is now: `cargo test` itself leaves an older one in place.
fn library() -> PathBuf {
    let status = Command::new(env!("CARGO"))
        .args([
            "build",
            "--quiet",
            "--lib",
            "-p",
            "calcine-wire",
            "--manifest-path",
        ])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"))
        .status()
        .unwrap();
    assert!(status.success());
    target().join("libcalcine_wire.a")
}

fn compile(name: &str) -> PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR"));
    let library = library();
    let program = target().join(name);
    let status = Command::new("g++")
        .args(["-std=c++14", "-Wall", "-Wextra", "-Werror", "-o"])
        .arg(&program)
        .arg(source.join("tests/cpp/solver.cpp"))
        .arg("-I")
        .arg(source.join("include"))
        .arg(library)
        .args(["-lgcc_s", "-lutil", "-lrt", "-lpthread", "-lm", "-ldl"])
        .status()
        .unwrap();
    assert!(status.success());
    program
}

fn hello() -> Hello {
    Hello {
        role: "gas".into(),
        name: "Calcine".into(),
        version: "0".into(),
        case_hash: "case".into(),
        mesh_hash: "mesh".into(),
        origin: NEW.into(),
        count: 3,
        ranks: 1,
        catalogue: Catalogue::standard("gas").unwrap(),
    }
}

struct Solver {
    child: Child,
    link: Link,
    _run: RunDirectory,
}

fn start(program: &Path, mesh: &str) -> Solver {
    let run = RunDirectory::create().unwrap();
    let address = run.address("gas");
    let (child, link) = join(program, mesh, &address);
    Solver {
        child,
        link,
        _run: run,
    }
}

fn join(program: &Path, mesh: &str, address: &LinkAddress) -> (Child, Link) {
    let transport = SharedMemory::open(address, 0, LinkEnd::Coordinator).unwrap();
    let link = Link::new(Box::new(transport), address.number(), 0);
    let child = Command::new(program)
        .arg(mesh)
        .env(VARIABLE, address.to_text())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    (child, link)
}

fn receive(link: &mut Link) -> Result<Header, WireError> {
    Ok(link
        .receive(Duration::from_secs(10))?
        .expect("an answer within 10 s"))
}

#[test]
fn a_solver_in_cpp_shakes_hands_answers_fails_and_ends() {
    let program = compile("wire-cpp-solver");
    let mut solver = start(&program, "mesh");
    let link = &mut solver.link;
    receive(link).unwrap();
    assert_eq!(link.answer_greeting(&hello()).unwrap().name, "test");
    assert_eq!(receive(link).unwrap().kind(), Some(MessageKind::State));
    assert_eq!(link.column("temperature").unwrap(), [1.0; 3]);
    assert_eq!(link.column("balances").unwrap().len(), 35);

    let begun = Instant::now();
    for window in 0..100u64 {
        let start = Header {
            window,
            span_motion: 7,
            ..Header::of(MessageKind::Start)
        };
        link.loan(start, 3).unwrap();
        for field in [
            "void_fraction",
            "drag_coefficient",
            "drag_source",
            "heat_coefficient",
        ] {
            link.column_mut(field).unwrap().fill(0.5);
        }
        let sources = link.column_mut("heat_source").unwrap();
        sources.copy_from_slice(&[0.0, 1.0, window as f64]);
        link.send().unwrap();
        let finished = receive(link).unwrap();
        assert_eq!(finished.kind(), Some(MessageKind::Finished));
        assert_eq!(finished.window, window);
        let heat = link.column("heat").unwrap();
        assert_eq!(heat, [2.0 * window as f64 + 7.0; 3]);
        assert_eq!(heat.as_ptr() as usize % 64, 0);
        link.send_plain(Header::of(MessageKind::Commit)).unwrap();
    }
    eprintln!("a window over the wire: {:?}", begun.elapsed() / 100);

    link.send_text(Header::of(MessageKind::Checkpoint), "/a/directory")
        .unwrap();
    let failure = receive(link).unwrap_err();
    assert_eq!(failure.to_string(), "/a/directory");
    let WireError::Failed { kind, .. } = failure else {
        panic!("{failure:?}");
    };
    assert_eq!(kind, SolverFailure::NotConverged);
    assert_eq!(solver.child.wait().unwrap().code(), Some(1));

    let mut solver = start(&program, "mesh");
    receive(&mut solver.link).unwrap();
    solver.link.answer_greeting(&hello()).unwrap();
    receive(&mut solver.link).unwrap();
    solver
        .link
        .send_plain(Header::of(MessageKind::Bye))
        .unwrap();
    assert_eq!(
        receive(&mut solver.link).unwrap().kind(),
        Some(MessageKind::Bye)
    );
    assert_eq!(solver.child.wait().unwrap().code(), Some(0));

    let mut solver = start(&program, "another");
    receive(&mut solver.link).unwrap();
    let error = solver.link.answer_greeting(&hello()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("mesh hash is mesh here, but another"),
        "{error}"
    );
    let output = solver.child.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(13), "{told}");
    assert!(told.contains("another"), "{told}");
}

/// Names in shared memory and scratch that begin with a run's.
fn files_of(name: &str) -> Vec<PathBuf> {
    let folders = [PathBuf::from("/dev/shm"), std::env::temp_dir()];
    let entries = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap().flatten());
    let paths = entries.map(|entry| entry.path());
    let own = |path: &PathBuf| {
        path.file_name()
            .unwrap()
            .to_string_lossy()
            .starts_with(name)
    };
    paths.filter(own).collect()
}

/// When a process started, in clock ticks since boot: the 20th word after its name.
fn started(pid: u32) -> u64 {
    let text = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    let words = text.rsplit_once(')').unwrap().1;
    words
        .split_ascii_whitespace()
        .nth(19)
        .unwrap()
        .parse()
        .unwrap()
}

/// A process that ends with the test, however the test ends.
struct Sleeper(Child);

impl Drop for Sleeper {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A solver whose coordinator, here a sleeping process, is killed; its log, and how long it lived on.
fn orphan(program: &Path, mesh: &str, greeted: bool) -> (String, Option<i32>, Duration) {
    let coordinator = Sleeper(Command::new("sleep").arg("600").spawn().unwrap());
    let pid = coordinator.0.id();
    let name = format!("calcine-{pid}-{:x}-0", started(pid));
    let root = std::env::temp_dir().join(&name);
    fs::create_dir(&root).unwrap();
    let address = LinkAddress {
        name: name.clone(),
        role: "gas".into(),
        root,
        means: TransportKind::SharedMemory,
    };
    let (mut child, mut link) = join(program, mesh, &address);
    receive(&mut link).unwrap();
    if greeted {
        link.answer_greeting(&hello()).unwrap();
        receive(&mut link).unwrap();
    }
    assert!(!files_of(&name).is_empty());
    drop(coordinator);
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > Duration::from_secs(20) {
            child.kill().unwrap();
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    let lived = begun.elapsed();
    assert_eq!(files_of(&name), Vec::<PathBuf>::new());
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        told.contains(&format!("coordinator (pid {pid}) died")),
        "{told}"
    );
    (told, output.status.code(), lived)
}

#[test]
fn a_solver_whose_coordinator_is_killed_says_so_removes_all_and_ends_within_a_second() {
    let program = compile("wire-cpp-orphan");
    let (_, code, lived) = orphan(&program, "mesh", true);
    assert_eq!(code, Some(12));
    assert!(lived < Duration::from_secs(1), "{lived:?}");
    // One that computes, and so does not look at its link, is ended by the watcher.
    let (_, code, lived) = orphan(&program, "busy", false);
    assert_eq!(code, None);
    assert!(lived < Duration::from_secs(1), "{lived:?}");
}
