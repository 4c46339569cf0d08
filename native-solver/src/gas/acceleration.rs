//! Anderson acceleration of the outer loop (Anderson 1965, doi 10.1145/321296.321305; Walker and Ni 2011, doi 10.1137/10078356X): the next iterate
//! combines the last ones such that what an iteration changes of the combination is least. With x the flow before an outer iteration, g(x) after it
//! and f = g(x) − x,
//!
//! x' = x + β f − Σ γ_j (Δx_j + β Δf_j),  γ minimising |f − Σ γ_j Δf_j|.
//!
//! For linear equations that is GMRES with an outer iteration as its preconditioner, and it converges as well where a part of the flow grows in each
//! iteration by itself: pressure corrections overshoot by friction on thin and stretched cells. The norm is
//! that of momentum, Σ m |Δu|² + Σ m |χ V Δ∇p/a|² over cells, both in the velocities that they mean. `calcine_numerics::Anderson` is the method for
//! short vectors: Euclidean norm, double precision, one thread, without β.

use calcine_coupler::physics::Vec3;
use nalgebra::{DMatrix, DVector};

use super::state::GasState;
use crate::numerics::parallel::{fill, sums, update};

/// Iterates that are combined beside the last one, at most.
const DEPTH: usize = 8;
/// Eigenvalues of the normal equations below this share of the largest are left out.
const INDEPENDENT: f64 = 1e-10;

/// Δ(x + f) and Δf between two iterations. Single precision: a combination is the guess of the next iteration, nothing else.
#[derive(Debug, Default)]
struct Change {
    after: Vec<f32>,
    step: Vec<f32>,
}

/// The last iterations of an outer loop, in memory that is kept from the first window on that needs it.
#[derive(Debug, Default)]
pub struct FlowAcceleration {
    /// x of the iteration at hand, then its f.
    step: Vec<f64>,
    /// x + f.
    after: Vec<f64>,
    /// The same of the iteration before.
    last_step: Vec<f64>,
    last_after: Vec<f64>,
    has_last: bool,
    /// Oldest first, as many as `count`.
    changes: Vec<Change>,
    count: usize,
    /// Σ products of Δf.
    products: DMatrix<f64>,
    /// m and m (χ V/a)² of each cell.
    weights: Vec<[f64; 2]>,
}

/// The flow of a state: velocity, pressure gradient, the gradient along faces, pressure, flux.
fn gather(now: &GasState, along: &[Vec3], flow: &mut Vec<f64>) {
    let cells = now.pressure.len();
    let faces = now.flux.len();
    flow.resize(7 * cells + 3 * along.len() + faces, 0.0);
    let (velocity, rest) = flow.split_at_mut(3 * cells);
    let (gradient, rest) = rest.split_at_mut(3 * cells);
    let (beside, rest) = rest.split_at_mut(3 * along.len());
    let (pressure, flux) = rest.split_at_mut(cells);
    fill(velocity, |i| now.velocity[i / 3][i % 3]);
    fill(gradient, |i| now.pressure_gradient[i / 3][i % 3]);
    fill(beside, |i| along[i / 3][i % 3]);
    pressure.copy_from_slice(&now.pressure);
    flux.copy_from_slice(&now.flux);
}

/// The other way round.
fn scatter(flow: &[f64], now: &mut GasState, along: &mut [Vec3]) {
    let cells = now.pressure.len();
    let (velocity, rest) = flow.split_at(3 * cells);
    let (gradient, rest) = rest.split_at(3 * cells);
    let (beside, rest) = rest.split_at(3 * along.len());
    let (pressure, flux) = rest.split_at(cells);
    let vector = |of: &[f64], i: usize| Vec3::new(of[3 * i], of[3 * i + 1], of[3 * i + 2]);
    fill(&mut now.velocity, |i| vector(velocity, i));
    fill(&mut now.pressure_gradient, |i| vector(gradient, i));
    fill(along, |i| vector(beside, i));
    now.pressure.copy_from_slice(pressure);
    now.flux.copy_from_slice(flux);
}

impl FlowAcceleration {
    /// Drops what there is.
    pub fn forget(&mut self) {
        self.has_last = false;
        self.count = 0;
    }

    /// Takes up the flow before an iteration, with χ V/a in m³ s/kg of each cell.
    pub fn begin(&mut self, now: &GasState, along: &[Vec3], push: impl Fn(usize) -> f64 + Sync) {
        gather(now, along, &mut self.step);
        if !self.has_last {
            self.weights.resize(now.mass.len(), [0.0; 2]);
            fill(&mut self.weights, |cell| {
                let mass = now.mass[cell];
                [mass, mass * push(cell) * push(cell)]
            });
        }
    }

    /// Combines the flow after it with those of earlier iterations; a share β of what it changed is taken.
    pub fn combine(&mut self, now: &mut GasState, along: &mut [Vec3], share: f64) {
        gather(now, along, &mut self.after);
        let after = &self.after;
        update(&mut self.step, |i, x| *x = after[i] - *x);
        if self.has_last {
            self.remember();
        }
        let factors = self.factors();
        let (step, after, changes) = (&self.step, &self.after, &self.changes[..self.count]);
        let left = 1.0 - share;
        let next = &mut self.last_after;
        next.resize(after.len(), 0.0);
        fill(next, |i| {
            let mut value = after[i] - left * step[i];
            for (change, factor) in changes.iter().zip(&factors) {
                let by = f64::from(change.after[i]) - left * f64::from(change.step[i]);
                value -= factor * by;
            }
            value
        });
        scatter(next, now, along);
        std::mem::swap(&mut self.last_after, &mut self.after);
        std::mem::swap(&mut self.last_step, &mut self.step);
        self.has_last = true;
    }

