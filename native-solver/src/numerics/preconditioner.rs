//! Preconditioners: approximate inverses of a matrix.

use rayon::prelude::*;

use super::matrix::Matrix;

/// Cells per block of an incomplete factorisation. Fixed, so that it does not depend on the
/// number of threads; couplings between blocks are left out.
const BLOCK: usize = 16 * 1024;

/// z ≈ A⁻¹ r, the same linear map at each call until the matrix changes; symmetric where A is.
pub trait Preconditioner {
    /// Says that the matrix is another one.
    fn expire(&mut self);

    /// Takes up the matrix, where it is another one than before; a solver asks for it before it applies.
    fn renew(&mut self, matrix: &Matrix);

    /// Takes up a matrix.
    fn update(&mut self, matrix: &Matrix) {
        self.expire();
        self.renew(matrix);
    }

    /// z ≈ A⁻¹ r.
    fn apply(&mut self, r: &[f64], z: &mut [f64]);
}

/// Incomplete factorisation without fill, A ≈ (L + D) D⁻¹ (D + U), in blocks of cells; for a
/// symmetric matrix the incomplete Cholesky factorisation. Exact where no two neighbours of a
/// cell come after it (a chain of cells in order), within one block.
#[derive(Clone, Debug, Default)]
pub struct Incomplete {
    blocks: Vec<Block>,
    /// True where the factors are of the matrix at hand.
    holds: bool,
}

/// The factorisation of a block of cells; indices count from its first one.
#[derive(Clone, Debug, Default)]
struct Block {
    first: usize,
    inverse: Vec<f64>,
    lower_start: Vec<u32>,
    lower: Vec<f64>,
    lower_column: Vec<u32>,
    upper_start: Vec<u32>,
    upper: Vec<f64>,
    upper_column: Vec<u32>,
    /// Where `pairs` begins for each entry of `lower`; one more.
    pair_start: Vec<u32>,
    /// What is subtracted while an entry of `lower` is eliminated: from what, which entry of `upper` in the pivot's row.
    pairs: Vec<(Target, u32)>,
}

/// An entry of the row that is eliminated.
#[derive(Clone, Copy, Debug)]
enum Target {
    Lower(u32),
    Diagonal,
    Upper(u32),
}

impl Block {
    fn new(matrix: &Matrix, first: usize) -> Self {
        let count = BLOCK.min(matrix.diagonal().len() - first);
        let mut block = Self {
            first,
            inverse: vec![0.0; count],
            lower_start: vec![0],
            upper_start: vec![0],
            ..Self::default()
        };
        for cell in 0..count {
            for &column in matrix.row(first + cell).0 {
                let other = (column as usize).wrapping_sub(first);
                if other < cell {
                    block.lower_column.push(other as u32);
                } else if other < count {
                    block.upper_column.push(other as u32);
                }
            }
            block.lower_start.push(block.lower_column.len() as u32);
            block.upper_start.push(block.upper_column.len() as u32);
        }
        block.lower.resize(block.lower_column.len(), 0.0);
        block.upper.resize(block.upper_column.len(), 0.0);
        block.find_pairs();
        block
    }

    /// Where the rows of pivots meet entries of the rows that they are subtracted from; there is no fill elsewhere.
    fn find_pairs(&mut self) {
        self.pair_start.push(0);
        for cell in 0..self.inverse.len() {
            let (lower, upper) = (self.lower_range(cell), self.upper_range(cell));
            for k in lower.clone() {
                let pivot = self.lower_column[k] as usize;
                for from in self.upper_range(pivot) {
                    let column = self.upper_column[from];
                    let within = |columns: &[u32], first: usize| {
                        let at = columns.binary_search(&column).ok()?;
                        Some((first + at) as u32)
                    };
                    let target = if column as usize == cell {
                        Some(Target::Diagonal)
                    } else if (column as usize) < cell {
                        let found = within(&self.lower_column[lower.clone()], lower.start);
                        found.map(Target::Lower)
                    } else {
                        let found = within(&self.upper_column[upper.clone()], upper.start);
                        found.map(Target::Upper)
                    };
                    self.pairs
                        .extend(target.map(|target| (target, from as u32)));
                }
                self.pair_start.push(self.pairs.len() as u32);
            }
        }
    }

    #[inline]
    fn lower_range(&self, cell: usize) -> std::ops::Range<usize> {
        self.lower_start[cell] as usize..self.lower_start[cell + 1] as usize
    }

    #[inline]
    fn upper_range(&self, cell: usize) -> std::ops::Range<usize> {
        self.upper_start[cell] as usize..self.upper_start[cell + 1] as usize
    }

    fn factorise(&mut self, matrix: &Matrix) {
        for cell in 0..self.inverse.len() {
            let (columns, values) = matrix.row(self.first + cell);
            let (lower, upper) = (self.lower_range(cell), self.upper_range(cell));
            // Columns ascend: what comes before the block, then lower, upper, and what follows.
            let before = columns.partition_point(|&column| (column as usize) < self.first);
            let middle = before + lower.len();
            self.lower[lower.clone()].copy_from_slice(&values[before..middle]);
            self.upper[upper.clone()].copy_from_slice(&values[middle..middle + upper.len()]);
            let mut diagonal = matrix.diagonal()[self.first + cell];
            for k in lower {
                let pivot = self.lower_column[k] as usize;
                let factor = self.lower[k] * self.inverse[pivot];
                let pairs = self.pair_start[k] as usize..self.pair_start[k + 1] as usize;
                for &(target, from) in &self.pairs[pairs] {
                    let change = factor * self.upper[from as usize];
                    match target {
                        Target::Diagonal => diagonal -= change,
                        Target::Lower(at) => self.lower[at as usize] -= change,
                        Target::Upper(at) => self.upper[at as usize] -= change,
                    }
                }
                self.lower[k] = factor;
            }
            self.inverse[cell] = 1.0 / diagonal;
        }
    }

    fn solve(&self, r: &[f64], z: &mut [f64]) {
        for cell in 0..r.len() {
            let mut sum = r[cell];
            for k in self.lower_range(cell) {
                sum -= self.lower[k] * z[self.lower_column[k] as usize];
            }
            z[cell] = sum;
        }
        for cell in (0..r.len()).rev() {
            let mut sum = z[cell];
            for k in self.upper_range(cell) {
                sum -= self.upper[k] * z[self.upper_column[k] as usize];
            }
            z[cell] = sum * self.inverse[cell];
        }
    }
}

impl Preconditioner for Incomplete {
    fn expire(&mut self) {
        self.holds = false;
    }

    fn renew(&mut self, matrix: &Matrix) {
        if self.holds {
            return;
        }
        self.holds = true;
        if self.blocks.is_empty() {
            let starts = (0..matrix.diagonal().len()).step_by(BLOCK);
            self.blocks = starts.map(|first| Block::new(matrix, first)).collect();
        }
        if let [block] = &mut self.blocks[..] {
            block.factorise(matrix);
        } else {
            let blocks = self.blocks.par_iter_mut();
            blocks.for_each(|block| block.factorise(matrix));
        }
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        if let [block] = &self.blocks[..] {
            block.solve(r, z);
            return;
        }
        let parts = r.par_chunks(BLOCK).zip(z.par_chunks_mut(BLOCK));
        let blocks = self.blocks.par_iter().zip(parts);
        blocks.for_each(|(block, (r, z))| block.solve(r, z));
    }
}
