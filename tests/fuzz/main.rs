//! Fuzzing of what reads users' files: `cargo xtask fuzz --minutes 10 case`, and five seconds of
//! each target in `cargo test`.
//!
//! A worker mutates files of a corpus, an input for each number from a fixed seed on, and executes
//! them with 2 GiB of address space. The parent sees whether it dies (an abort, an overflow of the
//! stack, memory) or stands still. A finding is saved with its files, named by seed and number;
//! `cargo test --test fuzz -- --replay FOLDER` executes it again.

#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

mod attached;
mod case;
#[cfg(feature = "hdf5")]
mod checkpoint;
mod curves;
mod foam;
mod mutate;
mod parent;
mod polymesh;
mod random;
mod set;
mod worker;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use random::Random;
use tempfile::TempDir;

/// An input: files by name.
type Files = Vec<(String, Vec<u8>)>;

/// What is fuzzed.
trait Target {
    /// Makes an input.
    fn input(&self, random: &mut Random) -> Files;
    /// Executes it; whether it was accepted. Panics are findings.
    fn execute(&mut self, files: &Files) -> bool;
}

/// Names of the targets.
const TARGETS: &[&str] = &[
    "case",
    "polymesh",
    "stl",
    "csv",
    "curves",
    "vtk",
    "foam",
    "set",
    #[cfg(feature = "hdf5")]
    "checkpoint",
];

fn target(name: &str) -> Box<dyn Target> {
    match name {
        "case" => Box::new(case::CaseFiles::new()),
        "curves" => Box::new(curves::Curves::new()),
        "foam" => Box::new(foam::Templates::new()),
        "set" => Box::new(set::Assignments::new()),
        "stl" | "csv" | "vtk" => Box::new(attached::AttachedFiles::new(name)),
        #[cfg(feature = "hdf5")]
        "checkpoint" => Box::new(checkpoint::Checkpoints::new()),
        _ => Box::new(polymesh::PolyMeshes::new()),
    }
}

/// A folder for the files of inputs, in memory where there is such a place.
fn scratch() -> TempDir {
    let memory = Path::new("/dev/shm");
    let folder = match memory.is_dir() {
        true => tempfile::tempdir_in(memory),
        false => tempfile::tempdir(),
    };
    folder.unwrap()
}

/// Executes a finding again, in this process, so that a backtrace can be seen. The folder's
/// parent names the target.
fn replay(folder: &Path) -> ExitCode {
    let name = folder.parent().and_then(Path::file_name).unwrap();
    let read = |path: PathBuf| {
        let file = path
            .file_name()
            .unwrap()
            .to_string_lossy()
            .replace('%', "/");
        (file, fs::read(&path).unwrap())
    };
    let entries = fs::read_dir(folder).unwrap();
    let files = entries.map(|entry| read(entry.unwrap().path())).collect();
    let accepted = target(&name.to_string_lossy()).execute(&files);
    println!("{}", if accepted { "accepted" } else { "refused" });
    ExitCode::SUCCESS
}

/// The seed, unless another is given: the day of the first run.
const SEED: u64 = 20_261_121;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let value = |option: &str| {
        let at = words.iter().position(|word| word == option)?;
        words.get(at + 1).map(String::as_str)
    };
    if words.first().is_some_and(|word| word == "--worker") {
        return worker::run(&words[1..]);
    }
    if let Some(folder) = value("--replay") {
        return replay(Path::new(folder));
    }
    // What `cargo test` hands to every test program: a list, filters.
    if words.iter().any(|word| word == "--list") {
        return ExitCode::SUCCESS;
    }
    let minutes = value("--minutes").and_then(|text| text.parse::<f64>().ok());
    let seed = value("--seed").and_then(|text| text.parse().ok());
    let named: Vec<&str> = TARGETS
        .iter()
        .copied()
        .filter(|name| words.iter().any(|word| word == name))
        .collect();
    let mut filters = words
        .iter()
        .filter(|word| !word.starts_with('-'))
        .peekable();
    let meant = filters.peek().is_none() || filters.any(|word| "fuzz".contains(&**word));
    if minutes.is_none() && named.is_empty() && !meant {
        return ExitCode::SUCCESS;
    }
    let time = minutes.map_or(Duration::from_secs(5), |minutes| {
        Duration::from_secs_f64(60.0 * minutes)
    });
    let chosen = if named.is_empty() { TARGETS } else { &named };
    let findings: usize = chosen
        .iter()
        .map(|name| parent::run(name, seed.unwrap_or(SEED), time))
        .sum();
    if findings == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
