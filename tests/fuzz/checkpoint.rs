//! Checkpoints: no bytes in them make a resumed run panic, hang or ask for memory beyond measure; what is not what was written is noticed
//! by its hash, and what has right hashes around wrong contents is refused or goes on.

use std::fs;
use std::path::{Path, PathBuf};

use calcine::simulation::Simulation;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

use crate::mutate::mutate;
use crate::random::Random;
use crate::{Files, Target, scratch};

/// Cases with their changes: a frozen bed, and one that moves and touches walls.
const CASES: [(&str, &[&str]); 2] = [
    ("cases/heated-column.toml", &["time.end=1 s"]),
    (
        "tests/inputs/good/springs-and-gates.toml",
        &["time.end=20 ms"],
    ),
];
/// Windows before the checkpoint that stays, and before the last.
const WINDOWS: [usize; 2] = [2, 4];
/// Names of the hashes of a checkpoint's files, and of the folder that is mutated.
const SUMS: &str = "SHA256SUMS";
const LAST: &str = "checkpoint";
/// Bytes of the checksum at the end of a state file.
const CHECKSUM: usize = 32;

/// The folder of a stopped run, all its files by their paths.
struct Stopped {
    case: PathBuf,
    set: &'static [&'static str],
    files: Files,
}

pub struct Checkpoints {
    runs: Vec<Stopped>,
    folder: TempDir,
}

impl Checkpoints {
    pub fn new() -> Self {
        let folder = scratch();
        let runs = CASES
            .into_iter()
            .map(|(case, set)| {
                let case = Path::new(env!("CARGO_MANIFEST_DIR")).join(case);
                let out = folder.path().join("made");
                let mut run = open(&case, set, &out).start().unwrap();
                for windows in WINDOWS {
                    while run.windows() < windows as u64 {
                        assert_eq!(run.step().unwrap(), None);
                    }
                    run.checkpoint().unwrap();
                }
                run.stop().unwrap();
                drop(run);
                let mut files = Vec::new();
                gather(&out, &out, &mut files);
                fs::remove_dir_all(&out).unwrap();
                Stopped { case, set, files }
            })
            .collect();
        Self { runs, folder }
    }
}

fn open(case: &Path, set: &[&str], out: &Path) -> calcine::simulation::SimulationBuilder {
    let builder = Simulation::open(case).out(out);
    set.iter().fold(builder, |builder, one| builder.set(*one))
}

/// All files below a folder.
fn gather(root: &Path, folder: &Path, files: &mut Files) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            gather(root, &path, files);
        } else {
            let name = path.strip_prefix(root).unwrap();
            let bytes = fs::read(&path).unwrap();
            files.push((name.to_string_lossy().into_owned(), bytes));
        }
    }
    files.sort();
}

/// What a file of a checkpoint is called in its list of hashes.
fn listed(name: &str) -> &str {
    name.split_once('/').map_or(name, |(_, rest)| rest)
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

impl Target for Checkpoints {
    /// The number of the run, one file of its last checkpoint, and with right hashes the list of them.
    fn input(&self, random: &mut Random) -> Files {
        let number = random.below(self.runs.len());
        let run = &self.runs[number];
        let last: Vec<&(String, Vec<u8>)> = run
            .files
            .iter()
            .filter(|(name, _)| name.split('/').next() == Some(LAST))
            .collect();
        let (name, bytes) = *random.one(&last);
        let mut bytes = bytes.clone();
        let others: Vec<&[u8]> = last.iter().map(|(_, bytes)| &bytes[..]).collect();
        let forged = random.once_in(2) && !name.ends_with(SUMS);
        let state = name.ends_with(".state");
        if forged && state {
            bytes.truncate(bytes.len() - CHECKSUM);
        }
        for _ in 0..=random.below(2) * random.below(4) {
            match random.once_in(3) {
                true => number_of_eight(&mut bytes, random),
                false => mutate(&mut bytes, random, &others),
            }
        }
        if forged && state {
            let checksum = Sha256::digest(&bytes);
            bytes.extend(checksum);
        }
        let mut files = vec![("run".to_owned(), vec![number as u8])];
        if forged {
            let sums = last.iter().find(|(name, _)| name.ends_with(SUMS)).unwrap();
            let text = String::from_utf8_lossy(&sums.1).into_owned();
            let lines = text.lines().map(|line| match line.split_once("  ") {
                Some((_, of)) if of == listed(name) => format!("{}  {of}\n", hex(&bytes)),
                _ => format!("{line}\n"),
            });
            files.push((format!("{LAST}/{SUMS}"), lines.collect::<String>().into()));
        }
        files.push((name.clone(), bytes));
        files
    }

    fn execute(&mut self, files: &Files) -> bool {
        let run = &self.runs[usize::from(files[0].1[0])];
        let out = self.folder.path().join("out");
        let _ = fs::remove_dir_all(&out);
        // A list of hashes may say the same in other words.
        let is_content = |name: &str| !name.ends_with(SUMS);
        let mut mutated = files[1..].iter();
        let changed = mutated.any(|file| is_content(&file.0) && !run.files.contains(file));
        let forged = files.len() > 2;
        for (name, bytes) in run.files.iter().chain(&files[1..]) {
            let path = out.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        let begun = open(&run.case, run.set, &out).resume(true).start();
        let mut resumed = match begun {
            Ok(resumed) => resumed,
            Err(error) => {
                assert!(!error.to_string().is_empty());
                return false;
            }
        };
        if changed && !forged {
            assert!(!resumed.notes().is_empty(), "damage was not noticed");
        }
        // A forged state may be of anything, and is not computed with.
        if !forged {
            assert!(resumed.finish().is_ok());
        }
        true
    }
}

/// Changes eight bytes to a number that readers stumble over.
fn number_of_eight(bytes: &mut [u8], random: &mut Random) {
    const NUMBERS: [u64; 9] = [
        0,
        1,
        u64::MAX,
        1 << 31,
        1 << 32,
        1 << 61,
        0x7ff8_0000_0000_0000,
        0x7ff0_0000_0000_0000,
        0xfe37_e43c_8800_759c,
    ];
    let at = random.below(bytes.len().saturating_sub(8)) & !3;
    if let Some(place) = bytes.get_mut(at..at + 8) {
        place.copy_from_slice(&random.one(&NUMBERS).to_le_bytes());
    }
}
