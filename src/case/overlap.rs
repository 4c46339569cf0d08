//! Particles must not overlap by more than contacts press them together.

use calcine_coupler::contacts::touching;
use calcine_coupler::interior::NeighbourPair;
use calcine_coupler::part::DEEP_CONTACT;
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::setup::ParticleSetup;

use super::model::{Case, MotionSpec};
use super::units::short3;

/// Two particles that overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Overlap {
    /// Indices of the two, the smaller first.
    pub pair: [usize; 2],
    /// Distance of their centres in m.
    pub distance: f64,
    /// Sum of their radii in m.
    pub radii: f64,
}

/// Touching spheres are fine, and so is an overlap of this share of the sum of radii, as spheres have that
/// are pressed together (and conduct heat).
pub(super) const PRESSED: f64 = 0.05;

/// An overlap of this share of the sum of radii is no contact of particles of one population either: softened contacts press
/// settled beds together by some per cent.
pub(super) const CRUSHED: f64 = 0.2;

/// The first particle that overlaps one before it: of another population by more than spheres that are pressed together, of
/// its own, where these are `solid`, by more than the softest contact does.
pub(super) fn first(
    setup: &ParticleSetup,
    periodicity: &Periodicity,
    solid: &[bool],
) -> Option<Overlap> {
    let is_solid = |row: usize| solid.get(setup.population[row] as usize) == Some(&true);
    let too_near = |touch: &NeighbourPair| {
        let [a, b] = touch.particles;
        let radii = touch.radius[0] + touch.radius[1];
        let one = setup.population[a] == setup.population[b];
        let most = if one { CRUSHED } else { PRESSED };
        (!one || is_solid(a)) && touch.overlap > radii * most
    };
    let foreign = setup.population.windows(2).any(|pair| pair[0] != pair[1]);
    if !foreign && !solid.contains(&true) {
        return None;
    }
    let touches = touching(periodicity, &setup.radius, &setup.position, 0.0).into_iter();
    let found = touches
        .filter(too_near)
        .min_by_key(|touch| touch.particles[1])?;
    let radii = found.radius[0] + found.radius[1];
    Some(Overlap {
        pair: found.particles,
        distance: radii - found.overlap,
        radii,
    })
}

/// A warning where particles that move are pressed together farther than contact laws hold before anything runs.
pub(super) fn deepest(
    case: &Case,
    setup: &ParticleSetup,
    periodicity: &Periodicity,
) -> Option<String> {
    let free: Vec<bool> = case
        .particles
        .iter()
        .map(|one| one.motion == MotionSpec::Free)
        .collect();
    let moves = |row: usize| free.get(setup.population[row] as usize) == Some(&true);
    let motion = case.motion.as_ref();
    if !free.contains(&true) || motion.is_none_or(|motion| motion.parcels.is_some()) {
        return None;
    }
    let depth = |touch: &NeighbourPair| touch.overlap / touch.radius[0].min(touch.radius[1]);
    let touches = touching(periodicity, &setup.radius, &setup.position, 0.0);
    let deep = touches
        .iter()
        .filter(|touch| touch.particles.iter().any(|&row| moves(row)))
        .filter(|touch| depth(touch) > DEEP_CONTACT);
    let worst = deep.clone().max_by(|a, b| depth(a).total_cmp(&depth(b)))?;
    let [a, b] = worst.particles.map(|row| setup.id[row]);
    Some(format!(
        "particles overlap by more than {DEEP_CONTACT} of the smaller radius at the start, {a} and {b} by {}{}: contacts drive them apart \
         at once; place them farther apart, or check the unit of their diameters",
        short3(depth(worst)),
        match deep.count() {
            1 => String::new(),
            count => format!(" and {} other pairs", count - 1),
        }
    ))
}

#[cfg(test)]
mod tests {
    use calcine_coupler::physics::Vec3;

    use calcine_coupler::periodicity::PeriodicSpan;

    use super::*;

    fn first(setup: &ParticleSetup, solid: bool) -> Option<Overlap> {
        super::first(setup, &Periodicity::default(), &[solid; 8])
    }

    fn bed(spheres: &[(u32, [f64; 3], f64)]) -> ParticleSetup {
        let mut setup = ParticleSetup::default();
        for &(population, position, radius) in spheres {
            setup.id.push(setup.id.len() as u64 + 1);
            setup.population.push(population);
            setup.position.push(Vec3::from(position));
            setup.radius.push(radius);
            setup.density.push(1.0);
        }
        setup
    }

    #[test]
    fn spheres_of_two_populations_closer_than_their_radii_overlap() {
        let setup = bed(&[(0, [-0.001, 0.0, 0.0], 2.0), (1, [3.0, 4.0, 0.0], 3.5)]);
        let found = first(&setup, false).unwrap();
        assert_eq!(found.pair, [0, 1]);
        assert!((found.distance - 5.0006).abs() < 1e-4);
        assert_eq!(found.radii, 5.5);
    }

    #[test]
    fn touching_spheres_and_pressed_ones_of_one_population_do_not() {
        let touching = bed(&[(0, [0.0; 3], 2.0), (1, [3.0, 4.0, 0.0], 3.0)]);
        assert_eq!(first(&touching, true), None);
        let one = |apart: f64| bed(&[(0, [0.0; 3], 2.0), (0, [apart, 0.0, 0.0], 2.0)]);
        assert_eq!(first(&one(3.4), true), None);
        assert_eq!(first(&one(3.0), true).unwrap().pair, [0, 1]);
        // In one place.
        assert_eq!(first(&one(0.0), true).unwrap().distance, 0.0);
        assert_eq!(first(&one(0.0), false), None);
    }

    #[test]
    fn a_sphere_and_the_image_of_another_overlap_across_a_periodic_plane() {
        let span = PeriodicSpan {
            low: 0.0,
            high: 20.0,
        };
        let periodicity = Periodicity {
            axes: [Some(span), None, None],
        };
        let setup = bed(&[(0, [1.0, 5.0, 5.0], 2.0), (0, [18.8, 5.0, 5.0], 2.0)]);
        assert_eq!(first(&setup, true), None);
        let found = super::first(&setup, &periodicity, &[true]).unwrap();
        assert!((found.distance - 2.2).abs() < 1e-12);
    }
}
