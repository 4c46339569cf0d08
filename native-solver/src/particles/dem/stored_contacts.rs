//! The memory of contacts, apart from the order of particles: carried over when candidates are found
//! anew, and kept in checkpoints.

use calcine_coupler::physics::Vec3;

use super::block::Block;
use super::sphere::Spheres;
use super::walls::group::WallContactMemory;

/// The memory of a contact of two particles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StoredContact {
    /// Rows of the particles among ascending ids, the smaller first.
    pub rows: [u32; 2],
    /// Elongation of the tangential spring in m, on the first.
    pub shift: Vec3,
    /// Torque of the rolling spring in N m, on the first.
    pub rolling: Vec3,
}

/// The memory of a contact with a wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StoredWallContact {
    /// Row of the particle among ascending ids.
    pub row: u32,
    /// Index of the wall.
    pub wall: u32,
    /// Its place among the memories of this particle and wall.
    pub slot: u32,
    /// Where it touched, in the wall's own frame.
    pub point: Vec3,
    /// Elongation of the tangential spring in m.
    pub shift: Vec3,
    /// Torque of the rolling spring in N m.
    pub rolling: Vec3,
}

/// All memories, in order of their rows.
#[derive(Clone, Debug, Default)]
pub struct StoredContacts {
    /// Of pairs.
    pub pairs: Vec<StoredContact>,
    /// Of walls.
    pub walls: Vec<StoredWallContact>,
    /// True where memories of walls go back to their slots; else these are counted anew.
    keeps_slots: bool,
    pair_of: Vec<u32>,
    wall_of: Vec<u32>,
}

impl StoredContacts {
    /// Memories given.
    pub fn of(pairs: Vec<StoredContact>, walls: Vec<StoredWallContact>) -> Self {
        Self {
            pairs,
            walls,
            ..Self::default()
        }
    }

    /// Memories given, of the search that is done again: those of walls go back to their slots.
    pub fn in_slots(pairs: Vec<StoredContact>, walls: Vec<StoredWallContact>) -> Self {
        Self {
            keeps_slots: true,
            ..Self::of(pairs, walls)
        }
    }

    /// Takes the memories of all contacts that touched in the last evaluation, `stamp`.
    pub fn collect(&mut self, blocks: &[Block], spheres: &Spheres, stamp: u64) {
        self.pairs.clear();
        self.walls.clear();
        self.keeps_slots = false;
        for block in blocks {
            for candidates in [&block.inner, &block.cross] {
                for (k, shift) in candidates.shift.iter().enumerate() {
                    if candidates.touched[k] {
                        let [i, j] = candidates.pair[k].map(|index| spheres.row_of(index as usize));
                        let rolling = candidates.rolling.get(k).copied().unwrap_or_default();
                        let sign = if i < j { 1.0 } else { -1.0 };
                        self.pairs.push(StoredContact {
                            rows: [i.min(j), i.max(j)],
                            shift: sign * shift,
                            rolling: sign * rolling,
                        });
                    }
                }
            }
            for group in &block.walls.groups {
                let slots =
                    &block.walls.slots[group.slots.start as usize..group.slots.end as usize];
                let touched = (0..).zip(slots).filter(|(_, slot)| slot.stamp == stamp);
                for (number, slot) in touched {
                    self.walls.push(StoredWallContact {
                        row: spheres.row[block.begin + group.particle as usize],
                        wall: group.wall,
                        slot: number,
                        point: slot.point,
                        shift: slot.shift,
                        rolling: slot.rolling,
                    });
                }
            }
        }
    }

    /// Takes the memories along with particles that were moved by so many m, given by row: contact points of walls.
    pub fn shift(&mut self, moved: impl Fn(u32) -> Vec3) {
        for one in &mut self.walls {
            one.point += moved(one.row);
        }
    }

    /// Sorts the memories, so that they can be found by row.
    pub fn sort(&mut self, rows: usize) {
        self.pairs.sort_unstable_by_key(|carried| carried.rows);
        // Contacts of one sphere with one mesh keep their order.
        self.walls
            .sort_by_key(|carried| (carried.row, carried.wall));
        index(
            &mut self.pair_of,
            rows,
            self.pairs.iter().map(|one| one.rows[0]),
        );
        index(
            &mut self.wall_of,
            rows,
            self.walls.iter().map(|one| one.row),
        );
    }

    /// The memory of a pair of rows, as the first of them sees it.
    #[inline]
    pub fn pair(&self, first: u32, second: u32) -> Option<(Vec3, Vec3)> {
        let (low, high) = (first.min(second), first.max(second));
        let of = self.pair_of[low as usize] as usize..self.pair_of[low as usize + 1] as usize;
        let found = self.pairs[of].iter().find(|one| one.rows[1] == high)?;
        let sign = if first < second { 1.0 } else { -1.0 };
        Some((sign * found.shift, sign * found.rolling))
    }

    /// Puts the memories of a row and wall into the slots of their group.
    pub fn fill(&self, row: u32, wall: u32, slots: &mut [WallContactMemory], stamp: u64) {
        let of = self.wall_of[row as usize] as usize..self.wall_of[row as usize + 1] as usize;
        let found = self.walls[of].iter().filter(|one| one.wall == wall);
        for (count, one) in found.enumerate() {
            let place = match self.keeps_slots {
                true => one.slot as usize,
                false => count,
            };
            if let Some(slot) = slots.get_mut(place) {
                *slot = WallContactMemory {
                    point: one.point,
                    shift: one.shift,
                    rolling: one.rolling,
                    stamp,
                };
            }
        }
    }
}

/// Where the entries of each row begin among sorted rows.
fn index(begin: &mut Vec<u32>, rows: usize, sorted: impl Iterator<Item = u32>) {
    begin.clear();
    begin.resize(rows + 1, 0);
    for row in sorted {
        begin[row as usize + 1] += 1;
    }
    for row in 0..rows {
        begin[row + 1] += begin[row];
    }
}
