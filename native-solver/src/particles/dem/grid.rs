//! The search of near spheres: one grid of cells per class of sizes, kept as a table of the cells that
//! are occupied, so that neither empty space nor a wide distribution of sizes costs anything.
//!
//! A class holds the spheres between half and once its largest radius (Ogarko and Luding, Comput. Phys.
//! Commun. 183 (2012) 931, doi 10.1016/j.cpc.2011.12.019). A sphere looks for those of its own class and
//! of the coarser ones, in 27 cells each, so that a big one never looks through all small ones around it.

use calcine_coupler::physics::Vec3;

use super::sphere::SpherePosition;

/// Cells along an axis that a key can hold.
const MOST: f64 = (1u64 << 20) as f64;

/// One occupied cell and its spheres.
#[derive(Clone, Copy, Debug)]
struct Entry {
    key: u64,
    begin: u32,
    end: u32,
}

const EMPTY: Entry = Entry {
    key: u64::MAX,
    begin: 0,
    end: 0,
};

/// The grid of one class of sizes.
#[derive(Clone, Debug, Default)]
struct Level {
    cell: f64,
    largest: f64,
    members: Vec<u32>,
    table: Vec<Entry>,
}

/// The spheres of 27 cells: ranges of a class' members.
#[derive(Clone, Copy, Debug)]
pub struct CellNeighbourhood {
    cell: [u64; 3],
    ranges: [[u32; 2]; 27],
    count: usize,
}

impl Default for CellNeighbourhood {
    fn default() -> Self {
        Self {
            cell: [u64::MAX; 3],
            ranges: [[0; 2]; 27],
            count: 0,
        }
    }
}

/// All classes, the finest first.
#[derive(Clone, Debug, Default)]
pub struct SearchGrid {
    low: Vec3,
    levels: Vec<Level>,
    /// Class of each sphere.
    level_of: Vec<u8>,
    keyed: Vec<(u64, u32)>,
}

impl SearchGrid {
    /// Sorts spheres into cells such that spheres whose surfaces are nearer than `gap` in m are found. The first `along` of
    /// them stand along the curve.
    pub fn fill(
        &mut self,
        places: &[SpherePosition],
        along: usize,
        (low, high): (Vec3, Vec3),
        gap: f64,
    ) {
        self.low = low;
        let largest = places.iter().map(|place| place.radius).fold(0.0, f64::max);
        let sorted = along == places.len() && places.iter().all(|place| place.radius == largest);
        let class = |radius: f64| {
            let (mut class, mut bound) = (0usize, 0.5 * largest);
            while radius <= bound && class < 40 {
                class += 1;
                bound *= 0.5;
            }
            class
        };
        let mut used = [0.0f64; 41];
        for place in places {
            let class = class(place.radius);
            used[class] = used[class].max(place.radius);
        }
        let mut index = [0u8; 41];
        let mut count = 0;
        for class in (0..used.len()).rev().filter(|&class| used[class] > 0.0) {
            index[class] = count as u8;
            if self.levels.len() == count {
                self.levels.push(Level::default());
            }
            let level = &mut self.levels[count];
            let extent = (high - low).max() / (MOST - 2.0);
            level.largest = used[class];
            level.cell = (2.0 * used[class] + gap).max(extent);
            count += 1;
        }
        self.levels.truncate(count);
        self.level_of.clear();
        let classes = places.iter().map(|place| index[class(place.radius)]);
        self.level_of.extend(classes);
        for k in 0..count {
            self.keyed.clear();
            for (i, place) in places.iter().enumerate() {
                if usize::from(self.level_of[i]) == k {
                    let key = pack(cell(low, self.levels[k].cell, place.centre));
                    self.keyed.push((key, i as u32));
                }
            }
            // Along the curve, whose cells are as wide as the smallest sphere, equal keys stand together already
            // where all spheres are alike; else those of a cell may be apart, and would not be found.
            if !sorted {
                self.keyed.sort_unstable();
            }
            self.levels[k].fill(&self.keyed);
        }
    }

    /// Number of classes.
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// Class of a sphere.
    pub fn level(&self, sphere: usize) -> usize {
        usize::from(self.level_of[sphere])
    }

