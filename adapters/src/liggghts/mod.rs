//! Particles in Debian's LIGGGHTS, run as a library by the host `calcine-liggghts`.

mod facets;
pub mod inputs;
pub mod moving;
pub mod template;

use std::path::PathBuf;
use std::time::Duration;

use calcine_coupler::error::PartError;
use calcine_coupler::supervisor::Supervisor;
use calcine_wire::hello::{NEW, hash_text, particles_hash};
use calcine_wire::{Catalogue, Hello};

use crate::checkpoint;
use crate::find::find_program;
use crate::launch::{Launcher, Program};
use crate::liggghts::inputs::{Inputs, SCRIPT};
use crate::particles::{self, LinkedParticles};
use crate::solver::{ExternalSolver, Launch};

/// Name in messages.
const NAME: &str = "LIGGGHTS (particles)";
/// Name of the host's program.
pub const HOST: &str = "calcine-liggghts";
/// The variable that names another host program.
pub const HOST_VARIABLE: &str = "CALCINE_LIGGGHTS_HOST";
/// Name of the restart file in a checkpoint's folder, as the host writes it.
const RESTART: &str = "liggghts.restart";
/// The largest id, LIGGGHTS' tags being signed integers of 32 bits.
const LARGEST_ID: u64 = i32::MAX as u64;
/// Time step in s for a bed that is held: nothing happens within it.
pub const FROZEN_STEP: f64 = 1e-4;

/// What LIGGGHTS is started with.
#[derive(Clone, Debug)]
pub struct LiggghtsLaunch<'a> {
    /// Particles, box, step, ranks.
    pub inputs: Inputs<'a>,
    /// Hash of the case.
    pub case_hash: String,
    /// Who starts the ranks.
    pub launcher: Launcher,
    /// Where the inputs are written and the host runs.
    pub folder: PathBuf,
    /// Where the host's output goes.
    pub log: PathBuf,
    /// The particles' folder of the checkpoint to start from.
    pub resume: Option<PathBuf>,
    /// Longest silence while starting, writing a checkpoint or ending.
    pub deadline: Duration,
}

/// The host's program.
pub fn find() -> Result<PathBuf, PartError> {
    find_program(HOST_VARIABLE, HOST)
}

impl LiggghtsLaunch<'_> {
    /// Writes the inputs, starts the host and takes over its particles.
    pub fn launch(self, supervisor: &mut Supervisor) -> Result<LinkedParticles, PartError> {
        let launch = self;
        let host = find()?;
        launch.inputs.write(&launch.folder)?;
        let mut arguments = vec![SCRIPT.into(), launch.case_hash.clone().into()];
        let mut origin = NEW.to_owned();
        if let Some(folder) = &launch.resume {
            let file = checkpoint::absolute(NAME, &folder.join(RESTART))?;
            origin = file.to_string_lossy().into_owned();
            arguments.push(file.into());
        }
        let setup = launch.inputs.setup;
        let (ids, radii) = particles::identity(NAME, setup, launch.resume.as_deref())?;
        let hello = Hello {
            role: "particles".into(),
            name: "Calcine".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            case_hash: launch.case_hash,
            mesh_hash: hash_text(particles_hash(&ids, &radii)),
            origin,
            count: ids.len() as u64,
            ranks: launch.inputs.ranks,
            catalogue: Catalogue::particles_with(
                !setup.weight.is_empty(),
                launch.inputs.moving_drag,
            ),
        };
        let program = Program {
            path: host,
            arguments,
            directory: launch.folder,
            environment: Vec::new(),
        };
        let solver = ExternalSolver::launch(
            Launch::of_own(
                NAME,
                program,
                launch.launcher,
                launch.log,
                hello,
                launch.deadline,
            ),
            supervisor,
        )?;
        LinkedParticles::new(NAME, solver, setup, LARGEST_ID)
    }
}
