//! Kennedy and Carpenter's implicit method.

use calcine_numerics::{DenseMatrix, LinearAlgebra};

use super::method::{Followed, Span, StepMethod, add_weighted, weighted, worst};
use crate::PlantError;

const GAMMA: f64 = 0.25;
const STAGES: usize = 6;
/// Lower triangle; the last row has the weights of the result.
const A: [[f64; 5]; 5] = [
    [0.25, 0.0, 0.0, 0.0, 0.0],
    [8611.0 / 62500.0, -1743.0 / 31250.0, 0.0, 0.0, 0.0],
    [
        5012029.0 / 34652500.0,
        -654441.0 / 2922500.0,
        174375.0 / 388108.0,
        0.0,
        0.0,
    ],
    [
        15267082809.0 / 155376265600.0,
        -71443401.0 / 120774400.0,
        730878875.0 / 902184768.0,
        2285395.0 / 8070912.0,
        0.0,
    ],
    [
        82889.0 / 524892.0,
        0.0,
        15625.0 / 83664.0,
        69875.0 / 102672.0,
        -2260.0 / 8211.0,
    ],
];
const C: [f64; 5] = [0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0];
/// Weights of third order.
const LOWER: [f64; STAGES] = [
    4586570599.0 / 29645900160.0,
    0.0,
    178811875.0 / 945068544.0,
    814220225.0 / 1159782912.0,
    -3700637.0 / 11593932.0,
    61727.0 / 225920.0,
];
/// Newton's iterations of a stage, and what they have to reach relative to the error of a step.
const MOST_ITERATIONS: usize = 10;
const NEWTON: f64 = 1e-2;
/// Steps with one Jacobian.
const JACOBIAN_STEPS: usize = 40;
/// Steps that do not grow after one whose stages were not found.
const HELD_STEPS: usize = 5;

/// ESDIRK4(3)6L: fourth order with an error estimate of third, six stages of which five are implicit, L-stable, stiffly
/// accurate.
///
/// Stages are solved with a Jacobian by differences that serves several steps; the step itself sums the stages' rates,
/// so that balances hold to round-off whatever the Jacobian's error.
///
/// Source: Kennedy and Carpenter, Appl. Numer. Math. 44 (2003) 139, doi 10.1016/S0168-9274(02)00138-1.
#[derive(Clone, Debug, Default)]
pub(super) struct ImplicitRungeKutta {
    stages: Vec<Vec<f64>>,
    jacobian: Vec<f64>,
    /// Steps since the Jacobian; none before the first.
    age: Option<usize>,
    algebra: DenseMatrix,
    /// 1/(γ h) of the factors.
    factored: f64,
    /// Steps that must not grow.
    held: usize,
    /// Change of the unknowns in 1/s over the step before; empty before the first.
    slope: Vec<f64>,
    memory: StageMemory,
    step: f64,
}

/// Vectors of the stages' iteration.
#[derive(Clone, Debug, Default)]
struct StageMemory {
    known: Vec<f64>,
    place: Vec<f64>,
    change: Vec<f64>,
    sizes: Vec<f64>,
}

