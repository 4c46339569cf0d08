//! Sommeijer, Shampine and Verwer's method.

use super::method::{Followed, Span, StepMethod, worst};
use crate::PlantError;

/// Damping of the stability polynomial.
const DAMPING: f64 = 2.0 / 13.0;
/// Most stages of a step.
const MOST_STAGES: usize = 400;

/// Runge–Kutta–Chebyshev: second order, explicit, with as many stages as the fastest rate of the plant asks for. Its steps grow
/// with the square of the stages, so that fast exchange through a small hold-up costs its square root.
///
/// Stages are sums of the rates, so that unknowns and totals stay together to round-off.
///
/// Source: Sommeijer, Shampine and Verwer, J. Comput. Appl. Math. 88 (1998) 315, doi 10.1016/S0377-0427(97)00219-7.
#[derive(Clone, Debug, Default)]
pub(super) struct Chebyshev {
    /// Rates at the start, and of a stage.
    first: Vec<f64>,
    rates: Vec<f64>,
    /// Start and the last two stages, unknowns and totals.
    start: Vec<f64>,
    stages: [Vec<f64>; 2],
    sizes: Vec<f64>,
    /// By how much the fastest rate turned out to be larger than it was said to be.
    surplus: f64,
    step: f64,
}

/// Coefficients of a number of stages.
struct Coefficients {
    /// Of each stage from the second on: μ, ν, μ̃, γ̃, and where it stands.
    stages: Vec<[f64; 5]>,
    /// μ̃ of the first stage, and where it stands.
    first: [f64; 2],
}

impl Coefficients {
    fn new(count: usize) -> Self {
        let s = count as f64;
        let w0 = 1.0 + DAMPING / (s * s);
        // Chebyshev's polynomials at w0 with two derivatives.
        let mut t = vec![[1.0, 0.0, 0.0], [w0, 1.0, 0.0]];
        for j in 2..=count {
            let ([a, da, dda], [b, db, ddb]) = (t[j - 2], t[j - 1]);
            t.push([
                2.0 * w0 * b - a,
                2.0 * b + 2.0 * w0 * db - da,
                4.0 * db + 2.0 * w0 * ddb - dda,
            ]);
        }
        let w1 = t[count][1] / t[count][2];
        let b = |j: usize| {
            let [_, first, second] = t[j.max(2)];
            second / (first * first)
        };
        let place = |j: usize| w1 * t[j][2] / t[j][1];
        let stage = |j: usize| {
            let slope = 2.0 * b(j) * w1 / b(j - 1);
            let a = 1.0 - b(j - 1) * t[j - 1][0];
            [
                2.0 * b(j) * w0 / b(j - 1),
                -b(j) / b(j - 2),
                slope,
                -a * slope,
                place(j),
            ]
        };
        Self {
            stages: (2..=count).map(stage).collect(),
            first: [b(1) * w1, place(2) / t[2][1]],
        }
    }

    /// Largest |h λ| of a real rate that is stable.
    fn reach(count: usize) -> f64 {
        let s = count as f64;
        2.0 / 3.0 * (s * s - 1.0) * (1.0 - 2.0 / 15.0 * DAMPING)
    }

    fn stages(reach: f64) -> usize {
        let count = (1.0 + 1.5 * reach / (1.0 - 2.0 / 15.0 * DAMPING)).sqrt();
        (count.ceil() as usize).max(2)
    }
}

impl Chebyshev {
    /// Stages of a step, the last of which is the result; its rates stand in `rates`.
    fn stages(
        &mut self,
        span: &Span<'_>,
        h: f64,
        count: usize,
        now: &mut Followed,
    ) -> Result<(), PlantError> {
        let n = now.y.len();
        let of = Coefficients::new(count);
        let [before, last] = &mut self.stages;
        before.copy_from_slice(&self.start);
        let [slope, mut place] = of.first;
        for ((y, start), rate) in last.iter_mut().zip(&self.start).zip(&self.first) {
            *y = start + slope * h * rate;
        }
        for [mu, nu, slope, of_first, next] in of.stages {
            let at = span.moment(place, h);
            span.plant
                .rates(at, &last[..n], &mut now.work, &mut self.rates)?;
            let own = 1.0 - mu - nu;
            let rows = before.iter_mut().zip(&*last).zip(&self.start);
            for (((y, last), start), (rate, first)) in rows.zip(self.rates.iter().zip(&self.first))
            {
                *y = own * start + mu * last + nu * *y + h * (slope * rate + of_first * first);
            }
            std::mem::swap(before, last);
            place = next;
        }
        let end = span.moment(1.0, h);
        span.plant
            .rates(end, &last[..n], &mut now.work, &mut self.rates)
    }
}

