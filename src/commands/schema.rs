//! `calcine schema`.

use std::path::PathBuf;

use clap::Args;

use super::console::say;
use super::failure::Failure;
use super::inputs::own_or_new;
use crate::case::keys::{KINDS, kind_named, kind_names};
use crate::case::schema::schema;
use crate::exit;
use crate::laws::LawCatalogue;

/// Prints the JSON schema of case files, for completion and checks in editors.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Kind of case, the word of its key `kind`.
    #[arg(long, value_name = "KIND", default_value = "bed", value_parser = kind)]
    kind: Named,
    /// Writes the schema to this file instead.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// A kind that is named on the command line.
#[derive(Clone, Debug)]
struct Named(&'static str);

fn kind(name: &str) -> Result<Named, String> {
    let found = kind_named(name).map(|kind| Named(kind.name));
    found.ok_or_else(|| format!("it may be {}", kind_names().join(", ")))
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let text = text(arguments.kind.0);
    let Some(file) = &arguments.out else {
        say(text.trim_end())?;
        return Ok(exit::OK);
    };
    own_or_new(file, '{', "--out")?;
    std::fs::write(file, text).map_err(|cause| Failure::unwritable(file, "--out", &cause))?;
    say(format_args!(
        "{}: name it in the first line of a case file, as\n  #:schema {0}",
        file.display()
    ))?;
    Ok(exit::OK)
}

/// The schema of a kind of case as it stands in a file.
pub(super) fn text(kind: &str) -> String {
    let kind = kind_named(kind).unwrap_or(&KINDS[0]);
    format!("{:#}\n", schema(kind, &LawCatalogue::default()))
}
