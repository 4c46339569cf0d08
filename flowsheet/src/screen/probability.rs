//! A cumulative normal distribution.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::model::{ScreenLaw, not_positive};
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

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn ScreenLaw> = LawEntry {
    name: "probability",
    summary: "A cumulative normal distribution of the cut size.",
    source: "as the screen of Dyssol, SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572",
    parameters: &[
        LawParameter {
            name: "mean",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Mean cut size.",
            example: "\"1 mm\"",
        },
        LawParameter {
            name: "deviation",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Standard deviation of the cut size.",
            example: "\"0.1 mm\"",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(ProbabilityScreen {
            mean: values[0],
            deviation: values[1],
        })
    },
};

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
