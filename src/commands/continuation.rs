//! What to type to go on after an interrupt.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::parallel;
use super::shell::word;
use crate::assembly::{Pairing, SolverStarts};
use crate::exit;
use crate::results::files;

/// What of a run's command line its continuation needs.
pub(super) struct Line<'a> {
    /// The case file.
    pub(super) case: &'a Path,
    /// The results folder.
    pub(super) out: &'a Path,
    /// Who computes what.
    pub(super) pairing: Pairing,
    /// How external solvers are started.
    pub(super) starts: &'a SolverStarts,
    /// Changes of the case, without which its hash is another.
    pub(super) set: &'a [String],
    /// Number of threads, where it was given.
    pub(super) threads: Option<u16>,
    /// Ends with an exit code of its own where there are warnings.
    pub(super) strict: bool,
    /// Shows no progress bar.
    pub(super) quiet: bool,
}

impl Line<'_> {
    /// The command that goes on from the checkpoint. `--from` is left out, since the checkpoint holds what was taken
    /// over, and `--stop-after`, which limits one stretch of a run.
    pub(super) fn resume(&self) -> String {
        let mut line = format!(
            "calcine run {} --out {} --resume",
            word(self.case.as_os_str()),
            word(self.out.as_os_str())
        );
        for option in self.options() {
            line += &format!(" {}", word(option.as_ref()));
        }
        line
    }

    /// What `--resume DIR` takes from the folder: the case, wherever it is looked at from, and the options. Nothing
    /// where the path of the case is not UTF-8.
    pub(super) fn recorded(&self) -> Option<Recorded> {
        let case = std::path::absolute(self.case).ok()?;
        Some(Recorded {
            case: case.to_str()?.to_owned(),
            options: self.options(),
        })
    }

    /// The options, word by word; of a key that is set twice the last value, which holds.
    fn options(&self) -> Vec<String> {
        let mut words = Vec::new();
        if !self.pairing.is_native() {
            let (gas, particles) = (self.pairing.gas.name(), self.pairing.particles.name());
            words.extend(["--gas", gas, "--particles", particles].map(str::to_owned));
        }
        words.extend(parallel::flags(self.starts));
        let key = |setting: &str| {
            setting
                .split_once('=')
                .map(|(key, _)| key.trim().to_owned())
        };
        for (place, setting) in self.set.iter().enumerate() {
            let mut later = self.set.iter().skip(place + 1);
            if !later.any(|other| key(other) == key(setting)) {
                words.extend(["--set".to_owned(), setting.clone()]);
            }
        }
        if let Some(threads) = self.threads {
            words.extend(["--threads".to_owned(), threads.to_string()]);
        }
        for (option, given) in [("--strict", self.strict), ("--quiet", self.quiet)] {
            words.extend(given.then(|| option.to_owned()));
        }
        words
    }
}

/// The command of a run, kept in its results folder.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub(super) struct Recorded {
    /// Absolute path of the case file.
    pub(super) case: String,
    /// Its options, word by word.
    pub(super) options: Vec<String>,
}

impl Recorded {
    /// Keeps it in a results folder.
    pub(super) fn write(&self, out: &Path) -> Result<(), Failure> {
        let written = files::replace_json(&out.join(files::COMMAND), self);
        written.map_err(|error| Failure::told(exit::OTHER, &error))
    }

    /// Its text in a results folder.
    pub(super) fn json(&self) -> Option<String> {
        files::json(Path::new(files::COMMAND), self).ok()
    }

    /// What was kept in a results folder.
    pub(super) fn read(out: &Path) -> Result<Self, Failure> {
        let path = out.join(files::COMMAND);
        let text = std::fs::read_to_string(&path).map_err(|cause| cause.to_string());
        let read = text.and_then(|text| {
            serde_json::from_str(&text)
                .map_err(|error| format!("it is no command of a run: {error}"))
        });
        read.map_err(|cause| {
            let message = format!(
                "{} cannot be read: {cause}\n  help: name the folder that a run wrote, or the case as well, as for a run from Python: calcine run CASE --out {} --resume",
                path.display(),
                word(out.as_os_str())
            );
            Failure::new(exit::CASE, message)
        })
    }

    /// An error where the case file is gone.
    pub(super) fn needs_case(&self, out: &Path) -> Result<(), Failure> {
        if Path::new(&self.case).exists() {
            return Ok(());
        }
        let folder = word(out.as_os_str());
        let message = format!(
            "{}, the case of the run in {}, is not there\n  help: name it where it is, `calcine run CASE --resume {folder}`, or put it \
             back: {} holds it as it was run (files that it names are found from where it stood)",
            self.case,
            out.display(),
            out.join(files::CASE).display()
        );
        Err(Failure::new(exit::CASE, message))
    }
}

/// What to do where a command of several runs was interrupted in one of them.
pub(super) fn begin_again(what: &str, out: &Path) -> String {
    format!(
        "the {what} is not complete and cannot be resumed: begin it again with another folder (`--out`), or remove {}",
        word(out.as_os_str())
    )
}
