//! Water in particles, one law a file: its vapour pressure and boiling point ([`antoine`]), the heat that binds it
//! ([`bound_water`]), the vapour over bound water ([`isotherm`]), and a wet surface in a gas stream ([`wet_surface`]).
//!
//! Moisture is the mass of water over the mass of dry solid, a plain number.

pub mod antoine;
pub mod bound_water;
pub mod isotherm;
pub mod wet_surface;

pub use wet_surface::{WetState, WetSurface};
