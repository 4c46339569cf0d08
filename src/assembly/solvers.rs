//! The solvers of a run: native ones made, external ones started, their inputs.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calcine_adapters::external::{AttachedProgram, ExternalGasLaunch, ExternalParticlesLaunch};
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_adapters::liggghts::template::ScriptTemplate;
use calcine_adapters::liggghts::{self, FROZEN_STEP, LiggghtsLaunch};
use calcine_adapters::openfoam::case::OpenfoamCase;
use calcine_adapters::openfoam::parcels::ParcelLaunch;
use calcine_adapters::openfoam::{self, LIBRARY, OpenfoamLaunch, ParcelCase};
use calcine_coupler::coordinator::RunError;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::held::HeldGas;
use calcine_coupler::motion::Motion;
use calcine_coupler::part::{Gas, Particles};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::GasStart;
use calcine_coupler::supervisor::Supervisor;
use calcine_native::gas::{NativeGas, match_patches};
use calcine_native::parcels::NativeParcels;
use calcine_native::particles::NativeParticles;

use super::error::AssemblyError;
use super::pairing::{GasBackend, Pairing, ParticleBackend};
use super::prepared::PreparedCase;
use super::settings::{RunSettings, SolverStart, SolverStarts};
use crate::case::model::{Case, ExternalProgram};

/// Writes the inputs of the external solvers of a pairing, as a run would, into `openfoam/` and
/// `liggghts/` below a folder; returns what was written.
pub fn write_inputs(
    case: &Case,
    prepared: &PreparedCase,
    pairing: Pairing,
    folder: &Path,
) -> Result<Vec<PathBuf>, AssemblyError> {
    let starts = SolverStarts::of(case, pairing);
    let mut written = Vec::new();
    if pairing.gas == GasBackend::Openfoam {
        let target = folder.join("openfoam");
        OpenfoamCase {
            setup: &case.gas,
            mesh: &prepared.mesh,
            template: case.openfoam.template.as_deref(),
            start: case.openfoam.start.as_deref(),
            gas: None,
            solver: case.openfoam.solver,
            library: Path::new(LIBRARY),
            case_hash: &case.hash,
            ranks: starts.gas.ranks,
        }
        .write(&target)?;
        written.push(target);
    }
    if pairing.particles_of(case) == ParticleBackend::Liggghts {
        let target = folder.join("liggghts");
        let template = own_script(case)?;
        let inputs = liggghts_inputs(case, prepared, template.as_ref(), starts.particles.ranks);
        inputs.write(&target)?;
        written.push(target);
    }
    if pairing.particles_of(case) == ParticleBackend::Openfoam {
        let target = folder.join("openfoam-parcels");
        parcel_case(case, prepared, starts.particles.ranks).write(&target)?;
        written.push(target);
    }
    Ok(written)
}

/// Refuses what the native solvers of a pairing would refuse at their start, patches that do not match, and an external gas that is
/// not named.
pub fn native_parts(
    case: &Case,
    prepared: &PreparedCase,
    pairing: Pairing,
) -> Result<(), AssemblyError> {
    if pairing.gas == GasBackend::Native && !case.gas_held {
        NativeGas::new(Arc::clone(&prepared.mesh), &case.gas)?;
    } else if pairing.gas == GasBackend::Openfoam && !case.gas_held {
        match_patches(&prepared.mesh, &case.gas)?;
    }
    if pairing.gas == GasBackend::External && case.external_gas.is_none() {
        return Err(AssemblyError::NoExternalGas);
    }
    if pairing.particles_of(case) == ParticleBackend::External && case.external_particles.is_none()
    {
        return Err(AssemblyError::NoExternalParticles);
    }
    if pairing.particles_of(case) == ParticleBackend::Native {
        match &prepared.particles.motion {
            Motion::Parcels(_) => {
                NativeParcels::new(Arc::clone(&prepared.mesh), &prepared.particles)?;
            }
            _ => drop(NativeParticles::new(&prepared.particles)?),
        }
    }
    Ok(())
}

/// The programs of the external solvers of a pairing; an error where one is not installed.
pub fn programs(case: &Case, pairing: Pairing) -> Result<Vec<PathBuf>, PartError> {
    let mut found = Vec::new();
    if pairing.gas == GasBackend::Openfoam && !case.gas_held {
        let (solver, own) = openfoam::find(case.openfoam.solver)?;
        found.extend([solver, own.with_file_name(LIBRARY)]);
    }
    if pairing.particles_of(case) == ParticleBackend::Liggghts {
        found.push(liggghts::find()?);
    }
    if pairing.particles_of(case) == ParticleBackend::Openfoam {
        found.push(openfoam::parcels::find()?);
    }
    Ok(found)
}

