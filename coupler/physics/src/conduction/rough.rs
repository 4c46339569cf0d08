//! Conduction through contacts of rough surfaces.

use std::f64::consts::PI;

use super::model::{Conduction, SphereContact};
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter};

/// The smooth contact of Hertz in series with the asperities that touch within it.
///
/// 1/G = 1/(2 k r) + 1/(h_c π r²), r² = R* δ, h_c = 1.25 k (m/σ) (P/H)^0.95, P = 4/(3 π) E* √(δ/R*)
///
/// (docs/theory.md, COR-17), with k = 2 k₁k₂/(k₁ + k₂), the height σ and the slope m of the asperities of both surfaces together
/// (σ² = σ₁² + σ₂², m² = m₁² + m₂²), the mean pressure P of Hertz' contact and the hardness H of the softer surface, which comes in as
/// E*/H.
///
/// Validity: asperities that yield within a contact that stays Hertz' own, σ R*/r² well below 1; 1e-6 < P/H < 0.02 in the data. With the gas
/// between the asperities left out: add `gap`. δ is that of the real material, so write `area = "force"` or `"load"`.
///
/// Source: Yovanovich, AIAA paper 81-1164 (1981), doi 10.2514/6.1981-1164; Bahrami, Yovanovich and Culham, Int. J. Heat Mass Transf. 49
/// (2006) 3691, doi 10.1016/j.ijheatmasstransfer.2006.02.021.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughContact {
    /// Height σ of the asperities in m.
    pub height: f64,
    /// Their slope m.
    pub slope: f64,
    /// E*/H.
    pub modulus_over_hardness: f64,
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Conduction> = LawEntry {
    name: "rough",
    summary: "Hertz' contact in series with the asperities of rough surfaces.",
    source: "Yovanovich, AIAA paper 81-1164 (1981), doi 10.2514/6.1981-1164; Bahrami, Yovanovich and Culham, Int. J. Heat Mass Transf. 49 (2006) 3691, doi 10.1016/j.ijheatmasstransfer.2006.02.021",
    parameters: &[
        LawParameter {
            name: "height",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Height of the asperities (root mean square) of both surfaces together.",
            example: "\"1 um\"",
        },
        LawParameter {
            name: "slope",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Mean absolute slope of the asperities of both surfaces together.",
            example: "0.15",
        },
        LawParameter {
            name: "modulus_over_hardness",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Young's modulus E* of the contact over the hardness of the softer surface.",
            example: "60",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(RoughContact {
            height: values[0],
            slope: values[1],
            modulus_over_hardness: values[2],
        })
    },
};

impl Conduction for RoughContact {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn conductance(&self, contact: &SphereContact) -> f64 {
        let radius = contact.reduced_radius();
        let k = contact.conductivity();
        let area = PI * radius * contact.overlap;
        if area <= 0.0 {
            return 0.0;
        }
        let smooth = 2.0 * k * (radius * contact.overlap).sqrt();
        let pressure =
            4.0 / (3.0 * PI) * self.modulus_over_hardness * (contact.overlap / radius).sqrt();
        let asperities = 1.25 * k * self.slope / self.height * pressure.powf(0.95) * area;
        smooth * asperities / (smooth + asperities)
    }
}

#[cfg(test)]
mod tests {
    use super::super::BatchelorObrien;
    use super::*;

    const LAW: RoughContact = RoughContact {
        height: 1e-6,
        slope: 0.15,
        modulus_over_hardness: 60.0,
    };

    fn contact(overlap: f64) -> SphereContact {
        SphereContact {
            radius: [5e-3, 5e-3],
            overlap,
            conductivity: [20.0, 20.0],
        }
    }

    /// R* = 2.5 mm, δ = 0.1 µm: r = 15.8114 µm, 2 k r = 6.32456e-4 W/K; P/H = 4/(3 π) 60 √(4e-5) = 0.161053; h_c = 1.25·20·0.15/1e-6 ·
    /// 0.161053^0.95 = 6.61687e5 W/m²/K over π r² = 7.85398e-10 m²: 5.19688e-4 W/K; in series 2.852766e-4 W/K.
    #[test]
    fn agrees_with_an_independent_evaluation() {
        let made = LAW.conductance(&contact(1e-7));
        assert!((made / 2.852_766e-4 - 1.0).abs() < 1e-6, "{made}");
    }

    #[test]
    fn surfaces_that_become_smooth_conduct_as_smooth_ones_do() {
        let smooth = BatchelorObrien.conductance(&contact(1e-7));
        let mut last = 0.0;
        for height in [1e-6, 1e-8, 1e-10] {
            let made = RoughContact { height, ..LAW }.conductance(&contact(1e-7));
            assert!(made > last && made < smooth);
            last = made;
        }
        assert!((last / smooth - 1.0).abs() < 2e-4, "{last} {smooth}");
    }

    #[test]
    fn rough_contacts_conduct_nearly_as_their_force() {
        // With the asperities alone G goes with r² P^0.95, that is δ^1.475; the force with δ^1.5.
        let rough = RoughContact { height: 1.0, ..LAW };
        let ratio = rough.conductance(&contact(2e-7)) / rough.conductance(&contact(1e-7));
        assert!((ratio.log2() - 1.475).abs() < 1e-4, "{ratio}");
        assert_eq!(rough.conductance(&contact(0.0)), 0.0);
    }
}