impl StepMethod for Chebyshev {
    fn advance(&mut self, span: &Span<'_>, now: &mut Followed) -> Result<f64, PlantError> {
        let (n, width) = (now.y.len(), now.y.len() + now.totals.len());
        if self.start.len() != width {
            for row in [&mut self.first, &mut self.rates, &mut self.start] {
                row.resize(width, 0.0);
            }
            self.stages
                .iter_mut()
                .for_each(|row| row.resize(width, 0.0));
        }
        if span.fresh {
            span.plant
                .rates(span.at, &now.y, &mut now.work, &mut self.first)?;
            self.surplus = 1.0;
        }
        if self.step <= 0.0 {
            self.step = span.first_step(&now.y, &self.first, 2);
        }
        self.start[..n].copy_from_slice(&now.y);
        self.start[n..].copy_from_slice(&now.totals);
        span.sizes(&now.y, &mut self.sizes);
        let fastest = span.plant.fastest(span.at, &now.y, &now.work);
        let before = now.work.streams.clone();
        loop {
            let (mut h, mut ends) = span.cut(self.step);
            let rate = self.surplus * fastest;
            if h * rate > Coefficients::reach(MOST_STAGES) {
                (h, ends) = (Coefficients::reach(MOST_STAGES) / rate, false);
            }
            let count = Coefficients::stages(h * rate);
            let failed = self.stages(span, h, count, now).err();
            let error = match &failed {
                Some(_) => f64::INFINITY,
                None => {
                    let rows = self.stages[1].iter().zip(&self.start);
                    let rates = self.rates.iter().zip(&self.first);
                    let errors = rows.zip(rates).map(|((new, old), (after, before))| {
                        0.8 * (old - new) + 0.4 * h * (before + after)
                    });
                    worst(errors, &self.sizes)
                }
            };
            if error <= 1.0 || (span.forced && error.is_finite()) {
                now.y.copy_from_slice(&self.stages[1][..n]);
                now.totals.copy_from_slice(&self.stages[1][n..]);
                std::mem::swap(&mut self.first, &mut self.rates);
                now.steps[0] += 1;
                self.surplus = (0.95 * self.surplus).max(1.0);
                let factor = (0.8 * error.max(1e-10).powf(-1.0 / 3.0)).clamp(0.2, 3.0);
                self.step = if ends && factor >= 1.0 {
                    self.step.max(h * factor)
                } else {
                    h * factor
                };
                return Ok(h);
            }
            now.steps[1] += 1;
            now.work.streams.copy_from_slice(&before);
            // Far off: more likely unstable than inaccurate.
            if error > 10.0 {
                self.surplus = (1.5 * self.surplus).min(1e3);
            }
            let factor = 0.8 * error.min(1e6).powf(-1.0 / 3.0);
            self.step = h * factor.clamp(0.1, 0.8);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// What a step makes of y' = λ y with h λ = z.
    fn growth(count: usize, z: f64) -> f64 {
        let of = Coefficients::new(count);
        let (mut before, mut last) = (1.0, 1.0 + of.first[0] * z);
        for [mu, nu, slope, of_first, _] in of.stages {
            let next = 1.0 - mu - nu + mu * last + nu * before + z * (slope * last + of_first);
            (before, last) = (last, next);
        }
        last
    }

    #[test]
    fn a_step_has_second_order_and_is_stable_as_far_as_said() {
        for count in [2, 3, 7, 20, 100] {
            let off = |z: f64| (growth(count, z) - z.exp()).abs();
            let order = (off(-0.02) / off(-0.01)).log2();
            assert!((order - 3.0).abs() < 0.1, "{count}: {order}");
            let reach = Coefficients::reach(count);
            for share in 1..=200 {
                let z = -reach * f64::from(share) / 200.0;
                assert!(growth(count, z).abs() <= 1.0 + 1e-9, "{count}: {z}");
            }
            // The formula is that of many stages; of two and three the reach is larger.
            assert!(count <= 3 || growth(count, -1.1 * reach).abs() > 1.0);
            assert_eq!(Coefficients::stages(0.999 * reach), count);
        }
    }
}
