//! Particles of different populations must not overlap.

use std::collections::HashMap;

use calcine_coupler::setup::ParticleSetup;

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

/// Touching spheres are fine; this share of the sum of radii is round-off of the units.
const ROUND_OFF: f64 = 1e-9;

/// The first particle that overlaps one of another population before it. Cells as wide as the
/// largest particle make the work proportional to the number of particles.
pub(super) fn between_populations(setup: &ParticleSetup) -> Option<Overlap> {
    let first = setup.population.first()?;
    if setup
        .population
        .iter()
        .all(|population| population == first)
    {
        return None;
    }
    let width = 2.0 * setup.radius.iter().copied().fold(0.0, f64::max);
    // Each cell's last particle, and before each particle the one that came into its cell earlier.
    let mut last: HashMap<[i64; 3], usize> = HashMap::with_capacity(setup.position.len());
    let mut earlier: Vec<Option<usize>> = Vec::with_capacity(setup.position.len());
    for (index, position) in setup.position.iter().enumerate() {
        let cell = [0, 1, 2].map(|axis| (position[axis] / width).floor() as i64);
        for neighbour in neighbours(cell) {
            let mut other = last.get(&neighbour).copied();
            while let Some(candidate) = other {
                let radii = setup.radius[index] + setup.radius[candidate];
                let distance = (position - setup.position[candidate]).norm();
                if setup.population[index] != setup.population[candidate]
                    && distance < radii * (1.0 - ROUND_OFF)
                {
                    let pair = [candidate, index];
                    return Some(Overlap {
                        pair,
                        distance,
                        radii,
                    });
                }
                other = earlier[candidate];
            }
        }
        earlier.push(last.insert(cell, index));
    }
    None
}

/// A cell and the 26 around it.
fn neighbours(cell: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27).map(move |n| {
        let step = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
        [0, 1, 2].map(|axis| cell[axis].saturating_add(step[axis]))
    })
}

#[cfg(test)]
mod tests {
    use calcine_coupler::physics::Vec3;

    use super::*;

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
        let found = between_populations(&setup).unwrap();
        assert_eq!(found.pair, [0, 1]);
        assert!((found.distance - 5.0006).abs() < 1e-4);
        assert_eq!(found.radii, 5.5);
    }

    #[test]
    fn touching_spheres_and_those_of_one_population_do_not() {
        let touching = bed(&[(0, [0.0; 3], 2.0), (1, [3.0, 4.0, 0.0], 3.0)]);
        assert_eq!(between_populations(&touching), None);
        let one = bed(&[(0, [0.0; 3], 2.0), (0, [1.0, 0.0, 0.0], 2.0)]);
        assert_eq!(between_populations(&one), None);
    }

    #[test]
    fn the_cells_find_what_the_search_over_all_pairs_finds() {
        // Points of a linear congruential generator (Knuth's MMIX constants).
        let mut state = 1u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..200 {
            let spheres: Vec<_> = (0..40)
                .map(|n| {
                    let point = [next() - 0.5, next() - 0.5, next() - 0.5];
                    (n % 2, point, 0.01 + 0.03 * next())
                })
                .collect();
            let setup = bed(&spheres);
            let slow = (0..40usize)
                .flat_map(|b| (0..b).map(move |a| (a, b)))
                .any(|(a, b)| {
                    let distance = (setup.position[a] - setup.position[b]).norm();
                    setup.population[a] != setup.population[b]
                        && distance < setup.radius[a] + setup.radius[b]
                });
            assert_eq!(between_populations(&setup).is_some(), slow);
        }
    }
}
