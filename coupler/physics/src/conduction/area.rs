//! Whose overlap a contact conducts by: that of the computed, soft spheres, or of the real ones.

use super::model::reduced;
use crate::contact::{ContactModel, HertzMindlin, Linear, PairConstants};
use crate::sphere;

/// Elastic constants of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Young's modulus in Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

/// Elastic normal force that belongs to an overlap in the computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElasticLaw {
    /// Hertz: 4/3 E* √R* δ^1.5.
    Hertz,
    /// A linear spring of a characteristic speed in m/s.
    Linear {
        /// Characteristic speed of impact in m/s.
        speed: f64,
    },
    /// A linear spring of a stiffness in N/m.
    Springs {
        /// Stiffness in N/m.
        stiffness: f64,
    },
}

/// The overlap by which a contact conducts.
///
/// Moving beds are computed with a Young's modulus some orders below the real one, so that time steps are
/// long enough; their overlaps, and with them all contact areas, are too large. The force is right, though:
/// it carries the weight of the bed. `Force` therefore takes the elastic force F of the computed overlap and
/// gives the overlap that Hertz' law has for it with the real modulus,
///
/// δ_r = (3 F/(4 E*_r √R*))^(2/3),   1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂.
///
/// Where both obey Hertz it is δ (E*/E*_r)^(2/3), and the contact radius shrinks by (E*/E*_r)^(1/3): the
/// correction of Zhou, Yu and Zulli, Powder Technol. 197 (2010) 102, doi 10.1016/j.powtec.2009.09.002. `Load`
/// is for beds that geometry alone has made, whose overlaps mean nothing.
///
/// Validity: contacts that last; an impact's duration also changes with the modulus, which this leaves out.
///
/// Source: Hertz, J. reine angew. Math. 92 (1882) 156.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactArea {
    /// The overlap as it is.
    Overlap,
    /// That of the real materials under the computed elastic force.
    Force(ElasticLaw),
    /// That of the real materials under one force on every pair whose surfaces are near enough.
    Load {
        /// The force in N.
        force: f64,
        /// The widest gap in m that still counts as a contact.
        within: f64,
    },
}

impl ContactArea {
    /// The widest gap in m that still counts as a contact.
    pub fn within(&self) -> f64 {
        match self {
            Self::Load { within, .. } => *within,
            Self::Overlap | Self::Force(_) => 0.0,
        }
    }

    /// The overlap in m that conducts, zero where there is no contact; from radii and computed overlap
    /// (negative for a gap) in m, densities in kg/m³, and the computed and the real stiffness of both.
    pub fn overlap(
        &self,
        radius: [f64; 2],
        overlap: f64,
        density: [f64; 2],
        soft: [Stiffness; 2],
        real: [Stiffness; 2],
    ) -> f64 {
        let effective = reduced(radius);
        let hertz = |force: f64| {
            let young = pair(real).young;
            (0.75 * force / (young * effective.sqrt())).powf(2.0 / 3.0)
        };
        match *self {
            Self::Overlap => overlap.max(0.0),
            Self::Force(_) if overlap <= 0.0 => 0.0,
            Self::Force(law) => {
                let mass = [0, 1].map(|i| sphere::mass(radius[i], density[i]));
                let (pair, mass) = (pair(soft), reduced(mass));
                hertz(match law {
                    ElasticLaw::Hertz => {
                        let springs = HertzMindlin.springs(&pair, 0.0, overlap, effective, mass);
                        springs.elastic
                    }
                    ElasticLaw::Linear { speed } => {
                        Linear { speed }.prepare(&pair, effective, mass) * overlap
                    }
                    ElasticLaw::Springs { stiffness } => stiffness * overlap,
                })
            }
            Self::Load { force, within } if overlap >= -within => hertz(force),
            Self::Load { .. } => 0.0,
        }
    }
}

