//! Solvers that are not ours: any program that speaks the wire's C ABI (docs/attach-a-solver.md).
//!
//! Calcine writes no inputs for one beyond what it may use. In the folder in which a gas runs lie the case as TOML and the
//! mesh as a polyMesh; its cells are compared with the mesh's one by one, as there is no hash to compare. In that of
//! particles lie the case and the particles as a table; what they are at the start is compared one by one.

use std::ffi::OsString;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::{Mesh, polymesh};
use calcine_coupler::motion::Motion;
use calcine_coupler::part::Particles;
use calcine_coupler::setup::{GasSetup, ParticleSetup};
use calcine_coupler::supervisor::Supervisor;
use calcine_wire::hello::{NEW, NOT_COMPARED};
use calcine_wire::{Catalogue, Field, Hello};

use crate::checkpoint::absolute;
use crate::gas::LinkedGas;
use crate::launch::{Launcher, Program};
use crate::particles::{self, LinkedParticles};
use crate::solver::{ExternalSolver, Launch};

/// Names in messages.
const NAME: &str = "external gas";
const PARTICLES: &str = "external particles";
/// The variable with the folder of the checkpoint that the same run goes on from.
pub const RESUME_VARIABLE: &str = "CALCINE_RESUME";
/// The variable with the folder of another run's checkpoint to continue from.
pub const FROM_VARIABLE: &str = "CALCINE_FROM";

/// A program to attach.
#[derive(Clone, Debug)]
pub struct AttachedProgram {
    /// Its path.
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// Where it runs.
    pub folder: PathBuf,
    /// Where its output goes.
    pub log: PathBuf,
    /// Number of ranks.
    pub ranks: u32,
    /// Who starts them.
    pub launcher: Launcher,
    /// Its folder of the checkpoint to start from.
    pub resume: Option<PathBuf>,
    /// Its folder of another run's checkpoint to continue from.
    pub from: Option<PathBuf>,
    /// Longest silence while starting, writing a checkpoint or ending.
    pub deadline: Duration,
}

/// What a program must agree to.
struct Terms {
    name: &'static str,
    role: &'static str,
    /// Number of its cells or particles.
    count: u64,
    catalogue: Catalogue,
    /// Columns that it may have beside those.
    optional: Vec<Field>,
    cells: Option<Arc<Mesh>>,
}

impl AttachedProgram {
    /// Starts it in its folder, which is written.
    fn start(self, terms: Terms, supervisor: &mut Supervisor) -> Result<ExternalSolver, PartError> {
        let mut environment: Vec<(OsString, OsString)> = Vec::new();
        let mut origin = NEW.to_owned();
        for (name, folder) in [(RESUME_VARIABLE, &self.resume), (FROM_VARIABLE, &self.from)] {
            let Some(folder) = folder else { continue };
            let absolute = absolute(terms.name, folder)?;
            origin = absolute.to_string_lossy().into_owned();
            environment.push((name.into(), absolute.into()));
        }
        let hello = Hello {
            role: terms.role.into(),
            name: "Calcine".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            case_hash: NOT_COMPARED.into(),
            mesh_hash: NOT_COMPARED.into(),
            origin,
            count: terms.count,
            ranks: self.ranks,
            catalogue: terms.catalogue,
        };
        ExternalSolver::launch(
            Launch {
                name: terms.name.into(),
                program: Program {
                    path: self.program,
                    arguments: self.arguments.into_iter().map(OsString::from).collect(),
                    directory: self.folder,
                    environment,
                },
                launcher: self.launcher,
                log: self.log,
                hello,
                optional: terms.optional,
                cells: terms.cells,
                handshake: self.deadline,
                deadline: self.deadline,
            },
            supervisor,
        )
    }
}

/// What an external gas is started with.
#[derive(Clone, Debug)]
pub struct ExternalGasLaunch<'a> {
    /// The gas as the case has it.
    pub setup: &'a GasSetup,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The case's effective TOML.
    pub case: &'a str,
    /// The solver.
    pub solver: AttachedProgram,
}

impl ExternalGasLaunch<'_> {
    /// Writes the folder, starts the solver and takes over the state it starts from.
    pub fn launch(self, supervisor: &mut Supervisor) -> Result<LinkedGas, PartError> {
        self.write_folder()?;
        let species = self.setup.properties.species().len();
        let turbulent = !self.setup.turbulence.is_laminar();
        let mut catalogue = Catalogue::gas(species, turbulent).with_geometry();
        if self.setup.turbulence.is_in_bed() {
            catalogue = catalogue.with_bed_eddies();
        }
        let mut optional = Catalogue::patch_report(species, self.mesh.patches().len());
        if turbulent {
            optional.extend(Catalogue::turbulence_report());
        }
        let terms = Terms {
            name: NAME,
            role: "gas",
            count: self.mesh.cells() as u64,
            catalogue,
            optional,
            cells: Some(Arc::clone(&self.mesh)),
        };
        let solver = self.solver.start(terms, supervisor)?;
        LinkedGas::new(solver, self.setup, self.mesh, true)
    }

    /// The folder in which the solver runs, with what it may use of the case.
    fn write_folder(&self) -> Result<(), PartError> {
        let folder = &self.solver.folder;
        polymesh::write(&self.mesh, &folder.join("constant/polyMesh"))
            .map_err(|error| unwritten(NAME, folder, error))?;
        fs::write(folder.join("case.toml"), self.case)
            .map_err(|error| unwritten(NAME, folder, error))
    }
}

