//! A cone crusher.

use std::fmt::Display;

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use super::model::MillLaw;
use crate::{PlantError, SizeGrid, Transformation};

/// A cone crusher: King's selection, Vogel and Peukert's breakage.
///
/// Selected of diameter y is  S = 0 below α₁ c,  1 above α₂ c,  else 1 − ((α₂ c − y)/((α₂ − α₁) c))ⁿ,
/// c the closed-side setting; of its fragments  B(x, y) = ½ (x/y)^q (1 + tanh((x − d′)/d′))  are smaller than x,
/// normalised to B(y, y) = 1.
///
/// Dyssol takes the shape of B as a density over its classes with x and y exchanged, which makes other fragments.
///
/// Sources: King, Modeling and Simulation of Mineral Processing Systems (2001), chapter 5; Vogel and Peukert, Powder
/// Technol. 129 (2003) 101, doi 10.1016/S0032-5910(02)00217-8.
#[derive(Clone, Debug, PartialEq)]
pub struct ConeMill {
    /// Closed-side setting c in m.
    pub closed_side_setting: f64,
    /// α₁.
    pub lower: f64,
    /// α₂.
    pub upper: f64,
    /// n.
    pub power: f64,
    /// Smallest fragments d′ in m.
    pub smallest_fragment: f64,
    /// q.
    pub breakage_power: f64,
}

impl ConeMill {
    fn selected(&self, y: f64) -> f64 {
        let (low, high) = (
            self.lower * self.closed_side_setting,
            self.upper * self.closed_side_setting,
        );
        if y >= high {
            1.0
        } else if y <= low {
            0.0
        } else {
            1.0 - ((high - y) / (high - low)).powf(self.power)
        }
    }

    /// ½ x^q (1 + tanh((x − d′)/d′)).
    fn below(&self, x: f64) -> f64 {
        let size = self.smallest_fragment;
        0.5 * x.powf(self.breakage_power) * (1.0 + ((x - size) / size).tanh())
    }
}

impl MillLaw for ConeMill {
    fn transformation(
        &self,
        grid: &SizeGrid,
        _feed: &[f64],
        place: &dyn Display,
    ) -> Result<Transformation, PlantError> {
        for (quantity, value) in [
            ("closed-side setting", self.closed_side_setting),
            ("lower limit of selection", self.lower),
            ("width of selection", self.upper - self.lower),
            ("power of selection", self.power),
            ("smallest fragment", self.smallest_fragment),
            ("power of breakage", self.breakage_power),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(PlantError::Value {
                    place: place.to_string(),
                    quantity,
                    value,
                    allowed: "it is above zero",
                });
            }
        }
        let count = grid.classes();
        let mut matrix = vec![0.0; count * count];
        for (class, row) in matrix.chunks_exact_mut(count).enumerate() {
            let y = grid.diameters()[class];
            let (selected, all) = (self.selected(y), self.below(y));
            let upper = grid.edges()[1..=class].iter().map(|edge| self.below(*edge));
            let mut low = 0.0;
            for (share, high) in row.iter_mut().zip(upper.chain([all])) {
                *share = selected * (high - low) / all;
                low = high;
            }
            row[class] += 1.0 - selected;
        }
        Ok(Transformation::Full(matrix))
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn MillLaw> = LawEntry {
    name: "cone",
    summary: "A cone crusher: King's selection, Vogel and Peukert's breakage.",
    source: "King, Modeling and Simulation of Mineral Processing Systems (2001), chapter 5; Vogel and Peukert, Powder Technol. 129 (2003) 101, doi 10.1016/S0032-5910(02)00217-8",
    parameters: &[
        LawParameter {
            name: "closed_side_setting",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Closed-side setting.",
            example: "\"40 mm\"",
        },
        LawParameter {
            name: "lower",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Selected is nothing below so many closed-side settings.",
            example: "0.6",
        },
        LawParameter {
            name: "upper",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Selected is all above so many closed-side settings.",
            example: "2",
        },
        LawParameter {
            name: "selection_power",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Power of the selection between both.",
            example: "2",
        },
        LawParameter {
            name: "smallest_fragment",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Size below which there are few fragments.",
            example: "\"3 mm\"",
        },
        LawParameter {
            name: "breakage_power",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Power of the fragments' distribution.",
            example: "0.55",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(ConeMill {
            closed_side_setting: values[0],
            lower: values[1],
            upper: values[2],
            power: values[3],
            smallest_fragment: values[4],
            breakage_power: values[5],
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selects_between_its_limits_and_conserves_mass() {
        let law = ConeMill {
            closed_side_setting: 0.04,
            lower: 0.6,
            upper: 2.0,
            power: 2.0,
            smallest_fragment: 0.003,
            breakage_power: 0.55,
        };
        assert_eq!(law.selected(0.024), 0.0);
        assert_eq!(law.selected(0.08), 1.0);
        // 1 − (0.02/0.056)².
        assert!((law.selected(0.06) - (1.0 - 0.127_551_020_408)).abs() < 1e-12);
        let grid = SizeGrid::uniform(50, 0.0, 0.1).unwrap();
        let made = law.transformation(&grid, &[], &"mill").unwrap();
        assert!(made.loss(50) < 1e-14);
        // Of 81 mm (all selected), below 10 mm: ½ 0.01^q (1 + tanh(7/3)) over ½ 0.081^q (1 + tanh(26)).
        let Transformation::Full(matrix) = made else {
            unreachable!()
        };
        let small: f64 = matrix[40 * 50..40 * 50 + 5].iter().sum();
        let expected = (10.0f64 / 81.0).powf(0.55) * (1.0 + (7.0f64 / 3.0).tanh()) / 2.0;
        assert!((small - expected).abs() < 1e-12, "{small} {expected}");
    }
}
