//! Batchelor and O'Brien 1977.

use super::model::{Conduction, SphereContact};
use crate::law::LawEntry;

/// Conduction through the circular contact of two spheres in a poorly conducting gas.
///
/// G = 2 k r_c, k = 2 k₁k₂/(k₁ + k₂), r_c = √(R* δ), R* = R₁R₂/(R₁ + R₂) (docs/theory.md, COR-17)
///
/// r_c is Hertz' contact radius for the overlap δ, so that G rests on the overlap of the real material:
/// with a softened Young's modulus the overlap, and G with its square root, is too large.
///
/// Validity: r_c small against the radii; contacts that do not disturb each other.
///
/// Source: Batchelor and O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313, doi 10.1098/rspa.1977.0100.
#[derive(Clone, Copy, Debug)]
pub struct BatchelorObrien;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Conduction> = LawEntry {
    name: "batchelor-obrien",
    summary: "By Hertz' contact radius.",
    source: "Batchelor and O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313, doi 10.1098/rspa.1977.0100",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(BatchelorObrien),
};

impl Conduction for BatchelorObrien {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn conductance(&self, contact: &SphereContact) -> f64 {
        let radius = (contact.reduced_radius() * contact.overlap.max(0.0)).sqrt();
        2.0 * contact.conductivity() * radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_spheres_conduct_by_twice_conductivity_and_contact_radius() {
        let mut contact = SphereContact {
            radius: [5e-3, 5e-3],
            overlap: 1e-6,
            conductivity: [50.0, 50.0],
        };
        // r_c = √(2.5e-3 · 1e-6) = 5e-5 m, G = 2 · 50 · 5e-5
        assert!((BatchelorObrien.conductance(&contact) / 5e-3 - 1.0).abs() < 1e-14);
        contact.conductivity = [50.0, 12.5];
        assert!((BatchelorObrien.conductance(&contact) / 2e-3 - 1.0).abs() < 1e-14);
        contact.overlap = 0.0;
        assert_eq!(BatchelorObrien.conductance(&contact), 0.0);
    }

    #[test]
    fn grows_with_the_root_of_the_overlap_and_does_not_mind_the_order() {
        let contact = |overlap: f64, radius| SphereContact {
            radius,
            overlap,
            conductivity: [1.0, 3.0],
        };
        let at = |overlap| BatchelorObrien.conductance(&contact(overlap, [1e-3, 4e-3]));
        assert!((at(4e-7) / at(1e-7) - 2.0).abs() < 1e-14);
        let swapped = SphereContact {
            conductivity: [3.0, 1.0],
            ..contact(1e-7, [4e-3, 1e-3])
        };
        assert_eq!(BatchelorObrien.conductance(&swapped), at(1e-7));
    }
}
