//! Conduction by the area of the lens of two overlapping spheres, as LIGGGHTS computes it.

use super::model::{Conduction, SphereContact};
use crate::law::LawEntry;

/// Conduction through the circle in which two spheres cut each other.
///
/// G = 4 k₁k₂/(k₁ + k₂) √A, A = π r², with the radius r of the circle of intersection (docs/theory.md,
/// COR-17). The circle of equal spheres has r² ≈ R δ = 2 R* δ at small overlaps, so that G is there √π times
/// the form of Batchelor and O'Brien with the same contact radius, and √(2π) = 2.51 times with the same
/// overlap.
///
/// Validity: a model of LIGGGHTS (fix heat/gran/conduction), here for comparison with it; it overstates
/// the conductance of a contact of the real overlap.
///
/// Source: LIGGGHTS-PUBLIC 3.8; Chaudhuri, Muzzio and Tomassone, Chem. Eng. Sci. 61 (2006) 6348,
/// doi 10.1016/j.ces.2006.05.034.
#[derive(Clone, Copy, Debug)]
pub struct Lens;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Conduction> = LawEntry {
    name: "lens",
    summary: "By the circle in which two spheres cut each other, as LIGGGHTS has it; for comparison with it.",
    source: "Chaudhuri, Muzzio and Tomassone, Chem. Eng. Sci. 61 (2006) 6348, doi 10.1016/j.ces.2006.05.034",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Lens),
};

impl Conduction for Lens {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn conductance(&self, contact: &SphereContact) -> f64 {
        2.0 * contact.conductivity() * contact.intersection().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_circle_of_equal_spheres_follows_from_pythagoras() {
        let contact = SphereContact {
            radius: [1.0, 1.0],
            overlap: 0.4,
            conductivity: [3.0, 3.0],
        };
        // Centres 1.6 apart: r² = 1 − 0.64, √A = √π 0.6
        let expected = 2.0 * 3.0 * PI.sqrt() * 0.6;
        assert!((Lens.conductance(&contact) / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_wall_cuts_the_circle_that_the_sphere_shows_it() {
        let mut contact = SphereContact {
            radius: [1.0, f64::INFINITY],
            overlap: 0.2,
            conductivity: [3.0, 3.0],
        };
        let expected = 2.0 * 3.0 * PI.sqrt() * 0.6;
        assert!((Lens.conductance(&contact) / expected - 1.0).abs() < 1e-14);
        contact.radius[1] = 1e9;
        assert!((Lens.conductance(&contact) / expected - 1.0).abs() < 1e-6);
    }
}
