//! Why a command fails, in words for the user.

use std::fmt;

use crate::assembly::AssemblyError;
use crate::exit;

/// Why a command failed: an exit code and what to tell the user.
#[derive(Debug)]
pub struct Failure {
    /// Exit code, see [`crate::exit`].
    pub code: u8,
    /// What to tell the user; ends up on standard error.
    pub message: String,
}

impl Failure {
    pub(super) fn new(code: u8, message: impl fmt::Display) -> Self {
        Self {
            code,
            message: message.to_string(),
        }
    }
}

impl From<AssemblyError> for Failure {
    fn from(error: AssemblyError) -> Self {
        let code = match &error {
            AssemblyError::Run(error) => exit::of(error),
            AssemblyError::Part(_) => exit::PEER,
            _ => exit::CASE,
        };
        Failure::new(code, chain(&error))
    }
}

/// An error with its causes, one a line.
pub(super) fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let line = error.to_string();
        if !text.contains(&line) {
            text.push_str("\n  because: ");
            text.push_str(&line);
        }
        cause = error.source();
    }
    text
}

/// An error with its causes and its remedy.
pub(super) fn with_help<E: std::error::Error + miette::Diagnostic>(error: &E) -> String {
    let remedy = error
        .help()
        .map(|help| format!("\n  help: {help}"))
        .unwrap_or_default();
    chain(error) + &remedy
}
