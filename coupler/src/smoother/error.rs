//! What the smoother refuses.

use calcine_physics::Vec3;
use thiserror::Error;

/// A bed that cannot be smoothed, or a smoother that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SmootherError {
    /// α_max outside its range.
    #[error("the largest solid fraction is {0}; it must lie between 0 and 1")]
    MaxSolidFraction(f64),
    /// A tolerance that would leave no gas, or ask for the impossible.
    #[error(
        "the smoother's tolerance is {tolerance}; it must be above 0 and below {below}, the gas \
         fraction of a full cell"
    )]
    Tolerance {
        /// The tolerance.
        tolerance: f64,
        /// 1 − α_max.
        below: f64,
    },
    /// A diffusion length that is no length.
    #[error("the diffusion length is {0} m; it must be finite and not negative")]
    NoLength(f64),
    /// A diffusion length that is far longer than cells.
    #[error(
        "the smoother's diffusion length of {length} m spans too many cells of this mesh: {steps} steps, at most {most}; shorten \
         `coupling.smoother.diffusion_length`, half the mean diameter where it is not stated, or check the unit of the diameters"
    )]
    DiffusionLength {
        /// The length in m.
        length: f64,
        /// Steps that it would take.
        steps: f64,
        /// Steps allowed.
        most: u32,
    },
    /// Lists of different lengths.
    #[error("{given} {what}, but {expected} expected")]
    Lengths {
        /// What is counted.
        what: &'static str,
        /// How many were given.
        given: usize,
        /// How many were expected.
        expected: usize,
    },
    /// A solid volume that is negative or not finite.
    #[error("particle {particle} has a solid volume of {volume} m^3")]
    SolidVolume {
        /// Index of the particle.
        particle: usize,
        /// Its solid volume in m³.
        volume: f64,
    },
    /// A bed that does not fit below α_max (docs/theory.md, VFS-5).
    #[error(
        "the bed does not fit: {left_over:.4e} m^3 of solid are left over above a solid fraction of \
         {max_solid_fraction} in a region of {cells} cells with centres between \
         ({:.4}, {:.4}, {:.4}) and ({:.4}, {:.4}, {:.4}) m, whose mean solid fraction is {mean:.4}{}; place fewer or smaller \
         particles there, or check `coupling.smoother.max_solid_fraction`",
        lower.x, lower.y, lower.z, upper.x, upper.y, upper.z,
        if *unsettled { ", and the active cells did not settle" } else { "" }
    )]
    DoesNotFit {
        /// Solid volume left over in m³.
        left_over: f64,
        /// α_max.
        max_solid_fraction: f64,
        /// Cells of the connected region.
        cells: usize,
        /// Lowest coordinates of the region's cell centres in m.
        lower: Vec3,
        /// Highest coordinates of the region's cell centres in m.
        upper: Vec3,
        /// Mean solid fraction of the region.
        mean: f64,
        /// Whether there is room, but the solver did not find where.
        unsettled: bool,
    },
}
