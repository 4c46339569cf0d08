//! The base mapping W₀: which share of each particle lies in which cell.

mod disc;
mod overlap;
mod satellites;
mod weights;

use std::ops::Deref;

use calcine_physics::Vec3;
use rayon::prelude::*;
use thiserror::Error;

pub use weights::Weights;

use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use overlap::{Overlap, Scratch};
pub(crate) use weights::Amount;
use weights::Piece;

/// Particles that cannot be mapped.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MappingError {
    /// A particle whose centre lies in no cell.
    #[error(
        "particle {particle} at ({}, {}, {}) m lies outside the mesh",
        position.x, position.y, position.z
    )]
    Outside {
        /// Index of the particle.
        particle: usize,
        /// Its centre in m.
        position: Vec3,
    },
    /// A radius that is negative or not finite.
    #[error("particle {particle} has a radius of {radius} m")]
    Radius {
        /// Index of the particle.
        particle: usize,
        /// Its radius in m.
        radius: f64,
    },
    /// Shares that no particle can have.
    #[error("the shares of particle {particle} in its cells sum to {total}, not to 1")]
    Shares {
        /// Index of the particle.
        particle: usize,
        /// Sum of its shares.
        total: f64,
    },
    /// Lists of different lengths.
    #[error("{positions} positions of particles, but {radii} radii")]
    Lengths {
        /// Number of positions.
        positions: usize,
        /// Number of radii.
        radii: usize,
    },
}

/// How a particle is divided among cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// All of it in the cell of its centre; for frozen beds and fine checks.
    Centroid,
    /// By 29 points of equal weight: the centre and two shells.
    Divided,
    /// By the exact volume that its sphere shares with each cell; continuous in position.
    Overlap,
}

/// Maps particles onto the cells of a mesh.
#[derive(Clone, Debug)]
pub struct Mapper<M> {
    locator: Locator<M>,
    overlap: Overlap,
}

impl<M: Deref<Target = Mesh> + Sync> Mapper<M> {
    /// Shares below this are round-off, not overlap.
    const ROUND_OFF: f64 = 1e-14;
    /// Particles that one thread takes at a time.
    const PIECE: usize = 256;

    /// The mapper of a mesh.
    pub fn new(mesh: M) -> Self {
        let locator = Locator::new(mesh);
        let overlap = Overlap::new(&locator);
        Self { locator, overlap }
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
        // Neighbours one after the other: they need the same cells, which memory is slow to give.
        let mut order: Vec<(usize, u32)> = positions
            .iter()
            .zip(0..)
            .map(|(&position, particle)| (self.locator.bin(position), particle))
            .collect();
        order.sort_unstable();
        let pieces: Vec<Piece> = order
            .par_chunks(Self::PIECE)
            .map_init(Memory::default, |memory, particles| {
                let mut piece = Piece::default();
                for &(_, particle) in particles {
                    let index = particle as usize;
                    let (position, radius) = (positions[index], radii[index]);
                    match self.row(method, index, position, radius, memory) {
                        Ok(()) => piece.push(particle, &mut memory.row, cells),
                        Err(error) => piece.fail(particle, error),
                    }
                }
                piece
            })
            .collect();
        Weights::from_pieces(cells, positions.len(), &pieces)
    }

    /// Leaves the cells of a particle, ascending, and its share in each in `memory.row`.
    fn row(
        &self,
        method: Method,
        particle: usize,
        position: Vec3,
        radius: f64,
        memory: &mut Memory,
    ) -> Result<(), MappingError> {
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(MappingError::Radius { particle, radius });
        }
        let (home, depth) = self
            .locator
            .cell_and_depth(position)
            .ok_or(MappingError::Outside { particle, position })?;
        memory.row.clear();
        match method {
            Method::Divided if depth < radius => self.by_satellites(position, radius, memory),
            Method::Overlap if depth < radius => self.by_overlap(position, radius, memory),
            _ => {}
        }
        // All of it lies in one cell; a sphere too small for its volume to be a number is a point.
        if memory.row.is_empty() {
            memory.row.push((home as u32, 1.0));
        }
        Ok(())
    }

    fn by_satellites(&self, position: Vec3, radius: f64, memory: &mut Memory) {
        let cells = satellites::points(position, radius)
            .filter_map(|point| self.locator.cell_at(point))
            .map(|cell| cell as u32);
        memory.cells.clear();
        memory.cells.extend(cells);
        memory.cells.sort_unstable();
        let shares = memory.cells.chunk_by(|a, b| a == b);
        let shares = shares.map(|same| (same[0], same.len() as f64));
        memory.row.extend(shares);
    }

    fn by_overlap(&self, position: Vec3, radius: f64, memory: &mut Memory) {
        let Memory {
            cells,
            scratch,
            row,
        } = memory;
        let sphere = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        self.locator.cells_near(position, radius, cells);
        let mesh = self.locator.mesh();
        let volumes = self.overlap.volumes(mesh, cells, position, radius, scratch);
        let shares = volumes.iter().map(|volume| volume / sphere);
        let shares = cells.iter().copied().zip(shares);
        row.extend(shares.filter(|&(_, share)| share > Self::ROUND_OFF));
    }
}

/// What the rows of one thread are made in.
#[derive(Default)]
struct Memory {
    cells: Vec<u32>,
    scratch: Scratch,
    row: Vec<(u32, f64)>,
}
