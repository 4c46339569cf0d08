//! Which spheres are near each other, and which overlap.

use calcine_interior::{NeighbourPair, NeighbourWall};
use calcine_physics::Vec3;
use rayon::prelude::*;

use crate::periodicity::Periodicity;
use crate::view_factors::WallSurface;

/// Spheres that one thread looks about at a time.
const CHUNK: usize = 4096;
/// Octaves of sizes that are told apart; what is smaller counts to the last.
const OCTAVES: usize = 16;

/// Spheres in the cells of a grid over a box (its lowest corner and its size in m; what lies outside counts to the
/// nearest cell).
struct Grid {
    corner: Vec3,
    size: Vec3,
    count: [usize; 3],
    /// Where the spheres of each cell begin in `sorted`, and the end.
    start: Vec<usize>,
    sorted: Vec<u32>,
}

impl Grid {
    /// With cells that are `reach` in m wide at least.
    fn new((corner, size): (Vec3, Vec3), centres: &[Vec3], members: &[u32], reach: f64) -> Self {
        // No more cells than spheres along an axis: a wide, thin bed needs no more memory.
        let most = (members.len() as f64).cbrt().ceil();
        let count = [0, 1, 2].map(|axis| (size[axis] / reach).max(1.0).min(most) as usize);
        let mut grid = Self {
            corner,
            size,
            count,
            start: vec![0; count[0] * count[1] * count[2] + 1],
            sorted: vec![0; members.len()],
        };
        let cell = |&member: &u32| grid.index(grid.cell(&centres[member as usize]));
        let cells: Vec<usize> = members.iter().map(cell).collect();
        for &cell in &cells {
            grid.start[cell + 1] += 1;
        }
        for i in 1..grid.start.len() {
            grid.start[i] += grid.start[i - 1];
        }
        let mut next = grid.start.clone();
        for (&member, cell) in members.iter().zip(cells) {
            grid.sorted[next[cell]] = member;
            next[cell] += 1;
        }
        grid
    }

    fn cell(&self, place: &Vec3) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            let part = (place[axis] - self.corner[axis]) / self.size[axis];
            ((part * self.count[axis] as f64).max(0.0) as usize).min(self.count[axis] - 1)
        })
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.count[0] * (j + self.count[1] * k)
    }

    /// The spheres of the cell at a place and of the cells around it.
    fn around(&self, place: &Vec3, mut found: impl FnMut(u32)) {
        let at = self.cell(place);
        let range =
            |axis: usize| at[axis].saturating_sub(1)..=(at[axis] + 1).min(self.count[axis] - 1);
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let here = self.index([i, j, k]);
                    for &sphere in &self.sorted[self.start[here]..self.start[here + 1]] {
                        found(sphere);
                    }
                }
            }
        }
    }
}

/// All pairs of spheres whose surfaces are nearer than `gap` in m, the smaller index first. Spheres of each octave of
/// sizes have a grid of their own over the box (its lowest corner and its size in m), in which smaller ones look for them:
/// the work grows with the number of spheres and not with the ratio of their sizes. Pairs come in the order of the sphere
/// that looks, then of the octaves, then of the cells.
pub fn pairs(bounds: (Vec3, Vec3), radii: &[f64], centres: &[Vec3], gap: f64) -> Vec<[u32; 2]> {
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let octave = |radius: f64| ((largest / radius).log2().max(0.0) as usize).min(OCTAVES - 1);
    let mut members = vec![Vec::new(); OCTAVES];
    for (sphere, &radius) in (0u32..).zip(radii) {
        members[octave(radius)].push(sphere);
    }
    let grid = |members: &Vec<u32>| {
        let radii = members.iter().map(|&member| radii[member as usize]);
        let reach = 2.0 * radii.fold(0.0, f64::max) + gap;
        (!members.is_empty()).then(|| Grid::new(bounds, centres, members, reach))
    };
    let grids: Vec<Option<Grid>> = members.iter().map(grid).collect();
    let search = |first: usize, part: &[Vec3]| {
        let mut pairs = Vec::new();
        for (a, place) in (first..).zip(part) {
            let radius = radii[a];
            let own = octave(radius);
            for (octave, grid) in grids[..=own].iter().enumerate() {
                let Some(grid) = grid else { continue };
                grid.around(place, |b| {
                    let other = b as usize;
                    let cut = radius + radii[other] + gap;
                    // Of an octave of their own, each pair is found by its first.
                    if (octave < own || other > a)
                        && (centres[other] - place).norm_squared() < cut * cut
                    {
                        let a = a as u32;
                        pairs.push([a.min(b), a.max(b)]);
                    }
                });
            }
        }
        pairs
    };
    let parts = centres.par_chunks(CHUNK).enumerate();
    let found: Vec<Vec<[u32; 2]>> = parts
        .map(|(chunk, part)| search(chunk * CHUNK, part))
        .collect();
    found.concat()
}