    /// Takes up by how much the iteration at hand differs from the last.
    fn remember(&mut self) {
        if self.count == DEPTH {
            self.changes.rotate_left(1);
            let kept = self.products.view((1, 1), (DEPTH - 1, DEPTH - 1));
            let kept = kept.clone_owned();
            self.products
                .view_mut((0, 0), (DEPTH - 1, DEPTH - 1))
                .copy_from(&kept);
            self.count -= 1;
        }
        if self.changes.len() == self.count {
            self.changes.push(Change::default());
        }
        let place = self.count;
        let change = &mut self.changes[place];
        let difference = |new: &[f64], old: &[f64], into: &mut Vec<f32>| {
            into.resize(new.len(), 0.0);
            fill(into, |i| (new[i] - old[i]) as f32);
        };
        difference(&self.after, &self.last_after, &mut change.after);
        difference(&self.step, &self.last_step, &mut change.step);
        self.count += 1;
        if self.products.nrows() != DEPTH {
            self.products = DMatrix::zeros(DEPTH, DEPTH);
        }
        for other in 0..=place {
            let product = self.product(&self.changes[place].step, &self.changes[other].step);
            self.products[(place, other)] = product;
            self.products[(other, place)] = product;
        }
    }

    /// Σ m u·u' + Σ m (χ V/a)² ∇p·∇p'.
    fn product<A: Copy + Into<f64> + Sync>(&self, one: &[A], other: &[f32]) -> f64 {
        let cells = self.weights.len();
        let dot = |start: usize| -> f64 {
            let pairs = one[start..start + 3].iter().zip(&other[start..start + 3]);
            pairs.map(|(&a, &b)| a.into() * f64::from(b)).sum()
        };
        let [sum] = sums(cells, |cell| {
            let [momentum, push] = self.weights[cell];
            [momentum * dot(3 * cell) + push * dot(3 * (cells + cell))]
        });
        sum
    }

    /// γ by least squares.
    fn factors(&self) -> Vec<f64> {
        let count = self.count;
        let scale = |j: usize| match self.products[(j, j)] {
            square if square > 0.0 => 1.0 / square.sqrt(),
            _ => 0.0,
        };
        let right = DVector::from_fn(count, |j, _| {
            scale(j) * self.product(&self.step, &self.changes[j].step)
        });
        let normal = DMatrix::from_fn(count, count, |i, j| {
            self.products[(i, j)] * scale(i) * scale(j)
        });
        if count == 0
            || !right
                .iter()
                .chain(normal.iter())
                .all(|value| value.is_finite())
        {
            return vec![0.0; count];
        }
        let eigen = normal.symmetric_eigen();
        let least = INDEPENDENT * eigen.eigenvalues.max();
        let mut found = DVector::zeros(count);
        let pairs = eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter());
        for (value, vector) in pairs.filter(|(value, _)| **value > least) {
            found += vector * (vector.dot(&right) / value);
        }
        (0..count).map(|j| found[j] * scale(j)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear iteration on velocity and pressure gradient of three cells, some of whose parts grow.
    fn iterate(now: &mut GasState, growth: &[f64]) {
        for (cell, velocity) in now.velocity.iter_mut().enumerate() {
            for axis in 0..3 {
                let (u, p) = (
                    velocity[axis] - 1.0,
                    now.pressure_gradient[cell][axis] + 2.0,
                );
                let [a, b] = [growth[2 * axis], growth[2 * axis + 1]];
                // Eigenvalues a and b on oblique directions.
                let (first, second) = (u - 0.5 * p, p);
                let (first, second) = (a * first, b * second);
                velocity[axis] = 1.0 + first + 0.5 * second;
                now.pressure_gradient[cell][axis] = second - 2.0;
            }
        }
    }

    fn start() -> GasState {
        GasState {
            mass: vec![1.0, 2.0, 0.5],
            velocity: (1..4)
                .map(|i| Vec3::new(0.3, -1.0, 2.0) * f64::from(i))
                .collect(),
            pressure_gradient: vec![Vec3::new(1.0, 2.0, 3.0); 3],
            pressure: vec![0.0; 3],
            flux: vec![0.0; 2],
            ..GasState::default()
        }
    }

    #[test]
    fn what_grows_in_each_iteration_is_cancelled_as_by_gmres() {
        // Five different eigenvalues, three of them outside the unit circle: exact after five combinations, to what single precision leaves.
        let growth = [-3.0, 0.5, 1.8, -3.0, 0.2, -1.4];
        for share in [1.0, 0.5] {
            let mut acceleration = FlowAcceleration::default();
            let mut now = start();
            for _ in 0..7 {
                acceleration.begin(&now, &[], |_| 1.0);
                iterate(&mut now, &growth);
                acceleration.combine(&mut now, &mut [], share);
            }
            for (velocity, gradient) in now.velocity.iter().zip(&now.pressure_gradient) {
                let error = (velocity.add_scalar(-1.0)).norm() + gradient.add_scalar(2.0).norm();
                assert!(error < 1e-3, "{share}: {error}");
            }
        }
    }

    #[test]
    fn an_iteration_that_changes_nothing_stays_there() {
        let mut acceleration = FlowAcceleration::default();
        let mut now = start();
        for _ in 0..3 {
            acceleration.begin(&now, &[], |_| 1.0);
            acceleration.combine(&mut now, &mut [], 1.0);
        }
        assert_eq!(now, start());
    }
}