    /// The spheres of a class in the 27 cells around a place, through a memory of the last cell.
    pub fn around<'a>(
        &'a self,
        level: usize,
        place: Vec3,
        memory: &'a mut CellNeighbourhood,
    ) -> impl Iterator<Item = u32> + 'a {
        let level = &self.levels[level];
        let cell = cell(self.low, level.cell, place);
        if memory.cell != cell {
            memory.cell = cell;
            memory.count = 0;
            for z in cell[2] - 1..=cell[2] + 1 {
                for y in cell[1] - 1..=cell[1] + 1 {
                    for x in cell[0] - 1..=cell[0] + 1 {
                        let found = level.find(pack([x, y, z]));
                        if found[0] < found[1] {
                            memory.ranges[memory.count] = found;
                            memory.count += 1;
                        }
                    }
                }
            }
        }
        let ranges = memory.ranges[..memory.count].iter();
        ranges.flat_map(|&[begin, end]| level.members[begin as usize..end as usize].iter().copied())
    }

    /// Calls `near` with each sphere whose surface may be nearer than `gap` to a box with these corners.
    pub fn within(&self, (from, to): (Vec3, Vec3), gap: f64, mut near: impl FnMut(u32)) {
        for level in &self.levels {
            let reach = Vec3::repeat(level.largest + gap);
            // A box may reach out of the bounds of the particles.
            let (from, to) = ((from - reach).sup(&self.low), to + reach);
            if (0..3).any(|axis| to[axis] < from[axis]) {
                continue;
            }
            let (first, last) = (
                cell(self.low, level.cell, from),
                cell(self.low, level.cell, to),
            );
            let cells: f64 = (0..3).map(|k| (last[k] - first[k] + 1) as f64).product();
            if cells > level.members.len() as f64 {
                level.members.iter().for_each(|&sphere| near(sphere));
                continue;
            }
            for z in first[2]..=last[2] {
                for y in first[1]..=last[1] {
                    for x in first[0]..=last[0] {
                        let [begin, end] = level.find(pack([x, y, z]));
                        let members = &level.members[begin as usize..end as usize];
                        members.iter().for_each(|&sphere| near(sphere));
                    }
                }
            }
        }
    }
}

impl Level {
    fn fill(&mut self, keyed: &[(u64, u32)]) {
        let slots = (2 * keyed.len()).next_power_of_two().max(16);
        self.table.clear();
        self.table.resize(slots, EMPTY);
        self.members.clear();
        self.members.extend(keyed.iter().map(|&(_, sphere)| sphere));
        let mut begin = 0;
        while begin < keyed.len() {
            let key = keyed[begin].0;
            let run = keyed[begin..].iter().take_while(|one| one.0 == key).count();
            let mut slot = self.slot(key);
            while self.table[slot].key != u64::MAX {
                slot = (slot + 1) & (slots - 1);
            }
            self.table[slot] = Entry {
                key,
                begin: begin as u32,
                end: (begin + run) as u32,
            };
            begin += run;
        }
    }

    /// Fibonacci hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    #[inline]
    fn slot(&self, key: u64) -> usize {
        let bits = self.table.len().trailing_zeros();
        (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - bits)) as usize
    }

    #[inline]
    fn find(&self, key: u64) -> [u32; 2] {
        let mut slot = self.slot(key);
        loop {
            let entry = &self.table[slot];
            if entry.key == key {
                return [entry.begin, entry.end];
            }
            if entry.key == u64::MAX {
                return [0, 0];
            }
            slot = (slot + 1) & (self.table.len() - 1);
        }
    }
}

/// The cell of a place; one is left free below, so that every cell has neighbours.
#[inline]
fn cell(low: Vec3, size: f64, place: Vec3) -> [u64; 3] {
    let part = (place - low) / size;
    [0, 1, 2].map(|axis| part[axis].clamp(0.0, MOST - 3.0) as u64 + 1)
}

#[inline]
fn pack([x, y, z]: [u64; 3]) -> u64 {
    x | y << 21 | z << 42
}

/// Place of a cell along a curve that keeps neighbours together (Morton 1966): the bits of its three
/// numbers in turn.
#[inline]
pub fn curve(low: Vec3, size: f64, place: Vec3) -> u64 {
    let [x, y, z] = cell(low, size, place).map(spread);
    x | y << 1 | z << 2
}

/// Two free bits between each of the lower 21 bits.
#[inline]
fn spread(number: u64) -> u64 {
    let mut bits = number & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}
