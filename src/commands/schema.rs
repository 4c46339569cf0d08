//! `calcine schema`.

use std::path::PathBuf;

use clap::Args;

use super::console::say;
use super::failure::Failure;
use crate::case::schema::schema;
use crate::exit;
use crate::laws::LawCatalogue;

/// Prints the JSON schema of case files, for completion and checks in editors.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Writes the schema to this file instead.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let text = text();
    let Some(file) = &arguments.out else {
        say(text.trim_end())?;
        return Ok(exit::OK);
    };
    std::fs::write(file, text).map_err(|cause| Failure::unwritable(file, "--out", &cause))?;
    say(format_args!(
        "{}: name it in the first line of a case file, as\n  #:schema {0}",
        file.display()
    ))?;
    Ok(exit::OK)
}

/// The schema as it stands in a file.
pub(super) fn text() -> String {
    format!("{:#}\n", schema(&LawCatalogue::default()))
}
