//! What keeps particles from being placed.

use std::path::PathBuf;

use calcine_coupler::packing::PackingError;
use thiserror::Error;

use super::units::shown;

/// Particles that cannot be placed.
#[derive(Debug, Error)]
pub enum PlaceError {
    /// The file cannot be read.
    #[error("{path}: {cause}")]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// A particle, or a file of particles, that is not as it should be.
    #[error("{place}: {what}")]
    File {
        /// The file or population, and the line or particle.
        place: String,
        /// What is wrong.
        what: String,
    },
    /// Two particles of different populations in the same space.
    #[error(
        "particle {} of \"{}\" and particle {} of \"{}\" overlap: their centres are {} m apart, their \
         radii add up to {} m; move one of the populations",
        .ids[0], .names[0], .ids[1], .names[1], shown(*.distance), shown(*.radii)
    )]
    Overlap {
        /// Their ids.
        ids: [u64; 2],
        /// Their populations.
        names: [String; 2],
        /// Distance of their centres in m.
        distance: f64,
        /// Sum of their radii in m.
        radii: f64,
    },
    /// A packing or a distribution of sizes that cannot be made.
    #[error("population \"{name}\": {cause}")]
    Packing {
        /// Name of the population.
        name: String,
        /// Why.
        cause: PackingError,
    },
    /// Contacts that cannot be stepped through.
    #[error(transparent)]
    Contacts(#[from] super::contacts::ContactsError),
    /// No particle at all.
    #[error("the case has no particles")]
    Empty,
}
