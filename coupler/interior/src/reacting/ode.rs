//! Small stiff systems of ordinary differential equations.

use thiserror::Error;

/// Steps of one integration at most.
const STEPS: u32 = 20_000;

/// An integration that does not come to its end.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the rates could not be followed beyond {reached} s of {span} s, in {STEPS} steps")]
pub struct IntegrationStalled {
    /// How far it came in s.
    pub reached: f64,
    /// How far it was to go in s.
    pub span: f64,
}

/// Rosenbrock's method of second order with an error estimate of third, L-stable: stiff systems y' = f(y)
/// need no small steps. The Jacobian is taken by differences.
///
/// Source: Shampine and Reichelt, SIAM J. Sci. Comput. 18 (1997) 1, doi 10.1137/S1064827594276424
/// ("ode23s").
#[derive(Debug, Default)]
pub struct Rosenbrock {
    jacobian: Vec<f64>,
    matrix: Vec<f64>,
    pivots: Vec<usize>,
    rates: [Vec<f64>; 3],
    stages: [Vec<f64>; 3],
    other: Vec<f64>,
    next: Vec<f64>,
}

impl Rosenbrock {
    /// Advances `y` over a span with errors below `tolerance` (each in the unit of its y); `follow` is told of
    /// each step: its length and the states before and after.
    pub fn integrate(
        &mut self,
        mut rate: impl FnMut(&[f64], &mut [f64]),
        y: &mut [f64],
        span: f64,
        tolerance: &[f64],
        mut follow: impl FnMut(f64, &[f64], &[f64]),
    ) -> Result<(), IntegrationStalled> {
        let n = y.len();
        self.resize(n);
        let (mut time, mut step) = (0.0, span);
        let mut fresh = true;
        for _ in 0..STEPS {
            let left = span - time;
            step = if step > 0.99 * left { left } else { step };
            if fresh {
                rate(y, &mut self.rates[0]);
                self.differentiate(&mut rate, y, tolerance);
            }
            let error = self.attempt(&mut rate, y, step, tolerance);
            let factor = if error > 0.0 {
                (0.9 / error.cbrt()).clamp(0.2, 5.0)
            } else {
                5.0
            };
            if error <= 1.0 {
                follow(step, y, &self.next);
                y.copy_from_slice(&self.next);
                time += step;
                if step >= left {
                    return Ok(());
                }
            }
            fresh = error <= 1.0;
            step *= if error.is_finite() { factor } else { 0.2 };
            if step <= 1e-14 * span {
                break;
            }
        }
        Err(IntegrationStalled {
            reached: time,
            span,
        })
    }

    fn resize(&mut self, n: usize) {
        for list in self.rates.iter_mut().chain(&mut self.stages) {
            list.resize(n, 0.0);
        }
        self.other.resize(n, 0.0);
        self.next.resize(n, 0.0);
        self.jacobian.resize(n * n, 0.0);
        self.matrix.resize(n * n, 0.0);
        self.pivots.resize(n, 0);
    }

    /// The Jacobian at y, whose rates are known, by differences of a tenth of the tolerance.
    fn differentiate(
        &mut self,
        rate: &mut impl FnMut(&[f64], &mut [f64]),
        y: &[f64],
        tolerance: &[f64],
    ) {
        let n = y.len();
        self.other.copy_from_slice(y);
        for column in 0..n {
            let change = 0.1 * tolerance[column];
            self.other[column] = y[column] + change;
            let moved = self.other[column] - y[column];
            rate(&self.other, &mut self.rates[1]);
            self.other[column] = y[column];
            for row in 0..n {
                self.jacobian[row * n + column] = if moved == 0.0 {
                    0.0
                } else {
                    (self.rates[1][row] - self.rates[0][row]) / moved
                };
            }
        }
    }

    /// One step from y to `next`; its error relative to the tolerance.
    fn attempt(
        &mut self,
        rate: &mut impl FnMut(&[f64], &mut [f64]),
        y: &[f64],
        step: f64,
        tolerance: &[f64],
    ) -> f64 {
        let n = y.len();
        let gamma = 1.0 / (2.0 + std::f64::consts::SQRT_2);
        let third = 6.0 + std::f64::consts::SQRT_2;
        for (i, (value, slope)) in self.matrix.iter_mut().zip(&self.jacobian).enumerate() {
            let unit = if i / n == i % n { 1.0 } else { 0.0 };
            *value = unit - step * gamma * slope;
        }
        if !self.factorise(n) {
            return f64::INFINITY;
        }
        let [k1, k2, k3] = &mut self.stages;
        k1.copy_from_slice(&self.rates[0]);
        solve(&self.matrix, &self.pivots, k1);
        for i in 0..n {
            self.other[i] = y[i] + 0.5 * step * k1[i];
        }
        rate(&self.other, &mut self.rates[1]);
        for i in 0..n {
            k2[i] = self.rates[1][i] - k1[i];
        }
        solve(&self.matrix, &self.pivots, k2);
        for i in 0..n {
            k2[i] += k1[i];
            self.next[i] = y[i] + step * k2[i];
        }
        rate(&self.next, &mut self.rates[2]);
        for i in 0..n {
            k3[i] = self.rates[2][i]
                - third * (k2[i] - self.rates[1][i])
                - 2.0 * (k1[i] - self.rates[0][i]);
        }
        solve(&self.matrix, &self.pivots, k3);
        let share = |i: usize| {
            let error = step / 6.0 * (k1[i] - 2.0 * k2[i] + k3[i]);
            (error / tolerance[i]).abs()
        };
        (0..n).map(share).fold(0.0, |worst: f64, share| {
            if share.is_nan() {
                f64::INFINITY
            } else {
                worst.max(share)
            }
        })
    }

