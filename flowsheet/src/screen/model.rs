//! What every law of a screen is.

/// Which share of a size a screen sends to its coarse side.
pub trait ScreenLaw: Send + Sync {
    /// Share of mass of diameter `d` in m that is coarse, 0 to 1.
    fn coarse_share(&self, d: f64) -> f64;

    /// Which of its numbers it cannot have, with the value and what it may be.
    fn refused(&self) -> Option<(&'static str, f64, &'static str)>;
}

/// The first of some numbers that is not above zero and finite.
pub(super) fn not_positive(
    numbers: &[(&'static str, f64)],
) -> Option<(&'static str, f64, &'static str)> {
    let bad = |(_, value): &&(_, f64)| !(value.is_finite() && *value > 0.0);
    numbers
        .iter()
        .find(bad)
        .map(|(name, value)| (*name, *value, "it is above zero"))
}
