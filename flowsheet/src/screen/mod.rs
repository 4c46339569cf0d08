//! Laws of screens: which share of a size goes to the coarse side. One law a file.

mod molerus_hoffmann;
mod plitt;
mod probability;
mod teipel_hennig;

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

/// Which share of a size a screen sends to its coarse side.
pub trait ScreenLaw: Send + Sync {
    /// Share of mass of diameter `d` in m that is coarse, 0 to 1.
    fn coarse_share(&self, d: f64) -> f64;

    /// Which of its numbers it cannot have, with the value and what it may be.
    fn refused(&self) -> Option<(&'static str, f64, &'static str)>;
}

/// The first of some numbers that is not above zero and finite.
fn not_positive(numbers: &[(&'static str, f64)]) -> Option<(&'static str, f64, &'static str)> {
    let bad = |(_, value): &&(_, f64)| !(value.is_finite() && *value > 0.0);
    numbers
        .iter()
        .find(bad)
        .map(|(name, value)| (*name, *value, "it is above zero"))
}
