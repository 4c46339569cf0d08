//! Krylov solvers: conjugate gradients for symmetric matrices, BiCGStab for others.
//!
//! Hestenes and Stiefel 1952, doi 10.6028/jres.049.044; van der Vorst 1992,
//! doi 10.1137/0913035.

use super::matrix::Matrix;
use super::parallel::{dot, magnitude, update};
use super::preconditioner::Preconditioner;

/// A residual below this many units of round-off of the equation's terms cannot be improved.
pub const ROUND_OFF: f64 = 4.0 * f64::EPSILON;
/// Restarts from the true residual at most; one is the rule, more only where recurrence and true
/// residual have drifted apart.
const RESTARTS: u32 = 4;

/// When a solve ends: where Σ|b − A x| is below any of these.
#[derive(Clone, Copy, Debug)]
pub struct SolveTolerance {
    /// In the units of b.
    pub absolute: f64,
    /// As a share of the magnitudes of the equation's terms, Σ(|A| |x| + |b|).
    pub of_terms: f64,
    /// As a share of the initial residual.
    pub relative: f64,
    /// Iterations at most.
    pub iterations: u32,
}

/// How a solve went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveStatistics {
    /// Iterations done.
    pub iterations: u32,
    /// Σ|b − A x| before.
    pub initial: f64,
    /// Σ|b − A x| after, from the solution itself.
    pub residual: f64,
    /// True where the target, or round-off, was reached.
    pub converged: bool,
}

/// Scratch vectors of the solvers, reused from solve to solve.
#[derive(Clone, Debug, Default)]
pub struct Krylov {
    r: Vec<f64>,
    p: Vec<f64>,
    q: Vec<f64>,
    z: Vec<f64>,
    s: Vec<f64>,
    shadow: Vec<f64>,
    direction: Vec<f64>,
}

/// One run of a method from a residual: iterations, and whether the target was reached.
type Sweep = fn(&mut Krylov, &Matrix, &mut dyn Preconditioner, &mut [f64], f64, u32) -> u32;

impl Krylov {
    /// Solves A x = b for a symmetric positive definite A by conjugate gradients.
    pub fn symmetric(
        &mut self,
        matrix: &Matrix,
        preconditioner: &mut dyn Preconditioner,
        b: &[f64],
        x: &mut [f64],
        target: SolveTolerance,
    ) -> SolveStatistics {
        self.solve(conjugate_gradients, matrix, preconditioner, b, x, target)
    }

    /// Solves A x = b for a general A by BiCGStab.
    pub fn general(
        &mut self,
        matrix: &Matrix,
        preconditioner: &mut dyn Preconditioner,
        b: &[f64],
        x: &mut [f64],
        target: SolveTolerance,
    ) -> SolveStatistics {
        self.solve(bi_cg_stab, matrix, preconditioner, b, x, target)
    }

    fn solve(
        &mut self,
        sweep: Sweep,
        matrix: &Matrix,
        preconditioner: &mut dyn Preconditioner,
        b: &[f64],
        x: &mut [f64],
        target: SolveTolerance,
    ) -> SolveStatistics {
        self.resize(b.len());
        matrix.residual(x, b, &mut self.r);
        let initial = magnitude(&self.r);
        let mut solved = SolveStatistics {
            initial,
            residual: initial,
            ..SolveStatistics::default()
        };
        let mut goal = target.absolute.max(target.relative * initial);
        for _ in 0..RESTARTS {
            // Round-off is looked up only where the solve would go on, and anew as x changes.
            if solved.residual > goal {
                goal = goal.max((target.of_terms + ROUND_OFF) * matrix.terms(x, b));
            }
            solved.converged = solved.residual <= goal;
            let left = target.iterations.saturating_sub(solved.iterations);
            if solved.converged || left == 0 || !solved.residual.is_finite() {
                break;
            }
            preconditioner.renew(matrix);
            solved.iterations += sweep(self, matrix, preconditioner, x, goal, left);
            matrix.residual(x, b, &mut self.r);
            solved.residual = magnitude(&self.r);
            solved.converged = solved.residual <= goal;
        }
        solved
    }

    fn resize(&mut self, cells: usize) {
        if self.r.len() == cells {
            return;
        }
        for vector in [
            &mut self.r,
            &mut self.p,
            &mut self.q,
            &mut self.z,
            &mut self.s,
            &mut self.shadow,
            &mut self.direction,
        ] {
            vector.resize(cells, 0.0);
        }
    }
}

fn add(x: &mut [f64], factor: f64, p: &[f64]) {
    update(x, |i, x| *x += factor * p[i]);
}

fn conjugate_gradients(
    work: &mut Krylov,
    matrix: &Matrix,
    preconditioner: &mut dyn Preconditioner,
    x: &mut [f64],
    goal: f64,
    iterations: u32,
) -> u32 {
    let Krylov { r, p, q, z, .. } = work;
    let mut before = 0.0;
    for done in 1..=iterations {
        preconditioner.apply(r, z);
        let product = dot(r, z);
        let share = if done == 1 { 0.0 } else { product / before };
        before = product;
        update(p, |i, p| *p = z[i] + share * *p);
        matrix.times(p, q);
        let curvature = dot(p, q);
        if curvature == 0.0 || !curvature.is_finite() {
            return done;
        }
        let step = product / curvature;
        add(x, step, p);
        add(r, -step, q);
        if magnitude(r) <= goal {
            return done;
        }
    }
    iterations
}

fn bi_cg_stab(
    work: &mut Krylov,
    matrix: &Matrix,
    preconditioner: &mut dyn Preconditioner,
    x: &mut [f64],
    goal: f64,
    iterations: u32,
) -> u32 {
    let Krylov {
        r,
        p,
        q,
        z,
        s,
        shadow,
        direction,
    } = work;
    shadow.copy_from_slice(r);
    let (mut before, mut step, mut damping) = (1.0, 1.0, 1.0);
    for done in 1..=iterations {
        let product = dot(shadow, r);
        if product == 0.0 || !product.is_finite() {
            return done;
        }
        if done == 1 {
            p.copy_from_slice(r);
        } else {
            let share = product / before * step / damping;
            update(p, |i, p| *p = r[i] + share * (*p - damping * q[i]));
        }
        before = product;
        preconditioner.apply(p, direction);
        matrix.times(direction, q);
        let projection = dot(shadow, q);
        if projection == 0.0 {
            return done;
        }
        step = product / projection;
        add(x, step, direction);
        add(r, -step, q);
        if magnitude(r) <= goal {
            return done;
        }
        preconditioner.apply(r, z);
        matrix.times(z, s);
        let length = dot(s, s);
        if length == 0.0 {
            return done;
        }
        damping = dot(s, r) / length;
        add(x, damping, z);
        add(r, -damping, s);
        if magnitude(r) <= goal || damping == 0.0 {
            return done;
        }
    }
    iterations
}
