//! `calcine check CASE`.

use std::path::PathBuf;

use clap::Args;

use crate::case::contacts;

use super::console::say;
use super::failure::{Failure, chain};
use super::inputs::read_and_prepare;
use crate::assembly::check_own_script;
use crate::exit;

/// Checks a case: all its errors at once, or both clocks, sizes and what each backend honours.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The case file.
    case: PathBuf,
    /// Changes a key of the case, for example `--set time.acceleration=200`.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let (case, prepared) = read_and_prepare(&arguments.case, &arguments.set)?;
    let particles = prepared.particles.id.len();
    let void_fraction = prepared.void_fraction(&case)?;
    say(crate::case::check_report(
        &case,
        &prepared.mesh,
        particles,
        void_fraction,
    ));
    if let Some(text) = contacts::report(&case, &prepared.mesh, &prepared.particles) {
        say(text);
    }
    if let Err(error) = check_own_script(&case, &prepared) {
        say(format_args!("    not with LIGGGHTS: {}", chain(&error)));
    }
    Ok(exit::OK)
}