/// The user's own script of the particles, where the case names one.
fn own_script(case: &Case) -> Result<Option<ScriptTemplate>, PartError> {
    let Some(path) = &case.liggghts.template else {
        return Ok(None);
    };
    let populations = case.particles.iter().map(|one| one.name.clone()).collect();
    let materials = case.materials.iter().map(|one| one.name.clone()).collect();
    let read = ScriptTemplate::read(path, populations, materials);
    read.map(Some).map_err(|error| {
        let message = format!("the script {} cannot be used", path.display());
        PartError::new("LIGGGHTS (particles)", FailureKind::NotStarted, message).caused_by(error)
    })
}

/// What LIGGGHTS would not take of the case or of the user's own script, for `calcine check`.
pub fn check_for_liggghts(case: &Case, prepared: &PreparedCase) -> Result<(), PartError> {
    if case.particles.is_empty() {
        return Ok(());
    }
    let template = own_script(case)?;
    let inputs = liggghts_inputs(
        case,
        prepared,
        template.as_ref(),
        case.liggghts.ranks.max(1),
    );
    inputs.check()?;
    inputs.script().map(|_| ())
}

/// What OpenFOAM's cloud would not do of the case, for `calcine check`.
pub fn check_for_openfoam_parcels(case: &Case, prepared: &PreparedCase) -> Result<(), PartError> {
    parcel_case(case, prepared, 1).check()
}

/// What OpenFOAM's cloud is told of the parcels.
fn parcel_case<'a>(case: &'a Case, prepared: &'a PreparedCase, ranks: u32) -> ParcelCase<'a> {
    ParcelCase {
        setup: &prepared.particles,
        mesh: &prepared.mesh,
        moving_drag: case.coupling.window_drag.follows(),
        case_hash: &case.hash,
        ranks,
    }
}

/// What LIGGGHTS is told of the particles, in the box of the mesh's points.
fn liggghts_inputs<'a>(
    case: &Case,
    prepared: &'a PreparedCase,
    template: Option<&'a ScriptTemplate>,
    ranks: u32,
) -> Inputs<'a> {
    let points = &prepared.mesh.topology().points;
    let bounds = points.iter().fold(
        (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)),
        |(low, high), point| (low.inf(point), high.sup(point)),
    );
    Inputs {
        setup: &prepared.particles,
        bounds,
        step: match &prepared.particles.motion {
            Motion::Frozen | Motion::Parcels(_) => FROZEN_STEP,
            Motion::Free(contacts) => contacts.step,
        },
        ranks,
        wall_impulse: case.liggghts.wall_impulse,
        moving_drag: case.coupling.window_drag.follows(),
        template,
    }
}

/// What the builders of the parts share.
pub(super) struct Assembly<'a> {
    pub(super) case: &'a Case,
    pub(super) prepared: &'a PreparedCase,
    pub(super) settings: &'a RunSettings<'a>,
    pub(super) from: Option<&'a Path>,
}

