//! The base mapping W₀: which share of each particle lies in which cell.

mod overlap;
mod satellites;
mod weights;

use calcine_physics::Vec3;
use rayon::prelude::*;
use thiserror::Error;

pub use weights::Weights;

use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use overlap::Overlap;
pub(crate) use weights::Amount;

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
pub struct Mapper<'m> {
    locator: Locator<'m>,
    overlap: Overlap,
}

impl<'m> Mapper<'m> {
    /// Shares below this are round-off, not overlap.
    const ROUND_OFF: f64 = 1e-14;

    /// The mapper of a mesh.
    pub fn new(mesh: &'m Mesh) -> Self {
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
        let rows: Vec<_> = positions
            .par_iter()
            .zip(radii)
            .enumerate()
            .map(|(particle, (&position, &radius))| self.row(method, particle, position, radius))
            .collect();
        // Collected one after the other, so that the first error is the one reported.
        let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
        Weights::new(self.locator.mesh().cells(), rows)
    }

    fn row(
        &self,
        method: Method,
        particle: usize,
        position: Vec3,
        radius: f64,
    ) -> Result<Vec<(u32, f64)>, MappingError> {
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(MappingError::Radius { particle, radius });
        }
        let (home, depth) = self
            .locator
            .cell_and_depth(position)
            .ok_or(MappingError::Outside { particle, position })?;
        if depth >= radius {
            return Ok(vec![(home as u32, 1.0)]);
        }
        Ok(match method {
            Method::Centroid => vec![(home as u32, 1.0)],
            Method::Divided => self.by_satellites(position, radius),
            Method::Overlap => self.by_overlap(home, position, radius),
        })
    }

    fn by_satellites(&self, position: Vec3, radius: f64) -> Vec<(u32, f64)> {
        let mut cells: Vec<u32> = satellites::points(position, radius)
            .filter_map(|point| self.locator.cell_at(point))
            .map(|cell| cell as u32)
            .collect();
        cells.sort_unstable();
        cells
            .chunk_by(|a, b| a == b)
            .map(|same| (same[0], same.len() as f64))
            .collect()
    }

    fn by_overlap(&self, home: usize, position: Vec3, radius: f64) -> Vec<(u32, f64)> {
        let ball = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let cells = self.locator.cells_near(position, radius);
        let locator = &self.locator;
        let volumes = self.overlap.volumes(locator, &cells, position, radius);
        let shares: Vec<_> = cells
            .into_iter()
            .zip(volumes.into_iter().map(|volume| volume / ball))
            .filter(|&(_, share)| share > Self::ROUND_OFF)
            .collect();
        // A ball too small for its volume to be a number is a point.
        if shares.is_empty() {
            return vec![(home as u32, 1.0)];
        }
        shares
    }
}
