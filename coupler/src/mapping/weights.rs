//! Weights of particles in cells: the base operator W₀ and its transpose.

use rayon::prelude::*;

use super::error::MappingError;

/// Up to so many rows the caller's thread does the work alone: waking another costs more.
const ALONE: usize = 16_384;

/// For each particle the cells it lies in and its share in each; the shares of a particle sum to 1
/// (docs/theory.md, CON-6). Kept by particle and by cell, so that both directions gather and results
/// do not depend on the number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    by_particle: Rows,
    by_cell: Rows,
}

/// A sparse matrix by rows.
#[derive(Clone, Debug, Default, PartialEq)]
struct Rows {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

/// What a particle or a cell holds: a number or a vector.
pub(crate) trait Amount:
    Copy
    + PartialEq
    + Send
    + Sync
    + std::ops::AddAssign
    + std::ops::Sub<Output = Self>
    + std::ops::Mul<f64, Output = Self>
{
    const ZERO: Self;
}

impl Amount for f64 {
    const ZERO: Self = 0.0;
}

impl Amount for calcine_physics::Vec3 {
    const ZERO: Self = Self::new(0.0, 0.0, 0.0);
}

impl Rows {
    /// Rows in the order of particles.
    fn from_pieces(particles: usize, pieces: &[Piece]) -> Self {
        let mut offsets = vec![0; particles + 1];
        for &(particle, length) in pieces.iter().flat_map(|piece| &piece.rows) {
            offsets[particle as usize + 1] = length;
        }
        for particle in 0..particles {
            offsets[particle + 1] += offsets[particle];
        }
        let mut columns = vec![0; offsets[particles]];
        let mut values = vec![0.0; offsets[particles]];
        for piece in pieces {
            let mut first = 0;
            for &(particle, length) in &piece.rows {
                let (from, to) = (first..first + length, offsets[particle as usize]);
                columns[to..to + length].copy_from_slice(&piece.columns[from.clone()]);
                values[to..to + length].copy_from_slice(&piece.values[from]);
                first += length;
            }
        }
        Self {
            offsets,
            columns,
            values,
        }
    }

    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.offsets[row]..self.offsets[row + 1];
        let columns = self.columns[range.clone()].iter();
        columns
            .map(|&column| column as usize)
            .zip(self.values[range].iter().copied())
    }

    /// The transpose, each row in ascending order of its columns.
    pub fn transposed(&self, columns: usize) -> Self {
        let mut offsets = vec![0usize; columns + 1];
        for &column in &self.columns {
            offsets[column as usize + 1] += 1;
        }
        for column in 0..columns {
            offsets[column + 1] += offsets[column];
        }
        let mut next = offsets.clone();
        let mut transposed = Self {
            offsets,
            columns: vec![0; self.columns.len()],
            values: vec![0.0; self.values.len()],
        };
        for row in 0..self.len() {
            for (column, value) in self.row(row) {
                let slot = next[column];
                transposed.columns[slot] = row as u32;
                transposed.values[slot] = value;
                next[column] += 1;
            }
        }
        transposed
    }

    /// The sum of one row with what its columns hold.
    pub fn gather<T: Amount>(&self, row: usize, from: &[T]) -> T {
        let mut sum = T::ZERO;
        for (column, value) in self.row(row) {
            sum += from[column] * value;
        }
        sum
    }

    /// The product with a vector.
    pub fn apply<T: Amount>(&self, from: &[T], to: &mut [T]) {
        debug_assert_eq!(to.len(), self.len());
        let set = |(row, value): (usize, &mut T)| *value = self.gather(row, from);
        if to.len() <= ALONE {
            to.iter_mut().enumerate().for_each(set);
        } else {
            let rows = to.par_iter_mut().with_min_len(1024).enumerate();
            rows.for_each(set);
        }
    }
}

/// Rows of some particles, in any order, one after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Piece {
    /// Each particle and the length of its row.
    rows: Vec<(u32, usize)>,
    columns: Vec<u32>,
    values: Vec<f64>,
    /// The first particle that has none.
    failed: Option<(u32, MappingError)>,
}

impl Piece {
    /// Takes the shares of a particle in some of `cells` cells, scaled to the sum 1.
    pub fn push(&mut self, particle: u32, row: &mut [(u32, f64)], cells: usize) {
        let total: f64 = row.iter().map(|&(_, share)| share).sum();
        let valid = |&(cell, share): &(u32, f64)| (cell as usize) < cells && share >= 0.0;
        if !(total > 0.0 && total.is_finite() && row.iter().all(valid)) {
            let index = particle as usize;
            let error = MappingError::Shares {
                particle: index,
                total,
            };
            return self.fail(particle, error);
        }
        row.sort_unstable_by_key(|&(cell, _)| cell);
        self.rows.push((particle, row.len()));
        self.columns.extend(row.iter().map(|&(cell, _)| cell));
        self.values
            .extend(row.iter().map(|&(_, share)| share / total));
    }

    /// Notes that a particle has no row.
    pub fn fail(&mut self, particle: u32, error: MappingError) {
        if self
            .failed
            .as_ref()
            .is_none_or(|(first, _)| particle < *first)
        {
            self.failed = Some((particle, error));
        }
    }
}

impl Weights {
    /// Weights of a mesh of `cells` cells from shares by particle, scaled to the sum 1.
    pub fn new(cells: usize, mut by_particle: Vec<Vec<(u32, f64)>>) -> Result<Self, MappingError> {
        let mut piece = Piece::default();
        for (row, particle) in by_particle.iter_mut().zip(0..) {
            piece.push(particle, row, cells);
        }
        Self::from_pieces(cells, by_particle.len(), &[piece])
    }

    /// Weights from pieces that have each particle once; the error is the first particle's.
    pub(super) fn from_pieces(
        cells: usize,
        particles: usize,
        pieces: &[Piece],
    ) -> Result<Self, MappingError> {
        let failed = pieces.iter().filter_map(|piece| piece.failed.as_ref());
        if let Some((_, error)) = failed.min_by_key(|(particle, _)| *particle) {
            return Err(error.clone());
        }
        let by_particle = Rows::from_pieces(particles, pieces);
        Ok(Self {
            by_cell: by_particle.transposed(cells),
            by_particle,
        })
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.by_particle.len()
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.by_cell.len()
    }

    /// The cells of a particle with its share in each, by ascending cell.
    pub fn of_particle(&self, particle: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.by_particle.row(particle)
    }

    /// The particles of a cell with their shares in it, by ascending particle.
    pub fn of_cell(&self, cell: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.by_cell.row(cell)
    }

    /// W₀ x: what particles carry, spread over cells.
    pub(crate) fn spread<T: Amount>(&self, per_particle: &[T], per_cell: &mut [T]) {
        self.by_cell.apply(per_particle, per_cell);
    }

    /// W₀ᵀ y: what particles see of the cells.
    pub(crate) fn sample<T: Amount>(&self, per_cell: &[T], per_particle: &mut [T]) {
        self.by_particle.apply(per_cell, per_particle);
    }
}
