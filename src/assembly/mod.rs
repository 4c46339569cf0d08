//! The only place that knows every backend: from a checked case to a run that is ready to go.

mod interior;
mod pairing;
mod plan;
mod prepared;
mod solvers;

use std::path::Path;
use std::sync::Arc;

use calcine_coupler::coordinator::{CheckpointPaths, CoupledRun, Origin, RunError, RunParts};
use calcine_coupler::error::PartError;
use calcine_coupler::interior::reacting::LayersError;
use calcine_coupler::supervisor::Supervisor;
use calcine_native::gas::NativeError;
use thiserror::Error;

pub use interior::chemistry;
pub use pairing::{GasBackend, Pairing, ParticleBackend};
pub use prepared::PreparedCase;
pub use solvers::{SolverStart, SolverStarts, check_own_script, write_inputs};

use crate::case::model::Case;
use crate::case::sizes::TooLarge;
use crate::case::{MeshingError, PlaceError};

/// A case that cannot be assembled, although its file was in order.
#[derive(Debug, Error)]
pub enum AssemblyError {
    /// The mesh cannot be made or read.
    #[error("mesh: {0}")]
    Mesh(#[from] MeshingError),
    /// An excluded zone beside the mesh.
    #[error(
        "`coupling.smoother.excluded[{index}]` holds no centre of a cell; enlarge it, or move it into \
         the mesh"
    )]
    Excluded {
        /// Number of the zone, from 0.
        index: usize,
    },
    /// More than this machine's memory.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// The particles cannot be placed.
    #[error("particles: {0}")]
    Particles(#[from] PlaceError),
    /// Reactions that make no shrinking core.
    #[error("reactions: {0}")]
    Layers(#[from] LayersError),
    /// A native solver refuses the case or a checkpoint.
    #[error(transparent)]
    Native(#[from] NativeError),
    /// A part could not start.
    #[error(transparent)]
    Part(#[from] PartError),
    /// The bed does not fit, or a checkpoint cannot be taken up.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// How a run is put together, beside its case.
#[derive(Clone, Copy, Debug)]
pub struct RunSettings<'a> {
    /// Who computes what.
    pub pairing: Pairing,
    /// How external solvers are started.
    pub starts: &'a SolverStarts,
    /// The results folder; inputs of external solvers go to `solvers/`, logs to `log/` in it.
    pub results: &'a Path,
    /// True where every part starts from the committed checkpoint.
    pub resume: bool,
    /// Another run of the same mesh and particles to continue from; not with `resume`.
    pub from: Option<&'a Origin>,
}

/// Builds the run.
pub fn assemble(
    case: &Case,
    prepared: &PreparedCase,
    settings: &RunSettings<'_>,
    supervisor: &mut Supervisor,
) -> Result<CoupledRun, AssemblyError> {
    if let Some(origin) = settings.from {
        let species = case.gas.properties.species();
        origin.check(&prepared.mesh, species, &prepared.particles)?;
    }
    let checkpoint = CheckpointPaths::new(settings.results);
    let from = settings.resume.then(|| checkpoint.committed());
    let assembly = solvers::Assembly {
        case,
        prepared,
        settings,
        from: from.as_deref(),
    };
    let gas = assembly.gas(supervisor)?;
    let particles = assembly.particles(supervisor)?;
    let interior = interior::interior(case, prepared, &particles.fields())?;
    let parts = RunParts {
        gas,
        particles,
        interior,
    };
    let smoother = prepared::smoother(case, prepared)?;
    let mut plan = plan::plan(case, prepared, checkpoint);
    let foam = settings.pairing.gas == GasBackend::Openfoam;
    if foam && case.openfoam.solver.is_stock() {
        // A stock solver cannot go back to the start of a time step.
        plan.exchange_attempts = 1;
        plan.repeats = false;
    }
    let mut run = CoupledRun::new(
        plan,
        Arc::clone(&prepared.mesh),
        smoother,
        plan::closures(case),
        parts,
    )?;
    if settings.resume {
        run.resume()?;
    } else if let Some(origin) = settings.from {
        run.take_over(origin)?;
    }
    Ok(run)
}
