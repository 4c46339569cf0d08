//! What to type to go on after an interrupt.

use std::path::Path;

use super::parallel;
use super::shell::word;
use crate::assembly::{Pairing, SolverStarts};

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
        if !self.pairing.is_native() {
            let (gas, particles) = (self.pairing.gas.name(), self.pairing.particles.name());
            line += &format!(" --gas {gas} --particles {particles}");
        }
        line += &parallel::flags(self.starts);
        for setting in self.set {
            line += &format!(" --set {}", word(setting.as_ref()));
        }
        if let Some(threads) = self.threads {
            line += &format!(" --threads {threads}");
        }
        for (option, given) in [("--strict", self.strict), ("--quiet", self.quiet)] {
            if given {
                line += &format!(" {option}");
            }
        }
        line
    }
}

/// What to do where a command of several runs was interrupted in one of them.
pub(super) fn begin_again(what: &str, out: &Path) -> String {
    format!(
        "the {what} is not complete and cannot be resumed: begin it again with another folder (`--out`), or remove {}",
        word(out.as_os_str())
    )
}
