//! Results of a run: what is written while it runs, and how it is read back.
//!
//! A result directory holds `summary.json`, `status.json`, `series.csv`, `results.h5`, `case.toml`, `command.json`,
//! `gas.pvd` with `gas/gas_NNNN.vtu`, `particles.pvd` with `particles/particles_NNNN.vtp`,
//! `probes/probes_NNNN.csv` where the case has probes, and at its end `voids.csv` where it has a bed.
//! Every time in them is process time, unless its name begins with `motion_`.

mod difference;
mod error;
pub(crate) mod files;
pub mod flows;
// Only HDF5 holds descriptions.
#[cfg_attr(not(feature = "hdf5"), allow(dead_code))]
pub mod inertial_number;
pub(crate) mod marked;
mod means;
mod moment;
mod now;
mod open;
mod passages;
mod probe;
pub mod quantities;
pub mod read;
mod rebuild;
mod recorder;
mod resume;
mod series;
pub(crate) mod sheet;
#[cfg_attr(not(feature = "hdf5"), allow(dead_code))]
mod snapshot;
mod status;
pub mod steps;
#[cfg_attr(not(feature = "hdf5"), path = "no_store.rs")]
mod store;
pub mod summary;
pub mod voids;
mod vtk;
pub mod warnings;

use calcine_coupler::mesh::Mesh;

use crate::case::model::Case;
pub(crate) use difference::{CaseIdentity, differences, same_case};
pub use error::ResultsError;
pub use files::{CASE, SERIES, STATUS, STORE, SUMMARY};
pub use recorder::{Recorder, RunInfo, unoccupied};
pub use resume::{as_finished, clear_start, may_start_again};
pub(crate) use snapshot::lengths_of;
pub use summary::{Summary, Verdict, kind, must_hold_run};

/// Refuses probes outside a mesh, and quantities of patches that it lacks.
pub fn fits(case: &Case, mesh: &Mesh) -> Result<(), ResultsError> {
    probe::sites(&case.probes, mesh)?;
    case.quantities
        .iter()
        .try_for_each(|quantity| quantities::check(quantity, mesh))
}
