//! DenseMatrix matrices.

use super::LinearAlgebra;
use crate::Number;

/// A small dense matrix, row by row: LU factors with row pivots.
#[derive(Clone, Debug, Default)]
pub struct DenseMatrix {
    order: usize,
    factors: Vec<f64>,
    pivots: Vec<usize>,
}

impl DenseMatrix {
    /// Matrices of this order.
    pub fn new(order: usize) -> Self {
        let mut made = Self::default();
        made.resize(order);
        made
    }

    /// Changes the order; memory grows, and never shrinks.
    pub fn resize(&mut self, order: usize) {
        self.order = order;
        self.factors.resize(order * order, 0.0);
        self.pivots.resize(order, 0);
    }

    /// Solves with the factors, in place, for right sides that have derivatives.
    pub fn solve_numbers<N: Number>(&self, x: &mut [N]) {
        let n = self.order;
        for (k, &pivot) in self.pivots.iter().enumerate() {
            x.swap(k, pivot);
        }
        for row in 1..n {
            for column in 0..row {
                x[row] = x[row] - x[column].times(self.factors[row * n + column]);
            }
        }
        for row in (0..n).rev() {
            for column in row + 1..n {
                x[row] = x[row] - x[column].times(self.factors[row * n + column]);
            }
            x[row] = x[row].times(self.factors[row * n + row]);
        }
    }
}

impl LinearAlgebra for DenseMatrix {
    fn entries(&self) -> usize {
        self.order * self.order
    }

    fn order(&self) -> usize {
        self.order
    }

    fn factorise(&mut self, diagonal: f64, jacobian: &[f64]) -> bool {
        let n = self.order;
        for (value, slope) in self.factors.iter_mut().zip(jacobian) {
            *value = -slope;
        }
        for k in 0..n {
            self.factors[k * n + k] += diagonal;
        }
        factorise(&mut self.factors, &mut self.pivots, n)
    }

    fn solve(&mut self, x: &mut [f64]) {
        let (factors, pivots) = (&self.factors[..], &self.pivots[..]);
        // Orders of particles and small mechanisms, with loops of known length: the same operations in the same order.
        match self.order {
            2 => solve_of::<2>(factors, pivots, x),
            3 => solve_of::<3>(factors, pivots, x),
            4 => solve_of::<4>(factors, pivots, x),
            5 => solve_of::<5>(factors, pivots, x),
            6 => solve_of::<6>(factors, pivots, x),
            _ => solve(factors, pivots, x),
        }
    }
}

/// LU factors with row pivots in place, the inverse of U's diagonal on it; false where the matrix is
/// singular or not finite.
pub(super) fn factorise(a: &mut [f64], pivots: &mut [usize], n: usize) -> bool {
    for k in 0..n {
        let (mut row, mut most) = (k, a[k * n + k].abs());
        for candidate in k + 1..n {
            let size = a[candidate * n + k].abs();
            if size > most {
                (row, most) = (candidate, size);
            }
        }
        pivots[k] = row;
        if row != k {
            let (upper, lower) = a.split_at_mut(row * n);
            upper[k * n..(k + 1) * n].swap_with_slice(&mut lower[..n]);
        }
        let pivot = a[k * n + k];
        if !(pivot.abs() > 0.0 && pivot.is_finite()) {
            return false;
        }
        let inverse = 1.0 / pivot;
        a[k * n + k] = inverse;
        let (upper, lower) = a.split_at_mut((k + 1) * n);
        let own = &upper[k * n..];
        for line in lower.chunks_exact_mut(n) {
            let share = line[k] * inverse;
            line[k] = share;
            if share != 0.0 {
                for (value, own) in line[k + 1..].iter_mut().zip(&own[k + 1..]) {
                    *value -= share * own;
                }
            }
        }
    }
    true
}