/// Pairs of spheres whose surfaces are nearer than `gap` in m across a periodic plane, the smaller index first, and the
/// translation of the second that brings it near the first. A pair may be near by several images, and comes with each; a
/// sphere is no pair with its own image. Centres may be anywhere.
pub fn pairs_across(
    periodicity: &Periodicity,
    radii: &[f64],
    centres: &[Vec3],
    gap: f64,
) -> Vec<([u32; 2], Vec3)> {
    if periodicity.is_none() {
        return Vec::new();
    }
    let largest = radii.iter().copied().fold(0.0, f64::max);
    // Spheres that have an image near the domain: others are in no such pair.
    let (mut of, mut seen, mut shifts) = (Vec::new(), Vec::new(), Vec::new());
    for ((sphere, &radius), &centre) in (0u32..).zip(radii).zip(centres) {
        let place = periodicity.wrap(centre);
        for shift in periodicity.images(place, radius + largest + gap) {
            if seen.last() != Some(&sphere) {
                seen.push(sphere);
            }
            of.push(sphere);
            shifts.push(place + shift - centre);
        }
    }
    let own = seen.len();
    let all = seen.iter().chain(&of).map(|&sphere| sphere as usize);
    let (all, radii): (Vec<usize>, Vec<f64>) = all.map(|one| (one, radii[one])).unzip();
    let place = |k: usize| match k.checked_sub(own) {
        Some(image) => centres[all[k]] + shifts[image],
        None => periodicity.wrap(centres[all[k]]),
    };
    let places: Vec<Vec3> = (0..all.len()).map(place).collect();
    let found = near(&radii, &places, gap).into_iter();
    let across = found.filter_map(|[a, b]| {
        let (a, b) = (a as usize, b as usize);
        let pair = [all[a], all[b]];
        // Each is found from both sides: as the first and an image of the second, and as an image of the first.
        if a >= own || b < own || pair[0] >= pair[1] {
            return None;
        }
        let moved = places[a] - centres[pair[0]];
        Some((pair.map(|one| one as u32), shifts[b - own] - moved))
    });
    across.collect()
}

/// Pairs of spheres whose surfaces are nearer than `gap` in m, in the order of their indices.
pub fn near(radii: &[f64], centres: &[Vec3], gap: f64) -> Vec<[u32; 2]> {
    let Some(first) = centres.first() else {
        return Vec::new();
    };
    let (mut low, mut high) = (*first, *first);
    for centre in centres {
        low = low.inf(centre);
        high = high.sup(centre);
    }
    // Never a box without extent.
    let width = radii
        .iter()
        .copied()
        .fold(0.0, f64::max)
        .max(f64::MIN_POSITIVE);
    let size = (high - low).map(|length| length.max(width));
    let mut found = pairs((low, size), radii, centres, gap);
    found.sort_unstable();
    found
}

