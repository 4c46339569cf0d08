//! Conduction by the area of the lens of two overlapping spheres, as LIGGGHTS computes it.

use std::f64::consts::PI;

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
        let [own, other] = contact.radius;
        if other.is_infinite() {
            // A plane cuts the sphere: r² = R² − (R − δ)².
            let area = PI * contact.overlap * (2.0 * own - contact.overlap);
            return 2.0 * contact.conductivity() * area.max(0.0).sqrt();
        }
        let d = own + other - contact.overlap;
        // Heron: 16 times the square of the triangle of both radii and the distance is 4 d² r².
        let product = (own + other - d) * (d + own - other) * (d - own + other) * (d + own + other);
        let area = PI * product.max(0.0) / (4.0 * d * d);
        2.0 * contact.conductivity() * area.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conduction::BatchelorObrien;

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

    #[test]
    fn at_small_overlap_it_is_root_two_pi_times_batchelor_and_obrien() {
        let contact = SphereContact {
            radius: [5e-3, 5e-3],
            overlap: 1e-9,
            conductivity: [50.0, 50.0],
        };
        let ratio = Lens.conductance(&contact) / BatchelorObrien.conductance(&contact);
        assert!((ratio / (2.0 * PI).sqrt() - 1.0).abs() < 1e-5, "{ratio}");
    }
}