/// Solves with the factors, in place.
pub(super) fn solve(factors: &[f64], pivots: &[usize], x: &mut [f64]) {
    let n = x.len();
    for (k, &pivot) in pivots.iter().enumerate() {
        x.swap(k, pivot);
    }
    for row in 1..n {
        let (known, rest) = x.split_at_mut(row);
        let line = &factors[row * n..row * n + row];
        rest[0] -= line.iter().zip(known).map(|(a, x)| a * *x).sum::<f64>();
    }
    for row in (0..n).rev() {
        let (rest, known) = x.split_at_mut(row + 1);
        let line = &factors[row * n + row + 1..(row + 1) * n];
        let sum: f64 = line.iter().zip(known).map(|(a, x)| a * *x).sum();
        rest[row] = (rest[row] - sum) * factors[row * n + row];
    }
}

/// [`solve`] of an order that the compiler knows.
fn solve_of<const N: usize>(factors: &[f64], pivots: &[usize], x: &mut [f64]) {
    let (rows, []) = factors.as_chunks::<N>() else {
        return solve(factors, pivots, x);
    };
    let (Some(rows), Ok(x)) = (rows.first_chunk::<N>(), <&mut [f64; N]>::try_from(&mut *x)) else {
        return solve(factors, pivots, x);
    };
    for (k, &pivot) in pivots.iter().take(N).enumerate() {
        x.swap(k, pivot);
    }
    for row in 1..N {
        let mut sum = 0.0;
        for k in 0..row {
            sum += rows[row][k] * x[k];
        }
        x[row] -= sum;
    }
    for row in (0..N).rev() {
        let mut sum = 0.0;
        for k in row + 1..N {
            sum += rows[row][k] * x[k];
        }
        x[row] = (x[row] - sum) * rows[row][row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_fulfils_its_equations_and_needs_pivots() {
        // The first pivot of 2 I − J is zero.
        let jacobian = [2.0, 3.0, -1.0, 4.0, 1.0, 7.0, 0.5, -2.0, 9.0];
        let mut matrix = DenseMatrix::new(3);
        assert!(matrix.factorise(2.0, &jacobian));
        let right = [1.0, -2.0, 0.25];
        let mut x = right;
        matrix.solve(&mut x);
        for (row, right) in right.iter().enumerate() {
            let line = &jacobian[3 * row..3 * row + 3];
            let product: f64 = line.iter().zip(x).map(|(a, x)| a * x).sum();
            assert!((2.0 * x[row] - product - right).abs() < 1e-14, "{x:?}");
        }
    }

    #[test]
    fn a_solution_with_derivatives_is_that_of_its_value_and_of_each_slope() {
        use crate::Dual;
        let jacobian = [2.0, 3.0, -1.0, 4.0, 1.0, 7.0, 0.5, -2.0, 9.0];
        let mut matrix = DenseMatrix::new(3);
        assert!(matrix.factorise(2.0, &jacobian));
        let sides = [[1.0, -2.0, 0.25], [0.0, 3.0, -1.0], [2.0, 0.5, 0.5]];
        let mut x = [0, 1, 2].map(|k| Dual::<2> {
            value: sides[0][k],
            slope: [sides[1][k], sides[2][k]],
        });
        matrix.solve_numbers(&mut x);
        for (lane, side) in sides.into_iter().enumerate() {
            let mut expected = side;
            matrix.solve(&mut expected);
            for (found, expected) in x.iter().zip(expected) {
                let found = [found.value, found.slope[0], found.slope[1]][lane];
                assert!(
                    (found - expected).abs() < 1e-14,
                    "{lane}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn orders_that_the_compiler_knows_have_the_bits_of_all_others() {
        for order in 1..9 {
            let value = |k: usize| ((7 * k + 3) as f64).sin();
            let jacobian: Vec<f64> = (0..order * order).map(value).collect();
            let mut matrix = DenseMatrix::new(order);
            assert!(matrix.factorise(1.5, &jacobian));
            let mut x: Vec<f64> = (0..order).map(|k| value(k + 100)).collect();
            let mut other = x.clone();
            matrix.solve(&mut x);
            solve(&matrix.factors, &matrix.pivots, &mut other);
            assert_eq!(x, other);
        }
    }

    #[test]
    fn a_singular_matrix_and_one_with_nan_have_no_factors() {
        let mut matrix = DenseMatrix::new(2);
        assert!(!matrix.factorise(1.0, &[1.0, 0.0, 0.0, 0.0]));
        assert!(!matrix.factorise(1.0, &[f64::NAN, 0.0, 0.0, 0.0]));
    }
}
