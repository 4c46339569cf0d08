use super::quantile::student_quantile;
use crate::TuningError;
use crate::least_squares::{FitChoice, FittedPlaces, fit};
use crate::problem::TuningProblem;

/// Steps that bracket a crossing, and that refine it.
const BRACKET_STEPS: usize = 40;
const REFINE_STEPS: usize = 30;
/// A crossing is known to this share of the threshold.
const EXACT: f64 = 2e-3;

/// Where an interval ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntervalEnd {
    /// Place of the end.
    pub place: f64,
    /// True: the data do not end the interval; the bound does, or what lies beyond cannot be evaluated.
    pub at_bound: bool,
}

/// The likelihood along one parameter, all others refitted.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterProfile {
    /// The parameter.
    pub parameter: usize,
    /// Place of the best value.
    pub best: f64,
    /// Lower end of the interval.
    pub low: IntervalEnd,
    /// Upper end of the interval.
    pub high: IntervalEnd,
    /// Rise of the deviance that ends the interval.
    pub threshold: f64,
    /// Places with the rise of the deviance above its least value, in ascending order.
    pub points: Vec<(f64, f64)>,
}

/// The interval of one parameter by the profile of its likelihood: values at which the best fit of all other parameters has
/// a deviance D = Σ n ln(S/n) below its least value plus N ln(1 + t²/(N − p)), with t the quantile of Student's distribution
/// at N − p degrees of freedom; with many values that is the usual 3.84 for 95 % (docs/theory.md, TUN-8).
///
/// Source: Bates and Watts, Nonlinear Regression Analysis and Its Applications (1988), section 6.1, doi
/// 10.1002/9780470316757.
pub fn profile(
    problem: &dyn TuningProblem,
    fitted: &FittedPlaces,
    choice: &FitChoice,
    parameter: usize,
    level: f64,
) -> Result<ParameterProfile, TuningError> {
    let values: usize = fitted.counts.iter().sum();
    let numbers = fitted.free.len() + problem.scales();
    let freedom = values as f64 - numbers as f64;
    if freedom < 1.0 {
        return Err(TuningError::TooFewValues {
            values,
            parameters: numbers,
        });
    }
    let t = student_quantile(0.5 + 0.5 * level, freedom);
    let mut ray = Ray {
        problem,
        choice,
        parameter,
        least: fitted.deviance(),
        threshold: values as f64 * (t * t / freedom).ln_1p(),
        points: vec![(fitted.places[parameter], 0.0)],
    };
    let column = fitted.free.iter().position(|&k| k == parameter);
    let column = column.map_or(0.0, |k| {
        fitted.jacobian[k].iter().map(|j| j * j).sum::<f64>()
    });
    // The error of this parameter alone, the others fixed: the interval is wider.
    let alone = if column > 0.0 { t / column.sqrt() } else { 1.0 };
    let first = alone.clamp(1e-9, 0.05);
    let low = ray.end(fitted, -first)?;
    let high = ray.end(fitted, first)?;
    ray.points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(ParameterProfile {
        parameter,
        best: fitted.places[parameter],
        low,
        high,
        threshold: ray.threshold,
        points: ray.points,
    })
}

struct Ray<'a> {
    problem: &'a dyn TuningProblem,
    choice: &'a FitChoice,
    parameter: usize,
    least: f64,
    threshold: f64,
    points: Vec<(f64, f64)>,
}

impl Ray<'_> {
    /// Rise of the deviance at a place, from a fit of the others that starts at places; infinite where that cannot be evaluated.
    fn rise(&mut self, place: f64, from: &[f64]) -> Result<(f64, Vec<f64>), TuningError> {
        let mut choice = self.choice.clone();
        choice.fixed.push((self.parameter, place));
        let fitted = match fit(self.problem, from, &choice) {
            Ok(fitted) => fitted,
            Err(TuningError::Interrupted) => return Err(TuningError::Interrupted),
            Err(_) => return Ok((f64::INFINITY, from.to_vec())),
        };
        let rise = fitted.deviance() - self.least;
        self.points.push((place, rise));
        Ok((rise, fitted.places))
    }

    /// The end on one side: steps that double until the threshold is passed, then false position with bisection.
    fn end(&mut self, fitted: &FittedPlaces, first: f64) -> Result<IntervalEnd, TuningError> {
        let best = fitted.places[self.parameter];
        let bound = if first > 0.0 { 1.0 } else { 0.0 };
        let (mut inside, mut below) = (best, 0.0f64);
        let mut from = fitted.places.clone();
        let (mut step, mut outside) = (first, None);
        for _ in 0..BRACKET_STEPS {
            let place = (inside + step).clamp(0.0, 1.0);
            if place == inside {
                break;
            }
            let (rise, places) = self.rise(place, &from)?;
            if rise > self.threshold {
                outside = Some((place, rise));
                break;
            }
            (inside, below, from) = (place, rise, places);
            step *= 2.0;
        }
        let Some((mut outside, mut above)) = outside else {
            return Ok(IntervalEnd {
                place: bound,
                at_bound: true,
            });
        };
        for _ in 0..REFINE_STEPS {
            // The rise is a parabola about the best place.
            let root = |rise: f64| rise.max(0.0).sqrt();
            let share = match above.is_finite() {
                true => (root(self.threshold) - root(below)) / (root(above) - root(below)),
                false => 0.5,
            };
            let place = inside + share.clamp(0.1, 0.9) * (outside - inside);
            let (rise, places) = self.rise(place, &from)?;
            if rise > self.threshold {
                (outside, above) = (place, rise);
            } else {
                (inside, below, from) = (place, rise, places);
            }
            if (rise / self.threshold - 1.0).abs() < EXACT {
                return Ok(IntervalEnd {
                    place,
                    at_bound: false,
                });
            }
        }
        Ok(match above.is_finite() {
            true => IntervalEnd {
                place: 0.5 * (inside + outside),
                at_bound: false,
            },
            false => IntervalEnd {
                place: inside,
                at_bound: true,
            },
        })
    }
}
