//! How a run is put together.

use std::path::Path;

use calcine_adapters::launch::Launcher;
use calcine_coupler::coordinator::Origin;

use super::pairing::{GasBackend, Pairing, ParticleBackend};
use crate::case::model::Case;

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
    /// Another run on the same mesh to continue from; not with `resume`.
    pub from: Option<&'a Origin>,
}

/// How an external solver is started.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SolverStart {
    /// Number of ranks.
    pub ranks: u32,
    /// Who starts them.
    pub launcher: Launcher,
}

impl Default for SolverStart {
    fn default() -> Self {
        Self {
            ranks: 1,
            launcher: Launcher::default(),
        }
    }
}

/// How the external solvers of a run are started; natively it does not matter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SolverStarts {
    /// That of the gas.
    pub gas: SolverStart,
    /// That of the particles.
    pub particles: SolverStart,
}

impl SolverStarts {
    /// As many ranks as the case says for the solvers of a pairing, started by Calcine.
    pub fn of(case: &Case, pairing: Pairing) -> Self {
        let start = |ranks: u32| SolverStart {
            ranks: ranks.max(1),
            ..SolverStart::default()
        };
        Self {
            gas: start(match (pairing.gas, &case.external_gas) {
                (GasBackend::External, Some(external)) => external.ranks,
                _ => case.openfoam.ranks,
            }),
            particles: start(match (pairing.particles, &case.external_particles) {
                (ParticleBackend::External, Some(external)) => external.ranks,
                // OpenFOAM's parcels are coupled on one rank.
                (ParticleBackend::Openfoam, _) => 1,
                _ => case.liggghts.ranks,
            }),
        }
    }
}
