//! `calcine conform`.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::external::{AttachedProgram, ExternalGasLaunch, ExternalParticlesLaunch};
use calcine_adapters::launch::Launcher;
use calcine_adapters::liggghts::LiggghtsLaunch;
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_adapters::openfoam::OpenfoamLaunch;
use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::conformance::{LawOutcome, gas, particles};
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::part::{Gas, Particles};
use calcine_coupler::physics::Vec3;
use calcine_native::gas::{NativeError, NativeGas};
use calcine_native::particles::NativeParticles;
use clap::Args;

use super::console::say;
use super::failure::Failure;
use crate::assembly::{GasBackend, ParticleBackend};
use crate::exit;

/// The column of the laws of a gas as a case, for solvers that read `case.toml`.
const COLUMN: &str = include_str!("conform/column.toml");
/// Folder of the checkpoints in that of the command.
const CHECKPOINTS: &str = "checkpoints";
/// What the names of the folders of the solvers begin with.
const START: &str = "start-";
/// Longest silence of a solver while it starts, writes a checkpoint or ends.
const DEADLINE: Duration = Duration::from_secs(60);

/// Runs the laws that every gas, or all particles, must obey against a solver and says of each whether it holds.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A gas: a program that couples through Calcine's C ABI, or `native` or `openfoam`.
    #[arg(
        long,
        value_name = "PROGRAM",
        required_unless_present = "particles",
        conflicts_with = "particles"
    )]
    gas: Option<PathBuf>,
    /// Particles: a program that couples through Calcine's C ABI, or `native` or `liggghts`.
    #[arg(long, value_name = "PROGRAM")]
    particles: Option<PathBuf>,
    /// Ranks of the program, under `mpirun` where there are several.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    ranks: u16,
    /// What the balances of a gas may leave open, relative to their terms.
    #[arg(long, value_name = "SHARE", default_value_t = 1e-10)]
    closure: f64,
    /// How far heat and drag that a gas reports may be from what it was told at its new fields, relative.
    #[arg(long, value_name = "SHARE", default_value_t = 1e-9)]
    told: f64,
    /// Folder of the solver's inputs, logs and checkpoints.
    #[arg(long, value_name = "DIR", default_value = "results/conform")]
    out: PathBuf,
    /// Arguments of the program, after `--`.
    #[arg(last = true)]
    arguments: Vec<String>,
}

/// The folders of one solver after the other.
struct Folders<'a> {
    out: &'a Path,
    started: usize,
}

impl Folders<'_> {
    /// Folder and log of the solver that is started next.
    fn next(&mut self) -> (PathBuf, PathBuf) {
        self.started += 1;
        let name = format!("{START}{}", self.started);
        (
            self.out.join(&name),
            self.out.join("log").join(name + ".log"),
        )
    }
}

/// A name in the folder that is none of those that this command writes.
fn foreign(out: &Path) -> std::io::Result<Option<String>> {
    let entries = match fs::read_dir(out) {
        Err(cause) if cause.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        entries => entries?,
    };
    for entry in entries {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let own = ["log", CHECKPOINTS].contains(&name.as_str()) || name.starts_with(START);
        if !own {
            return Ok(Some(name));
        }
    }
    Ok(None)
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let unusable = |cause: std::io::Error| Failure::unwritable(&arguments.out, "--out", &cause);
    let out = std::path::absolute(&arguments.out).map_err(unusable)?;
    let foreign = foreign(&out).map_err(unusable)?;
    if let Some(name) = foreign {
        let message = format!(
            "{} holds {name}, which is not of this command: name another folder with `--out`",
            arguments.out.display()
        );
        return Err(Failure::new(exit::CASE, message));
    }
    let named = |path: &PathBuf, names: &[&str]| {
        let is_named = names.iter().any(|name| path.as_os_str() == *name);
        match is_named || path.is_file() {
            true => Ok(()),
            false => Err(Failure::new(
                exit::CASE,
                format_args!(
                    "{} is neither {} nor a program",
                    path.display(),
                    names.join(" nor ")
                ),
            )),
        }
    };
    match (&arguments.gas, &arguments.particles) {
        (Some(program), _) => {
            let names = [GasBackend::Native.name(), GasBackend::Openfoam.name()];
            named(program, &names)?;
        }
        (None, Some(program)) => {
            let names = [
                ParticleBackend::Native.name(),
                ParticleBackend::Liggghts.name(),
            ];
            named(program, &names)?;
        }
        (None, None) => {} // refused by the command line's reader
    }
    // What an earlier run has left is not to be mistaken for this one's.
    match fs::remove_dir_all(&out) {
        Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => return Err(unusable(cause)),
        _ => fs::create_dir_all(&out).map_err(unusable)?,
    }
    let outcomes = match (&arguments.gas, &arguments.particles) {
        (Some(program), _) => gases(arguments, program, &out)?,
        (None, Some(program)) => spheres(arguments, program, &out),
        (None, None) => Vec::new(),
    };
    for outcome in &outcomes {
        say(outcome)?;
    }
    let broken = outcomes.iter().filter(|outcome| !outcome.holds()).count();
    say(format_args!(
        "{} of {} laws hold; logs are in {}",
        outcomes.len() - broken,
        outcomes.len(),
        out.join("log").display()
    ))?;
    Ok(match broken {
        0 => exit::OK,
        _ => exit::OUTSIDE_BANDS,
    })
}

