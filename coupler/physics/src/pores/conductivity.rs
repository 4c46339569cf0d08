//! Conductivity of a porous solid.

use crate::conduction::Conductivity;
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter};
use crate::radiation::STEFAN_BOLTZMANN;

/// By which law a porous solid conducts heat, as a case states it. The conductivity that it begins from is that of the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PorousConductivity {
    /// The material's conductivity is that of the porous solid.
    Stated,
    /// Solid and gas side by side, λ = (1 − ε) λ_s + ε λ_g + 16/3 σ d T³, with the material's conductivity as that of the solid
    /// without pores and the radiation across pores of a diameter d in m.
    Parallel {
        /// d.
        radiating: f64,
    },
}

impl PorousConductivity {
    /// λ in W/m/K at a porosity and a temperature in K, of a material of this conductivity, with gas of a conductivity in W/m/K in
    /// its pores.
    pub fn of(&self, material: &Conductivity, gas: f64, porosity: f64, temperature: f64) -> f64 {
        let solid = material.at(temperature);
        match self {
            Self::Stated => solid,
            Self::Parallel { radiating } => {
                let rays = 16.0 / 3.0 * STEFAN_BOLTZMANN * radiating * temperature.powi(3);
                (1.0 - porosity) * solid + porosity * gas + rays
            }
        }
    }
}

/// The material's own.
pub static STATED: LawEntry<PorousConductivity> = LawEntry {
    name: "stated",
    summary: "The material's conductivity is that of the porous particle.",
    source: "docs/theory.md, XDP-5",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(PorousConductivity::Stated),
};

/// Solid and gas side by side.
pub static PARALLEL: LawEntry<PorousConductivity> = LawEntry {
    name: "parallel",
    summary: "Solid and gas of the pores side by side; the material's conductivity is that of the solid without pores.",
    source: "Copertaro et al., Eng. J. 20(5) (2016) 187, doi 10.4186/ej.2016.20.5.187; radiation: Rosseland's diffusion",
    parameters: &[LawParameter {
        name: "radiating_pores",
        dimension: Dimension::LENGTH,
        bound: Bound::NotNegative,
        default: Some(0.0),
        needed_with: None,
        meaning: "Diameter of the pores across which radiation passes; 0 for none.",
        example: "\"20 um\"",
    }],
    tables: &[],
    make: |values| {
        Box::new(PorousConductivity::Parallel {
            radiating: values[0],
        })
    },
};

/// The laws by which a case may let a porous solid conduct heat.
pub static CONDUCTIVITY_LAWS: &[&LawEntry<PorousConductivity>] = &[&STATED, &PARALLEL];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // 0.4 · 2.2 + 0.6 · 0.07 + 16/3 · 5.670374419e-8 · 2e-5 · 1200³ in Python.
        let material = Conductivity::constant(2.2);
        let law = PorousConductivity::Parallel { radiating: 2e-5 };
        let found = law.of(&material, 0.07, 0.6, 1200.0);
        assert!((found - 0.932_451_634_1).abs() < 1e-9, "{found}");
        assert_eq!(
            PorousConductivity::Stated.of(&material, 0.07, 0.6, 1200.0),
            2.2
        );
    }

    #[test]
    fn without_pores_it_is_the_solid_and_without_solid_the_gas() {
        let law = PorousConductivity::Parallel { radiating: 0.0 };
        let material = Conductivity::constant(2.2);
        assert_eq!(law.of(&material, 0.07, 0.0, 900.0), 2.2);
        assert_eq!(law.of(&material, 0.07, 1.0, 900.0), 0.07);
    }
}
