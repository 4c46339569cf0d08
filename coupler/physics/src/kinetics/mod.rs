//! Reactions among gases: a [`Mechanism`] over the species of a mixture says how fast each is made, a
//! [`Reactor`] integrates one parcel of gas over a time, alone or with gas that flows through it ([`stirred`]), [`pasr`] says what share of it reacts where turbulence mixes it.
//!
//! Equations, rate constants and powers are those of [`crate::reaction`].

pub mod elements;
pub mod error;
pub mod falloff;
pub mod jones_lindstedt;
pub mod mechanism;
pub mod mechanism_reaction;
pub mod pasr;
pub mod reactor;
pub mod statement;
pub mod stirred;

pub use error::KineticsError;
pub use falloff::{Broadening, RateConstant};
pub use mechanism::{Mechanism, MixtureState};
pub use mechanism_reaction::MechanismReaction;
pub use reactor::{Reactor, ReactorStatistics, ReactorWorkspace, Tolerances};
pub use statement::{Collider, ReactionStatement};
pub use stirred::Throughflow;
