//! How far values spread over all runs, places and times, with what is only round-off told apart.

/// Share of a magnitude below which differences are those of round-off and of the tolerances of linear solvers, not of the physics:
/// 3e-7 K at 300 K, 1e-4 Pa at 1 atm.
const ROUND_OFF: f64 = 1e-9;

/// Smallest and largest of values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    low: f64,
    high: f64,
}

impl Spread {
    /// Of no values.
    pub const NONE: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    /// Of these values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut spread = Self::NONE;
        values.into_iter().for_each(|value| spread.add(value));
        spread
    }

    /// Takes a value up; NaN changes nothing.
    pub fn add(&mut self, value: f64) {
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }

    /// Largest difference that may be round-off.
    fn round_off(self) -> f64 {
        ROUND_OFF * self.low.abs().max(self.high.abs())
    }

    /// Largest minus smallest value; zero where that is round-off, so that nothing is told as a share of it.
    pub fn span(self) -> f64 {
        let span = self.high - self.low;
        match span <= self.round_off() {
            true => 0.0,
            false => span,
        }
    }

    /// The distance that a share of the span allows: differences of round-off always.
    pub fn allowance(self, share: f64) -> f64 {
        (share * self.span()).max(self.round_off())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_of_round_off_is_none_and_a_share_of_it_allows_round_off() {
        let flat = Spread::of([300.0, 300.0 + 1e-10, f64::NAN]);
        assert_eq!(flat.span(), 0.0);
        assert!((flat.allowance(0.01) - 3e-7).abs() < 1e-15);
        let steep = Spread::of([101_325.0, 101_325.01]);
        assert!((steep.span() - 0.01).abs() < 1e-9);
        assert!((steep.allowance(0.1) - 1e-3).abs() < 1e-9);
    }
}
