//! Setups that the native gas cannot take.

use calcine_coupler::checkpoint::StateFileError;
use calcine_coupler::motion::LOST_REMEDY;
use calcine_coupler::periodic_motion::PeriodicMotionError;
use thiserror::Error;

/// Why a native part cannot be made or taken up again.
#[derive(Debug, Error)]
pub enum NativeError {
    /// A patch of the mesh without a boundary condition.
    #[error(
        "patch `{patch}` of the mesh has no boundary condition; give it one in `gas.patch.{patch}`"
    )]
    NoCondition {
        /// Name of the patch.
        patch: String,
    },
    /// A boundary condition for a patch that the mesh does not have.
    #[error("`gas.patch.{patch}` names no patch of the mesh, which has {present}")]
    NoPatch {
        /// Name of the patch.
        patch: String,
        /// Patches of the mesh.
        present: String,
    },
    /// A mesh and a setup that do not agree on what is periodic.
    #[error(
        "patch `{patch}` of the mesh is {}joined to a partner, and `gas.patch.{patch}` says otherwise",
        if *joined { "" } else { "not " }
    )]
    NotJoined {
        /// Name of the patch.
        patch: String,
        /// Whether the mesh has it joined.
        joined: bool,
    },
    /// An inlet of turbulent gas that says nothing of its eddies.
    #[error(
        "the gas is turbulent, and `gas.patch.{patch}.inlet` says nothing of its eddies; give it a \
         `turbulence`"
    )]
    NoEddies {
        /// Name of the patch.
        patch: String,
    },
    /// More and more gas of constant density.
    #[error("gas of constant density flows in and no patch is an outlet; make one an outlet")]
    NoOutlet,
    /// A number that makes no sense.
    #[error("{field} of {place} is {value} {unit}; it must be {rule}")]
    Value {
        /// What the number is.
        field: &'static str,
        /// Where it stands, for example "patch `bottom`".
        place: String,
        /// The number.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// What is allowed.
        rule: &'static str,
    },
    /// Moving particles that do not go with the periodic directions.
    #[error(transparent)]
    Periodic(#[from] PeriodicMotionError),
    /// A particle that left the space in which particles may be.
    #[error(
        "particle {id} left the box about the gas mesh at ({}, {}, {}) m with a velocity of ({}, {}, {}) m/s; {LOST_REMEDY}",
        place[0], place[1], place[2], velocity[0], velocity[1], velocity[2]
    )]
    OutOfBounds {
        /// Its id.
        id: u64,
        /// Its centre in m.
        place: [f64; 3],
        /// Its velocity in m/s.
        velocity: [f64; 3],
    },
    /// A particle that is not there, or no longer.
    #[error("particle {id} cannot be taken out: there is none, or it was named twice")]
    NoParticle {
        /// Its id.
        id: u64,
    },
    /// Particles that move in another way than the part moves them.
    #[error("the part moves {takes}, and is given {given}")]
    OtherMotion {
        /// What it moves.
        takes: &'static str,
        /// What it is given.
        given: &'static str,
    },
    /// Lists of unequal length.
    #[error("{field} has {found} values for {expected} {of}")]
    Length {
        /// What the list holds.
        field: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        expected: usize,
        /// What is counted.
        of: &'static str,
    },
    /// A state file that cannot be used.
    #[error(transparent)]
    State(#[from] StateFileError),
}
