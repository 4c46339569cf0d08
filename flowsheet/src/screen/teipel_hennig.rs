//! Teipel and Hennig.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::model::{ScreenLaw, not_positive};

/// Separation curve of Teipel and Hennig, with a share of the fines that sticks to the coarse side.
///
/// T(d) = (1 − (1 + 3 (d/d_cut)^((d/d_cut + α) β))^(−1/2)) (1 − a) + a
///
/// Source: Hennig and Teipel, Chem. Ing. Tech. 83 (2011) 1107, doi 10.1002/cite.201000208.
#[derive(Clone, Debug, PartialEq)]
pub struct TeipelHennig {
    /// Cut size d_cut in m.
    pub cut: f64,
    /// Sharpness α.
    pub sharpness: f64,
    /// Sharpness β.
    pub second_sharpness: f64,
    /// Share a of the fines that is coarse, 0 to 1.
    pub offset: f64,
}

impl ScreenLaw for TeipelHennig {
    fn coarse_share(&self, d: f64) -> f64 {
        let x = d / self.cut;
        let power = (x + self.sharpness) * self.second_sharpness;
        let share = 1.0 - (1.0 + 3.0 * x.powf(power)).powf(-0.5);
        share * (1.0 - self.offset) + self.offset
    }

    fn refused(&self) -> Option<(&'static str, f64, &'static str)> {
        if !(0.0..=1.0).contains(&self.offset) {
            return Some(("offset", self.offset, "it is 0 to 1"));
        }
        let second = ("second sharpness", self.second_sharpness);
        not_positive(&[
            ("cut size", self.cut),
            ("sharpness", self.sharpness),
            second,
        ])
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn ScreenLaw> = LawEntry {
    name: "teipel-hennig",
    summary: "The curve of Teipel and Hennig, with a share of the fines that is coarse.",
    source: "Hennig and Teipel, Chem. Ing. Tech. 83 (2011) 1107, doi 10.1002/cite.201000208",
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
        LawParameter {
            name: "second_sharpness",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Second sharpness of the cut.",
            example: "0.5",
        },
        LawParameter {
            name: "offset",
            dimension: Dimension::NONE,
            bound: Bound::Between(0.0, 1.0),
            default: Some(0.0),
            needed_with: None,
            meaning: "Share of the fines that is coarse.",
            example: "0.1",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(TeipelHennig {
            cut: values[0],
            sharpness: values[1],
            second_sharpness: values[2],
            offset: values[3],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_the_cut_size_without_offset_and_agrees_with_an_independent_evaluation() {
        let law = |offset| TeipelHennig {
            cut: 2e-3,
            sharpness: 10.0,
            second_sharpness: 0.5,
            offset,
        };
        assert_eq!(law(0.0).coarse_share(2e-3), 0.5);
        assert_eq!(law(0.2).coarse_share(0.0), 0.2);
        // x = 0.75: 0.8 (1 − (1 + 3 x^5.375)^(−1/2)) + 0.2, evaluated with forty digits.
        let found = law(0.2).coarse_share(1.5e-3);
        assert!((found - 0.375_135_358_834_350_3).abs() < 1e-15, "{found}");
    }
}
