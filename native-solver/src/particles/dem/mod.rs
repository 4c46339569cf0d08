//! The discrete element solver: spheres that move under gravity, contacts and pushes.
//!
//! Particles are sorted along a space-filling curve and cut into blocks of a fixed size. A block owns
//! the candidates (pairs that may touch) of its particles; the force on a particle of another block is
//! kept aside and taken up by that block in a fixed order, so that sums do not depend on the number of
//! threads.

mod block;
mod candidates;
mod contact;
mod deep;
pub mod energy;
mod engine;
mod force_context;
mod grid;
mod lanes;
mod motion;
mod rebuild;
mod rules;
mod sphere;
mod stored_contacts;
mod walls;

pub use engine::{Engine, EngineState, EscapedParticle, InsertedSphere, ServoState};
pub use stored_contacts::{StoredContact, StoredWallContact};
pub use walls::{distance_to_shape, distance_to_triangle, repeated};
