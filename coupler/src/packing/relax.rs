//! Removal of overlaps: each overlapping pair in turn moves apart, then walls push inwards.

use calcine_physics::Vec3;

use super::Container;

/// Pairs are parted a little farther than contact, so that overlaps end after finitely many sweeps.
const MARGIN: f64 = 1e-3;
/// Reach of the neighbour list beyond contact, in largest diameters.
const SKIN: f64 = 0.3;
/// Sweeps before giving up.
const SWEEPS: usize = 20_000;
/// Sweeps between two looks at the overlap.
const LOOK: usize = 10;

/// Moves centres (m) until no spheres overlap. Returns the largest overlap that is left over the
/// sum of the pair's radii, 0 if none is. In one fixed order: the same bits on any machine.
pub(super) fn relax(container: &Container, radii: &[f64], centres: &mut [Vec3]) -> f64 {
    let largest = 2.0 * radii.iter().copied().fold(0.0, f64::max);
    let skin = SKIN * largest;
    let mut listed = centres.to_vec();
    let mut pairs = neighbours(container, radii, centres, largest * (1.0 + MARGIN) + skin);
    for sweep in 0..SWEEPS {
        let moved = |(new, old): (&Vec3, &Vec3)| (new - old).norm_squared();
        let farthest = centres.iter().zip(&listed).map(moved).fold(0.0, f64::max);
        // The list is renewed before two spheres that it lacks can touch.
        if farthest > 0.25 * (0.5 * skin) * (0.5 * skin) {
            listed.copy_from_slice(centres);
            pairs = neighbours(container, radii, centres, largest * (1.0 + MARGIN) + skin);
        }
        if sweep % LOOK == 0 && overlap(&pairs, radii, centres) <= 0.0 {
            return 0.0;
        }
        for &[a, b] in &pairs {
            let (a, b) = (a as usize, b as usize);
            let apart = (radii[a] + radii[b]) * (1.0 + MARGIN);
            let line = centres[b] - centres[a];
            let square = line.norm_squared();
            if square < apart * apart {
                let distance = square.sqrt();
                let way = if distance > 0.0 {
                    line / distance
                } else {
                    Vec3::z()
                };
                let push = 0.5 * (apart - distance) * way;
                centres[a] -= push;
                centres[b] += push;
            }
        }
        for (centre, &radius) in centres.iter_mut().zip(radii) {
            *centre = container.inside(*centre, radius);
        }
    }
    let pairs = neighbours(container, radii, centres, largest);
    overlap(&pairs, radii, centres)
}

fn overlap(pairs: &[[u32; 2]], radii: &[f64], centres: &[Vec3]) -> f64 {
    let of = |&[a, b]: &[u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        1.0 - (centres[b] - centres[a]).norm() / (radii[a] + radii[b])
    };
    pairs.iter().map(of).fold(0.0, f64::max)
}

/// All pairs of centres nearer than `reach`, by cells of that size.
fn neighbours(container: &Container, radii: &[f64], centres: &[Vec3], reach: f64) -> Vec<[u32; 2]> {
    let (corner, size) = container.bounds();
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
    let beyond = reach - 2.0 * radii.iter().copied().fold(0.0, f64::max);
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
                        let cut = radii[a] + radii[other] + beyond;
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
