//! What keeps models of particles from going on.

use calcine_interior::ModelError;
use thiserror::Error;

use crate::checkpoint::StateFileError;

/// A model that cannot go on, with the id of the particle.
#[derive(Debug, Error)]
pub enum ParticleModelError {
    /// The state of one particle.
    #[error("particle {id}: {cause}")]
    Particle {
        /// Its id.
        id: u64,
        /// What is wrong.
        cause: ModelError,
    },
    /// Values of a column.
    #[error(transparent)]
    Column(ModelError),
    /// A column of two models that do not agree on it.
    #[error("two models of this run have a column `{name}`, but one of {} and one of {}", .units[0], .units[1])]
    ColumnClash {
        /// Its name.
        name: String,
        /// What the two say of unit, type and shape.
        units: [String; 2],
    },
    /// A population without a model.
    #[error("population {population} has no model for what is inside its particles")]
    Population {
        /// Its index.
        population: usize,
    },
}

/// Names the particle of an error by its id.
pub(super) fn named(cause: ModelError, rows: &[usize], id: &[u64]) -> ParticleModelError {
    match &cause {
        ModelError::Particle { row, .. } => match rows.get(*row).and_then(|row| id.get(*row)) {
            Some(&id) => ParticleModelError::Particle { id, cause },
            None => ParticleModelError::Column(cause),
        },
        ModelError::Column { .. } => ParticleModelError::Column(cause),
    }
}

/// State of particles that cannot be taken up.
#[derive(Debug, Error)]
pub enum RestoreError {
    /// An array that is missing or of another type.
    #[error(transparent)]
    StateFile(#[from] StateFileError),
    /// Values that a model does not take.
    #[error(transparent)]
    Model(#[from] ParticleModelError),
}