/// Pairs of spheres whose centres are nearer than `reach` in m, in the order of their indices.
pub fn pairs_around(radii: &[f64], centres: &[Vec3], reach: f64) -> Vec<[u32; 2]> {
    let smallest = radii.iter().copied().fold(f64::INFINITY, f64::min);
    let mut found = near(radii, centres, (reach - 2.0 * smallest).max(0.0));
    let apart = |&[a, b]: &[u32; 2]| centres[b as usize] - centres[a as usize];
    found.retain(|pair| apart(pair).norm_squared() < reach * reach);
    found
}

/// Pairs of spheres that overlap, or whose surfaces are nearer than `gap` in m, in the order of their indices, across
/// periodic planes too; a pair that touches by several images comes with each.
pub fn touching(
    periodicity: &Periodicity,
    radii: &[f64],
    centres: &[Vec3],
    gap: f64,
) -> Vec<NeighbourPair> {
    let wrapped: Vec<Vec3> = match periodicity.is_none() {
        true => Vec::new(),
        false => centres.iter().map(|&at| periodicity.wrap(at)).collect(),
    };
    let centres = match periodicity.is_none() {
        true => centres,
        false => &wrapped,
    };
    let touch = |([a, b], shift): ([u32; 2], Vec3)| {
        let particles = [a as usize, b as usize];
        let radius = particles.map(|p| radii[p]);
        let distance = (centres[particles[1]] - centres[particles[0]] + shift).norm();
        NeighbourPair {
            particles,
            radius,
            overlap: radius[0] + radius[1] - distance,
        }
    };
    let within = near(radii, centres, gap).into_iter();
    let mut found: Vec<_> = within.map(|pair| (pair, Vec3::zeros())).collect();
    found.extend(pairs_across(periodicity, radii, centres, gap));
    // Those of a pair stay in their order.
    found.sort_by_key(|one| one.0);
    let touches = found.into_iter().map(touch);
    touches.filter(|touch| touch.overlap > -gap).collect()
}