fn unwritten(
    name: &str,
    folder: &Path,
    error: impl std::error::Error + Send + Sync + 'static,
) -> PartError {
    let message = format!("the folder {} cannot be written", folder.display());
    PartError::new(name, FailureKind::Io, message).caused_by(error)
}

/// What external particles are started with.
#[derive(Clone, Debug)]
pub struct ExternalParticlesLaunch<'a> {
    /// The particles as the case has them.
    pub setup: &'a ParticleSetup,
    /// The case's effective TOML; `None` where there is no case.
    pub case: Option<&'a str>,
    /// The solver.
    pub solver: AttachedProgram,
}

impl ExternalParticlesLaunch<'_> {
    /// Writes the folder, starts the solver and takes over the particles it starts from, which must be those of the
    /// case where no checkpoint is taken up.
    pub fn launch(self, supervisor: &mut Supervisor) -> Result<LinkedParticles, PartError> {
        if matches!(self.setup.motion, Motion::Parcels(_)) {
            return Err(PartError::new(
                PARTICLES,
                FailureKind::NotStarted,
                "the particles are parcels, which programs of their own are not told to move; move them natively \
                 (`--particles native`) or by OpenFOAM (`--particles openfoam`)",
            ));
        }
        self.write_folder()?;
        let resume = self.solver.resume.as_deref();
        let (ids, radii) = particles::identity(PARTICLES, self.setup, resume)?;
        let terms = Terms {
            name: PARTICLES,
            role: "particles",
            count: ids.len() as u64,
            catalogue: Catalogue::particles(&[]),
            optional: [Catalogue::moving_drag(), Catalogue::weights()].concat(),
            cells: None,
        };
        let (setup, anew) = (self.setup, resume.is_none());
        let solver = self.solver.start(terms, supervisor)?;
        let particles = LinkedParticles::new(PARTICLES, solver, setup, u64::MAX)?;
        let fields = particles.fields();
        let refuse = |message: String| {
            let kind = FailureKind::NotStarted;
            Err(PartError::new(PARTICLES, kind, message))
        };
        if let Some(message) = particles::other_than(&particles, &ids, &radii) {
            return refuse(format!(
                "{message}; take ids and radii as `particles.csv` or the checkpoint has them"
            ));
        }
        let mut rows = 0..if anew { ids.len() } else { 0 };
        if let Some(row) = rows.find(|&row| fields.weight_of(row) != setup.weight_of(row)) {
            return refuse(format!(
                "its particle {} stands for {}, in the case for {}; take weights as `particles.csv` has them",
                ids[row],
                fields.weight_of(row),
                setup.weight_of(row)
            ));
        }
        Ok(particles)
    }

    /// The folder in which the solver runs, with what it may use of the case: particles in ascending id, in SI, with
    /// every digit.
    fn write_folder(&self) -> Result<(), PartError> {
        let (setup, folder) = (self.setup, &self.solver.folder);
        let mut table = String::from("id,population,held,x,y,z,vx,vy,vz,radius,density,weight\n");
        for row in 0..setup.id.len() {
            let population = setup.population[row];
            let held = match &setup.motion {
                Motion::Frozen => true,
                Motion::Free(contacts) => contacts.held.get(population as usize) == Some(&true),
                Motion::Parcels(_) => false,
            };
            let _ = write!(table, "{},{population},{}", setup.id[row], u8::from(held));
            let velocity = setup.velocity.get(row).copied().unwrap_or_default();
            let vectors = [setup.position[row], velocity];
            let values = vectors.iter().flat_map(|vector| vector.iter());
            let weight = setup.weight_of(row);
            for value in values.chain([&setup.radius[row], &setup.density[row], &weight]) {
                let _ = write!(table, ",{value:e}");
            }
            table.push('\n');
        }
        let write = || {
            fs::create_dir_all(folder)?;
            fs::write(folder.join("particles.csv"), table)?;
            match self.case {
                Some(case) => fs::write(folder.join("case.toml"), case),
                None => Ok(()),
            }
        };
        write().map_err(|error| unwritten(PARTICLES, folder, error))
    }
}
