//! What keeps particles from being mapped onto cells.

use calcine_physics::Vec3;
use thiserror::Error;

/// Particles that cannot be mapped.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MappingError {
    /// A particle whose centre lies in no cell.
    #[error(
        "particle {particle} at ({}, {}, {}) m lies outside the mesh",
        position.x, position.y, position.z
    )]
    Outside {
        /// Index of the particle.
        particle: usize,
        /// Its centre in m.
        position: Vec3,
    },
    /// A radius that is negative or not finite.
    #[error("particle {particle} has a radius of {radius} m")]
    Radius {
        /// Index of the particle.
        particle: usize,
        /// Its radius in m.
        radius: f64,
    },
    /// Shares that no particle can have.
    #[error("the shares of particle {particle} in its cells sum to {total}, not to 1")]
    Shares {
        /// Index of the particle.
        particle: usize,
        /// Sum of its shares.
        total: f64,
    },
    /// Lists of different lengths.
    #[error("{positions} positions of particles, but {radii} radii")]
    Lengths {
        /// Number of positions.
        positions: usize,
        /// Number of radii.
        radii: usize,
    },
}
