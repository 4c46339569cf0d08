//! `calcine check CASE`.

use std::path::PathBuf;

use clap::Args;

use super::console::say;
use super::failure::Failure;
use super::parallel::crowded;
use crate::assembly::{GasBackend, Pairing, ParticleBackend, SolverStarts};
use crate::case::contacts;
use crate::exit;
use crate::progress::preparing;
use crate::valid::ValidCase;

/// Checks a case as a run would: prints all its errors at once, or its clocks, sizes, laws and what each backend honours.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The case file.
    pub(super) case: PathBuf,
    /// Whose gas is to run it.
    #[arg(long, value_enum, default_value_t)]
    gas: GasBackend,
    /// Whose particles are to run it.
    #[arg(long, value_enum, default_value_t)]
    particles: ParticleBackend,
    /// Changes a key of the case, for example `--set time.acceleration=200`.
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let mut valid = preparing(|| ValidCase::open(&arguments.case, &arguments.set))?;
    let pairing = Pairing {
        gas: arguments.gas,
        particles: arguments.particles,
    };
    valid.honoured_by(pairing)?;
    valid.warn_of(pairing);
    let starts = SolverStarts::of(&valid.case, pairing);
    valid.case.warnings.extend(crowded(&starts, pairing));
    say(valid.report())?;
    let ValidCase { case, prepared, .. } = &valid;
    if let Some(text) = contacts::report(case, &prepared.mesh, &prepared.particles) {
        say(text)?;
    }
    Ok(exit::OK)
}
