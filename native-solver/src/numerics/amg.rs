//! Algebraic multigrid by smoothed aggregation, as a preconditioner for symmetric positive
//! definite matrices: a V-cycle with two Chebyshev steps before and after each coarser level and
//! a direct solve on the coarsest, so that it is one symmetric linear map.
//!
//! Vaněk, Mandel and Brezina 1996, doi 10.1007/BF02238511; Chebyshev smoothing after Adams,
//! Brezina, Hu and Tuminaro 2003, doi 10.1016/S0021-9991(03)00194-3.

use nalgebra::{Cholesky, DMatrix, DVectorViewMut, Dyn};

use super::aggregate::interpolation;
use super::matrix::Matrix;
use super::parallel::{fill, largest, update};
use super::preconditioner::Preconditioner;
use super::sparse::Rows;

/// Couplings below this share of the strongest are weak on the finest level; half of it on each
/// coarser one, where the stencils are wider.
const THRESHOLD: f64 = 0.25;
/// Unknowns that are solved for directly.
const DIRECT: usize = 200;
/// Levels at most.
const LEVELS: usize = 20;
/// A level that keeps more than this share of the unknowns is not worth having.
const STALLED: f64 = 0.8;
/// The smoother damps from this share of the largest eigenvalue on.
const SMOOTHED: f64 = 0.25;
/// A diagonal that has changed by less than this share keeps the hierarchy that it has.
const KEPT: f64 = 0.2;

/// One level: its matrix, smoother, and the way to the next coarser one.
#[derive(Clone, Debug)]
struct Level {
    matrix: Rows,
    inverse: Vec<f64>,
    /// Factors of the two Chebyshev steps: of D⁻¹r in the first; of the first step and of D⁻¹r in
    /// the second.
    steps: [f64; 3],
    /// From the next coarser level to this one, and its transpose; empty on the coarsest.
    interpolation: Rows,
    restriction: Rows,
    right: Vec<f64>,
    x: Vec<f64>,
    other: Vec<f64>,
}

impl Level {
    fn new(matrix: Rows) -> Self {
        let count = matrix.len();
        let mut inverse = vec![0.0; count];
        fill(&mut inverse, |index| {
            let diagonal = matrix.pairs(index).find(|pair| pair.0 as usize == index);
            diagonal.map_or(1.0, |pair| 1.0 / pair.1)
        });
        // Gershgorin: no eigenvalue of D⁻¹A is larger.
        let (_, top) = largest(count, |index| {
            let sum: f64 = matrix.row(index).1.iter().map(|value| value.abs()).sum();
            sum * inverse[index]
        });
        let (middle, half) = (0.5 * (1.0 + SMOOTHED) * top, 0.5 * (1.0 - SMOOTHED) * top);
        let first = half / middle;
        let second = 1.0 / (2.0 / first - first);
        Self {
            matrix,
            inverse,
            steps: [1.0 / middle, first * second, 2.0 * second / half],
            interpolation: Rows::default(),
            restriction: Rows::default(),
            right: vec![0.0; count],
            x: vec![0.0; count],
            other: vec![0.0; count],
        }
    }

    /// Two Chebyshev steps from zero; the result is in `x`.
    fn smooth_from_zero(&mut self) {
        let [first, ..] = self.steps;
        fill(&mut self.other, |i| first * self.inverse[i] * self.right[i]);
        let [_, again, second] = self.steps;
        let (matrix, right, old) = (&self.matrix, &self.right, &self.other);
        fill(&mut self.x, |i| {
            let residual = right[i] - matrix.row_times(i, old);
            (1.0 + again) * old[i] + second * self.inverse[i] * residual
        });
    }

    /// Two Chebyshev steps from `x`; the result is in `x`.
    fn smooth(&mut self) {
        let [first, again, second] = self.steps;
        let (matrix, right, inverse) = (&self.matrix, &self.right, &self.inverse);
        let x = &self.x;
        fill(&mut self.other, |i| {
            let residual = right[i] - matrix.row_times(i, x);
            x[i] + first * inverse[i] * residual
        });
        let old = &self.other;
        update(&mut self.x, |i, x| {
            let residual = right[i] - matrix.row_times(i, old);
            *x = old[i] + again * (old[i] - *x) + second * inverse[i] * residual;
        });
    }

    /// What is left of the right side, restricted to the next coarser level.
    fn restrict(&mut self, coarser: &mut [f64]) {
        let (matrix, right, x) = (&self.matrix, &self.right, &self.x);
        fill(&mut self.other, |i| right[i] - matrix.row_times(i, x));
        let (restriction, residual) = (&self.restriction, &self.other);
        fill(coarser, |i| restriction.row_times(i, residual));
    }

