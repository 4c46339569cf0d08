//! One level of the multigrid: a symmetric matrix, its smoothing, and the way to the next level.

use super::super::sparse::Sparse;
use super::aggregate::Aggregates;
use crate::mapping::Amount;
use calcine_numerics::parallel;

/// A symmetric matrix with a positive diagonal, as (H x)_i = d_i x_i − Σ_j p_ij x_j.
#[derive(Clone, Debug)]
pub(in super::super) struct Matrix {
    pub diagonal: Vec<f64>,
    /// p, how much each row is pulled by its neighbours.
    pub pull: Sparse,
}

impl Matrix {
    pub fn rows(&self) -> usize {
        self.diagonal.len()
    }

    /// r − H x of one row.
    #[inline]
    pub fn residual<T: Amount>(&self, row: usize, rhs: &[T], x: &[T]) -> T {
        let mut residual = rhs[row] - x[row] * self.diagonal[row];
        residual += self.pull.gather(row, x);
        residual
    }
}

/// A level. Its smoothing is the Chebyshev polynomial of degree 2 in D⁻¹H on [b/RANGE, b], b the
/// largest eigenvalue by Gershgorin's theorem, done as two weighted Jacobi steps.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub matrix: Matrix,
    /// 1/d.
    inverse: Vec<f64>,
    /// Weights of the two Jacobi steps.
    steps: [f64; 2],
    /// The way to the next coarser level and back, if there is one.
    pub transfer: Option<Transfer>,
}

/// Prolongation and its transpose.
#[derive(Clone, Debug)]
pub(super) struct Transfer {
    pub prolong: Sparse,
    pub restrict: Sparse,
}

/// Spread of the eigenvalues that smoothing is for.
const RANGE: f64 = 5.0;
/// Rows whose neighbours pull less than this share of the diagonal are smooth without a coarser
/// level: their eigenvalues lie within the smoothing's range.
const PULLED: f64 = 0.6;
/// Joined strongly on the finest level: |p| above this times the mean (geometric) of both diagonals;
/// half as much on each coarser one, where rows have more neighbours (Vaněk et al., as above).
const STRONG: f64 = 0.08;

impl Level {
    pub fn new(matrix: Matrix) -> Self {
        let bound = matrix.bound();
        let (least, most) = (bound / RANGE, bound);
        let (middle, half) = (0.5 * (most + least), 0.5 * (most - least));
        let root = std::f64::consts::FRAC_1_SQRT_2;
        Self {
            inverse: matrix.diagonal.iter().map(|d| 1.0 / d).collect(),
            steps: [1.0 / (middle + half * root), 1.0 / (middle - half * root)],
            matrix,
            transfer: None,
        }
    }

    /// Makes the transfer by smoothed aggregation and returns the next coarser matrix; `None` where
    /// smoothing alone does. With the prolongation P = (I − ω D⁻¹ H) P₀ of the aggregates' P₀ and
    /// ω = 4/(3 b), the coarser matrix is Pᵀ H P.
    pub fn coarsen(&mut self, number: usize) -> Option<Matrix> {
        let Matrix { diagonal, pull } = &self.matrix;
        let rows = self.matrix.rows();
        let mut pulled = vec![false; rows];
        parallel::fill(&mut pulled, |row| {
            pull.row(row).map(|(_, p)| p.abs()).sum::<f64>() > PULLED * diagonal[row]
        });
        let threshold = (STRONG * 0.5f64.powi(number as i32)).powi(2);
        let strong = |a: usize, b: usize, p: f64| p * p > threshold * diagonal[a] * diagonal[b];
        let aggregates = Aggregates::new(pull, strong, &pulled);
        let coarse = aggregates.count;
        if coarse == 0 || 10 * coarse > 9 * rows {
            return None;
        }
        let prolong = self.smoothed(&aggregates);
        let restrict = prolong.transposed(coarse);
        let half = self.matrix.times(&prolong, coarse);
        let matrix = Matrix::from_full(&restrict.times(&half, coarse));
        self.transfer = Some(Transfer { prolong, restrict });
        Some(matrix)
    }

    fn smoothed(&self, aggregates: &Aggregates) -> Sparse {
        let Matrix { diagonal, pull } = &self.matrix;
        let omega = 4.0 / (3.0 * self.matrix.bound());
        Sparse::build(self.matrix.rows(), 4, |row, prolong| {
            let first = prolong.columns.len();
            let mut add = |aggregate: u32, value: f64| {
                if aggregate == Aggregates::NONE {
                    return;
                }
                let known = prolong.columns[first..]
                    .iter()
                    .position(|&a| a == aggregate);
                match known {
                    Some(place) => prolong.values[first + place] += value,
                    None => prolong.push(aggregate, value),
                }
            };
            add(aggregates.of[row], 1.0 - omega);
            for (other, p) in pull.row(row) {
                add(aggregates.of[other], omega * p / diagonal[row]);
            }
        })
    }

    /// First half of the smoothing, from x = 0; `spare` is overwritten.
    pub fn smooth_first<T: Amount>(&self, rhs: &[T], x: &mut [T], spare: &mut [T]) {
        parallel::fill(spare, |row| rhs[row] * (self.steps[0] * self.inverse[row]));
        self.step(self.steps[1], rhs, spare, x);
    }

    /// Second half, the first half's transpose.
    pub fn smooth_last<T: Amount>(&self, rhs: &[T], x: &mut [T], spare: &mut [T]) {
        self.step(self.steps[1], rhs, x, spare);
        self.step(self.steps[0], rhs, spare, x);
    }

    fn step<T: Amount>(&self, weight: f64, rhs: &[T], from: &[T], to: &mut [T]) {
        parallel::fill(to, |row| {
            let mut new = self.matrix.residual(row, rhs, from) * (weight * self.inverse[row]);
            new += from[row];
            new
        });
    }
}

impl Matrix {
    /// No eigenvalue of D⁻¹H is larger (Gershgorin).
    fn bound(&self) -> f64 {
        let sum =
            |row: usize| self.pull.row(row).map(|(_, p)| p.abs()).sum::<f64>() / self.diagonal[row];
        1.0 + parallel::largest(self.rows(), sum).1.max(0.0)
    }

    fn times(&self, other: &Sparse, columns: usize) -> Sparse {
        let full = Sparse::build(self.rows(), 7, |row, full| {
            full.push(row as u32, self.diagonal[row]);
            for (column, p) in self.pull.row(row) {
                full.push(column as u32, -p);
            }
        });
        full.times(other, columns)
    }

    fn from_full(full: &Sparse) -> Self {
        let mut diagonal = vec![0.0; full.rows()];
        parallel::fill(&mut diagonal, |row| {
            let own = full.row(row).find(|&(column, _)| column == row);
            own.map_or(0.0, |(_, value)| value)
        });
        let pull = Sparse::build(full.rows(), 24, |row, pull| {
            for (column, value) in full.row(row).filter(|&(column, _)| column != row) {
                pull.push(column as u32, -value);
            }
        });
        Self { diagonal, pull }
    }
}
