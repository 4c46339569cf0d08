//! Why a simulation cannot be begun, or cannot go on.

use std::io;
use std::path::{Path, PathBuf};

use calcine_adapters::last_words;
use calcine_coupler::coordinator::{Ending, RunError};
use miette::Diagnostic;
use thiserror::Error;

use crate::assembly::AssemblyError;
use crate::case::CaseErrors;
use crate::exit;
use crate::results::{ResultsError, SUMMARY};
use crate::valid::InvalidCase;

/// Why a simulation cannot be begun, or cannot go on; the words are those that `calcine run` prints.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The case file is wrong; all its errors at once.
    #[error("{}", .0.render())]
    Case(CaseErrors),
    /// The case cannot be assembled, although its file is in order.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The results folder, or the results of another run, cannot be used.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A window failed; the last checkpoint stays.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Another run writes into the folder.
    #[error("another run is writing into {folder}: name another folder with `--out`")]
    Occupied {
        /// The results folder.
        folder: PathBuf,
    },
    /// A folder that holds something else than a run's results.
    #[error(
        "{folder} is not the results folder of a run, and holds {names}, which a run would write over: name another folder with `--out`, \
         or remove them"
    )]
    NotResults {
        /// The results folder.
        folder: PathBuf,
        /// What it holds.
        names: String,
    },
    /// The results folder cannot be made, or not be written.
    #[error("no results can be written to {folder} ({cause}): name another folder with `--out`")]
    UnusableFolder {
        /// The results folder.
        folder: PathBuf,
        /// Why.
        #[source]
        cause: io::Error,
    },
    /// There is nothing to resume.
    #[error(
        "there is no checkpoint in {folder}: {}", elsewhere(.folder)
    )]
    NoCheckpoint {
        /// The results folder.
        folder: PathBuf,
    },
    /// The checkpoint to resume from is of other solvers.
    #[error(
        "the run in {folder} has {found}, this command asks for {asked}, and the state of one solver is no start of \
         another: resume with `{words}`"
    )]
    OtherSolvers {
        /// The results folder.
        folder: PathBuf,
        /// Its solvers.
        found: String,
        /// Those asked for.
        asked: String,
        /// The words of the command line that ask for its solvers.
        words: String,
    },
    /// The results to continue from are of another gas solver.
    #[error(
        "--from {folder}: the results are of the gas backend `{found}`, this run has `{asked}`, and a gas of the \
         user's own goes on from its own state only: run both with `--gas {found}`"
    )]
    OtherGas {
        /// The folder to continue from.
        folder: PathBuf,
        /// Its gas backend.
        found: String,
        /// This run's.
        asked: String,
    },
    /// The results to continue from hold no checkpoint.
    #[error(
        "--from {folder}: there is no checkpoint in it; a run leaves one at its end, on Ctrl-C and as often as \
         `time.checkpoint` says"
    )]
    NoOrigin {
        /// The folder to continue from.
        folder: PathBuf,
    },
    /// The checkpoint to continue from cannot be read.
    #[error("--from {folder}: {cause}")]
    Origin {
        /// The folder to continue from.
        folder: PathBuf,
        /// Why.
        #[source]
        cause: RunError,
    },
    /// A file or folder of the run.
    #[error("{path}: {cause}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        #[source]
        cause: io::Error,
    },
    /// The run has ended already.
    #[error("the run has ended ({}): open the case again, with `resume` to go on from a checkpoint", words(.0))]
    Over(Ending),
    /// An earlier step failed, so that the parts may stand in the middle of a window.
    #[error(
        "an earlier step failed: open the case again with `resume` to go on from the last checkpoint"
    )]
    Failed,
}

/// What helps against the failure of an external solver.
pub(crate) fn of_run(error: &RunError) -> Option<&'static str> {
    match error {
        RunError::Part(part) => last_words::remedy(part),
        RunError::Reacting { cause, .. } => of_run(cause),
        _ => None,
    }
}

/// What to do where a folder has no checkpoint.
fn elsewhere(folder: &Path) -> &'static str {
    match folder.join(SUMMARY).is_file() {
        true => {
            "it holds results of a run of this case, whose checkpoints are gone (`checkpoint`, `checkpoint.before`): copy them back, or \
             remove the folder and run without `--resume`"
        }
        false => "run without `--resume`, or name the folder with `--out`",
    }
}

fn words(ending: &Ending) -> String {
    match ending {
        Ending::Finished => "at the end of its time".into(),
        Ending::Checkpointed(path) => format!("with a checkpoint in {}", path.display()),
    }
}

impl From<CaseErrors> for SimulationError {
    fn from(errors: CaseErrors) -> Self {
        Self::Case(errors)
    }
}

impl From<InvalidCase> for SimulationError {
    fn from(error: InvalidCase) -> Self {
        match error {
            InvalidCase::File(errors) => Self::Case(errors),
            InvalidCase::Assembly(error) => Self::Assembly(error),
            InvalidCase::Results(error) => Self::Results(error),
        }
    }
}

impl SimulationError {
    /// The exit code with which `calcine run` ends, see [`crate::exit`].
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Assembly(AssemblyError::Run(error)) | Self::Run(error) => exit::of(error),
            Self::Assembly(AssemblyError::Part(_)) => exit::PEER,
            Self::Io { .. } | Self::Failed | Self::Over(_) => exit::OTHER,
            _ => exit::CASE,
        }
    }

    /// The error with its causes and what to do about it: the words that `calcine` prints.
    pub fn told(&self) -> String {
        let remedy = self.remedy().map(|help| format!("\n  help: {help}"));
        crate::error_chain::chain(self) + &remedy.unwrap_or_default()
    }

    /// What to do about it, where the message does not say so itself.
    pub fn remedy(&self) -> Option<String> {
        match self {
            Self::Results(error) => error.help().map(|help| help.to_string()),
            Self::Assembly(error) => error.remedy().map(str::to_owned),
            Self::Run(error) => of_run(error).map(str::to_owned),
            _ => None,
        }
    }
}
