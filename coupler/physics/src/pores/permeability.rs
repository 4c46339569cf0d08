//! Permeability of a porous solid.

use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter};

/// Permeability of a porous solid to a gas that flows by a difference of pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Permeability {
    /// K in m².
    Constant(f64),
    /// Of grains of a diameter in m.
    KozenyCarman(f64),
}

impl Permeability {
    /// K in m² at a porosity.
    pub fn of(&self, porosity: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::KozenyCarman(diameter) => kozeny_carman(*diameter, porosity),
        }
    }
}

/// K = d² ε³/(180 (1 − ε)²) in m², of grains of a diameter d in m.
///
/// Source: Carman, Trans. Inst. Chem. Eng. 15 (1937) 150; Kozeny, Sitzungsber. Akad. Wiss. Wien 136 (1927) 271.
pub fn kozeny_carman(diameter: f64, porosity: f64) -> f64 {
    diameter * diameter * porosity.powi(3) / (180.0 * (1.0 - porosity).powi(2))
}

/// One value.
pub static CONSTANT: LawEntry<Permeability> = LawEntry {
    name: "constant",
    summary: "The same at all porosities.",
    source: "docs/theory.md, XDP-4",
    parameters: &[LawParameter {
        name: "value",
        dimension: Dimension::PERMEABILITY,
        bound: Bound::Positive,
        default: None,
        needed_with: None,
        meaning: "Permeability.",
        example: "\"1e-15 m^2\"",
    }],
    tables: &[],
    make: |values| Box::new(Permeability::Constant(values[0])),
};

/// By the porosity and the size of grains.
pub static KOZENY_CARMAN: LawEntry<Permeability> = LawEntry {
    name: "kozeny-carman",
    summary: "By the porosity and the diameter of grains.",
    source: "Carman, Trans. Inst. Chem. Eng. 15 (1937) 150",
    parameters: &[LawParameter {
        name: "grain_diameter",
        dimension: Dimension::LENGTH,
        bound: Bound::Positive,
        default: None,
        needed_with: None,
        meaning: "Diameter of the grains.",
        example: "\"5 um\"",
    }],
    tables: &[],
    make: |values| Box::new(Permeability::KozenyCarman(values[0])),
};

/// The laws by which a case may give a porous solid its permeability.
pub static PERMEABILITY_LAWS: &[&LawEntry<Permeability>] = &[&CONSTANT, &KOZENY_CARMAN];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // (1e-5)² · 0.4³/(180 · 0.6²) in Python.
        let found = Permeability::KozenyCarman(1e-5).of(0.4);
        assert!((found / 9.876_543_209_876_54e-14 - 1.0).abs() < 1e-12);
        assert_eq!(Permeability::Constant(1e-15).of(0.4), 1e-15);
    }
}
