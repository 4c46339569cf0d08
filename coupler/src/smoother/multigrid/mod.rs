//! A small algebraic multigrid for the symmetric systems of the smoother.
//!
//! One V-cycle is a fixed linear operator M. All its loops are sums by row, its smoothing before and
//! after the coarser level are transposes of each other, and the coarsest level is inverted, so M
//! is symmetric to round-off; it contracts in the energy norm, so the eigenvalues of MH lie in
//! (0, 1].

pub(super) mod aggregate;
mod krylov;
pub(super) mod level;

use nalgebra::DMatrix;

use crate::mapping::Amount;
use calcine_numerics::parallel;
use level::{Level, Matrix};

/// The V-cycle of a matrix.
#[derive(Clone, Debug)]
pub(super) struct Multigrid {
    levels: Vec<Level>,
    /// Inverse of the coarsest matrix, by rows, where there is a coarser level to invert.
    inverse: Option<Vec<f64>>,
}

/// A matrix of no more rows is inverted.
const FEW: usize = 64;
const MOST_LEVELS: usize = 24;

impl Multigrid {
    /// The multigrid of a symmetric positive definite matrix.
    pub fn new(matrix: Matrix) -> Self {
        let mut levels = Vec::new();
        let mut next = Some(matrix);
        let mut inverse = None;
        while let Some(matrix) = next.take() {
            if matrix.rows() <= FEW {
                inverse = inverted(&matrix);
            }
            let mut level = Level::new(matrix);
            if inverse.is_none() && levels.len() < MOST_LEVELS {
                next = level.coarsen(levels.len());
            }
            levels.push(level);
        }
        Self { levels, inverse }
    }

    /// The matrix.
    pub fn matrix(&self) -> &Matrix {
        &self.levels[0].matrix
    }

    /// Elements of scratch memory that a cycle takes.
    pub fn scratch(&self) -> usize {
        let coarse: usize = self.levels[1..]
            .iter()
            .map(|level| level.matrix.rows())
            .sum();
        self.matrix().rows() + 3 * coarse
    }

    /// x = M rhs.
    pub fn cycle<T: Amount>(&self, rhs: &[T], x: &mut [T], scratch: &mut [T]) {
        let (spare, rest) = scratch.split_at_mut(self.matrix().rows());
        self.cycle_from(0, rhs, x, spare, rest);
    }

    fn cycle_from<T: Amount>(
        &self,
        number: usize,
        rhs: &[T],
        x: &mut [T],
        spare: &mut [T],
        rest: &mut [T],
    ) {
        let level = &self.levels[number];
        if let (Some(inverse), None) = (&self.inverse, self.levels.get(number + 1)) {
            let rows = inverse.chunks_exact(rhs.len().max(1));
            for (x, row) in x.iter_mut().zip(rows) {
                *x = T::ZERO;
                row.iter().zip(rhs).for_each(|(&i, &r)| *x += r * i);
            }
            return;
        }
        level.smooth_first(rhs, x, spare);
        if let (Some(transfer), Some(coarser)) = (&level.transfer, self.levels.get(number + 1)) {
            parallel::fill(spare, |row| level.matrix.residual(row, rhs, x));
            let rows = coarser.matrix.rows();
            let (coarse_rhs, rest) = rest.split_at_mut(rows);
            let (coarse_x, rest) = rest.split_at_mut(rows);
            let (coarse_spare, rest) = rest.split_at_mut(rows);
            parallel::fill(coarse_rhs, |row| transfer.restrict.gather(row, spare));
            self.cycle_from(number + 1, coarse_rhs, coarse_x, coarse_spare, rest);
            parallel::update(x, |row, x| *x += transfer.prolong.gather(row, coarse_x));
        }
        level.smooth_last(rhs, x, spare);
    }
}

/// The inverse of a small matrix by rows, symmetric to the bit.
fn inverted(matrix: &Matrix) -> Option<Vec<f64>> {
    let rows = matrix.rows();
    let mut full = DMatrix::<f64>::zeros(rows, rows);
    for row in 0..rows {
        full[(row, row)] = matrix.diagonal[row];
        for (column, pull) in matrix.pull.row(row) {
            full[(row, column)] -= pull;
        }
    }
    let inverse = full.cholesky()?.inverse();
    let mean = 0.5 * (&inverse + inverse.transpose());
    Some(mean.as_slice().to_vec())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::sparse::Sparse;
    use super::*;

    /// The Laplacian of a cube of n³ cells with unit conductances, grounded by `leak` in every cell
    /// and by 1 in the first.
    fn grounded_cube(n: usize, leak: f64) -> Matrix {
        let at = |i: usize, j: usize, k: usize| (i + n * (j + n * k)) as u32;
        let pull = Sparse::from_entries(n * n * n, |entry| {
            let mut join = |a, b| {
                entry(a, b, 1.0);
                entry(b, a, 1.0);
            };
            for k in 0..n {
                for j in 0..n {
                    for i in 0..n {
                        if i + 1 < n {
                            join(at(i, j, k), at(i + 1, j, k));
                        }
                        if j + 1 < n {
                            join(at(i, j, k), at(i, j + 1, k));
                        }
                        if k + 1 < n {
                            join(at(i, j, k), at(i, j, k + 1));
                        }
                    }
                }
            }
        });
        let diagonal = (0..n * n * n)
            .map(|row| pull.gather(row, &vec![1.0; n * n * n]) + leak)
            .enumerate()
            .map(|(row, d)| if row == 0 { d + 1.0 } else { d });
        Matrix {
            diagonal: diagonal.collect(),
            pull,
        }
    }

    fn noise(count: usize, seed: usize) -> Vec<f64> {
        let hash = |i: usize| ((i + seed) as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11;
        (1..=count)
            .map(|i| hash(i) as f64 / (1u64 << 53) as f64 - 0.5)
            .collect()
    }

    #[test]
    fn the_cycle_is_symmetric_to_round_off() {
        let multigrid = Multigrid::new(grounded_cube(11, 1e-3));
        let (x, y) = (noise(1331, 3), noise(1331, 7000));
        let through = |rhs: &[f64]| {
            let mut out = vec![0.0; 1331];
            multigrid.cycle(rhs, &mut out, &mut vec![0.0; multigrid.scratch()]);
            out
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (one, other) = (dot(&through(&x), &y), dot(&x, &through(&y)));
        let size = dot(&through(&x), &x).abs();
        assert!((one - other).abs() < 1e-14 * size, "{one} {other}");
    }

    /// Smoothed aggregation converges independently of the size of the problem; the figure is
    /// the slowest mode's share that one cycle takes away.
    #[test]
    fn the_cycle_takes_away_at_least_two_fifths_of_every_mode_whatever_the_size() {
        for cells in [8, 16, 32] {
            for leak in [0.0, 1e-3, 0.5] {
                let multigrid = Multigrid::new(grounded_cube(cells, leak));
                let least = multigrid.least_eigenvalue();
                assert!((0.4..=1.0).contains(&least), "{cells} {leak}: {least}");
            }
        }
    }

    #[test]
    fn the_solution_of_a_grounded_cube_has_the_residual_asked_for() {
        let multigrid = Multigrid::new(grounded_cube(20, 0.0));
        let rhs = noise(8000, 1);
        let mut x = vec![0.0; 8000];
        multigrid.solve(&rhs, &mut x, &vec![1.0; 8000], 1e-12);
        let residual = (0..8000).map(|row| multigrid.matrix().residual(row, &rhs, &x).abs());
        assert!(residual.fold(0.0, f64::max) < 2e-12);
    }
}
