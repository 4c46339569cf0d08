//! Why a command fails, in words for the user.

use std::path::{Path, PathBuf};
use std::{fmt, io};

use miette::Diagnostic;

use crate::assembly::AssemblyError;
pub(super) use crate::error_chain::chain;
use crate::exit;
use crate::simulation::SimulationError;
use crate::valid::InvalidCase;

/// Why a command failed: an exit code and what to tell the user.
#[derive(Debug)]
pub struct Failure {
    /// Exit code, see [`crate::exit`].
    pub code: u8,
    /// What to tell the user; ends up on standard error.
    pub message: String,
    /// The results folder of the run that failed, where one had begun.
    pub out: Option<PathBuf>,
}

impl Failure {
    pub(super) fn new(code: u8, message: impl fmt::Display) -> Self {
        Self {
            code,
            message: message.to_string(),
            out: None,
        }
    }

    /// Of a run in this results folder.
    pub(super) fn of_run(self, out: &Path) -> Self {
        let out = Some(out.to_owned());
        Self { out, ..self }
    }
}

impl Failure {
    /// An error with its causes and what to do about it.
    pub(super) fn told(code: u8, error: &impl Diagnostic) -> Self {
        let help = error.help().map(|help| format!("\n  help: {help}"));
        Self::new(code, chain(error) + &help.unwrap_or_default())
    }

    /// A file or folder of the user's choice that cannot be written.
    pub(super) fn unwritable(path: &Path, option: &str, cause: &io::Error) -> Self {
        let path = path.display();
        let message = format!("{path} cannot be written ({cause}): name another with `{option}`");
        Self::new(exit::CASE, message)
    }
}

impl From<AssemblyError> for Failure {
    fn from(error: AssemblyError) -> Self {
        let code = match &error {
            AssemblyError::Run(error) => exit::of(error),
            AssemblyError::Part(_) => exit::PEER,
            _ => exit::CASE,
        };
        let remedy = error.remedy().map(|help| format!("\n  help: {help}"));
        Failure::new(code, chain(&error) + &remedy.unwrap_or_default())
    }
}

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        Failure::new(error.exit_code(), error.told())
    }
}

impl From<InvalidCase> for Failure {
    fn from(error: InvalidCase) -> Self {
        SimulationError::from(error).into()
    }
}
