//! Conduction by the circle in which two spheres cut each other.

use std::f64::consts::PI;

use super::model::{Conduction, SphereContact};
use crate::law::LawEntry;

/// Conduction through the circular contact of two spheres with the radius of geometry in place of Hertz'.
///
/// G = 2 k r, k = 2 k₁k₂/(k₁ + k₂), r² = R₁² − ((d² + R₁² − R₂²)/(2 d))² (docs/theory.md, COR-17)
///
/// of two spheres whose centres are d apart, which for equal ones is R² − (d/2)². At small overlaps r² = 2 R* δ, so that G is √2
/// times the form of Batchelor and O'Brien with the same overlap. In the form A/R_th, A = π r² and R_th = π r/(2 k).
///
/// Validity: a model of codes that count the overlap as the contact (MFiX-DEM), here for comparison with them. With `area =
/// "force"` or `"load"` it is of the overlap of the real material.
///
/// Source: Batchelor and O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313, doi 10.1098/rspa.1977.0100, with the radius of
/// Musser, Carney and Picarelli, Int. J. Heat Mass Transf. 84 (2015) 1070.
#[derive(Clone, Copy, Debug)]
pub struct Geometric;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Conduction> = LawEntry {
    name: "geometric",
    summary: "By the radius of the circle in which two spheres cut each other.",
    source: "Batchelor and O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313, doi 10.1098/rspa.1977.0100; Musser, Carney and Picarelli, Int. J. Heat Mass Transf. 84 (2015) 1070",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Geometric),
};

impl Conduction for Geometric {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn conductance(&self, contact: &SphereContact) -> f64 {
        2.0 * contact.conductivity() * (contact.intersection() / PI).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_spheres_have_the_radius_of_pythagoras() {
        let contact = SphereContact {
            radius: [1.0, 1.0],
            overlap: 0.4,
            conductivity: [3.0, 3.0],
        };
        // Centres 1.6 apart: r² = 1 − 0.64.
        assert!((Geometric.conductance(&contact) / (2.0 * 3.0 * 0.6) - 1.0).abs() < 1e-14);
        let apart = SphereContact {
            overlap: 0.0,
            ..contact
        };
        assert!(Geometric.conductance(&apart) < 1e-7);
    }

    #[test]
    fn unequal_spheres_and_a_wall_have_the_radius_of_their_triangle() {
        // Radii 13 and 15 at a distance of 14: the height of the triangle 13, 14, 15 is 12.
        let mut contact = SphereContact {
            radius: [13.0, 15.0],
            overlap: 14.0,
            conductivity: [2.0, 2.0],
        };
        assert!((Geometric.conductance(&contact) / 48.0 - 1.0).abs() < 1e-14);
        // A plane at a distance of 5 from the centre of a sphere of 13: 12 again.
        contact.radius[1] = f64::INFINITY;
        contact.overlap = 8.0;
        assert!((Geometric.conductance(&contact) / 48.0 - 1.0).abs() < 1e-14);
    }
}
