//! Removal of overlaps: each overlapping pair in turn moves apart, then walls push inwards.

use calcine_numerics::parallel::{self, update};
use calcine_physics::Vec3;
use rayon::prelude::*;

use super::Container;
use crate::contacts::{pairs, pairs_across};
use crate::periodicity::Periodicity;

/// Pairs are parted a little farther than contact, so that overlaps end after finitely many sweeps.
const MARGIN: f64 = 1e-3;
/// Reach of the neighbour list beyond contact, in mean diameters (by surface over diameter).
const SKIN: f64 = 0.3;
/// Sweeps before giving up.
const SWEEPS: usize = 20_000;
/// Sweeps between two looks at the overlap.
const LOOK: usize = 10;
/// Spheres up to which neither their order in memory nor threads matter.
const FEW: usize = 20_000;
/// Blocks of more spheres, swept side by side; their number does not depend on the threads, so that the result does not.
const BLOCKS: usize = 16;

/// Moves centres (m) until no spheres overlap. Returns the largest overlap that is left over the
/// sum of the pair's radii, 0 if none is. In one fixed order: the same bits on any machine.
pub(super) fn relax(container: &Container, radii: &[f64], centres: &mut [Vec3]) -> f64 {
    if centres.len() <= FEW {
        return sweeps(container, radii, centres, 1);
    }
    // Neighbours in space are neighbours in memory.
    let order = by_place(container.bounds(), centres);
    let sorted: Vec<f64> = order.iter().map(|&sphere| radii[sphere]).collect();
    let mut places: Vec<Vec3> = order.iter().map(|&sphere| centres[sphere]).collect();
    let overlap = sweeps(container, &sorted, &mut places, BLOCKS);
    for (sphere, place) in order.into_iter().zip(places) {
        centres[sphere] = place;
    }
    overlap
}

/// Spheres in the order of cubes that hold one of them on average, layer by layer.
fn by_place((corner, size): (Vec3, Vec3), centres: &[Vec3]) -> Vec<usize> {
    let width = (size.x * size.y * size.z / centres.len() as f64).cbrt();
    let cube = |&sphere: &usize| {
        let steps = (centres[sphere] - corner) / width;
        [steps.z as u32, steps.y as u32, steps.x as u32]
    };
    let mut order: Vec<usize> = (0..centres.len()).collect();
    order.sort_by_cached_key(cube);
    order
}

/// Spheres that may touch, sorted by the blocks of spheres that they are in.
struct Near {
    /// Spheres of a block.
    size: usize,
    /// Pairs within each block, counted from its first sphere.
    within: Vec<Vec<[u32; 2]>>,
    /// Pairs of spheres of two blocks.
    across: Vec<[u32; 2]>,
    periodicity: Periodicity,
}

impl Near {
    fn find(
        container: &Container,
        radii: &[f64],
        centres: &[Vec3],
        gap: f64,
        blocks: usize,
    ) -> Self {
        let size = centres.len().div_ceil(blocks).max(1);
        let mut near = Self {
            size,
            within: vec![Vec::new(); blocks],
            across: Vec::new(),
            periodicity: container.periodicity,
        };
        let within = pairs(container.bounds(), radii, centres, gap).into_iter();
        let across = pairs_across(&container.periodicity, radii, centres, gap);
        for [a, b] in within.chain(across.into_iter().map(|(pair, _)| pair)) {
            let block = a as usize / size;
            let first = (block * size) as u32;
            if b as usize / size == block {
                near.within[block].push([a - first, b - first]);
            } else {
                near.across.push([a, b]);
            }
        }
        near
    }

    /// Parts each overlapping pair in turn: pairs of all blocks side by side, then those between blocks.
    fn part(&self, radii: &[f64], centres: &mut [Vec3]) {
        let lines = Lines(self.periodicity);
        if let [pairs] = &self.within[..] {
            return lines.part(pairs, radii, centres);
        }
        let blocks = centres.par_chunks_mut(self.size);
        let blocks = blocks.zip(radii.par_chunks(self.size)).zip(&self.within);
        blocks.for_each(|((centres, radii), pairs)| lines.part(pairs, radii, centres));
        lines.part(&self.across, radii, centres);
    }

