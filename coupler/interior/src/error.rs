//! What keeps a model of particles from going on.

use std::error::Error;

use thiserror::Error as DeriveError;

/// A model that cannot go on. The coordinator names the particle's id.
#[derive(Debug, DeriveError)]
pub enum ModelError {
    /// The state of one particle.
    #[error("{cause}")]
    Particle {
        /// Its row in the model.
        row: usize,
        /// What is wrong.
        cause: Box<dyn Error + Send + Sync>,
    },
    /// Values of a column that do not fit.
    #[error("column `{column}` of the particles' state: found {found}, needs {expected}")]
    Column {
        /// Its name.
        column: String,
        /// What there is.
        found: String,
        /// What there must be.
        expected: String,
    },
}
