//! Parcels in Debian's OpenFOAM 1912: the program calcineParcelFoam, which moves them by OpenFOAM's MP-PIC cloud
//! (`basicKinematicMPPICCloud`) in a case that is generated here. Forces on parcels are Calcine's.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::Supervisor;
use calcine_wire::Hello;
use calcine_wire::hello::NEW;

pub use super::names::PARCEL_PROGRAM as PROGRAM;
use super::names::PARCELS as NAME;
use super::parcel_case::ParcelCase;
use super::{environment, identity, without_spaces};
use crate::checkpoint;
use crate::find::find_program;
use crate::launch::{Launcher, Program};
use crate::particles::{self, LinkedParticles};
use crate::solver::{ExternalSolver, Launch};

/// The variable that names another program.
pub const VARIABLE: &str = "CALCINE_PARCELFOAM";
/// The largest id, OpenFOAM's labels being signed integers of 32 bits.
const LARGEST_ID: u64 = i32::MAX as u64;

/// What OpenFOAM's parcels are started with.
#[derive(Clone, Debug)]
pub struct ParcelLaunch<'a> {
    /// The parcels.
    pub setup: &'a ParticleSetup,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// Whether drag comes by coefficient and gas velocity.
    pub moving_drag: bool,
    /// Hash of the case.
    pub case_hash: String,
    /// Where the OpenFOAM case is written and the program runs.
    pub folder: PathBuf,
    /// Where its output goes.
    pub log: PathBuf,
    /// Number of ranks: one.
    pub ranks: u32,
    /// Who starts it.
    pub launcher: Launcher,
    /// The particles' folder of the checkpoint to start from.
    pub resume: Option<PathBuf>,
    /// Longest silence while starting, writing a checkpoint or ending.
    pub deadline: Duration,
}

/// The program.
pub fn find() -> Result<PathBuf, PartError> {
    find_program(VARIABLE, PROGRAM)
}

impl ParcelLaunch<'_> {
    /// Writes the case, starts the program and takes over its parcels.
    pub fn launch(self, supervisor: &mut Supervisor) -> Result<LinkedParticles, PartError> {
        let launch = self;
        let case = ParcelCase {
            setup: launch.setup,
            mesh: &launch.mesh,
            moving_drag: launch.moving_drag,
            case_hash: &launch.case_hash,
            ranks: launch.ranks,
        };
        case.check()?;
        let path = find()?;
        without_spaces(NAME, &launch.folder)?;
        case.write(&launch.folder)?;
        let mut arguments: Vec<OsString> = Vec::new();
        let mut origin = NEW.to_owned();
        if let Some(folder) = &launch.resume {
            without_spaces(NAME, folder)?;
            let folder = checkpoint::absolute(NAME, folder)?;
            origin = folder.to_string_lossy().into_owned();
            arguments.extend(["-resume".into(), folder.into()]);
        }
        let (ids, radii) = particles::identity(NAME, launch.setup, launch.resume.as_deref())?;
        let hello = Hello {
            role: "particles".into(),
            name: "Calcine".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            mesh_hash: identity::mesh_hash(&launch.mesh),
            origin,
            count: ids.len() as u64,
            ranks: launch.ranks,
            catalogue: case.catalogue(),
            case_hash: launch.case_hash,
        };
        let program = Program {
            path,
            arguments,
            environment: environment(&launch.folder),
            directory: launch.folder,
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
        let parcels = LinkedParticles::new(NAME, solver, launch.setup, LARGEST_ID)?;
        match particles::other_than(&parcels, &ids, &radii) {
            Some(message) => Err(PartError::new(NAME, FailureKind::NotStarted, message)),
            None => Ok(parcels),
        }
    }
}