impl StepMethod for ImplicitRungeKutta {
    fn advance(&mut self, span: &Span<'_>, now: &mut Followed) -> Result<f64, PlantError> {
        let (n, width) = (now.y.len(), now.y.len() + now.totals.len());
        if self.stages.len() != STAGES || self.stages[0].len() != width {
            self.stages = vec![vec![0.0; width]; STAGES];
            self.algebra.resize(n);
        }
        if span.fresh {
            self.age = None;
            self.held = 0;
            self.slope.clear();
            let first = &mut self.stages[0];
            span.plant.rates(span.at, &now.y, &mut now.work, first)?;
        }
        if self.step <= 0.0 {
            self.step = span.first_step(&now.y, &self.stages[0], 4);
        }
        let mut memory = std::mem::take(&mut self.memory);
        span.sizes(&now.y, &mut memory.sizes);
        let before = now.work.streams.clone();
        let took = loop {
            let (h, ends) = span.cut(self.step);
            if !self.solve(span, h, now, &mut memory)? {
                now.steps[1] += 1;
                now.work.streams.copy_from_slice(&before);
                // With an old Jacobian the same step again, else a shorter one.
                if self.age == Some(0) {
                    self.step = 0.4 * h;
                    self.held = HELD_STEPS;
                    let cause = "its steps became too small to add up";
                    if let Err(told) = span.too_short(self.step, None, cause) {
                        break Err(told);
                    }
                } else {
                    self.age = None;
                }
                continue;
            }
            let error = &mut memory.change;
            error.fill(0.0);
            let weights: [f64; STAGES] =
                std::array::from_fn(|stage| (Self::weight(stage) - LOWER[stage]) / GAMMA);
            add_weighted(error, 0, 1.0, &self.stages, &weights);
            self.algebra.solve(error);
            let error = worst(error.iter().copied(), &memory.sizes);
            let factor = 0.9 * error.max(1e-10).powf(-0.25);
            if error <= 1.0 || (span.forced && error.is_finite()) {
                let weights: [f64; STAGES] = std::array::from_fn(Self::weight);
                memory.known.copy_from_slice(&now.y);
                add_weighted(&mut now.y, 0, h, &self.stages, &weights);
                add_weighted(&mut now.totals, n, h, &self.stages, &weights);
                self.slope.clear();
                let moved = now.y.iter().zip(&memory.known);
                self.slope.extend(moved.map(|(new, old)| (new - old) / h));
                self.stages.swap(0, STAGES - 1);
                now.steps[0] += 1;
                self.age = self.age.map(|age| age + 1);
                let most = if self.held > 0 { 1.0 } else { 2.5 };
                self.held = self.held.saturating_sub(1);
                // Small changes of the step are not worth new factors.
                let grown = if (0.8..1.3).contains(&factor) {
                    1.0
                } else {
                    factor.clamp(0.2, most)
                };
                self.step = if ends && grown >= 1.0 {
                    self.step.max(h * grown)
                } else {
                    h * grown
                };
                break Ok(h);
            }
            now.steps[1] += 1;
            now.work.streams.copy_from_slice(&before);
            self.step = h * factor.clamp(0.1, 0.9);
        };
        self.memory = memory;
        took
    }

    fn step(&self) -> f64 {
        self.step
    }

    fn set_step(&mut self, step: f64) {
        self.step = step;
    }
}

impl ImplicitRungeKutta {
    fn weight(stage: usize) -> f64 {
        A[4].get(stage).copied().unwrap_or(GAMMA)
    }

    /// All stages of a step; false where Newton's iteration does not converge.
    fn solve(
        &mut self,
        span: &Span<'_>,
        h: f64,
        now: &mut Followed,
        memory: &mut StageMemory,
    ) -> Result<bool, PlantError> {
        let Followed { y, work, .. } = now;
        let n = y.len();
        if self.age.is_none_or(|age| age >= JACOBIAN_STEPS) {
            let streams = work.streams.clone();
            let rates = &self.stages[0];
            span.plant.jacobian(
                span.at,
                y,
                rates,
                span.scales,
                work,
                &mut self.jacobian,
                false,
            )?;
            work.streams = streams;
            self.age = Some(0);
            self.factored = 0.0;
        }
        let diagonal = 1.0 / (GAMMA * h);
        if self.factored != diagonal {
            if !self.algebra.factorise(diagonal, &self.jacobian) {
                return Ok(false);
            }
            self.factored = diagonal;
        }
        let StageMemory {
            known,
            place,
            change,
            sizes,
        } = memory;
        for row in [&mut *known, &mut *place, &mut *change] {
            row.resize(n, 0.0);
        }
        place.copy_from_slice(y);
        let mut before = 0.0;
        for stage in 1..STAGES {
            weighted(known, y, h, &self.stages[..stage], &A[stage - 1]);
            // The first guess is on the line through what is known, not by the rates, whose fast part would end within the step.
            let next = C[stage - 1];
            let ahead = (next - before) * h;
            if stage == 1 {
                let pairs = place.iter_mut().zip(&self.slope);
                pairs.for_each(|(x, slope)| *x += ahead * slope);
            } else {
                let pairs = place.iter_mut().zip(&*y);
                pairs.for_each(|(x, y)| *x += (*x - y) / (before * h) * ahead);
            }
            before = next;
            let moment = span.moment(next, h);
            let rates = &mut self.stages[stage];
            let mut last = f64::INFINITY;
            let mut converged = false;
            for iteration in 0..MOST_ITERATIONS {
                // A state that units refuse is no failure of the plant: a shorter step may keep away from it.
                if span.plant.rates(moment, place, work, rates).is_err() {
                    return Ok(false);
                }
                for (k, change) in change.iter_mut().enumerate() {
                    *change = diagonal * (known[k] - place[k]) + rates[k];
                }
                self.algebra.solve(change);
                let size = worst(change.iter().copied(), sizes);
                if !size.is_finite() || (iteration > 1 && size > 0.9 * last) {
                    break;
                }
                place.iter_mut().zip(&*change).for_each(|(x, c)| *x += c);
                if size <= NEWTON {
                    converged = true;
                    break;
                }
                last = size;
            }
            if !converged || span.plant.rates(moment, place, work, rates).is_err() {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
