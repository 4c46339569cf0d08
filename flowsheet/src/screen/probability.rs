//! A cumulative normal distribution.

use super::{ScreenLaw, not_positive};
use crate::distribution::normal_below;

/// A separation curve that is a cumulative normal distribution of the cut size.
///
/// T(d) = Φ((d − μ)/σ)
///
/// Dyssol sums the density over its classes, own class included, which is this curve half a class lower and normalised to
/// its grid.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbabilityScreen {
    /// Mean cut size μ in m.
    pub mean: f64,
    /// Standard deviation σ in m.
    pub deviation: f64,
}

impl ScreenLaw for ProbabilityScreen {
    fn coarse_share(&self, d: f64) -> f64 {
        normal_below(d, self.mean, self.deviation)
    }

    fn refused(&self) -> Option<(&'static str, f64, &'static str)> {
        not_positive(&[
            ("mean cut size", self.mean),
            ("standard deviation", self.deviation),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_its_mean_and_has_the_quantiles_of_a_normal_distribution() {
        let law = ProbabilityScreen {
            mean: 1e-3,
            deviation: 1e-4,
        };
        assert_eq!(law.coarse_share(1e-3), 0.5);
        assert!((law.coarse_share(1.1e-3) - 0.841_344_746_068_543).abs() < 1e-13);
    }
}
