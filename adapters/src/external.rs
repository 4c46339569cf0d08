//! A gas solver that is not ours: any program that speaks the wire's C ABI (docs/attach-a-solver.md).
//!
//! Calcine writes no inputs for it beyond what it may use: in the folder in which it runs lie the case as TOML and the
//! mesh as a polyMesh. Its cells are compared with the mesh's one by one, as there is no hash to compare.

use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::{Mesh, polymesh};
use calcine_coupler::setup::GasSetup;
use calcine_coupler::supervisor::Supervisor;
use calcine_wire::hello::{NEW, NOT_COMPARED};
use calcine_wire::{Catalogue, Hello};

use crate::gas::LinkedGas;
use crate::launch::{Launcher, Program};
use crate::solver::{ExternalSolver, Launch};

/// Name in messages.
const NAME: &str = "external gas";
/// The variable with the folder of the checkpoint that the same run goes on from.
pub const RESUME_VARIABLE: &str = "CALCINE_RESUME";
/// The variable with the folder of another run's checkpoint to continue from.
pub const FROM_VARIABLE: &str = "CALCINE_FROM";

/// What an external gas is started with.
#[derive(Clone, Debug)]
pub struct ExternalGasLaunch<'a> {
    /// The gas as the case has it.
    pub setup: &'a GasSetup,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The solver's program.
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// The case's effective TOML.
    pub case: &'a str,
    /// Where the solver runs.
    pub folder: PathBuf,
    /// Where its output goes.
    pub log: PathBuf,
    /// Number of ranks.
    pub ranks: u32,
    /// Who starts them.
    pub launcher: Launcher,
    /// The gas' folder of the checkpoint to start from.
    pub resume: Option<PathBuf>,
    /// The gas' folder of another run's checkpoint to continue from.
    pub from: Option<PathBuf>,
    /// Longest silence while starting, writing a checkpoint or ending.
    pub deadline: Duration,
}

impl ExternalGasLaunch<'_> {
    /// Writes the folder, starts the solver and takes over the state it starts from.
    pub fn launch(self, supervisor: &mut Supervisor) -> Result<LinkedGas, PartError> {
        self.write_folder()?;
        let mut environment: Vec<(OsString, OsString)> = Vec::new();
        let mut origin = NEW.to_owned();
        for (name, folder) in [(RESUME_VARIABLE, &self.resume), (FROM_VARIABLE, &self.from)] {
            let Some(folder) = folder else { continue };
            let absolute = std::path::absolute(folder).map_err(|error| {
                let message = format!("the checkpoint {} cannot be used", folder.display());
                PartError::new(NAME, FailureKind::Io, message).caused_by(error)
            })?;
            origin = absolute.to_string_lossy().into_owned();
            environment.push((name.into(), absolute.into()));
        }
        let species = self.setup.properties.species().len();
        let turbulent = !self.setup.turbulence.is_laminar();
        let hello = Hello {
            role: "gas".into(),
            name: "Calcine".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            case_hash: NOT_COMPARED.into(),
            mesh_hash: NOT_COMPARED.into(),
            origin,
            count: self.mesh.cells() as u64,
            ranks: self.ranks,
            catalogue: Catalogue::gas(species, turbulent).with_geometry(),
        };
        let solver = ExternalSolver::launch(
            Launch {
                name: NAME.into(),
                program: Program {
                    path: self.program,
                    arguments: self.arguments.into_iter().map(OsString::from).collect(),
                    directory: self.folder,
                    environment,
                },
                launcher: self.launcher,
                log: self.log,
                hello,
                cells: Some(Arc::clone(&self.mesh)),
                handshake: self.deadline,
                deadline: self.deadline,
            },
            supervisor,
        )?;
        LinkedGas::new(solver, self.setup, self.mesh, true)
    }

    /// The folder in which the solver runs, with what it may use of the case.
    fn write_folder(&self) -> Result<(), PartError> {
        let failed = |error: Box<dyn std::error::Error + Send + Sync>| {
            let message = format!("the folder {} cannot be written", self.folder.display());
            let mut failure = PartError::new(NAME, FailureKind::Io, message);
            failure.cause = Some(error);
            failure
        };
        polymesh::write(&self.mesh, &self.folder.join("constant/polyMesh"))
            .map_err(|error| failed(error.into()))?;
        fs::write(self.folder.join("case.toml"), self.case).map_err(|error| failed(error.into()))
    }
}
