//! Finding candidates anew: sort the particles, fill the cells, list the pairs and walls that are near.

use calcine_coupler::motion::WallShape;
use calcine_coupler::physics::contact::{ContactModel, PairConstants};
use rayon::prelude::*;

use super::block::{Block, size};
use super::candidates::{CandidatePairs, TouchingPair};
use super::grid::{self, CellNeighbourhood, SearchGrid};
use super::rules::ContactRules;
use super::sphere::{SphereLoad, Spheres};
use super::stored_contacts::StoredContacts;
use super::walls::WallBody;
use super::walls::{shape, triangle};
use calcine_coupler::motion::{Cohesion, Rolling};
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;

/// Scratch memory of the search.
#[derive(Clone, Debug, Default)]
pub struct NeighbourSearch {
    /// Cells.
    pub grid: SearchGrid,
    /// Memories of contacts on their way from the old candidates to the new.
    pub stored: StoredContacts,
    /// True where each block has loads for particles of blocks behind it only.
    pub forward: bool,
    keys: Vec<(u64, u32, u32)>,
    order: Vec<u32>,
    spare: Spheres,
    /// Triangles near particles: particle, wall, triangle.
    triangles: Vec<[u32; 3]>,
}

/// What the search is told.
pub struct SearchInputs<'a, L> {
    /// The law, which may prepare values.
    pub law: &'a L,
    /// True where it does.
    pub prepares: bool,
    /// Constants and options.
    pub rules: &'a ContactRules,
    /// The walls where they are now.
    pub walls: &'a [WallBody],
    /// Bounds in m.
    pub bounds: (Vec3, Vec3),
    /// Directions in which they repeat.
    pub periodicity: &'a Periodicity,
    /// Surfaces nearer than this may touch before the next search, in m.
    pub skin: f64,
    /// Surfaces nearer than this are candidates, in m: the skin, and how far adhesion holds those that touch.
    pub reach: f64,
    /// The evaluation in which carried contacts touched.
    pub stamp: u64,
}

impl NeighbourSearch {
    /// Sorts the particles and lists all candidates, with the memories in `stored`.
    pub fn run<L: ContactModel>(
        &mut self,
        task: &SearchInputs<'_, L>,
        spheres: &mut Spheres,
        blocks: &mut Vec<Block>,
        outgoing: &mut Vec<Vec<SphereLoad>>,
        parallel: bool,
    ) {
        spheres.drop_images();
        self.sort(task, spheres);
        spheres.add_images(task.periodicity, task.reach);
        self.stored.sort(spheres.len());
        self.grid
            .fill(&spheres.place, spheres.len(), task.bounds, task.reach);
        self.near_triangles(task, spheres);
        let size = size(spheres.len());
        blocks.resize_with(spheres.len().div_ceil(size), Block::default);
        outgoing.resize_with(blocks.len(), Vec::new);
        let list = |(k, (block, outgoing)): (usize, (&mut Block, &mut Vec<SphereLoad>))| {
            block.begin = k * size;
            let end = spheres.len().min(block.begin + size);
            block.load.clear();
            block.load.resize(end - block.begin, SphereLoad::default());
            self.pairs(task, spheres, block, end);
            self.walls(task, spheres, block, end);
            let most = block.inner.pair.len().max(block.cross.pair.len());
            block.touching.clear();
            // One more: the place after the last that touches is written to.
            block.touching.resize(most + 1, TouchingPair::default());
            outgoing.clear();
            outgoing.resize(block.cross.pair.len(), SphereLoad::default());
        };
        if parallel {
            blocks
                .par_iter_mut()
                .zip(outgoing)
                .enumerate()
                .for_each(list);
        } else {
            blocks.iter_mut().zip(outgoing).enumerate().for_each(list);
        }
        self.forward = deliver(blocks, spheres, size);
    }

    fn sort<L>(&mut self, task: &SearchInputs<'_, L>, spheres: &mut Spheres) {
        let smallest = spheres.place.iter().map(|place| place.radius);
        let size = 2.0 * smallest.fold(f64::INFINITY, f64::min) + task.skin;
        self.keys.clear();
        for (i, place) in spheres.place.iter().enumerate() {
            let key = grid::curve(task.bounds.0, size, place.centre);
            self.keys.push((key, spheres.row[i], i as u32));
        }
        self.keys.sort_unstable();
        self.order.clear();
        self.order.extend(self.keys.iter().map(|key| key.2));
        spheres.reorder(&self.order, &mut self.spare);
    }

    fn pairs<L: ContactModel>(
        &self,
        task: &SearchInputs<'_, L>,
        spheres: &Spheres,
        block: &mut Block,
        end: usize,
    ) {
        block.inner.clear();
        block.cross.clear();
        let mut memory = vec![CellNeighbourhood::default(); self.grid.levels()];
        for i in block.begin..end {
            let place = spheres.place[i];
            let own = self.grid.level(i);
            for (level, memory) in memory.iter_mut().enumerate().skip(own) {
                for j in self.grid.around(level, place.centre, memory) {
                    // Across a plane too, one of the two finds the other.
                    let (seen, other) = (j as usize, spheres.origin(j as usize));
                    if level == own && other <= i {
                        continue;
                    }
                    let cut = place.radius + spheres.place[seen].radius + task.reach;
                    let apart = (spheres.place[seen].centre - place.centre).norm_squared();
                    let held =
                        spheres.moves[i].inverse_mass + spheres.moves[other].inverse_mass == 0.0;
                    if apart < cut * cut && !held {
                        let inner = (block.begin..end).contains(&seen);
                        let list = if inner {
                            &mut block.inner
                        } else {
                            &mut block.cross
                        };
                        self.add(task, spheres, list, i, seen);
                    }
                }
            }
        }
    }

