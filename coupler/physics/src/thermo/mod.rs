//! Thermodynamics and transport of ideal gases and their mixtures.

mod mixture;
mod nasa7;
mod species;

pub use mixture::{Mixture, MixtureError};
pub use nasa7::Nasa7;
pub use species::{Species, atomic_mass, species, species_names};
