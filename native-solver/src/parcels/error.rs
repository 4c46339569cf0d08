//! Parcels that cannot be made or moved.

use calcine_coupler::physics::figures::Brief;
use thiserror::Error;

use crate::gas::NativeError;

/// Why parcels cannot be made, or do not get on.
#[derive(Debug, Error)]
pub enum ParcelError {
    /// A cell whose faces do not share their edges in pairs.
    #[error(
        "cell {cell} has an edge of face {face} that no other face of it shares; parcels cannot be tracked through it: \
         check the mesh with `checkMesh`, its faces must name the points between their corners, too"
    )]
    OpenEdge {
        /// The cell.
        cell: usize,
        /// The face.
        face: usize,
    },
    /// A patch without a wall for parcels.
    #[error(
        "parcels have nothing to rebound from at patch `{patch}`; name it in the `patches` of one of [[walls]], or make it periodic"
    )]
    NoWall {
        /// Name of the patch.
        patch: String,
    },
    /// A wall of a patch that is not there.
    #[error(
        "a wall of parcels names patch `{patch}`, which the mesh does not have, or has as a periodic one"
    )]
    NoPatch {
        /// Name of the patch.
        patch: String,
    },
    /// A motion of a wall that leaves its place.
    #[error(
        "wall `{patch}` moves by a schedule or oscillates, and the mesh stays; walls of parcels turn or move along themselves"
    )]
    WallMoves {
        /// Name of the patch.
        patch: String,
    },
    /// A parcel that is not in the mesh.
    #[error("parcel {id} is at ({}, {}, {}) m, outside the mesh", place[0], place[1], place[2])]
    Outside {
        /// Its id.
        id: u64,
        /// Its place in m.
        place: [f64; 3],
    },
    /// Too many steps.
    #[error(
        "parcels of up to {speed} m/s need {steps} steps in a window of {span} s to keep to a Courant number of {courant}, more than {most}; \
         shorten `time.motion_window`, or make cells larger", speed = Brief(*.speed), span = Brief(*.span))]
    TooManySteps {
        /// Largest speed in m/s.
        speed: f64,
        /// Steps that were needed.
        steps: f64,
        /// Window in s.
        span: f64,
        /// Courant number.
        courant: f64,
        /// Steps at most.
        most: u32,
    },
    /// A packing that was not solved.
    #[error(
        "the solid fraction of the packing was not solved: {residual:.1e} of a cell's volume is left after {iterations} iterations; parcels that begin closer than `motion.parcels.close_packing` find no place: place fewer of them, lower their `weight`, or shorten `time.motion_window`"
    )]
    NotPacked {
        /// Largest residual as a solid fraction.
        residual: f64,
        /// Newton iterations.
        iterations: u32,
    },
    /// What every native part refuses.
    #[error(transparent)]
    Native(#[from] NativeError),
}