    #[inline]
    fn add<L: ContactModel>(
        &self,
        task: &SearchInputs<'_, L>,
        spheres: &Spheres,
        list: &mut CandidatePairs,
        i: usize,
        j: usize,
    ) {
        let memory = self.stored.pair(spheres.row[i], spheres.row_of(j));
        let (shift, rolling) = memory.unwrap_or_default();
        list.pair.push([i as u32, j as u32]);
        list.shift.push(shift);
        list.touched.push(memory.is_some());
        if task.rules.rolling == Rolling::ElasticPlastic {
            list.rolling.push(rolling);
        }
        let pair = task.rules.pair(spheres.material[i], spheres.material[j]);
        let [a, b] = [i, j].map(|k| spheres.place[k].radius);
        if task.rules.cohesion == Cohesion::Jkr {
            let tear_off = task.rules.tear_off(pair, a * b / (a + b));
            list.tear_off.push(tear_off);
        }
        if task.prepares {
            let mass = 1.0 / (spheres.moves[i].inverse_mass + spheres.moves[j].inverse_mass);
            list.prepared
                .push(task.law.prepare(pair, a * b / (a + b), mass));
        }
    }

    fn walls<L: ContactModel>(
        &self,
        task: &SearchInputs<'_, L>,
        spheres: &Spheres,
        block: &mut Block,
        end: usize,
    ) {
        block.walls.clear();
        let first = self
            .triangles
            .partition_point(|near| (near[0] as usize) < block.begin);
        let mut near = &self.triangles[first..];
        for i in block.begin..end {
            let place = &spheres.place[i];
            if spheres.moves[i].inverse_mass == 0.0 {
                continue;
            }
            for (index, wall) in task.walls.iter().enumerate() {
                let groups = block.walls.groups.len();
                let (particle, wall_index) = ((i - block.begin) as u32, index as u32);
                if let WallShape::Mesh { .. } = wall.shape {
                    let skip =
                        near.partition_point(|one| [one[0], one[1]] < [i as u32, wall_index]);
                    near = &near[skip..];
                    let count =
                        near.partition_point(|one| [one[0], one[1]] <= [i as u32, wall_index]);
                    let triangles = near[..count].iter().map(|one| one[2]);
                    block.walls.add(particle, wall_index, triangles, true);
                } else if shape::nearest(&wall.shape, wall.own(place.centre))
                    .is_some_and(|near| near.distance < place.radius + task.reach)
                {
                    block
                        .walls
                        .add(particle, wall_index, std::iter::empty(), false);
                }
                if block.walls.groups.len() > groups {
                    self.begin_wall(task, spheres, block, i, wall);
                }
            }
        }
    }

    /// Memories and prepared value of the group added last.
    fn begin_wall<L: ContactModel>(
        &self,
        task: &SearchInputs<'_, L>,
        spheres: &Spheres,
        block: &mut Block,
        i: usize,
        wall: &WallBody,
    ) {
        let Some(group) = block.walls.groups.last() else {
            return;
        };
        let slots = &mut block.walls.slots[group.slots.start as usize..group.slots.end as usize];
        self.stored
            .fill(spheres.row[i], group.wall, slots, task.stamp);
        if task.prepares {
            let pair: &PairConstants = task.rules.pair(spheres.material[i], wall.material);
            let mass = 1.0 / spheres.moves[i].inverse_mass;
            let value = task.law.prepare(pair, spheres.place[i].radius, mass);
            block.walls.prepared.push(value);
        }
    }

    /// Lists the triangles near each particle, in the order of particles, walls and triangles.
    fn near_triangles<L>(&mut self, task: &SearchInputs<'_, L>, spheres: &Spheres) {
        self.triangles.clear();
        for (index, wall) in task.walls.iter().enumerate() {
            let WallShape::Mesh { triangles } = &wall.shape else {
                continue;
            };
            for (k, corners) in triangles.iter().enumerate() {
                let [a, b, c] = corners.map(|corner| wall.placed(corner));
                let span = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
                let list = &mut self.triangles;
                self.grid.within(span, task.reach, |sphere| {
                    // Triangles have images of their own.
                    if sphere as usize >= spheres.len() {
                        return;
                    }
                    let place = &spheres.place[sphere as usize];
                    let reach = place.radius + task.reach;
                    let (point, _) = triangle::nearest(place.centre, &[a, b, c]);
                    if (place.centre - point).norm_squared() < reach * reach {
                        list.push([sphere, index as u32, k as u32]);
                    }
                });
            }
        }
        self.triangles.sort_unstable();
    }
}

/// Tells each block which loads of others are for its particles, in the order of blocks and slots; true where all
/// of them come from blocks before it.
fn deliver(blocks: &mut [Block], spheres: &Spheres, size: usize) -> bool {
    let mut forward = true;
    for block in blocks.iter_mut() {
        block.incoming.clear();
    }
    for source in 0..blocks.len() {
        for slot in 0..blocks[source].cross.pair.len() {
            let particle = spheres.origin(blocks[source].cross.pair[slot][1] as usize);
            forward &= source < particle / size;
            let target = &mut blocks[particle / size];
            let own = (particle % size) as u32;
            target.incoming.push([source as u32, slot as u32, own]);
        }
    }
    forward
}
