//! Why a run could not go on.

use thiserror::Error;

use super::checkpoint::CheckpointError;
use super::controls::ControlError;
use super::origin::OriginError;
use super::resize::TooLight;
use crate::checkpoint::StateFileError;
use crate::closures::ClosureError;
use crate::error::PartError;
use crate::mapping::MappingError;
use crate::models::{ParticleModelError, RestoreError};
use crate::observer::ObserverError;
use crate::packing::PackingError;
use crate::smoother::SmootherError;
use crate::time::TimeError;

/// A run that could not go on.
#[derive(Debug, Error)]
pub enum RunError {
    /// A part failed.
    #[error(transparent)]
    Part(#[from] PartError),
    /// Particles could not be mapped onto cells.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The bed does not fit the mesh.
    #[error(transparent)]
    Smoother(#[from] SmootherError),
    /// A law met a state that it is not defined for.
    #[error("window {window}: {cause}")]
    Closure {
        /// Index of the window.
        window: u64,
        /// What the law said.
        cause: ClosureError,
    },
    /// The inside of a particle that cannot be followed.
    #[error("window {window}: {cause}")]
    Interior {
        /// Index of the window.
        window: u64,
        /// Which particle, and why.
        cause: ParticleModelError,
    },
    /// Particles that their models do not take.
    #[error(transparent)]
    Models(#[from] ParticleModelError),
    /// State of particles that cannot be taken up.
    #[error(transparent)]
    Restore(#[from] RestoreError),
    /// A particle too light for the solver's time step.
    #[error(transparent)]
    TooLight(#[from] TooLight),
    /// Something that cannot be set.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A feed whose particles cannot be drawn.
    #[error("feeds: {0}")]
    Feed(#[from] PackingError),
    /// The clock ended.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// An observer failed, for example because a disk is full.
    #[error(transparent)]
    Observer(#[from] ObserverError),
    /// A checkpoint could not be written or read.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// Another run's results that this case cannot continue from.
    #[error(transparent)]
    Origin(#[from] OriginError),
    /// A state file could not be written or read.
    #[error(transparent)]
    StateFile(#[from] StateFileError),
}
