//! The film of gas about a particle: at which state its properties are taken, and the net flow through it.

mod coefficient;
mod diffusivity;
mod stefan;
mod temperature;

pub use coefficient::{FILM_TEMPERATURES, FilmCoefficient};
pub use diffusivity::{FilmDiffusivity, FilmState, ReferenceDiffusivity};
pub use stefan::{StefanFlow, bernoulli};
pub use temperature::FilmTemperature;

/// How transfer through films is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmTheory {
    /// At which temperature properties are taken.
    pub temperature: FilmTemperature,
    /// What the net flow through a film does to the transfer.
    pub stefan_flow: StefanFlow,
}
