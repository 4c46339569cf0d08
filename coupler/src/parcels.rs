//! How parcels move: what the multiphase particle-in-cell method (MP-PIC) is told beside the particles. All values are of
//! the motion clock.

use calcine_physics::Vec3;
use calcine_physics::parcels::{CollisionTimes, HarrisCrighton};

use crate::wall_motion::WallMotion;

/// Parcels: rows that stand for many particles, which meet walls one by one and each other by averages of the mesh
/// (docs/theory.md, MPC-1).
#[derive(Clone, Debug, PartialEq)]
pub struct ParcelMotion {
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Courant number that a parcel may have in a step, above 0 and up to 1.
    pub courant: f64,
    /// Steps that a window may have.
    pub most_steps: u32,
    /// What parcels meet at each patch that is not periodic.
    pub walls: Vec<ParcelWall>,
    /// How the stress of the solid acts.
    pub packing: ParcelPacking,
    /// What collisions do beside.
    pub collisions: ParcelCollisions,
    /// Friction under the stress of the solid; none where it is not given.
    pub friction: Option<ParcelFriction>,
    /// Resistance in proportion to velocity; none where it is not given.
    pub resistance: Option<ParcelResistance>,
}

/// A resistance −c m (v − v_wall) of each particle against a wall, wherever it is (docs/theory.md, NSP-2).
#[derive(Clone, Debug, PartialEq)]
pub struct ParcelResistance {
    /// Rate c in 1/s, 0 or above.
    pub rate: f64,
    /// How the wall moves; v_wall is the velocity of a body that moves with it at the particle's place.
    pub wall: WallMotion,
}

/// Coulomb's friction of the solid with itself and, by the friction of their impacts, with walls, under the stress of the solid
/// (docs/theory.md, NSP-1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParcelFriction {
    /// Coefficient of friction within the bed, 0 or above.
    pub bed: f64,
    /// Slip in m/s below which friction falls off, above 0.
    pub slip: f64,
}

/// A patch that parcels rebound from.
#[derive(Clone, Debug, PartialEq)]
pub struct ParcelWall {
    /// Name of the patch.
    pub patch: String,
    /// How the wall moves, along itself; the mesh stays.
    pub motion: WallMotion,
    /// The impact of a particle of each population.
    pub impact: Vec<ParcelImpact>,
}

/// Properties of the impact of a parcel on a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParcelImpact {
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Coefficient of sliding friction (Coulomb).
    pub friction: f64,
}

/// How the stress of the solid keeps parcels apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParcelPacking {
    /// Not at all: parcels pass through each other.
    None,
    /// The solid fraction at the end of the step is solved for (docs/theory.md, MPC-3).
    Implicit(HarrisCrighton),
    /// The gradient at its start acts, limited component by component (docs/theory.md, MPC-2).
    Explicit {
        /// The stress.
        stress: HarrisCrighton,
        /// Restitution between parcels, 0 to 1.
        restitution: f64,
    },
}

/// Damping and isotropy by collisions (docs/theory.md, MPC-4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParcelCollisions {
    /// Time scales of both.
    pub times: CollisionTimes,
    /// Whether velocities relax to their mean.
    pub damping: bool,
    /// Whether velocities are drawn anew.
    pub isotropy: bool,
    /// Seed of the draws.
    pub seed: u64,
}
