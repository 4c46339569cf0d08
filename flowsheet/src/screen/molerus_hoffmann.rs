//! Molerus and Hoffmann.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::model::{ScreenLaw, not_positive};

/// Separation curve of Molerus and Hoffmann.
///
/// T(d) = 1/(1 + (d_cut/d)² exp(α (1 − (d/d_cut)²)))
///
/// Source: Molerus and Hoffmann, Chem. Ing. Tech. 41 (1969) 340, doi 10.1002/cite.330410522.
#[derive(Clone, Debug, PartialEq)]
pub struct MolerusHoffmann {
    /// Cut size d_cut in m, of which one half is coarse.
    pub cut: f64,
    /// Sharpness α.
    pub sharpness: f64,
}

impl ScreenLaw for MolerusHoffmann {
    fn coarse_share(&self, d: f64) -> f64 {
        let square = (d / self.cut).powi(2);
        if square == 0.0 {
            return 0.0;
        }
        1.0 / (1.0 + (self.sharpness * (1.0 - square)).exp() / square)
    }

    fn refused(&self) -> Option<(&'static str, f64, &'static str)> {
        not_positive(&[("cut size", self.cut), ("sharpness", self.sharpness)])
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn ScreenLaw> = LawEntry {
    name: "molerus-hoffmann",
    summary: "The curve of Molerus and Hoffmann.",
    source: "Molerus and Hoffmann, Chem. Ing. Tech. 41 (1969) 340, doi 10.1002/cite.330410522",
    parameters: &[
        LawParameter {
            name: "cut",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Cut size.",
            example: "\"2 mm\"",
        },
        LawParameter {
            name: "sharpness",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Sharpness of the cut.",
            example: "4",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(MolerusHoffmann {
            cut: values[0],
            sharpness: values[1],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_the_cut_size_and_agrees_with_an_independent_evaluation() {
        let law = MolerusHoffmann {
            cut: 2e-3,
            sharpness: 6.0,
        };
        assert_eq!(law.coarse_share(2e-3), 0.5);
        assert_eq!(law.coarse_share(0.0), 0.0);
        // 1/(1 + exp(6 · 0.4375)/0.5625).
        let found = law.coarse_share(1.5e-3);
        assert!((found - 0.039_152_021_679_229_68).abs() < 1e-15, "{found}");
    }
}
