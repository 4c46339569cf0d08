//! Dormand and Prince's method.

use super::method::{Followed, Span, StepMethod, add_weighted, weighted, worst};
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
pub(super) struct DormandPrince {
    stages: Vec<Vec<f64>>,
    place: Vec<f64>,
    sizes: Vec<f64>,
    step: f64,
}

impl DormandPrince {
    /// All stages of a step; the result stands in `place`.
    fn stages(&mut self, span: &Span<'_>, h: f64, now: &mut Followed) -> Result<(), PlantError> {
        for (stage, (row, c)) in A.iter().zip(C).enumerate() {
            weighted(&mut self.place, &now.y, h, &self.stages, &row[..=stage]);
            let to = &mut self.stages[stage + 1];
            let at = span.moment(c, h);
            span.plant.rates(at, &self.place, &mut now.work, to)?;
        }
        Ok(())
    }
}

impl StepMethod for DormandPrince {
    fn advance(&mut self, span: &Span<'_>, now: &mut Followed) -> Result<f64, PlantError> {
        let (n, width) = (now.y.len(), now.y.len() + now.totals.len());
        if self.stages.len() != 7 || self.stages[0].len() != width {
            self.stages = vec![vec![0.0; width]; 7];
        }
        self.place.resize(n, 0.0);
        if span.fresh {
            let first = &mut self.stages[0];
            span.plant.rates(span.at, &now.y, &mut now.work, first)?;
        }
        if self.step <= 0.0 {
            self.step = span.first_step(&now.y, &self.stages[0], 5);
        }
        span.sizes(&now.y, &mut self.sizes);
        let before = now.work.streams.clone();
        loop {
            let (h, ends) = span.cut(self.step);
            let failed = self.stages(span, h, now).err();
            let error = match &failed {
                Some(_) => f64::INFINITY,
                None => {
                    self.place.fill(0.0);
                    add_weighted(&mut self.place, 0, h, &self.stages, &E);
                    worst(self.place.iter().copied(), &self.sizes)
                }
            };
            if error <= 1.0 || (span.forced && error.is_finite()) {
                add_weighted(&mut now.y, 0, h, &self.stages, &A[5]);
                add_weighted(&mut now.totals, n, h, &self.stages, &A[5]);
                self.stages.swap(0, 6);
                now.steps[0] += 1;
                let factor = (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0);
                self.step = if ends && factor >= 1.0 {
                    self.step.max(h * factor)
                } else {
                    h * factor
                };
                return Ok(h);
            }
            now.steps[1] += 1;
            now.work.streams.copy_from_slice(&before);
            let factor = 0.9 * error.min(1e6).powf(-0.2);
            self.step = h * factor.clamp(0.1, 0.9);
            span.too_short(
                self.step,
                failed,
                "its steps became too small to add up; let the `stiff` integrator follow it",
            )?;
        }
    }

    fn step(&self) -> f64 {
        self.step
    }

    fn set_step(&mut self, step: f64) {
        self.step = step;
    }
}
