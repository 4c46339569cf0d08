//! Dormand and Prince's method.

use super::flows::{FlowWorkspace, Moment};
use super::topology::Plant;
use crate::PlantError;

const A: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
const C: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
/// Difference of the weights of fifth and fourth order.
const E: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Dormand and Prince's pair of fifth and fourth order with control of its step. Balances are linear in the rates, so
/// that unknowns and totals stay together to round-off.
///
/// Source: Dormand and Prince, J. Comput. Appl. Math. 6 (1980) 19, doi 10.1016/0771-050X(80)90013-3.
#[derive(Clone, Debug, Default)]
pub struct DormandPrince {
    stages: Vec<Vec<f64>>,
    place: Vec<f64>,
    /// Length of the next step in s; zero before the first.
    pub step: f64,
}

impl DormandPrince {
    /// Advances unknowns and totals by one step that ends at `at.end` at the latest; the time it took. `fresh` where the
    /// rates at the start are not those of the last stage before (something jumped).
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
        if self.stages.len() != 7 || self.stages[0].len() != width {
            self.stages = vec![vec![0.0; width]; 7];
        }
        self.place.resize(n, 0.0);
        if fresh {
            plant.rates(at, y, work, &mut self.stages[0])?;
        }
        let left = at.end - at.time;
        if self.step <= 0.0 {
            self.step = self.first(y, scales, tolerance).min(left);
        }
        loop {
            let ends = self.step >= 0.999 * left;
            let h = if ends { left } else { self.step };
            for (stage, (row, c)) in A.iter().zip(C).enumerate() {
                self.place.copy_from_slice(y);
                for (rates, a) in self.stages[..=stage]
                    .iter()
                    .zip(row)
                    .filter(|(_, a)| **a != 0.0)
                {
                    let pairs = self.place.iter_mut().zip(&rates[..n]);
                    pairs.for_each(|(x, k)| *x += h * a * k);
                }
                let moment = Moment {
                    time: at.time + c * h,
                    end: at.end,
                };
                plant.rates(moment, &self.place, work, &mut self.stages[stage + 1])?;
            }
            let mut error = 0.0f64;
            for k in 0..n {
                let sum: f64 = self
                    .stages
                    .iter()
                    .zip(E)
                    .map(|(rates, e)| e * rates[k])
                    .sum();
                let size = tolerance * (scales[k] + y[k].abs());
                error = error.max((h * sum / size).abs());
                if sum.is_nan() {
                    error = f64::INFINITY;
                }
            }
            if error <= 1.0 {
                for (k, total) in totals.iter_mut().enumerate() {
                    let weighted = self.stages.iter().zip(&A[5]).map(|(r, b)| b * r[n + k]);
                    *total += h * weighted.sum::<f64>();
                }
                y.copy_from_slice(&self.place);
                self.stages.swap(0, 6);
                steps[0] += 1;
                let factor = 0.9 * error.max(1e-10).powf(-0.2);
                if !ends || factor < 1.0 {
                    self.step = h * factor.clamp(0.2, 5.0);
                } else {
                    self.step = self.step.max(h * factor.clamp(0.2, 5.0).min(5.0));
                }
                return Ok(h);
            }
            steps[1] += 1;
            let factor = if error.is_finite() {
                0.9 * error.powf(-0.2)
            } else {
                0.1
            };
            self.step = h * factor.clamp(0.1, 0.9);
            if at.time + self.step <= at.time {
                return Err(PlantError::Steps {
                    reached: at.time,
                    cause: "its steps became too small to add up; let the `stiff` integrator follow it",
                });
            }
        }
    }

    /// A first step by which unknowns change by a hundredth of what the tolerance's fifth root allows.
    fn first(&self, y: &[f64], scales: &[f64], tolerance: f64) -> f64 {
        let rates = &self.stages[0];
        let rate = (0..y.len()).map(|k| (rates[k] / (scales[k] + y[k].abs())).abs());
        let fastest = rate.fold(0.0, f64::max);
        if fastest > 0.0 {
            0.1 * tolerance.powf(0.2) / fastest
        } else {
            f64::INFINITY
        }
    }
}
