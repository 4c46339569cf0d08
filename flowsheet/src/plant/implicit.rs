//! Kennedy and Carpenter's implicit method.

use calcine_numerics::{DenseMatrix, LinearAlgebra};

use super::flows::{FlowWorkspace, Moment};
use super::topology::Plant;
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

/// ESDIRK4(3)6L: fourth order with an error estimate of third, six stages of which five are implicit, L-stable, stiffly
/// accurate.
///
/// Stages are solved with a Jacobian by differences that serves several steps; the step itself sums the stages' rates,
/// so that balances hold to round-off whatever the Jacobian's error.
///
/// Source: Kennedy and Carpenter, Appl. Numer. Math. 44 (2003) 139, doi 10.1016/S0168-9274(02)00138-1.
#[derive(Clone, Debug, Default)]
pub struct ImplicitRungeKutta {
    stages: Vec<Vec<f64>>,
    jacobian: Vec<f64>,
    /// Steps since the Jacobian; none before the first.
    age: Option<usize>,
    algebra: DenseMatrix,
    /// 1/(γ h) of the factors.
    factored: f64,
    /// Length of the next step in s; zero before the first.
    pub step: f64,
}

impl ImplicitRungeKutta {
    /// Advances unknowns and totals by one step that ends at `at.end` at the latest; the time it took. `fresh` where
    /// something jumped: rates and Jacobian are computed anew.
    #[expect(clippy::too_many_arguments, reason = "state and memory of one step")]
    pub fn advance(
        &mut self,
        plant: &Plant,
        at: Moment,
        y: &mut [f64],
        totals: &mut [f64],
        scales: &[f64],
        tolerance: f64,
        fresh: bool,
        work: &mut FlowWorkspace,
        steps: &mut [usize; 2],
    ) -> Result<f64, PlantError> {
        let (n, width) = (y.len(), y.len() + totals.len());
        if self.stages.len() != STAGES || self.stages[0].len() != width {
            self.stages = vec![vec![0.0; width]; STAGES];
            self.algebra.resize(n);
        }
        if fresh {
            self.age = None;
            plant.rates(at, y, work, &mut self.stages[0])?;
        }
        let left = at.end - at.time;
        if self.step <= 0.0 {
            let fastest = (0..n).map(|k| (self.stages[0][k] / (scales[k] + y[k].abs())).abs());
            let fastest = fastest.fold(0.0, f64::max);
            let guess = 0.1 * tolerance.powf(0.25) / fastest;
            self.step = if fastest > 0.0 { guess.min(left) } else { left };
        }
        let sizes: Vec<f64> = (0..n)
            .map(|k| tolerance * (scales[k] + y[k].abs()))
            .collect();
        loop {
            let ends = self.step >= 0.999 * left;
            let h = if ends { left } else { self.step };
            let before = work.streams.clone();
            if !self.solve(plant, at, y, scales, &sizes, h, work)? {
                steps[1] += 1;
                work.streams = before;
                // With an old Jacobian the same step again, else a shorter one.
                if self.age == Some(0) {
                    self.step = 0.25 * h;
                    if at.time + self.step <= at.time {
                        return Err(PlantError::Steps {
                            reached: at.time,
                            cause: "its steps became too small to add up",
                        });
                    }
                } else {
                    self.age = None;
                }
                continue;
            }
            let mut error: Vec<f64> = vec![0.0; n];
            for (stage, rates) in self.stages.iter().enumerate() {
                let weight = Self::weight(stage) - LOWER[stage];
                let pairs = error.iter_mut().zip(rates);
                pairs.for_each(|(e, k)| *e += weight * k / GAMMA);
            }
            self.algebra.solve(&mut error);
            let worst = error.iter().zip(&sizes).map(|(e, size)| (e / size).abs());
            let worst = worst.fold(0.0, f64::max).max(1e-10);
            let factor = 0.9 * worst.powf(-0.25);
            if worst <= 1.0 {
                for (stage, rates) in self.stages.iter().enumerate() {
                    let weight = h * Self::weight(stage);
                    let both = y.iter_mut().chain(totals.iter_mut());
                    both.zip(rates).for_each(|(x, k)| *x += weight * k);
                }
                self.stages.swap(0, STAGES - 1);
                steps[0] += 1;
                self.age = self.age.map(|age| age + 1);
                // Small changes of the step are not worth new factors.
                let grown = if (0.8..1.3).contains(&factor) {
                    1.0
                } else {
                    factor.clamp(0.2, 4.0)
                };
                self.step = if ends {
                    self.step.max(h * grown)
                } else {
                    h * grown
                };
                return Ok(h);
            }
            steps[1] += 1;
            work.streams = before;
            self.step = h * factor.clamp(0.1, 0.9);
        }
    }

    fn weight(stage: usize) -> f64 {
        A[4].get(stage).copied().unwrap_or(GAMMA)
    }

    /// All stages of a step; false where Newton's iteration does not converge.
    #[expect(clippy::too_many_arguments, reason = "state and memory of one step")]
    fn solve(
        &mut self,
        plant: &Plant,
        at: Moment,
        y: &[f64],
        scales: &[f64],
        sizes: &[f64],
        h: f64,
        work: &mut FlowWorkspace,
    ) -> Result<bool, PlantError> {
        let n = y.len();
        if self.age.is_none_or(|age| age >= JACOBIAN_STEPS) {
            let streams = work.streams.clone();
            plant.jacobian(
                at,
                y,
                &self.stages[0],
                scales,
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
        let mut known = vec![0.0; n];
        let mut place = vec![0.0; n];
        let mut change = vec![0.0; n];
        for stage in 1..STAGES {
            known.copy_from_slice(y);
            for (rates, a) in self.stages[..stage].iter().zip(A[stage - 1]) {
                known
                    .iter_mut()
                    .zip(rates)
                    .for_each(|(x, k)| *x += h * a * k);
            }
            let guess = &self.stages[stage - 1];
            for ((x, known), rate) in place.iter_mut().zip(&known).zip(guess) {
                *x = known + h * GAMMA * rate;
            }
            let moment = Moment {
                time: at.time + C[stage - 1] * h,
                end: at.end,
            };
            let mut last = f64::INFINITY;
            let mut converged = false;
            for iteration in 0..MOST_ITERATIONS {
                // A state that units refuse is no failure of the plant: a shorter step may keep away from it.
                if plant
                    .rates(moment, &place, work, &mut self.stages[stage])
                    .is_err()
                {
                    return Ok(false);
                }
                for (k, change) in change.iter_mut().enumerate() {
                    *change = diagonal * (known[k] - place[k]) + self.stages[stage][k];
                }
                self.algebra.solve(&mut change);
                let size = change.iter().zip(sizes).map(|(c, s)| (c / s).abs());
                let size = size.fold(0.0, f64::max);
                if !size.is_finite() || (iteration > 1 && size > 0.9 * last) {
                    break;
                }
                place.iter_mut().zip(&change).for_each(|(x, c)| *x += c);
                if size <= NEWTON {
                    converged = true;
                    break;
                }
                last = size;
            }
            if !converged
                || plant
                    .rates(moment, &place, work, &mut self.stages[stage])
                    .is_err()
            {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
