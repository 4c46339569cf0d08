//! Removal of overlaps: each overlapping pair in turn moves apart, then walls push inwards.

use calcine_physics::Vec3;

use super::Container;
use crate::contacts::pairs;

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
    let mut near = pairs(container.bounds(), radii, centres, largest * MARGIN + skin);
    for sweep in 0..SWEEPS {
        let moved = |(new, old): (&Vec3, &Vec3)| (new - old).norm_squared();
        let farthest = centres.iter().zip(&listed).map(moved).fold(0.0, f64::max);
        // The list is renewed before two spheres that it lacks can touch.
        if farthest > 0.25 * (0.5 * skin) * (0.5 * skin) {
            listed.copy_from_slice(centres);
            near = pairs(container.bounds(), radii, centres, largest * MARGIN + skin);
        }
        if sweep % LOOK == 0 && overlap(&near, radii, centres) <= 0.0 {
            return 0.0;
        }
        for &[a, b] in &near {
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
    let near = pairs(container.bounds(), radii, centres, 0.0);
    overlap(&near, radii, centres)
}

fn overlap(pairs: &[[u32; 2]], radii: &[f64], centres: &[Vec3]) -> f64 {
    let of = |&[a, b]: &[u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        1.0 - (centres[b] - centres[a]).norm() / (radii[a] + radii[b])
    };
    pairs.iter().map(of).fold(0.0, f64::max)
}