    fn prolong(&mut self, coarser: &[f64]) {
        let interpolation = &self.interpolation;
        update(&mut self.x, |i, x| {
            *x += interpolation.row_times(i, coarser)
        });
    }
}

/// The multigrid.
#[derive(Clone, Debug, Default)]
pub struct Multigrid {
    levels: Vec<Level>,
    direct: Option<Cholesky<f64, Dyn>>,
    /// Diagonal of the matrix that the hierarchy was built for.
    diagonal: Vec<f64>,
    /// True where the hierarchy serves the matrix at hand.
    holds: bool,
}

impl Multigrid {
    /// Drops the hierarchy, so that the next one depends on its matrix alone.
    pub fn forget(&mut self) {
        self.levels.clear();
        self.holds = false;
    }

    /// Entries on all levels over those of the finest: what a cycle costs.
    pub fn complexity(&self) -> f64 {
        let entries = |level: &Level| level.matrix.entries() as f64;
        let all: f64 = self.levels.iter().map(entries).sum();
        all / self.levels.first().map_or(1.0, entries)
    }

    /// True if the hierarchy at hand still serves a matrix.
    fn serves(&self, matrix: &Matrix) -> bool {
        let (new, old) = (matrix.diagonal(), &self.diagonal);
        if self.levels.is_empty() || new.len() != old.len() {
            return false;
        }
        let (_, change) = largest(new.len(), |i| (new[i] / old[i] - 1.0).abs());
        change <= KEPT
    }

    fn build(&mut self, matrix: &Matrix) {
        let count = matrix.diagonal().len();
        self.diagonal.clear();
        self.diagonal.extend_from_slice(matrix.diagonal());
        self.levels.clear();
        let mut rows = Rows::build(count, count, |index, entries| {
            entries.add(index as u32, matrix.diagonal()[index]);
            let (columns, values) = matrix.row(index);
            for (&column, &value) in columns.iter().zip(values) {
                entries.add(column, value);
            }
        });
        let mut threshold = THRESHOLD;
        loop {
            let mut level = Level::new(rows);
            let fine = level.matrix.len();
            let (from, coarse) = if fine > DIRECT && self.levels.len() + 1 < LEVELS {
                interpolation(&level.matrix, threshold)
            } else {
                (Rows::default(), 0)
            };
            if coarse == 0 || coarse as f64 > STALLED * fine as f64 {
                self.levels.push(level);
                break;
            }
            let back = from.transposed(coarse);
            rows = back.product(&level.matrix.product(&from, coarse), coarse);
            (level.interpolation, level.restriction) = (from, back);
            self.levels.push(level);
            threshold *= 0.5;
        }
        self.direct = self.levels.last().and_then(factorised);
    }
}

/// The factorised matrix of the coarsest level, where that is small enough. Its two triangles
/// agree to round-off; the factorisation reads the lower one.
fn factorised(level: &Level) -> Option<Cholesky<f64, Dyn>> {
    let count = level.matrix.len();
    if count > DIRECT {
        return None;
    }
    let mut dense = DMatrix::zeros(count, count);
    for row in 0..count {
        for (column, value) in level.matrix.pairs(row) {
            dense[(row, column as usize)] = value;
        }
    }
    Cholesky::new(dense)
}

impl Preconditioner for Multigrid {
    fn expire(&mut self) {
        self.holds = false;
    }

    /// Takes up a matrix; where it is nearly the last one, the hierarchy is kept. The graph must
    /// stay the same.
    fn renew(&mut self, matrix: &Matrix) {
        if !self.holds && !self.serves(matrix) {
            self.build(matrix);
        }
        self.holds = true;
    }

    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let Some(finest) = self.levels.first_mut() else {
            z.copy_from_slice(r);
            return;
        };
        finest.right.copy_from_slice(r);
        let last = self.levels.len() - 1;
        for k in 0..last {
            let (fine, coarse) = self.levels.split_at_mut(k + 1);
            fine[k].smooth_from_zero();
            fine[k].restrict(&mut coarse[0].right);
        }
        let coarsest = &mut self.levels[last];
        if let Some(direct) = &self.direct {
            let count = coarsest.x.len();
            coarsest.x.copy_from_slice(&coarsest.right);
            direct.solve_mut(&mut DVectorViewMut::from_slice(&mut coarsest.x, count));
        } else {
            coarsest.smooth_from_zero();
        }
        for k in (0..last).rev() {
            let (fine, coarse) = self.levels.split_at_mut(k + 1);
            fine[k].prolong(&coarse[0].x);
            fine[k].smooth();
        }
        z.copy_from_slice(&self.levels[0].x);
    }
}
