//! The only place that knows every backend: from a checked case to a run that is ready to go.

mod cautions;
mod error;
mod interior;
mod pairing;
mod plan;
mod prepared;
mod settings;
mod solvers;

use std::sync::Arc;

use calcine_coupler::bodies::HeatBodies;
use calcine_coupler::coordinator::{CheckpointPaths, CoupledRun, RunParts};
use calcine_coupler::supervisor::Supervisor;

pub use cautions::pairing_cautions;
pub use error::AssemblyError;
pub use interior::{ModelFactory, chemistry};
pub use pairing::{GasBackend, Pairing, ParticleBackend};
pub use prepared::PreparedCase;
pub use settings::{RunSettings, SolverStart, SolverStarts};
pub use solvers::{
    check_for_liggghts, check_for_openfoam_parcels, native_parts, programs, write_inputs,
};

use crate::case::model::Case;

/// Builds the run.
pub fn assemble(
    case: &Case,
    prepared: &PreparedCase,
    settings: &RunSettings<'_>,
    supervisor: &mut Supervisor,
) -> Result<CoupledRun, AssemblyError> {
    assemble_with(case, prepared, settings, supervisor, &|_| None)
}

/// Builds the run with models of particles that the case file does not know, by the name of the material.
pub fn assemble_with(
    case: &Case,
    prepared: &PreparedCase,
    settings: &RunSettings<'_>,
    supervisor: &mut Supervisor,
    models: &ModelFactory<'_>,
) -> Result<CoupledRun, AssemblyError> {
    let continued;
    let prepared = match settings.from {
        Some(origin) => {
            continued = prepared.continued(case, origin)?;
            &continued
        }
        None => prepared,
    };
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
    let parts = RunParts {
        gas,
        models: interior::models(case, prepared, &particles.fields(), models)?,
        network: interior::network(case),
        bodies: HeatBodies::new(case.bodies.clone(), &prepared.mesh),
        particles,
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
