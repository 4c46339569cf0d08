//! Thermophysical properties of gas mixtures, one law a file: the species' own ([`nasa7`],
//! [`sutherland`], [`eucken`], [`fuller`]), their mixing ([`wilke`], [`diffusion`]), the built-in
//! [`species`], and the [`mixture`] that the solvers ask.

pub mod diffusion;
pub mod element;
pub mod error;
pub mod eucken;
pub mod fuller;
mod inverse;
pub mod lennard_jones;
pub mod mixture;
pub mod nasa7;
pub mod species;
pub mod sutherland;
mod table;
pub mod wilke;

pub use element::Element;
pub use error::ThermoError;
pub use lennard_jones::LennardJones;
pub use mixture::{Mixture, TransportProperties};
pub use nasa7::Nasa7;
pub use species::Species;
pub use sutherland::Sutherland;
