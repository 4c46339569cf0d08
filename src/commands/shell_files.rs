//! `calcine completions` and `calcine man`: what shells and `man` read, made from the options themselves.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;

use super::console::say;
use super::failure::Failure;
use crate::exit;

/// Prints the completion of commands and options for a shell.
#[derive(Debug, Args)]
pub(super) struct Completions {
    /// Shell to complete for.
    #[arg(value_enum)]
    shell: Shell,
}

/// Writes the man pages of the program and of each command into a folder.
#[derive(Debug, Args)]
pub(super) struct Man {
    /// Folder, such as `/usr/local/share/man/man1`; it is made where it is missing.
    folder: PathBuf,
}

pub(super) fn complete(arguments: &Completions, mut command: Command) -> Result<u8, Failure> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "calcine", &mut text);
    say(String::from_utf8_lossy(&text).trim_end())?;
    Ok(exit::OK)
}

pub(super) fn man(arguments: &Man, command: Command) -> Result<u8, Failure> {
    let folder = &arguments.folder;
    let unwritable = |cause| Failure::unwritable(folder, "calcine man FOLDER", &cause);
    std::fs::create_dir_all(folder).map_err(unwritable)?;
    clap_mangen::generate_to(command, folder).map_err(unwritable)?;
    Ok(exit::OK)
}
