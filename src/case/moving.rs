//! The populations of a case that move, as spheres of their materials.

use calcine_coupler::motion::Elastic;
use calcine_coupler::setup::ParticleSetup;

use super::model::{Case, MotionSpec};

/// A population that moves.
pub(super) struct MovingSpheres {
    /// Index of the population.
    pub population: usize,
    /// True where two of them may meet: more than one is there, or a feed brings them.
    pub several: bool,
    /// Smallest and largest radius in m, of what is placed, or else of what may be fed.
    pub radius: [f64; 2],
    /// Density in kg/m³.
    pub density: f64,
    /// Elastic constants of their material.
    pub elastic: Elastic,
}

/// The populations that move and whose material has elastic constants.
pub(super) fn moving_spheres(
    case: &Case,
    setup: &ParticleSetup,
) -> impl Iterator<Item = MovingSpheres> {
    let populations = case.particles.iter().enumerate();
    let populations = populations.filter(|(_, one)| one.motion == MotionSpec::Free);
    populations.filter_map(|(index, population)| {
        let material = &case.materials[population.material];
        let elastic = Elastic {
            young: material.young?,
            poisson: material.poisson?,
        };
        let own = setup.population.iter().zip(&setup.radius);
        let own = own.filter(|(of, _)| **of as usize == index);
        let placed = own.clone().map(|(_, radius)| [*radius; 2]);
        let placed = placed.reduce(|all, one| [all[0].min(one[0]), all[1].max(one[1])]);
        let sizes = &population.sizes;
        let fed = case.feeds.iter().any(|feed| feed.population == index);
        Some(MovingSpheres {
            population: index,
            several: fed || own.count() != 1,
            radius: placed.unwrap_or([0.5 * sizes.smallest(), 0.5 * sizes.largest()]),
            density: material.density,
            elastic,
        })
    })
}
