//! Plitt.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::model::{ScreenLaw, not_positive};

/// Plitt's separation curve, after Rosin and Rammler.
///
/// T(d) = 1 − exp(−0.693 (d/d_cut)^α)
///
/// 0.693 stands for ln 2 as in the paper: the share at the cut size is 0.49993.
///
/// Source: Plitt, CIM Bulletin 69 (1976) 114; as the screen of Dyssol (Skorych, Dosta and Heinrich, SoftwareX 12 (2020) 100572,
/// doi 10.1016/j.softx.2020.100572).
#[derive(Clone, Debug, PartialEq)]
pub struct Plitt {
    /// Cut size d_cut in m.
    pub cut: f64,
    /// Sharpness α.
    pub sharpness: f64,
}

impl ScreenLaw for Plitt {
    fn coarse_share(&self, d: f64) -> f64 {
        -(-0.693 * (d / self.cut).powf(self.sharpness)).exp_m1()
    }

    fn refused(&self) -> Option<(&'static str, f64, &'static str)> {
        not_positive(&[("cut size", self.cut), ("sharpness", self.sharpness)])
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn ScreenLaw> = LawEntry {
    name: "plitt",
    summary: "Plitt's curve, after Rosin and Rammler.",
    source: "Plitt, CIM Bulletin 69 (1976) 114",
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
        Box::new(Plitt {
            cut: values[0],
            sharpness: values[1],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation_and_is_a_step_where_sharp() {
        let law = |sharpness| Plitt {
            cut: 2e-3,
            sharpness,
        };
        // 1 − exp(−0.693 · 0.75⁴) = 1 − exp(−0.219269…).
        let found = law(4.0).coarse_share(1.5e-3);
        assert!((found - 0.196_894_772_976_346_5).abs() < 1e-12, "{found}");
        assert!(law(500.0).coarse_share(1.9e-3) < 1e-10);
        assert_eq!(law(500.0).coarse_share(2.1e-3), 1.0);
    }
}
