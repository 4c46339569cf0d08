//! Which spheres are near each other, and which overlap.

use calcine_interior::Touch;
use calcine_physics::Vec3;

use crate::part::ParticleFields;

/// All pairs of spheres whose surfaces are nearer than `gap` in m, found by cells over a box (its lowest
/// corner and its size in m; what lies outside counts to the nearest cell). The first of a pair is the
/// smaller index; pairs come in the order of the first, then of the cells.
pub fn pairs(
    (corner, size): (Vec3, Vec3),
    radii: &[f64],
    centres: &[Vec3],
    gap: f64,
) -> Vec<[u32; 2]> {
    let reach = 2.0 * radii.iter().copied().fold(0.0, f64::max) + gap;
    // No more cells than spheres along an axis: a wide, thin bed needs no more memory.
    let most = centres.len() as f64;
    let count = [0, 1, 2].map(|axis| (size[axis] / reach).clamp(1.0, most.cbrt().ceil()) as usize);
    let cell = |place: &Vec3| {
        [0, 1, 2].map(|axis| {
            let part = (place[axis] - corner[axis]) / size[axis];
            ((part * count[axis] as f64).max(0.0) as usize).min(count[axis] - 1)
        })
    };
    let index = |[i, j, k]: [usize; 3]| i + count[0] * (j + count[1] * k);
    let mut start = vec![0usize; count[0] * count[1] * count[2] + 1];
    for place in centres {
        start[index(cell(place)) + 1] += 1;
    }
    for i in 1..start.len() {
        start[i] += start[i - 1];
    }
    let (mut next, mut sorted) = (start.clone(), vec![0u32; centres.len()]);
    for (sphere, place) in centres.iter().enumerate() {
        let slot = &mut next[index(cell(place))];
        sorted[*slot] = sphere as u32;
        *slot += 1;
    }
    let mut pairs = Vec::new();
    for (a, place) in centres.iter().enumerate() {
        let at = cell(place);
        let range = |axis: usize| at[axis].saturating_sub(1)..=(at[axis] + 1).min(count[axis] - 1);
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let here = index([i, j, k]);
                    for &b in &sorted[start[here]..start[here + 1]] {
                        let other = b as usize;
                        let cut = radii[a] + radii[other] + gap;
                        if other > a && (centres[other] - place).norm_squared() < cut * cut {
                            pairs.push([a as u32, b]);
                        }
                    }
                }
            }
        }
    }
    pairs
}

/// Pairs of spheres that overlap, in the order of their indices.
pub fn overlapping(radii: &[f64], centres: &[Vec3]) -> Vec<Touch> {
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
    let mut found = pairs((low, size), radii, centres, 0.0);
    found.sort_unstable();
    let touch = |[a, b]: [u32; 2]| {
        let particles = [a as usize, b as usize];
        let radius = particles.map(|p| radii[p]);
        let distance = (centres[particles[1]] - centres[particles[0]]).norm();
        Touch {
            particles,
            radius,
            overlap: radius[0] + radius[1] - distance,
        }
    };
    let touches = found.into_iter().map(touch);
    touches.filter(|touch| touch.overlap > 0.0).collect()
}

/// Particles that overlap.
pub fn touching(particles: &ParticleFields<'_>) -> Vec<Touch> {
    overlapping(particles.radius, particles.position)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let radii: Vec<f64> = (0..count).map(|_| 0.01 + 0.05 * next()).collect();
            let mut slow = Vec::new();
            for a in 0..count {
                for b in a + 1..count {
                    let distance = (centres[b] - centres[a]).norm();
                    if distance < radii[a] + radii[b] {
                        slow.push([a, b]);
                    }
                }
            }
            let fast: Vec<_> = overlapping(&radii, &centres)
                .iter()
                .map(|touch| touch.particles)
                .collect();
            assert_eq!(fast, slow);
        }
    }

    #[test]
    fn an_overlap_is_the_sum_of_the_radii_less_the_distance() {
        let centres = [Vec3::zeros(), Vec3::new(3.0, 4.0, 0.0)];
        let found = overlapping(&[2.0, 3.5], &centres);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].overlap, found[0].radius), (0.5, [2.0, 3.5]));
        assert!(overlapping(&[2.0, 3.0], &centres).is_empty());
        assert!(overlapping(&[], &[]).is_empty());
    }
}