/// Spheres that overlap a wall, or whose surfaces are nearer to it than `gap` in m; walls with the reservoirs
/// that they are.
pub fn touching_walls<'w>(
    radii: &[f64],
    centres: &[Vec3],
    walls: impl Iterator<Item = (usize, &'w WallSurface)>,
    gap: f64,
) -> Vec<NeighbourWall> {
    let mut found = Vec::new();
    for (reservoir, surface) in walls {
        for (particle, (&radius, &centre)) in radii.iter().zip(centres).enumerate() {
            let overlap = radius - surface.distance(centre, radius + gap);
            if overlap > -gap {
                found.push(NeighbourWall {
                    particle,
                    reservoir,
                    radius,
                    overlap,
                });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::periodicity::PeriodicSpan;

    fn touching(radii: &[f64], centres: &[Vec3], gap: f64) -> Vec<NeighbourPair> {
        super::touching(&Periodicity::default(), radii, centres, gap)
    }

    /// Numbers in [0, 1) of a linear congruential generator (Knuth's MMIX constants).
    fn scatter() -> impl FnMut() -> f64 {
        let mut state = 1u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn the_cells_find_what_the_search_over_all_pairs_finds() {
        let mut next = scatter();
        for round in 0..50 {
            let count = 3 * round;
            let centres: Vec<Vec3> = (0..count)
                .map(|_| Vec3::new(next() - 0.5, 3.0 * next(), 0.1 * next()))
                .collect();
            // Of one octave of sizes, and of ten.
            let smallest: f64 = if round % 2 == 0 { 0.4 } else { 1e-3 };
            let radii: Vec<f64> = (0..count).map(|_| 0.06 * smallest.powf(next())).collect();
            let mut slow = Vec::new();
            for a in 0..count {
                for b in a + 1..count {
                    let distance = (centres[b] - centres[a]).norm();
                    if distance < radii[a] + radii[b] {
                        slow.push([a, b]);
                    }
                }
            }
            let fast: Vec<_> = touching(&radii, &centres, 0.0)
                .iter()
                .map(|touch| touch.particles)
                .collect();
            assert_eq!(fast, slow);
        }
    }

    #[test]
    fn pairs_across_periodic_planes_are_those_within_a_bed_that_is_moved() {
        let span = |high: f64| Some(PeriodicSpan { low: 0.0, high });
        let periodicity = Periodicity {
            axes: [span(0.9), None, span(0.7)],
        };
        let mut next = scatter();
        for round in 1..40 {
            let count = 4 * round;
            let centres: Vec<Vec3> = (0..count)
                .map(|_| Vec3::new(0.9 * next(), 0.8 * next(), 0.7 * next()))
                .collect();
            let radii: Vec<f64> = (0..count).map(|_| 0.12 * 0.3f64.powf(next())).collect();
            let mut slow = Vec::new();
            for a in 0..count {
                for b in a + 1..count {
                    for image in 0..9 {
                        let [x, z] = [image % 3, image / 3].map(|k| f64::from(k) - 1.0);
                        let apart = centres[b] - centres[a] + Vec3::new(0.9 * x, 0.0, 0.7 * z);
                        let overlap = radii[a] + radii[b] - apart.norm();
                        if overlap > -0.01 {
                            slow.push(([a, b], overlap));
                        }
                    }
                }
            }
            let found = super::touching(&periodicity, &radii, &centres, 0.01);
            assert_eq!(found.len(), slow.len());
            // Of two images of a pair the order may differ.
            let mut fast: Vec<_> = found
                .iter()
                .map(|one| (one.particles, one.overlap))
                .collect();
            for list in [&mut fast, &mut slow] {
                list.sort_by(|one, other| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
            }
            for (found, wanted) in fast.iter().zip(&slow) {
                assert_eq!(found.0, wanted.0);
                assert!((found.1 - wanted.1).abs() < 1e-15);
            }
            // A sphere that stands in another period is as its image.
            let mut away = centres.clone();
            away[0].x -= 1.8;
            away[1].z += 0.7;
            let found: Vec<_> = super::touching(&periodicity, &radii, &away, 0.01)
                .iter()
                .map(|one| one.particles)
                .collect();
            let wanted: Vec<_> = fast.iter().map(|one| one.0).collect();
            assert_eq!(found, wanted);
        }
    }

    #[test]
    fn an_overlap_is_the_sum_of_the_radii_less_the_distance() {
        let centres = [Vec3::zeros(), Vec3::new(3.0, 4.0, 0.0)];
        let found = touching(&[2.0, 3.5], &centres, 0.0);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].overlap, found[0].radius), (0.5, [2.0, 3.5]));
        assert!(touching(&[2.0, 3.0], &centres, 0.0).is_empty());
        assert!(touching(&[], &[], 0.0).is_empty());
    }

    #[test]
    fn gaps_and_walls_count_up_to_their_width() {
        let centres = [Vec3::new(0.0, 0.0, 1.1), Vec3::new(2.5, 0.0, 0.9)];
        let pairs = touching(&[1.0; 2], &centres, 0.6);
        assert!((pairs[0].overlap + (6.29_f64.sqrt() - 2.0)).abs() < 1e-14);
        assert!(touching(&[1.0; 2], &centres, 0.4).is_empty());
        assert_eq!(pairs_around(&[1.0; 2], &centres, 2.51), [[0, 1]]);
        assert!(pairs_around(&[1.0; 2], &centres, 2.5).is_empty());
        let floor = WallSurface::new(&crate::motion::WallShape::Plane {
            point: Vec3::zeros(),
            normal: Vec3::z(),
        });
        let found = touching_walls(&[1.0; 2], &centres, [(4, &floor)].into_iter(), 0.2);
        let overlaps: Vec<f64> = found.iter().map(|one| one.overlap).collect();
        assert!((overlaps[0] + 0.1).abs() < 1e-15 && (overlaps[1] - 0.1).abs() < 1e-15);
        assert!(found.iter().all(|one| one.reservoir == 4));
        assert_eq!(
            touching_walls(&[1.0; 2], &centres, [(4, &floor)].into_iter(), 0.0).len(),
            1
        );
    }
}
