//! The base mapping W₀: which share of each particle lies in which cell.

mod disc;
mod error;
mod lanes;
pub mod linear;
mod overlap;
mod passage;
mod satellites;
mod weights;
mod wide;

use std::ops::Deref;
use std::sync::OnceLock;

use calcine_physics::{Vec3, sphere};
use rayon::prelude::*;

pub use error::MappingError;
pub use weights::Weights;

use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::tetrahedra::TetPlace;
use crate::periodicity::Periodicity;
use linear::LinearWeights;
use overlap::{Overlap, Scratch};
use passage::{Parts, Passage};
pub(crate) use weights::Amount;
use weights::Piece;

/// How a particle is divided among cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// All of it in the cell of its centre; for frozen beds and fine checks.
    Centroid,
    /// By 29 points of equal weight: the centre and two shells.
    Divided,
    /// By the exact volume that its sphere shares with each cell; continuous in position.
    Overlap,
    /// By linear weights of its centre in the tetrahedra of the mesh, whatever its size; continuous in position.
    Linear,
}

/// Maps particles onto the cells of a mesh.
#[derive(Clone, Debug)]
pub struct Mapper<M> {
    locator: Locator<M>,
    overlap: Overlap,
    passage: Passage,
    periodicity: Periodicity,
    linear: OnceLock<LinearWeights>,
}

impl<M: Deref<Target = Mesh> + Sync> Mapper<M> {
    /// Shares below this are round-off, not overlap.
    const ROUND_OFF: f64 = 1e-14;
    /// Particles that one thread takes at a time.
    const PIECE: usize = 256;
    /// Up to so many particles one thread finds their regions alone.
    const ALONE: usize = 4096;

    /// The mapper of a mesh; what of a sphere lies beyond a periodic plane is in the cells at the other.
    pub fn new(mesh: M) -> Self {
        let periodicity = *mesh.periodicity();
        let locator = Locator::new(mesh);
        let overlap = Overlap::new(&locator);
        let passage = Passage::new(&locator, &overlap);
        Self {
            locator,
            overlap,
            passage,
            periodicity,
            linear: OnceLock::new(),
        }
    }

    /// Weights of spheres, given by centres and radii in m. What of a sphere lies beyond a wall is
    /// put back into its cells in proportion; a centre outside the mesh is an error.
    pub fn fill(
        &self,
        method: Method,
        positions: &[Vec3],
        radii: &[f64],
    ) -> Result<Weights, MappingError> {
        if positions.len() != radii.len() {
            return Err(MappingError::Lengths {
                positions: positions.len(),
                radii: radii.len(),
            });
        }
        let cells = self.locator.mesh().cells();
        if method == Method::Linear {
            self.linear
                .get_or_init(|| LinearWeights::new(self.locator.mesh()));
        }
        let order = self.order(positions);
        let pieces: Vec<Piece> = order
            .par_chunks(Self::PIECE)
            .map_init(Memory::default, |memory, particles| {
                let mut piece = Piece::default();
                self.piece(method, (positions, radii), particles, memory, &mut piece);
                piece
            })
            .collect();
        Weights::from_pieces(cells, positions.len(), &pieces)
    }

    /// True where a position, brought back between periodic planes, lies in a cell.
    pub fn is_within(&self, position: Vec3) -> bool {
        self.locator
            .cell_at(self.periodicity.wrap(position))
            .is_some()
    }

    /// Particles in the order of space: neighbours need the same cells, which memory is slow to give.
    fn order(&self, positions: &[Vec3]) -> Vec<u32> {
        let region = |position: &Vec3| self.locator.region(*position) as u32;
        let regions: Vec<u32> = if positions.len() <= Self::ALONE {
            positions.iter().map(region).collect()
        } else {
            positions
                .par_iter()
                .with_min_len(1024)
                .map(region)
                .collect()
        };
        let mut next = vec![0u32; self.locator.regions() + 1];
        for &region in &regions {
            next[region as usize + 1] += 1;
        }
        for region in 1..next.len() {
            next[region] += next[region - 1];
        }
        let mut order = vec![0; positions.len()];
        for (particle, &region) in regions.iter().enumerate() {
            let slot = &mut next[region as usize];
            order[*slot as usize] = particle as u32;
            *slot += 1;
        }
        order
    }