fn pair(of: [Stiffness; 2]) -> PairConstants {
    let [first, second] = of.map(|one| [one.young, one.poisson]);
    PairConstants::new(first, second, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conduction::{BatchelorObrien, Conduction, SphereContact};
    use std::f64::consts::PI;

    const SOFT: Stiffness = Stiffness {
        young: 1e7,
        poisson: 0.25,
    };
    const STEEL: Stiffness = Stiffness {
        young: 2e11,
        poisson: 0.25,
    };
    const FORCE: ContactArea = ContactArea::Force(ElasticLaw::Hertz);

    fn real(area: ContactArea, radius: [f64; 2], overlap: f64) -> f64 {
        area.overlap(radius, overlap, [7800.0; 2], [SOFT; 2], [STEEL; 2])
    }

    #[test]
    fn between_hertzian_contacts_the_overlap_shrinks_with_the_moduli_to_two_thirds() {
        let overlap = real(FORCE, [1e-3, 3e-3], 2e-6);
        assert!((overlap / (2e-6 * (1e7_f64 / 2e11).powf(2.0 / 3.0)) - 1.0).abs() < 1e-13);
        assert_eq!(real(FORCE, [1e-3; 2], -1e-9), 0.0);
        assert_eq!(real(ContactArea::Overlap, [1e-3; 2], 2e-6), 2e-6);
    }

    #[test]
    fn a_softened_contact_conducts_as_the_real_one_under_the_same_force() {
        // The same weight pressed on the soft and the real sphere, by Hertz' law written out here.
        let (force, radius) = (0.3_f64, 2.5e-3_f64);
        let hertz = |young: f64| (0.75 * force / (young * radius.sqrt())).powf(2.0 / 3.0);
        let star = |e: f64| e / (2.0 * (1.0 - 0.0625));
        let conductance = |overlap: f64| {
            BatchelorObrien.conductance(&SphereContact {
                radius: [5e-3; 2],
                overlap,
                conductivity: [50.0; 2],
            })
        };
        let soft = hertz(star(1e7));
        let corrected = conductance(real(FORCE, [5e-3; 2], soft));
        let exact = conductance(hertz(star(2e11)));
        assert!((corrected / exact - 1.0).abs() < 1e-12);
        // Without the correction it is (2e11/1e7)^(1/3) = 27.1 times too large.
        assert!((conductance(soft) / exact - 27.144).abs() < 1e-3);
    }

    #[test]
    fn a_linear_spring_gives_its_own_force() {
        let law = ElasticLaw::Linear { speed: 0.5 };
        let area = ContactArea::Force(law);
        // k in proportion to the overlap, so that δ_r grows with its power 2/3.
        let ratio = real(area, [1e-3; 2], 8e-6) / real(area, [1e-3; 2], 1e-6);
        assert!((ratio - 4.0).abs() < 1e-12);
        // At the overlap where both springs store ½ m V²:
        // ½ k δ² = 2/5 F_h δ, so that F = k δ = 4/5 F_h.
        let mass = 0.5 * 4.0 / 3.0 * PI * 1e-9 * 7800.0;
        let stiffness = Linear { speed: 0.5 }.prepare(&pair([SOFT; 2]), 0.5e-3, mass);
        let deepest = 0.5 * (mass / stiffness).sqrt();
        let ratio = real(area, [1e-3; 2], deepest) / real(FORCE, [1e-3; 2], deepest);
        assert!((ratio - 0.8_f64.powf(2.0 / 3.0)).abs() < 1e-12, "{ratio}");
    }

    #[test]
    fn a_load_presses_every_pair_that_is_near_and_no_other() {
        let area = ContactArea::Load {
            force: 0.05,
            within: 1e-5,
        };
        // 0.75 · 0.05/(1.0666667e11 · √2.5e-3) = 7.03125e-12, to the power 2/3.
        for overlap in [-1e-5, 0.0, 3e-5] {
            let made = real(area, [5e-3; 2], overlap);
            assert!((made / 3.670_4e-8 - 1.0).abs() < 1e-4, "{made}");
        }
        assert_eq!(real(area, [5e-3; 2], -1.1e-5), 0.0);
        // Against a wall R* is the sphere's radius.
        let wall = real(area, [5e-3, f64::INFINITY], 0.0);
        assert!((wall / real(area, [5e-3; 2], 0.0) - 0.5_f64.powf(1.0 / 3.0)).abs() < 1e-12);
    }
}
