//! `calcine prepare CASE`.

use std::path::PathBuf;

use clap::Args;

use super::console::say;
use super::failure::Failure;
use super::inputs::{read_and_prepare, results_folder};
use crate::assembly::{self, GasBackend, Pairing, ParticleBackend};
use crate::exit;

/// Writes the exact OpenFOAM and LIGGGHTS inputs of a run without running it.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The case file.
    case: PathBuf,
    /// Gas solver whose inputs are written.
    #[arg(long, value_enum, default_value_t = GasBackend::Openfoam)]
    gas: GasBackend,
    /// Particle solver whose inputs are written.
    #[arg(long, value_enum, default_value_t = ParticleBackend::Liggghts)]
    particles: ParticleBackend,
    /// Output folder [default: results/NAME-inputs].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Changes a key of the case, for example `--set time.acceleration=200`.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let (case, prepared) = read_and_prepare(&arguments.case, &arguments.set)?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = results_folder(&case, None).into_os_string();
        folder.push("-inputs");
        folder.into()
    });
    if out.is_dir() && std::fs::read_dir(&out).is_ok_and(|mut entries| entries.next().is_some()) {
        let message = format!(
            "{} is not empty: name another folder with `--out`",
            out.display()
        );
        return Err(Failure::new(exit::CASE, message));
    }
    let pairing = Pairing {
        gas: arguments.gas,
        particles: arguments.particles,
    };
    if !pairing.is_native() {
        std::fs::create_dir_all(&out)
            .map_err(|cause| Failure::unwritable(&out, "--out", &cause))?;
    }
    let written = assembly::write_inputs(&case, &prepared, pairing, &out)?;
    if written.is_empty() {
        say("native parts have no input files; name --gas openfoam or --particles liggghts")?;
    }
    for folder in written {
        say(folder.display())?;
    }
    Ok(exit::OK)
}
