//! Plants: a case of kind `flowsheet` run into a results folder.

mod bed;
mod checkpoint;
mod collisions;
pub(crate) mod compare;
mod drawing;
mod error;
mod files;
mod measure;
mod progress;
mod quantities;
mod report;
mod run;
mod sensitivities;
mod steady;
#[cfg_attr(not(feature = "hdf5"), path = "no_store.rs")]
mod store;
mod summary;
mod tell;
pub(crate) mod trials;
pub(crate) mod tune;

pub use error::PlantRunError;
pub use report::write_plant_report;
pub use run::{PlantEnding, PlantStart, run_plant};
pub use summary::{
    PlantContinuationSummary, PlantLedgerSummary, PlantSensitivity, PlantSteadySummary,
    PlantSummary, PlantTunedParameter, PlantTuningSummary,
};
pub use tell::{plant_check, plant_closing};