    /// LU factors with row pivots in place; false where the matrix is singular.
    fn factorise(&mut self, n: usize) -> bool {
        let a = &mut self.matrix;
        for k in 0..n {
            let row = (k..n).fold(k, |best, row| {
                if a[row * n + k].abs() > a[best * n + k].abs() {
                    row
                } else {
                    best
                }
            });
            self.pivots[k] = row;
            if row != k {
                for column in 0..n {
                    a.swap(row * n + column, k * n + column);
                }
            }
            let pivot = a[k * n + k];
            if !(pivot.abs() > 0.0 && pivot.is_finite()) {
                return false;
            }
            for row in k + 1..n {
                let share = a[row * n + k] / pivot;
                a[row * n + k] = share;
                for column in k + 1..n {
                    a[row * n + column] -= share * a[k * n + column];
                }
            }
        }
        true
    }
}

fn solve(factors: &[f64], pivots: &[usize], x: &mut [f64]) {
    let n = x.len();
    for (k, &pivot) in pivots.iter().enumerate() {
        x.swap(k, pivot);
    }
    for row in 1..n {
        for column in 0..row {
            x[row] -= factors[row * n + column] * x[column];
        }
    }
    for row in (0..n).rev() {
        for column in row + 1..n {
            x[row] -= factors[row * n + column] * x[column];
        }
        x[row] /= factors[row * n + row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robertson(y: &[f64], out: &mut [f64]) {
        let (slow, back, fast) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        out.copy_from_slice(&[back - slow, slow - back - fast, fast]);
    }

    #[test]
    fn robertson_s_stiff_problem_agrees_with_its_reference_solution() {
        // At t = 40: Hairer and Wanner, Solving Ordinary Differential Equations II, IV.10.
        let mut y = [1.0, 0.0, 0.0];
        let mut steps = 0;
        let tolerance = [1e-7, 1e-11, 1e-7];
        let mut method = Rosenbrock::default();
        method
            .integrate(robertson, &mut y, 40.0, &tolerance, |_, _, _| steps += 1)
            .unwrap();
        for (value, expected) in y
            .iter()
            .zip([0.715_827_069, 9.185_534_765e-6, 0.284_163_745])
        {
            assert!((value / expected - 1.0).abs() < 1e-4, "{y:?}");
        }
        assert!(steps < 2000, "{steps}");
    }

    #[test]
    fn the_error_falls_with_the_tolerance_to_its_two_thirds() {
        // One step errs by a tolerance in step³; over all of them it is of second order in the step.
        let error = |tolerance: f64| {
            let mut y = [1.0, 0.0];
            let circle = |y: &[f64], out: &mut [f64]| out.copy_from_slice(&[-y[1], y[0]]);
            let mut method = Rosenbrock::default();
            let asked = [tolerance; 2];
            method
                .integrate(circle, &mut y, 1.0, &asked, |_, _, _| ())
                .unwrap();
            (y[0] - 1f64.cos()).hypot(y[1] - 1f64.sin())
        };
        let order = (error(1e-6) / error(1e-9)).ln() / 1e3f64.ln();
        assert!((order - 2.0 / 3.0).abs() < 0.1, "{order}");
    }

    #[test]
    fn a_decay_a_million_times_faster_than_the_span_ends_at_rest() {
        let mut y = [1.0];
        let decay = |y: &[f64], out: &mut [f64]| out[0] = -1e6 * (y[0] - 0.25);
        let mut method = Rosenbrock::default();
        method
            .integrate(decay, &mut y, 1.0, &[1e-8], |_, _, _| ())
            .unwrap();
        assert!((y[0] - 0.25).abs() < 1e-7);
    }

    #[test]
    fn rates_that_are_no_numbers_are_an_error() {
        let mut y = [1.0];
        let none = |_: &[f64], out: &mut [f64]| out[0] = f64::NAN;
        let mut method = Rosenbrock::default();
        assert!(
            method
                .integrate(none, &mut y, 1.0, &[1e-8], |_, _, _| ())
                .is_err()
        );
    }
}
