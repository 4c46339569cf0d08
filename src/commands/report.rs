//! `calcine report DIR`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::console::say;
use super::failure::Failure;
use crate::exit;
use crate::results::ResultsError;

/// Writes a self-contained HTML report of a results folder.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The results folder.
    dir: PathBuf,
}

/// Writes the page with `write`.
pub(super) fn run(
    arguments: &Arguments,
    write: fn(&Path) -> Result<PathBuf, ResultsError>,
) -> Result<u8, Failure> {
    let page = write(&arguments.dir).map_err(|error| {
        let code = match error {
            ResultsError::NoResults { .. } => exit::CASE,
            _ => exit::OTHER,
        };
        Failure::told(code, &error)
    })?;
    say(page.display())?;
    Ok(exit::OK)
}
