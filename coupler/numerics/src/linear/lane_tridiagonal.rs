//! Block-tridiagonal systems side by side.

use crate::lanes::Lanes;

/// Chains of blocks, one in each lane, solved at once: Gauss and Jordan by blocks with row pivots inside the diagonal ones, each
/// lane with its own.
///
/// Entries and validity are those of [`super::BlockTridiagonal`]. The bits of a lane do not depend on its neighbours.
#[derive(Clone, Debug)]
pub struct LaneTridiagonal<const N: usize> {
    rows: usize,
    block: usize,
    /// Of each row of blocks D⁻¹ U, with D as elimination leaves it; of the last one D⁻¹.
    above: Vec<Lanes<N>>,
    /// The rows of a block while it is eliminated: D, U and the right side.
    work: Vec<Lanes<N>>,
}

impl<const N: usize> LaneTridiagonal<N> {
    /// Chains of so many rows of blocks of an order.
    pub fn new(rows: usize, block: usize) -> Self {
        Self {
            rows,
            block,
            above: vec![Lanes::default(); rows * block * block],
            work: vec![Lanes::default(); block * (2 * block + 1)],
        }
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        3 * self.rows * self.block * self.block
    }

    /// D⁻¹ U of a row of blocks, row by row; of the last one D⁻¹.
    pub fn above(&self, row: usize) -> &[Lanes<N>] {
        let size = self.block * self.block;
        &self.above[row * size..(row + 1) * size]
    }

    /// Solves for a right side, in place. `B` is the order of the blocks, or zero for any.
    #[inline(always)]
    pub fn solve<const B: usize>(&mut self, entries: &[Lanes<N>], right: &mut [Lanes<N>]) {
        let b = if B == 0 { self.block } else { B };
        for row in 0..self.rows {
            let own = 3 * row * b * b..3 * (row + 1) * b * b;
            self.eliminate_row::<B>(row, &entries[own], right);
        }
        self.substitute::<B>(right);
    }

    /// Eliminates a row of blocks, of these entries, after the one before it.
    #[inline(always)]
    fn eliminate_row<const B: usize>(
        &mut self,
        row: usize,
        entries: &[Lanes<N>],
        right: &mut [Lanes<N>],
    ) {
        let b = if B == 0 { self.block } else { B };
        let (size, width) = (b * b, 2 * b + 1);
        let work = &mut self.work[..b * width];
        let (lower, rest) = entries[..3 * size].split_at(size);
        let (diagonal, upper) = rest.split_at(size);
        let last = row + 1 == self.rows;
        for i in 0..b {
            for j in 0..b {
                let mut value = diagonal[i * b + j];
                if row > 0 {
                    let before = &self.above[(row - 1) * size..row * size];
                    for k in 0..b {
                        value -= lower[i * b + k] * before[k * b + j];
                    }
                }
                work[i * width + j] = value;
                work[i * width + b + j] = if last {
                    Lanes::all(if i == j { 1.0 } else { 0.0 })
                } else {
                    upper[i * b + j]
                };
            }
            let mut value = right[row * b + i];
            if row > 0 {
                for k in 0..b {
                    value -= lower[i * b + k] * right[(row - 1) * b + k];
                }
            }
            work[i * width + 2 * b] = value;
        }
        eliminate(work, b, width);
        let above = &mut self.above[row * size..(row + 1) * size];
        for i in 0..b {
            for j in 0..b {
                above[i * b + j] = work[i * width + b + j];
            }
            right[row * b + i] = work[i * width + 2 * b];
        }
    }

    /// The solution, of right sides as elimination left them.
    #[inline(always)]
    fn substitute<const B: usize>(&self, right: &mut [Lanes<N>]) {
        let b = if B == 0 { self.block } else { B };
        let size = b * b;
        for row in (0..self.rows - 1).rev() {
            let above = &self.above[row * size..(row + 1) * size];
            for i in 0..b {
                let mut value = right[row * b + i];
                for k in 0..b {
                    value -= above[i * b + k] * right[(row + 1) * b + k];
                }
                right[row * b + i] = value;
            }
        }
    }
}

/// Brings the first `b` columns of `b` rows of a width to one: Gauss and Jordan, with row pivots in each lane by itself.
#[inline(always)]
pub fn eliminate<const N: usize>(rows: &mut [Lanes<N>], b: usize, width: usize) {
    let rows = &mut rows[..b * width];
    for k in 0..b {
        for i in k + 1..b {
            let (own, other) = (rows[k * width + k].abs(), rows[i * width + k].abs());
            if !(other - own).any(|more| more > 0.0) {
                continue;
            }
            for j in k..width {
                let (one, next) = (rows[k * width + j], rows[i * width + j]);
                rows[k * width + j] = own.if_below(other, next, one);
                rows[i * width + j] = own.if_below(other, one, next);
            }
        }
        let inverse = rows[k * width + k].inverse();
        for j in k + 1..width {
            rows[k * width + j] = rows[k * width + j] * inverse;
        }
        for i in 0..b {
            if i == k {
                continue;
            }
            let share = rows[i * width + k];
            for j in k + 1..width {
                let pivot = rows[k * width + j];
                rows[i * width + j] -= share * pivot;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BlockTridiagonal, LinearAlgebra};
    use super::*;

    #[test]
    fn every_lane_has_the_solution_of_its_own_chain() {
        for block in [1, 2, 3, 5] {
            let rows = 4;
            let mut lanes = LaneTridiagonal::<4>::new(rows, block);
            let mut entries = vec![Lanes::default(); lanes.entries()];
            let mut right = vec![Lanes::default(); rows * block];
            let mut seed = 7u64;
            let mut any = || {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (seed >> 40) as f64 / 2f64.powi(24) - 0.5
            };
            for value in entries.iter_mut().chain(&mut right) {
                value.0 = [any(), any(), any(), any()];
            }
            // Diagonal blocks dominate, by an element beside the diagonal in one lane, so that its rows change places.
            for row in 0..rows {
                for i in 0..block {
                    let place = |i: usize, j: usize| ((3 * row + 1) * block + i) * block + j;
                    (0..4).for_each(|lane| {
                        let j = if lane == 2 { (i + 1) % block } else { i };
                        entries[place(i, j)][lane] += 3.0 * block as f64;
                    });
                }
            }
            let mut found = right.clone();
            lanes.solve::<0>(&entries, &mut found);
            for lane in 0..4 {
                let mut chain = BlockTridiagonal::new(rows, block);
                let own: Vec<f64> = entries.iter().map(|value| -value[lane]).collect();
                let mut x: Vec<f64> = right.iter().map(|value| value[lane]).collect();
                assert!(chain.factorise(0.0, &own));
                chain.solve(&mut x);
                for (one, other) in found.iter().zip(&x) {
                    assert!((one[lane] - other).abs() < 1e-12, "{block} {lane}");
                }
            }
        }
    }
}
