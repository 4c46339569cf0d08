//! Sparse matrices by rows.

use rayon::prelude::*;

use crate::mapping::Amount;
use calcine_numerics::parallel;

/// A sparse matrix by rows, 12 bytes per entry and 8 per row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sparse {
    pub offsets: Vec<usize>,
    pub columns: Vec<u32>,
    pub values: Vec<f64>,
}

impl Sparse {
    /// A matrix whose rows are pushed one after the other.
    pub fn with_capacity(rows: usize, entries: usize) -> Self {
        let mut offsets = Vec::with_capacity(rows + 1);
        offsets.push(0);
        Self {
            offsets,
            columns: Vec::with_capacity(entries),
            values: Vec::with_capacity(entries),
        }
    }

    /// Adds an entry to the last row, which `end_row` ends.
    pub fn push(&mut self, column: u32, value: f64) {
        self.columns.push(column);
        self.values.push(value);
    }

    /// Ends a row.
    pub fn end_row(&mut self) {
        self.offsets.push(self.columns.len());
    }

    /// A matrix from (row, column, value), which `each` hands over twice in the same order.
    pub fn from_entries(rows: usize, each: impl Fn(&mut dyn FnMut(u32, u32, f64))) -> Self {
        let mut offsets = vec![0usize; rows + 1];
        each(&mut |row, _, _| offsets[row as usize + 1] += 1);
        for row in 0..rows {
            offsets[row + 1] += offsets[row];
        }
        let entries = offsets[rows];
        let (mut columns, mut values) = (vec![0; entries], vec![0.0; entries]);
        let mut next = offsets.clone();
        each(&mut |row, column, value| {
            let slot = &mut next[row as usize];
            columns[*slot] = column;
            values[*slot] = value;
            *slot += 1;
        });
        Self {
            offsets,
            columns,
            values,
        }
    }

    pub fn rows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Columns and values of a row.
    #[inline(always)]
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.offsets[row]..self.offsets[row + 1];
        let columns = self.columns[range.clone()].iter();
        columns
            .map(|&column| column as usize)
            .zip(self.values[range].iter().copied())
    }

    /// The sum of one row with what its columns hold.
    #[inline(always)]
    pub fn gather<T: Amount>(&self, row: usize, from: &[T]) -> T {
        let mut sum = T::ZERO;
        for (column, value) in self.row(row) {
            sum += from[column] * value;
        }
        sum
    }

    /// The same square matrix with all rows of one length, filled up by zeros on the diagonal, unless
    /// that takes half as much memory again: loops over rows of one length are foreseen by the
    /// processor.
    pub fn padded(self) -> Self {
        let length = |row: usize| self.offsets[row + 1] - self.offsets[row];
        let longest = (0..self.rows()).map(length).max().unwrap_or(0);
        if 2 * longest * self.rows() > 3 * self.columns.len() {
            return self;
        }
        Self::build(self.rows(), longest, |row, padded| {
            self.row(row)
                .for_each(|(column, value)| padded.push(column as u32, value));
            for _ in length(row)..longest {
                padded.push(row as u32, 0.0);
            }
        })
    }

    /// The transpose, each row in ascending order of its columns.
    pub fn transposed(&self, columns: usize) -> Self {
        Self::from_entries(columns, |entry| {
            for row in 0..self.rows() {
                for (column, value) in self.row(row) {
                    entry(column as u32, row as u32, value);
                }
            }
        })
    }

    /// The product with a matrix of `columns` columns.
    pub fn times(&self, other: &Self, columns: usize) -> Self {
        const UNSEEN: u32 = u32::MAX;
        let unseen = || vec![UNSEEN; columns];
        Self::build_with(self.rows(), 16, unseen, |place, row, product| {
            let first = product.columns.len();
            for (middle, a) in self.row(row) {
                for (column, b) in other.row(middle) {
                    if place[column] == UNSEEN {
                        place[column] = product.columns.len() as u32;
                        product.push(column as u32, 0.0);
                    }
                    product.values[place[column] as usize] += a * b;
                }
            }
            for &column in &product.columns[first..] {
                place[column as usize] = UNSEEN;
            }
        })
    }

    /// A matrix of which `row` pushes each row's entries; about `width` of them.
    pub fn build(rows: usize, width: usize, row: impl Fn(usize, &mut Self) + Sync) -> Self {
        Self::build_with(rows, width, || (), |(), index, matrix| row(index, matrix))
    }

    /// The same with memory that may be used from row to row, but must not change what comes out.
    fn build_with<M>(
        rows: usize,
        width: usize,
        memory: impl Fn() -> M + Sync + Send,
        row: impl Fn(&mut M, usize, &mut Self) + Sync,
    ) -> Self {
        let starts = (0..rows.div_ceil(parallel::CHUNK)).into_par_iter();
        let blocks: Vec<Self> = starts
            .map_init(memory, |memory, block| {
                let range = block * parallel::CHUNK..rows.min((block + 1) * parallel::CHUNK);
                let mut matrix = Self::with_capacity(range.len(), width * range.len());
                for index in range {
                    row(memory, index, &mut matrix);
                    matrix.end_row();
                }
                matrix
            })
            .collect();
        let entries = blocks.iter().map(|block| block.columns.len()).sum();
        let mut matrix = Self::with_capacity(rows, entries);
        for block in blocks {
            let before = matrix.columns.len();
            let ends = block.offsets[1..].iter().map(|end| before + end);
            matrix.offsets.extend(ends);
            matrix.columns.extend(block.columns);
            matrix.values.extend(block.values);
        }
        matrix
    }
}

