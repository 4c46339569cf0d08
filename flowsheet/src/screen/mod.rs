//! Laws of screens: which share of a size goes to the coarse side. One law a file.

mod model;
mod molerus_hoffmann;
mod plitt;
mod probability;
mod teipel_hennig;

pub use model::ScreenLaw;
pub use molerus_hoffmann::MolerusHoffmann;
pub use plitt::Plitt;
pub use probability::ProbabilityScreen;
pub use teipel_hennig::TeipelHennig;

use calcine_physics::law::LawEntry;

/// The laws of screens that a case may choose. A new one is a file beside these, declared above and listed here.
pub static SCREEN_LAWS: &[&LawEntry<dyn ScreenLaw>] = &[
    &plitt::LAW,
    &molerus_hoffmann::LAW,
    &teipel_hennig::LAW,
    &probability::LAW,
];