    /// Adds the rows of some particles to a piece.
    fn piece(
        &self,
        method: Method,
        (positions, radii): (&[Vec3], &[f64]),
        particles: &[u32],
        memory: &mut Memory,
        piece: &mut Piece,
    ) {
        let mesh = self.locator.mesh();
        memory.spheres.clear();
        memory.parts.clear();
        for &particle in particles {
            let index = particle as usize;
            let (position, radius) = (positions[index], radii[index]);
            match self.sphere(method, index, (position, radius), memory) {
                Ok(first) => memory
                    .spheres
                    .push((particle, first as u32, memory.home as u32)),
                Err(error) => piece.fail(particle, error),
            }
        }
        memory.parts.finish(mesh);
        for (sphere, &(particle, first, home)) in memory.spheres.iter().enumerate() {
            let first = first as usize;
            let end = memory
                .spheres
                .get(sphere + 1)
                .map_or(memory.parts.len(), |next| next.1 as usize);
            let volumes = &memory.parts.volumes[first..end];
            let cells = &memory.parts.cells[first..end];
            let whole = sphere::volume(radii[particle as usize]);
            memory.row.clear();
            if let &[cell] = cells {
                memory.row.push((cell, 1.0));
            } else {
                let shares = cells
                    .iter()
                    .zip(volumes)
                    .map(|(&cell, volume)| (cell, volume / whole));
                memory
                    .row
                    .extend(shares.filter(|&(_, share)| share > Self::ROUND_OFF));
            }
            if memory.row.is_empty() {
                memory.row.push((home, 1.0));
            }
            piece.push(particle, &mut memory.row, mesh.cells());
        }
    }

    /// Adds the cells of a particle to `memory.parts`, the first of which is returned.
    fn sphere(
        &self,
        method: Method,
        particle: usize,
        (position, radius): (Vec3, f64),
        memory: &mut Memory,
    ) -> Result<usize, MappingError> {
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(MappingError::Radius { particle, radius });
        }
        let mesh = self.locator.mesh();
        let position = self.periodicity.wrap(position);
        let (home, depth) = self
            .passage
            .home(mesh, position, memory.home)
            .or_else(|| self.locator.cell_and_depth(position))
            .ok_or(MappingError::Outside { particle, position })?;
        memory.home = home;
        let first = memory.parts.len();
        let whole = sphere::volume(radius);
        if method == Method::Linear {
            self.by_linear_weights((home, position), whole, &mut memory.parts);
            return Ok(first);
        }
        // All of it lies in one cell; a sphere too small for its volume to be a number is a point.
        if depth >= radius || whole == 0.0 || method == Method::Centroid {
            memory.parts.push(home as u32, whole);
            return Ok(first);
        }
        match method {
            Method::Divided => self.by_satellites((position, radius), whole, memory),
            _ => {
                let sphere = (position, radius);
                let Memory { parts, .. } = memory;
                if !self
                    .passage
                    .gather(mesh, &self.overlap, home, sphere, parts)
                {
                    self.by_overlap(sphere, memory);
                }
                for shift in self.periodicity.images(position, radius) {
                    self.image(first, (position + shift, radius), memory);
                }
            }
        }
        Ok(first)
    }

    fn by_linear_weights(&self, (home, position): (usize, Vec3), whole: f64, parts: &mut Parts) {
        let (mesh, first) = (self.locator.mesh(), parts.len());
        match (self.linear.get(), TetPlace::nearest(mesh, home, position)) {
            (Some(weights), Some(at)) => weights.shares(mesh, at, |cell, share| {
                parts.add(first, cell, share * whole);
            }),
            _ => parts.push(home as u32, whole),
        }
    }

    fn by_satellites(&self, (position, radius): (Vec3, f64), whole: f64, memory: &mut Memory) {
        let cells = satellites::points(position, radius)
            .filter_map(|point| self.locator.cell_at(self.periodicity.wrap(point)))
            .map(|cell| cell as u32);
        memory.cells.clear();
        memory.cells.extend(cells);
        memory.cells.sort_unstable();
        let share = whole / memory.cells.len() as f64;
        for same in memory.cells.chunk_by(|a, b| a == b) {
            memory.parts.push(same[0], same.len() as f64 * share);
        }
    }

    /// Adds what an image of the sphere whose first cell stands at `first` shares with cells.
    fn image(&self, first: usize, (position, radius): (Vec3, f64), memory: &mut Memory) {
        let Memory {
            cells,
            scratch,
            parts,
            ..
        } = memory;
        self.locator.cells_near(position, radius, cells);
        let mesh = self.locator.mesh();
        let volumes = self.overlap.volumes(mesh, cells, position, radius, scratch);
        for (&cell, &volume) in cells.iter().zip(volumes) {
            if volume > 0.0 {
                parts.add(first, cell, volume);
            }
        }
    }

    fn by_overlap(&self, (position, radius): (Vec3, f64), memory: &mut Memory) {
        let Memory {
            cells,
            scratch,
            parts,
            ..
        } = memory;
        self.locator.cells_near(position, radius, cells);
        let mesh = self.locator.mesh();
        let volumes = self.overlap.volumes(mesh, cells, position, radius, scratch);
        for (&cell, &volume) in cells.iter().zip(volumes) {
            parts.push(cell, volume);
        }
    }
}

/// What the rows of one thread are made in.
#[derive(Default)]
struct Memory {
    cells: Vec<u32>,
    scratch: Scratch,
    row: Vec<(u32, f64)>,
    parts: Parts,
    /// Particles, the first of each one's cells in `parts`, and the cell of its centre.
    spheres: Vec<(u32, u32, u32)>,
    /// The cell of the particle before.
    home: usize,
}

#[cfg(test)]
mod tests;