/// A square matrix that is multiplied by differences: six entries in each row, those that some rows have beyond in
/// a matrix of their own. Loops over rows of a length that is known when they are compiled need no branches.
#[derive(Clone, Debug)]
pub(super) struct Stencil {
    columns: Vec<[u32; 6]>,
    values: Vec<[f64; 6]>,
    /// Rows with more entries, ascending, and these entries.
    pub long: Vec<u32>,
    beyond: Sparse,
}

impl Stencil {
    pub fn new(matrix: &Sparse) -> Self {
        let rows = matrix.rows();
        let (mut columns, mut values) = (vec![[0; 6]; rows], vec![[0.0; 6]; rows]);
        let (mut long, mut beyond) = (Vec::new(), Sparse::with_capacity(0, 0));
        for row in 0..rows {
            columns[row] = [row as u32; 6];
            for (place, (column, value)) in matrix.row(row).enumerate() {
                if place < 6 {
                    columns[row][place] = column as u32;
                    values[row][place] = value;
                } else {
                    beyond.push(column as u32, value);
                }
            }
            if matrix.row(row).count() > 6 {
                long.push(row as u32);
                beyond.end_row();
            }
        }
        Self {
            columns,
            values,
            long,
            beyond,
        }
    }

    /// Σ a_rj (x_j − x_r) over the first entries of a row.
    #[inline(always)]
    pub fn differences<T: Amount>(&self, row: usize, x: &[T]) -> T {
        let (own, columns, values) = (x[row], &self.columns[row], &self.values[row]);
        let mut sum = T::ZERO;
        for k in 0..6 {
            sum += (x[columns[k] as usize] - own) * values[k];
        }
        sum
    }

    /// The same over what the row at a place of `long` has beyond them.
    pub fn differences_beyond<T: Amount>(&self, place: usize, x: &[T]) -> T {
        let own = x[self.long[place] as usize];
        let mut sum = T::ZERO;
        for (column, value) in self.beyond.row(place) {
            sum += (x[column] - own) * value;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stencil_takes_the_differences_of_short_and_long_rows_alike() {
        // Rows of 0 to 9 entries.
        let matrix = Sparse::build(10, 5, |row, matrix| {
            for k in 0..row {
                matrix.push(((row + 1 + k) % 10) as u32, (row * 10 + k) as f64);
            }
        });
        let x: Vec<f64> = (0..10).map(|i| f64::from(i * i)).collect();
        let stencil = Stencil::new(&matrix);
        assert_eq!(stencil.long, [7, 8, 9]);
        for row in 0..10 {
            let wanted: f64 = matrix.row(row).map(|(c, a)| a * (x[c] - x[row])).sum();
            let mut found = stencil.differences(row, &x);
            if let Some(place) = stencil.long.iter().position(|&long| long as usize == row) {
                found += stencil.differences_beyond(place, &x);
            }
            // Whole numbers: exact.
            assert_eq!(found, wanted, "row {row}");
        }
    }
}
