//! Preconditioners: approximate inverses of a matrix.

use super::matrix::Matrix;

/// z ≈ A⁻¹ r, the same linear map at each call until the next `update`; symmetric where A is.
pub trait Preconditioner {
    /// Takes up a matrix.
    fn update(&mut self, matrix: &Matrix);

    /// z ≈ A⁻¹ r.
    fn apply(&mut self, r: &[f64], z: &mut [f64]);
}

/// Incomplete factorisation without fill, A ≈ (L + D) D⁻¹ (D + U); for a symmetric matrix the
/// incomplete Cholesky factorisation. Exact where no two neighbours of a cell come after it (a
/// chain of cells in order).
#[derive(Clone, Debug, Default)]
pub struct Incomplete {
    inverse: Vec<f64>,
    lower_start: Vec<u32>,
    lower: Vec<f64>,
    lower_column: Vec<u32>,
    upper_start: Vec<u32>,
    upper: Vec<f64>,
    upper_column: Vec<u32>,
}

impl Incomplete {
    fn take_graph(&mut self, matrix: &Matrix) {
        let cells = matrix.diagonal().len();
        self.inverse.resize(cells, 0.0);
        self.lower_start.push(0);
        self.upper_start.push(0);
        for cell in 0..cells {
            for &column in matrix.row(cell).0 {
                if (column as usize) < cell {
                    self.lower_column.push(column);
                } else {
                    self.upper_column.push(column);
                }
            }
            self.lower_start.push(self.lower_column.len() as u32);
            self.upper_start.push(self.upper_column.len() as u32);
        }
        self.lower.resize(self.lower_column.len(), 0.0);
        self.upper.resize(self.upper_column.len(), 0.0);
    }

    #[inline]
    fn lower_range(&self, cell: usize) -> std::ops::Range<usize> {
        self.lower_start[cell] as usize..self.lower_start[cell + 1] as usize
    }

    #[inline]
    fn upper_range(&self, cell: usize) -> std::ops::Range<usize> {
        self.upper_start[cell] as usize..self.upper_start[cell + 1] as usize
    }

    /// Subtracts `factor` times the upper part of row `pivot` from row `cell`, where it has
    /// entries; what this does to the diagonal is returned.
    #[inline]
    fn eliminate(&mut self, cell: usize, pivot: usize, factor: f64) -> f64 {
        let mut on_diagonal = 0.0;
        for k in self.upper_range(pivot) {
            let column = self.upper_column[k];
            let change = factor * self.upper[k];
            if column as usize == cell {
                on_diagonal = change;
                continue;
            }
            let (lower, upper) = (self.lower_range(cell), self.upper_range(cell));
            if (column as usize) < cell {
                if let Ok(at) = self.lower_column[lower.clone()].binary_search(&column) {
                    self.lower[lower.start + at] -= change;
                }
            } else if let Ok(at) = self.upper_column[upper.clone()].binary_search(&column) {
                self.upper[upper.start + at] -= change;
            }
        }
        on_diagonal
    }
}

impl Preconditioner for Incomplete {
    fn update(&mut self, matrix: &Matrix) {
        if self.inverse.is_empty() {
            self.take_graph(matrix);
        }
        for cell in 0..self.inverse.len() {
            let (_, values) = matrix.row(cell);
            let (lower, upper) = (self.lower_range(cell), self.upper_range(cell));
            self.lower[lower.clone()].copy_from_slice(&values[..lower.len()]);
            self.upper[upper].copy_from_slice(&values[lower.len()..]);
            let mut diagonal = matrix.diagonal()[cell];
            for k in lower {
                let pivot = self.lower_column[k] as usize;
                let factor = self.lower[k] * self.inverse[pivot];
                diagonal -= self.eliminate(cell, pivot, factor);
                self.lower[k] = factor;
            }
            self.inverse[cell] = 1.0 / diagonal;
        }
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
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