fn unmade(error: NativeError) -> PartError {
    PartError::new("native", FailureKind::NotStarted, error.to_string()).caused_by(error)
}

/// The laws of a gas.
fn gases(arguments: &Arguments, program: &Path, out: &Path) -> Result<Vec<LawOutcome>, Failure> {
    let mut folders = Folders { out, started: 0 };
    let outcomes = gas::run(&mut gas::GasUnderTest {
        make: &mut |setup, mesh, from, supervisor| {
            let (folder, log) = folders.next();
            let resume = from.map(Path::to_owned);
            let (ranks, launcher) = (u32::from(arguments.ranks), Launcher::Mpirun);
            let gas: Box<dyn Gas> = if program.as_os_str() == GasBackend::Native.name() {
                let mut gas = NativeGas::new(Arc::clone(mesh), setup).map_err(unmade)?;
                if let Some(folder) = from {
                    gas.restore(folder).map_err(unmade)?;
                }
                Box::new(gas)
            } else if program.as_os_str() == GasBackend::Openfoam.name() {
                let launch = OpenfoamLaunch {
                    setup,
                    mesh: Arc::clone(mesh),
                    template: None,
                    start: None,
                    gas: None,
                    solver: StockSolver::default(),
                    case_hash: "conform".into(),
                    folder,
                    log,
                    ranks,
                    launcher,
                    resume,
                    from: None,
                    deadline: DEADLINE,
                };
                Box::new(launch.launch(supervisor)?)
            } else {
                let launch = ExternalGasLaunch {
                    setup,
                    mesh: Arc::clone(mesh),
                    case: COLUMN,
                    solver: external(arguments, program, (folder, log), resume),
                };
                Box::new(launch.launch(supervisor)?)
            };
            Ok(gas)
        },
        scratch: &out.join(CHECKPOINTS),
        closure: arguments.closure,
        told: arguments.told,
    });
    outcomes.map_err(|error| Failure::new(exit::OTHER, error))
}

/// The laws of particles.
fn spheres(arguments: &Arguments, program: &Path, out: &Path) -> Vec<LawOutcome> {
    let mut folders = Folders { out, started: 0 };
    particles::run(&mut particles::ParticlesUnderTest {
        make: &mut |setup, from, supervisor| {
            let (folder, log) = folders.next();
            let resume = from.map(Path::to_owned);
            let (ranks, launcher) = (u32::from(arguments.ranks), Launcher::Mpirun);
            let made: Box<dyn Particles> = if program.as_os_str() == ParticleBackend::Native.name()
            {
                let mut made = NativeParticles::new(setup).map_err(unmade)?;
                if let Some(folder) = from {
                    made.restore(folder).map_err(unmade)?;
                }
                Box::new(made)
            } else if program.as_os_str() == ParticleBackend::Liggghts.name() {
                let launch = LiggghtsLaunch {
                    inputs: Inputs {
                        setup,
                        bounds: (Vec3::zeros(), Vec3::repeat(particles::BOX)),
                        step: particles::STEP,
                        ranks,
                        wall_impulse: true,
                        moving_drag: true,
                        template: None,
                    },
                    case_hash: "conform".into(),
                    launcher,
                    folder,
                    log,
                    resume,
                    deadline: DEADLINE,
                };
                Box::new(launch.launch(supervisor)?)
            } else {
                let launch = ExternalParticlesLaunch {
                    setup,
                    case: None,
                    solver: external(arguments, program, (folder, log), resume),
                };
                Box::new(launch.launch(supervisor)?)
            };
            Ok(made)
        },
        scratch: &out.join(CHECKPOINTS),
    })
}

/// A program to attach, by a path that holds in any folder, with its folder and log.
fn external(
    arguments: &Arguments,
    program: &Path,
    (folder, log): (PathBuf, PathBuf),
    resume: Option<PathBuf>,
) -> AttachedProgram {
    AttachedProgram {
        program: std::path::absolute(program).unwrap_or_else(|_| program.to_owned()),
        arguments: arguments.arguments.clone(),
        folder,
        log,
        ranks: u32::from(arguments.ranks),
        launcher: Launcher::Mpirun,
        resume,
        from: None,
        deadline: DEADLINE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valid::ValidCase;

    #[test]
    fn the_column_that_solvers_may_read_is_that_of_the_laws() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("column.toml");
        fs::write(&path, COLUMN).unwrap();
        let valid = ValidCase::open(&path, &[]).unwrap();
        let mesh = gas::mesh().unwrap();
        assert_eq!(valid.prepared.mesh.cell_volume(), mesh.cell_volume());
        assert_eq!(valid.prepared.mesh.cell_centre(), mesh.cell_centre());
        let (read, own) = (&valid.case.gas, gas::setup(&mesh));
        let text = |setup: &calcine_coupler::setup::GasSetup| {
            let mut setup = setup.clone();
            setup.patches.sort_by(|one, other| one.0.cmp(&other.0));
            format!("{setup:#?}")
        };
        assert_eq!(text(read), text(&own));
    }
}