    /// Largest overlap over the sum of the pair's radii, 0 if there is none.
    fn overlap(&self, radii: &[f64], centres: &[Vec3]) -> f64 {
        let lines = Lines(self.periodicity);
        if let [pairs] = &self.within[..] {
            return lines.overlap(pairs, radii, centres);
        }
        let blocks = centres.par_chunks(self.size);
        let blocks = blocks.zip(radii.par_chunks(self.size)).zip(&self.within);
        let within = blocks.map(|((centres, radii), pairs)| lines.overlap(pairs, radii, centres));
        let across = lines.overlap(&self.across, radii, centres);
        within.reduce(|| 0.0, f64::max).max(across)
    }
}

fn sweeps(container: &Container, radii: &[f64], centres: &mut [Vec3], blocks: usize) -> f64 {
    let largest = 2.0 * radii.iter().copied().fold(0.0, f64::max);
    let moment = |power: i32| radii.iter().map(|radius| radius.powi(power)).sum::<f64>();
    let skin = SKIN * 2.0 * moment(2) / moment(1);
    let find = |centres: &[Vec3]| {
        let gap = largest * MARGIN + skin;
        Near::find(container, radii, centres, gap, blocks)
    };
    let mut listed = centres.to_vec();
    let mut near = find(centres);
    for sweep in 0..SWEEPS {
        let moved = |sphere: usize| {
            let way = centres[sphere] - listed[sphere];
            container.periodicity.shortest(way).norm_squared()
        };
        let (_, farthest) = parallel::largest(centres.len(), moved);
        // The list is renewed before two spheres that it lacks can touch.
        if farthest > 0.25 * (0.5 * skin) * (0.5 * skin) {
            listed.copy_from_slice(centres);
            near = find(centres);
        }
        if sweep % LOOK == 0 && near.overlap(radii, centres) <= 0.0 {
            return 0.0;
        }
        near.part(radii, centres);
        update(centres, |sphere, centre| {
            *centre = container.inside(*centre, radii[sphere]);
        });
    }
    Near::find(container, radii, centres, 0.0, blocks).overlap(radii, centres)
}

/// Lines between centres, the shortest ones across periodic planes.
#[derive(Clone, Copy)]
struct Lines(Periodicity);

impl Lines {
    fn part(self, pairs: &[[u32; 2]], radii: &[f64], centres: &mut [Vec3]) {
        match self.0.is_none() {
            true => part(pairs, radii, centres, |line| line),
            false => part(pairs, radii, centres, |line| self.0.shortest(line)),
        }
    }

    fn overlap(self, pairs: &[[u32; 2]], radii: &[f64], centres: &[Vec3]) -> f64 {
        match self.0.is_none() {
            true => overlap(pairs, radii, centres, |line| line),
            false => overlap(pairs, radii, centres, |line| self.0.shortest(line)),
        }
    }
}

fn part(pairs: &[[u32; 2]], radii: &[f64], centres: &mut [Vec3], shortest: impl Fn(Vec3) -> Vec3) {
    for &[a, b] in pairs {
        let (a, b) = (a as usize, b as usize);
        let apart = (radii[a] + radii[b]) * (1.0 + MARGIN);
        let line = shortest(centres[b] - centres[a]);
        let square = line.norm_squared();
        if square < apart * apart {
            let distance = square.sqrt();
            let way = if distance > 0.0 {
                line / distance
            } else {
                Vec3::z()
            };
            // The smaller one gives way: half as many sweeps as with equal shares.
            let share = radii[b] / (radii[a] + radii[b]);
            let push = (apart - distance) * way;
            centres[a] -= share * push;
            centres[b] += (1.0 - share) * push;
        }
    }
}

fn overlap(
    pairs: &[[u32; 2]],
    radii: &[f64],
    centres: &[Vec3],
    shortest: impl Fn(Vec3) -> Vec3,
) -> f64 {
    let of = |&[a, b]: &[u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        1.0 - shortest(centres[b] - centres[a]).norm() / (radii[a] + radii[b])
    };
    pairs.iter().map(of).fold(0.0, f64::max)
}
