//! Contacts that are pressed in farther than their laws hold.

use calcine_coupler::excursion::Excursion;
use calcine_coupler::part::DEEP_CONTACT;

use super::sphere::Spheres;

/// How far in m an overlap is beyond the deepest that holds, for two spheres by their radii.
#[inline(always)]
pub fn beyond(overlap: f64, radii: [f64; 2]) -> f64 {
    overlap - DEEP_CONTACT * radii[0].min(radii[1])
}

/// Notes those of these pairs of spheres whose overlaps are beyond it.
#[cold]
pub fn note_all(deep: &mut Excursion, spheres: &Spheres, pairs: impl Iterator<Item = [u32; 2]>) {
    for pair in pairs {
        let pair = pair.map(|index| index as usize);
        let [one, other] = pair.map(|index| spheres.place[index]);
        let overlap = one.radius + other.radius - (one.centre - other.centre).norm();
        if beyond(overlap, [one.radius, other.radius]) > 0.0 {
            note(deep, spheres, pair, overlap);
        }
    }
}

/// Notes an overlap in m that is beyond the deepest that holds, at the row of the smaller of two spheres, or of the first of two that are alike.
#[cold]
pub fn note(deep: &mut Excursion, spheres: &Spheres, pair: [usize; 2], overlap: f64) {
    let [one, other] = pair.map(|index| (spheres.place[index].radius, spheres.row_of(index)));
    let (radius, row) = if other < one { other } else { one };
    let (share, row) = (overlap / radius, row as usize);
    deep.look(row, share, (0.0, DEEP_CONTACT));
}