impl Assembly<'_> {
    pub(super) fn gas(&self, supervisor: &mut Supervisor) -> Result<Box<dyn Gas>, AssemblyError> {
        let from = self.from.map(|folder| folder.join("gas"));
        if self.case.gas_held {
            return Ok(Box::new(HeldGas::new(&self.prepared.mesh, &self.case.gas)));
        }
        match self.settings.pairing.gas {
            GasBackend::Native => {
                let mut gas = NativeGas::new(Arc::clone(&self.prepared.mesh), &self.case.gas)?;
                if let Some(folder) = from {
                    gas.restore(&folder)?;
                } else if let Some(other) = self.other_gas()? {
                    gas.start_from(&other);
                } else if let Some(folder) = self.gas_of_origin() {
                    gas.take_over(&folder)?;
                }
                Ok(Box::new(gas))
            }
            GasBackend::Openfoam => {
                match_patches(&self.prepared.mesh, &self.case.gas)?;
                let other = self.other_gas()?;
                let launch = OpenfoamLaunch {
                    setup: &self.case.gas,
                    mesh: Arc::clone(&self.prepared.mesh),
                    template: self.case.openfoam.template.as_deref(),
                    start: self.case.openfoam.start.as_deref(),
                    gas: other.as_ref(),
                    solver: self.case.openfoam.solver,
                    case_hash: self.case.hash.clone(),
                    folder: self.absolute("solvers/openfoam")?,
                    log: self.absolute("log/openfoam.log")?,
                    from: self.gas_of_origin().filter(|_| other.is_none()),
                    ranks: self.settings.starts.gas.ranks,
                    launcher: self.settings.starts.gas.launcher.clone(),
                    resume: from,
                    deadline: self.case.coupling.deadline,
                };
                Ok(Box::new(launch.launch(supervisor)?))
            }
            GasBackend::External => {
                let external = self.case.external_gas.as_ref();
                let external = external.ok_or(AssemblyError::NoExternalGas)?;
                let launch = ExternalGasLaunch {
                    setup: &self.case.gas,
                    mesh: Arc::clone(&self.prepared.mesh),
                    case: &self.case.effective,
                    solver: AttachedProgram {
                        from: self.gas_of_origin(),
                        ..self.attached(
                            external,
                            &self.settings.starts.gas,
                            "external-gas",
                            from,
                        )?
                    },
                };
                Ok(Box::new(launch.launch(supervisor)?))
            }
        }
    }

    pub(super) fn particles(
        &self,
        supervisor: &mut Supervisor,
    ) -> Result<Box<dyn Particles>, AssemblyError> {
        let from = self.from.map(|folder| folder.join("particles"));
        let setup = &self.prepared.particles;
        match self.settings.pairing.particles_of(self.case) {
            ParticleBackend::Native if matches!(setup.motion, Motion::Parcels(_)) => {
                let mut parcels = NativeParcels::new(Arc::clone(&self.prepared.mesh), setup)?;
                if let Some(folder) = from {
                    parcels.restore(&folder)?;
                }
                Ok(Box::new(parcels))
            }
            ParticleBackend::Native => {
                let mut particles = NativeParticles::new(setup)?;
                if let Some(folder) = from {
                    particles.restore(&folder)?;
                }
                Ok(Box::new(particles))
            }
            ParticleBackend::Liggghts => {
                let start = &self.settings.starts.particles;
                let template = own_script(self.case)?;
                let inputs =
                    liggghts_inputs(self.case, self.prepared, template.as_ref(), start.ranks);
                let launch = LiggghtsLaunch {
                    inputs,
                    launcher: start.launcher.clone(),
                    case_hash: self.case.hash.clone(),
                    folder: self.absolute("solvers/liggghts")?,
                    log: self.absolute("log/liggghts.log")?,
                    resume: from,
                    deadline: self.case.coupling.deadline,
                };
                Ok(Box::new(launch.launch(supervisor)?))
            }
            ParticleBackend::Openfoam => {
                let start = &self.settings.starts.particles;
                let launch = ParcelLaunch {
                    setup,
                    mesh: Arc::clone(&self.prepared.mesh),
                    moving_drag: self.case.coupling.window_drag.follows(),
                    case_hash: self.case.hash.clone(),
                    folder: self.absolute("solvers/openfoam-parcels")?,
                    log: self.absolute("log/openfoam-parcels.log")?,
                    ranks: start.ranks,
                    launcher: start.launcher.clone(),
                    resume: from,
                    deadline: self.case.coupling.deadline,
                };
                Ok(Box::new(launch.launch(supervisor)?))
            }
            ParticleBackend::External => {
                let external = self.case.external_particles.as_ref();
                let external = external.ok_or(AssemblyError::NoExternalParticles)?;
                let start = &self.settings.starts.particles;
                let launch = ExternalParticlesLaunch {
                    setup,
                    case: Some(&self.case.effective),
                    solver: self.attached(external, start, "external-particles", from)?,
                };
                Ok(Box::new(launch.launch(supervisor)?))
            }
        }
    }

    /// The gas of the run that this one continues from, unless it goes on from a checkpoint of its own.
    fn gas_of_origin(&self) -> Option<PathBuf> {
        match (self.from, self.settings.from) {
            (None, Some(origin)) => Some(origin.path.join("gas")),
            _ => None,
        }
    }

    /// The gas of the run that this one continues from, where another solver computed it than this run's.
    fn other_gas(&self) -> Result<Option<GasStart>, AssemblyError> {
        let Some((origin, folder)) = self.settings.from.zip(self.gas_of_origin()) else {
            return Ok(None);
        };
        let native = self.settings.pairing.gas == GasBackend::Native;
        let other = NativeGas::left_state(&folder) != native;
        let gas = other.then(|| origin.gas()).transpose();
        gas.map_err(|cause| RunError::StateFile(cause).into())
    }

    /// A program of the case in a folder of that name, from a folder of a checkpoint.
    fn attached(
        &self,
        external: &ExternalProgram,
        start: &SolverStart,
        name: &str,
        resume: Option<PathBuf>,
    ) -> Result<AttachedProgram, AssemblyError> {
        Ok(AttachedProgram {
            program: external.program.clone(),
            arguments: external.arguments.clone(),
            folder: self.absolute(&format!("solvers/{name}"))?,
            log: self.absolute(&format!("log/{name}.log"))?,
            ranks: start.ranks,
            launcher: start.launcher.clone(),
            resume,
            from: None,
            deadline: self.case.coupling.deadline,
        })
    }

    /// A path in the results folder that holds whatever the working directory of a solver is.
    fn absolute(&self, below: &str) -> Result<PathBuf, AssemblyError> {
        let path = self.settings.results.join(below);
        std::path::absolute(&path).map_err(|cause| {
            let message = format!("{} has no absolute path", path.display());
            PartError::new("calcine", FailureKind::Io, message)
                .caused_by(cause)
                .into()
        })
    }
}
