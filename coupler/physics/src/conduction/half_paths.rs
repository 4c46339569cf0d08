//! Conduction through the cores of two spheres, from centre to contact, as XDEM computes it.

use super::model::{Conduction, SphereContact};
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter};

/// Conduction along the line of centres, through a column as wide as the contact.
///
/// G = s A/(d (1/k₁ + 1/k₂)), A = π r², with the radius r of the circle of intersection and the distance d of the centres (docs/theory.md,
/// COR-17). Two half paths of d/2 in series are s = 2, the default; the paper of XDEM prints the equation without it, s = 1 (requirements
/// DEC-T5). A flat wall is at its temperature where the sphere touches it: s/2 A k₁/(R₁ − δ).
///
/// The column leaves out that heat spreads inside a sphere: G grows with the overlap δ, where laws of constricted heat flow grow with its
/// root, and between equal spheres it is s π r/(4 d) of 2 k r with the same radius.
///
/// Validity: a model of XDEM, here for comparison with it; it understates contacts that are narrow against the spheres.
///
/// Source: Copertaro et al., Engineering Journal 20(5) (2016) 187, doi 10.4186/ej.2016.20.5.187, eq 16.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPaths {
    /// s: 2 for half paths in series, 1 as printed.
    pub series_factor: f64,
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Conduction> = LawEntry {
    name: "half-paths",
    summary: "Along the line of centres, through a column as wide as the contact, as XDEM has it; for comparison with it.",
    source: "Copertaro et al., Engineering Journal 20(5) (2016) 187, doi 10.4186/ej.2016.20.5.187, eq 16",
    parameters: &[LawParameter {
        name: "series_factor",
        dimension: Dimension::NONE,
        bound: Bound::Between(1.0, 2.0),
        default: Some(2.0),
        needed_with: None,
        meaning: "2: both half paths in series; 1: the equation as XDEM prints it, half of that.",
        example: "1",
    }],
    tables: &[],
    make: |values| {
        Box::new(HalfPaths {
            series_factor: values[0],
        })
    },
};

impl Conduction for HalfPaths {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn conductance(&self, contact: &SphereContact) -> f64 {
        let [own, other] = contact.radius;
        let path = if other.is_infinite() {
            2.0 * (own - contact.overlap) / contact.conductivity[0]
        } else {
            let between = own + other - contact.overlap;
            between / contact.conductivity[0] + between / contact.conductivity[1]
        };
        self.series_factor * contact.intersection() / path
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const LAW: HalfPaths = HalfPaths { series_factor: 2.0 };

    fn contact(radius: [f64; 2], overlap: f64, conductivity: [f64; 2]) -> SphereContact {
        SphereContact {
            radius,
            overlap,
            conductivity,
        }
    }

    /// Grains of 78 µm radius and 2 W/m/K that overlap by 1 µm: d = 155 µm, r² = 78² − 77.5² = 77.75 µm², A = 244.2588 µm²,
    /// G = A k/d = 3.151727e-6 W/K.
    #[test]
    fn agrees_with_an_independent_evaluation() {
        let made = LAW.conductance(&contact([78e-6; 2], 1e-6, [2.0; 2]));
        assert!((made / 3.151_727e-6 - 1.0).abs() < 1e-6, "{made}");
    }

    #[test]
    fn two_half_paths_in_series_are_one_rod_and_half_of_it_as_printed() {
        // A rod of the area of the contact, one half of it of 3 W/m/K and the other of 6 W/m/K, between centres 1.6 apart.
        let contact = contact([1.0; 2], 0.4, [3.0, 6.0]);
        let area = PI * 0.36;
        let rod = 1.0 / (0.8 / (3.0 * area) + 0.8 / (6.0 * area));
        assert!((LAW.conductance(&contact) / rod - 1.0).abs() < 1e-14);
        let printed = HalfPaths { series_factor: 1.0 };
        assert!((printed.conductance(&contact) / rod - 0.5).abs() < 1e-14);
    }

    #[test]
    fn a_wall_ends_the_path_where_it_is_touched() {
        // A plane at 0.8 of the radius: a rod of 0.8 and of the area π 0.36, whatever the wall conducts.
        for wall in [0.1, 75.0] {
            let made = LAW.conductance(&contact([1.0, f64::INFINITY], 0.2, [3.0, wall]));
            assert!((made / (3.0 * PI * 0.36 / 0.8) - 1.0).abs() < 1e-14);
        }
        assert_eq!(LAW.conductance(&contact([1.0; 2], 0.0, [3.0; 2])), 0.0);
    }
}
