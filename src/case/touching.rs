//! Who can touch whom, and how stiff such contacts are.

use calcine_coupler::motion::Elastic;
use calcine_coupler::physics::contact::PairConstants;
use calcine_coupler::physics::sphere;
use calcine_coupler::setup::ParticleSetup;

use super::model::{Case, MotionSpec};
use super::moving::{MovingSpheres, moving_spheres};

/// A contact of the smallest sphere of a population that moves, with what it can touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Touching {
    /// Young's modulus in Pa that spheres of its Poisson's ratio have whose contact with each other is as stiff, its own at most: what
    /// it touches may be softer.
    pub young: f64,
    /// Effective mass in kg.
    pub mass: f64,
    /// Effective radius in m.
    pub radius: f64,
}

/// All contacts of a population. A particle that is alone touches none of its kind.
pub(super) fn touching(case: &Case, setup: &ParticleSetup, one: &MovingSpheres) -> Vec<Touching> {
    let radius = one.radius[0];
    let mass = sphere::mass(radius, one.density);
    let mut all = Vec::new();
    if one.several {
        all.push(Touching {
            young: one.elastic.young,
            mass: 0.5 * mass,
            radius: 0.5 * radius,
        });
    }
    for other in moving_spheres(case, setup).filter(|other| other.population != one.population) {
        let (near, heavy) = (
            other.radius[0],
            sphere::mass(other.radius[0], other.density),
        );
        all.push(Touching {
            young: softer(one.elastic, other.elastic),
            mass: mass * heavy / (mass + heavy),
            radius: radius * near / (radius + near),
        });
    }
    // What stays where it is has no end of mass, and is no rounder than a plane.
    let held = case
        .particles
        .iter()
        .filter(|other| other.motion == MotionSpec::Frozen);
    let still = held
        .map(|other| other.material)
        .chain(case.walls.iter().map(|wall| wall.material));
    let still = still.filter_map(|material| {
        let material = &case.materials[material];
        Some(Elastic {
            young: material.young?,
            poisson: material.poisson?,
        })
    });
    all.extend(still.map(|elastic| Touching {
        young: softer(one.elastic, elastic),
        mass,
        radius,
    }));
    all
}

/// The modulus in Pa of spheres of a material's Poisson's ratio whose contact is as stiff as that of the material with another one, its
/// own at most.
fn softer(own: Elastic, other: Elastic) -> f64 {
    if own == other {
        return own.young;
    }
    let [first, second] = [own, other].map(|one| [one.young, one.poisson]);
    let pair = PairConstants::new(first, second, 1.0);
    own.young
        .min(2.0 * (1.0 - own.poisson * own.poisson) * pair.young)
}
