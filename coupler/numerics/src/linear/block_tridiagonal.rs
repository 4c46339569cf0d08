//! Block-tridiagonal matrices.

use super::LinearAlgebra;
use super::dense::{factorise, solve};

/// A block-tridiagonal matrix of rows of blocks, such as a chain of shells that know their neighbours has: LU
/// factors by blocks, with row pivots inside the diagonal blocks only.
///
/// Order of the entries: for each row of blocks the block below the diagonal, the diagonal one, the one above it,
/// each row by row; the first row's first block and the last row's last are not looked at.
///
/// Validity: diagonal blocks that dominate, as those of 1/(γ h) I − J do for diffusion with any reaction that
/// is stable by itself.
///
/// Source: Golub and Van Loan, Matrix Computations, 4th ed. (2013), section 4.5.
#[derive(Clone, Debug)]
pub struct BlockTridiagonal {
    rows: usize,
    block: usize,
    /// Of each row of blocks: L's block, the factors of the diagonal block, and the block above.
    factors: Vec<f64>,
    pivots: Vec<usize>,
    column: Vec<f64>,
}

impl BlockTridiagonal {
    /// Matrices of so many rows of blocks of an order.
    pub fn new(rows: usize, block: usize) -> Self {
        Self {
            rows,
            block,
            factors: vec![0.0; 3 * rows * block * block],
            pivots: vec![0; rows * block],
            column: vec![0.0; block],
        }
    }

    /// Place in the entries of the derivative of a row's value by one of its own row of blocks or of a
    /// neighbour's: `(row of blocks, place in it)` each.
    pub fn place(&self, (row, i): (usize, usize), (column, j): (usize, usize)) -> usize {
        let size = self.block * self.block;
        (3 * row + column + 1 - row) * size + i * self.block + j
    }
}

impl LinearAlgebra for BlockTridiagonal {
    fn entries(&self) -> usize {
        self.factors.len()
    }

    fn order(&self) -> usize {
        self.rows * self.block
    }

    fn factorise(&mut self, diagonal: f64, jacobian: &[f64]) -> bool {
        let (b, size) = (self.block, self.block * self.block);
        for (value, slope) in self.factors.iter_mut().zip(jacobian) {
            *value = -slope;
        }
        for row in 0..self.rows {
            let own = &mut self.factors[(3 * row + 1) * size..][..size];
            for k in 0..b {
                own[k * b + k] += diagonal;
            }
        }
        for row in 0..self.rows {
            if row > 0 {
                // D_i − L_i D_{i−1}⁻¹ U_{i−1}, column by column of U.
                let (before, here) = self.factors.split_at_mut(3 * row * size);
                let above = &before[(3 * row - 1) * size..];
                let last = &before[(3 * row - 2) * size..][..size];
                let pivots = &self.pivots[(row - 1) * b..row * b];
                let (lower, own) = here.split_at_mut(size);
                for j in 0..b {
                    for (k, value) in self.column.iter_mut().enumerate() {
                        *value = above[k * b + j];
                    }
                    solve(last, pivots, &mut self.column);
                    for i in 0..b {
                        let line = &lower[i * b..(i + 1) * b];
                        let sum: f64 = line.iter().zip(&self.column).map(|(a, x)| a * x).sum();
                        own[i * b + j] -= sum;
                    }
                }
            }
            let own = &mut self.factors[(3 * row + 1) * size..][..size];
            if !factorise(own, &mut self.pivots[row * b..(row + 1) * b], b) {
                return false;
            }
        }
        true
    }

    fn solve(&mut self, x: &mut [f64]) {
        let (b, size) = (self.block, self.block * self.block);
        let block = |at: usize| &self.factors[at * size..(at + 1) * size];
        let pivots = |row: usize| &self.pivots[row * b..(row + 1) * b];
        // z_i = D_i⁻¹ (x_i − L_i z_{i−1}), then x_i = z_i − D_i⁻¹ U_i x_{i+1}.
        for row in 0..self.rows {
            let (before, here) = x.split_at_mut(row * b);
            let here = &mut here[..b];
            if row > 0 {
                subtract(block(3 * row), &before[(row - 1) * b..], here);
            }
            solve(block(3 * row + 1), pivots(row), here);
        }
        for row in (0..self.rows.saturating_sub(1)).rev() {
            let (here, after) = x.split_at_mut((row + 1) * b);
            self.column.fill(0.0);
            let above = &self.factors[(3 * row + 2) * size..(3 * row + 3) * size];
            subtract(above, &after[..b], &mut self.column);
            let own = &self.factors[(3 * row + 1) * size..(3 * row + 2) * size];
            solve(own, &self.pivots[row * b..(row + 1) * b], &mut self.column);
            let here = here[row * b..].iter_mut();
            here.zip(&self.column).for_each(|(x, d)| *x += d);
        }
    }
}

/// out − A x.
fn subtract(a: &[f64], x: &[f64], out: &mut [f64]) {
    let b = out.len();
    for (value, line) in out.iter_mut().zip(a.chunks_exact(b)) {
        *value -= line.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
    }
}

#[cfg(test)]
mod tests {
    use super::super::DenseMatrix;
    use super::*;

    #[test]
    fn agrees_with_the_dense_solution() {
        for block in [1, 2, 3, 65] {
            let rows = 4;
            let mut chain = BlockTridiagonal::new(rows, block);
            let n = rows * block;
            let mut full = vec![0.0; n * n];
            let mut entries = vec![0.0; chain.entries()];
            let mut seed = 1u64;
            for row in 0..rows {
                for column in row.saturating_sub(1)..(row + 2).min(rows) {
                    for i in 0..block {
                        for j in 0..block {
                            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                            let value = (seed >> 40) as f64 / 2f64.powi(24) - 0.5;
                            entries[chain.place((row, i), (column, j))] = value;
                            full[(row * block + i) * n + column * block + j] = value;
                        }
                    }
                }
            }
            let diagonal = 2.0 * block as f64;
            let mut dense = DenseMatrix::new(n);
            assert!(dense.factorise(diagonal, &full) && chain.factorise(diagonal, &entries));
            let right: Vec<f64> = (0..n).map(|k| (k as f64).sin()).collect();
            let (mut one, mut other) = (right.clone(), right);
            dense.solve(&mut one);
            chain.solve(&mut other);
            for (one, other) in one.iter().zip(other) {
                assert!((one - other).abs() < 1e-12, "{block}: {one} {other}");
            }
        }
    }
}
