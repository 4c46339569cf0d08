//! Fits with one objective, or with several weighted by what is left of each.

use crate::TuningError;
use crate::problem::{TuningProblem, sum_of_squares};

/// Most steps of a fit.
const MOST_STEPS: usize = 60;
/// A step that lowers the sum by less than this share, or moves less than this in places, ends the fit.
const SETTLED: f64 = 1e-12;
const STILL: f64 = 1e-10;
/// Damping at the start, and its bounds.
const DAMPING: f64 = 1e-3;
const LEAST_DAMPING: f64 = 1e-12;
const MOST_DAMPING: f64 = 1e12;
/// Rounds in which the weights of several objectives follow what is left.
const ROUNDS: usize = 8;
/// Weights have settled where none changes by more.
const SAME_WEIGHT: f64 = 1e-4;

/// What is minimised over which of the parameters.
#[derive(Clone, Debug, Default)]
pub struct FitChoice {
    /// Objectives that count; all where empty.
    pub objectives: Vec<usize>,
    /// Parameters that stay, with their places.
    pub fixed: Vec<(usize, f64)>,
}

/// The end of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedPlaces {
    /// Places of all parameters.
    pub places: Vec<f64>,
    /// Sum of squares of each objective that counts.
    pub sums: Vec<f64>,
    /// Number of values of each objective that counts.
    pub counts: Vec<usize>,
    /// Difference quotients of the weighted differences by the places of the free parameters, column by column.
    pub jacobian: Vec<Vec<f64>>,
    /// Which parameters are free.
    pub free: Vec<usize>,
    /// Evaluations of the problem.
    pub evaluations: usize,
}

impl FittedPlaces {
    /// −2 ln of the likelihood but for a constant, with Gaussian errors of unknown size of each objective:
    /// Σ n ln(S/n).
    pub fn deviance(&self) -> f64 {
        deviance(&self.sums, &self.counts)
    }
}

/// Least mean square of an objective that counts as a difference: below it agreement is exact to round-off.
const EXACT: f64 = 1e-28;

/// Σ n ln(S/n) over objectives.
pub fn deviance(sums: &[f64], counts: &[usize]) -> f64 {
    let terms = sums.iter().zip(counts).map(|(sum, &count)| {
        let count = count as f64;
        count * (sum / count).max(EXACT).ln()
    });
    terms.sum()
}

/// Levenberg and Marquardt's method within bounds, by difference quotients. Parameters that stand on a bound and would leave
/// it rest. The objectives are weighted by 1/σ, σ² = S/n of each, which is repeated until it settles: the fit is the one of
/// the largest likelihood (docs/theory.md, TUN-7).
///
/// Sources: Marquardt, J. SIAM 11 (1963) 431, doi 10.1137/0111030; Nielsen, IMM-REP-1999-05, Technical University of
/// Denmark, for the control of the damping.
pub fn fit(
    problem: &dyn TuningProblem,
    start: &[f64],
    choice: &FitChoice,
) -> Result<FittedPlaces, TuningError> {
    let mut walk = Walk::new(problem, start, choice)?;
    let single = walk.chosen.len() == 1;
    for round in 0..ROUNDS {
        walk.minimise()?;
        if single {
            break;
        }
        let before = walk.weights.clone();
        walk.reweigh();
        let changes = walk.weights.iter().zip(&before);
        let settled = changes
            .into_iter()
            .all(|(a, b)| (a / b - 1.0).abs() < SAME_WEIGHT);
        if settled || round + 1 == ROUNDS {
            break;
        }
    }
    walk.finish()
}

/// The slopes of a problem at places, where nothing is to be moved.
pub fn slopes(
    problem: &dyn TuningProblem,
    places: &[f64],
    choice: &FitChoice,
) -> Result<FittedPlaces, TuningError> {
    Walk::new(problem, places, choice)?.finish()
}

struct Walk<'a> {
    problem: &'a dyn TuningProblem,
    chosen: Vec<usize>,
    free: Vec<usize>,
    places: Vec<f64>,
    /// Differences of the chosen objectives, unweighted.
    lists: Vec<Vec<f64>>,
    weights: Vec<f64>,
    evaluations: usize,
}

impl<'a> Walk<'a> {
    fn new(
        problem: &'a dyn TuningProblem,
        start: &[f64],
        choice: &FitChoice,
    ) -> Result<Self, TuningError> {
        let count = problem.objectives().len();
        let chosen = match choice.objectives.is_empty() {
            true => (0..count).collect(),
            false => choice.objectives.clone(),
        };
        let mut places = start.to_vec();
        for &(parameter, place) in &choice.fixed {
            places[parameter] = place;
        }
        let held = |k: &usize| choice.fixed.iter().all(|(fixed, _)| fixed != k);
        let free = (0..places.len()).filter(held).collect();
        let mut walk = Self {
            problem,
            weights: vec![1.0; chosen.len()],
            chosen,
            free,
            lists: Vec::new(),
            evaluations: 0,
            places,
        };
        let places = walk.places.clone();
        walk.lists = walk.at(&places)?;
        walk.reweigh();
        Ok(walk)
    }

    fn at(&mut self, places: &[f64]) -> Result<Vec<Vec<f64>>, TuningError> {
        let mut all = Vec::new();
        self.evaluations += 1;
        self.problem.differences(places, &mut all)?;
        let chosen = self.chosen.iter();
        Ok(chosen.map(|&k| std::mem::take(&mut all[k])).collect())
    }

    /// [`Self::at`] of a trial: none where the problem could not be evaluated there.
    fn trial(&mut self, places: &[f64]) -> Result<Option<Vec<Vec<f64>>>, TuningError> {
        match self.at(places) {
            Ok(lists) => Ok(Some(lists)),
            Err(TuningError::Interrupted) => Err(TuningError::Interrupted),
            Err(_) => Ok(None),
        }
    }

    /// Weights 1/σ of what is left of each objective.
    fn reweigh(&mut self) {
        for (weight, list) in self.weights.iter_mut().zip(&self.lists) {
            let mean = sum_of_squares(list) / list.len().max(1) as f64;
            *weight = 1.0 / mean.max(EXACT).sqrt();
        }
    }

    fn weighted(&self, lists: &[Vec<f64>]) -> f64 {
        let terms = lists.iter().zip(&self.weights);
        terms
            .map(|(list, weight)| weight * weight * sum_of_squares(list))
            .sum()
    }

    /// Columns of difference quotients of the weighted differences: from one side where the problem cannot be evaluated on the
    /// other, and zero, a parameter that stays, where on neither.
    fn quotients(&mut self) -> Result<Vec<Vec<f64>>, TuningError> {
        let step = self.problem.step();
        let mut columns = Vec::with_capacity(self.free.len());
        for k in self.free.clone() {
            let place = self.places[k];
            let (low, high) = ((place - step).max(0.0), (place + step).min(1.0));
            let mut at = self.places.clone();
            at[k] = high;
            let above = self.trial(&at)?;
            at[k] = low;
            let below = self.trial(&at)?;
            let (high, above) = above.map_or((place, self.lists.clone()), |lists| (high, lists));
            let (low, below) = below.map_or((place, self.lists.clone()), |lists| (low, lists));
            if high <= low {
                columns.push(vec![0.0; self.lists.iter().map(Vec::len).sum()]);
                continue;
            }
            let mut column = Vec::new();
            for ((above, below), weight) in above.iter().zip(&below).zip(&self.weights) {
                let pairs = above.iter().zip(below);
                column.extend(pairs.map(|(a, b)| weight * (a - b) / (high - low)));
            }
            columns.push(column);
        }
        Ok(columns)
    }

    fn minimise(&mut self) -> Result<(), TuningError> {
        let (mut damping, mut growth) = (DAMPING, 2.0);
        let mut sum = self.weighted(&self.lists);
        let mut columns = self.quotients()?;
        for _ in 0..MOST_STEPS {
            let flat: Vec<f64> = self.flat();
            let gradient: Vec<f64> = columns.iter().map(|column| dot(column, &flat)).collect();
            let moving = self.moving(&gradient);
            if moving.is_empty() || sum == 0.0 {
                return Ok(());
            }
            let Some(step) = damped(&columns, &gradient, &moving, damping) else {
                damping *= growth;
                growth *= 2.0;
                if damping > MOST_DAMPING {
                    return Ok(());
                }
                continue;
            };
            let mut next = self.places.clone();
            let mut moved: f64 = 0.0;
            for (&k, change) in moving.iter().zip(&step) {
                let parameter = self.free[k];
                next[parameter] = (next[parameter] + change).clamp(0.0, 1.0);
                moved = moved.max((next[parameter] - self.places[parameter]).abs());
            }
            if moved < STILL {
                return Ok(());
            }
            let lists = self.trial(&next)?;
            let reached = lists
                .as_ref()
                .map_or(f64::INFINITY, |lists| self.weighted(lists));
            match lists {
                Some(lists) if reached < sum => {
                    let gain = (sum - reached) / sum;
                    (self.places, self.lists, sum) = (next, lists, reached);
                    damping = (damping / 5.0).max(LEAST_DAMPING);
                    growth = 2.0;
                    if gain < SETTLED {
                        return Ok(());
                    }
                    columns = self.quotients()?;
                }
                _ => {
                    damping *= growth;
                    growth *= 2.0;
                    if damping > MOST_DAMPING {
                        return Ok(());
                    }
                }
            }
        }
        Ok(())
    }

    fn flat(&self) -> Vec<f64> {
        let lists = self.lists.iter().zip(&self.weights);
        lists
            .flat_map(|(list, &weight)| list.iter().map(move |r| weight * r))
            .collect()
    }

    /// Free parameters that do not rest on a bound.
    fn moving(&self, gradient: &[f64]) -> Vec<usize> {
        let rests = |k: &usize| {
            let place = self.places[self.free[*k]];
            (place <= 0.0 && gradient[*k] > 0.0) || (place >= 1.0 && gradient[*k] < 0.0)
        };
        (0..self.free.len()).filter(|k| !rests(k)).collect()
    }

    fn finish(mut self) -> Result<FittedPlaces, TuningError> {
        let jacobian = self.quotients()?;
        Ok(FittedPlaces {
            sums: self.lists.iter().map(|list| sum_of_squares(list)).collect(),
            counts: self.lists.iter().map(Vec::len).collect(),
            places: self.places,
            jacobian,
            free: self.free,
            evaluations: self.evaluations,
        })
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The step of (JᵀJ + λ diag JᵀJ) s = −Jᵀr over the parameters that move, by Cholesky's factors of the scaled matrix.
fn damped(
    columns: &[Vec<f64>],
    gradient: &[f64],
    moving: &[usize],
    damping: f64,
) -> Option<Vec<f64>> {
    let n = moving.len();
    let scale: Vec<f64> = moving
        .iter()
        .map(|&k| dot(&columns[k], &columns[k]).sqrt())
        .collect();
    // A parameter without any effect stays.
    let scaled = |k: usize| if scale[k] > 0.0 { 1.0 / scale[k] } else { 0.0 };
    let mut matrix = vec![0.0; n * n];
    for row in 0..n {
        for column in 0..n {
            let product = dot(&columns[moving[row]], &columns[moving[column]]);
            matrix[row * n + column] = product * scaled(row) * scaled(column);
        }
        matrix[row * n + row] = 1.0 + damping;
    }
    let right: Vec<f64> = (0..n).map(|k| -gradient[moving[k]] * scaled(k)).collect();
    let solution = cholesky_solve(&mut matrix, &right)?;
    Some(
        solution
            .iter()
            .enumerate()
            .map(|(k, s)| s * scaled(k))
            .collect(),
    )
}

/// Solves with a symmetric positive definite matrix, row by row, that is overwritten; `None` where it is not definite.
pub(crate) fn cholesky_solve(matrix: &mut [f64], right: &[f64]) -> Option<Vec<f64>> {
    let n = right.len();
    for row in 0..n {
        for column in 0..=row {
            let mut value = matrix[row * n + column];
            for k in 0..column {
                value -= matrix[row * n + k] * matrix[column * n + k];
            }
            if row == column {
                if value.is_nan() || value <= 0.0 {
                    return None;
                }
                matrix[row * n + row] = value.sqrt();
            } else {
                matrix[row * n + column] = value / matrix[column * n + column];
            }
        }
    }
    let mut x = right.to_vec();
    for row in 0..n {
        for k in 0..row {
            x[row] -= matrix[row * n + k] * x[k];
        }
        x[row] /= matrix[row * n + row];
    }
    for row in (0..n).rev() {
        for k in row + 1..n {
            x[row] -= matrix[k * n + row] * x[k];
        }
        x[row] /= matrix[row * n + row];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{ParameterSpace, TunedParameter};
    use calcine_physics::dimension::Dimension;

    /// y = a exp(−b t) at t = 0 … 9, a within 0 to 10, b within 0 to 1; the second objective is a copy of other size.
    struct Decay {
        space: ParameterSpace,
        objectives: Vec<String>,
        data: Vec<f64>,
    }

    impl Decay {
        fn new(a: f64, b: f64, noise: &[f64]) -> Self {
            let parameter = |name: &str, high| TunedParameter {
                name: name.into(),
                dimension: Dimension::NONE,
                low: 0.0,
                high,
                logarithmic: false,
            };
            let data = (0..10).map(|t| a * (-b * f64::from(t)).exp());
            let data = data.zip(noise.iter().cycle()).map(|(y, e)| y + e).collect();
            Self {
                space: ParameterSpace::new(vec![parameter("a", 10.0), parameter("b", 1.0)])
                    .unwrap(),
                objectives: vec!["y".into(), "1000 y".into()],
                data,
            }
        }
    }

    impl TuningProblem for Decay {
        fn space(&self) -> &ParameterSpace {
            &self.space
        }
        fn objectives(&self) -> &[String] {
            &self.objectives
        }
        fn differences(&self, places: &[f64], out: &mut Vec<Vec<f64>>) -> Result<(), TuningError> {
            let p = self.space.values(places);
            let r = |(t, y): (usize, &f64)| p[0] * (-p[1] * t as f64).exp() - y;
            let one: Vec<f64> = self.data.iter().enumerate().map(r).collect();
            *out = vec![one.clone(), one.iter().map(|r| 1000.0 * r).collect()];
            Ok(())
        }
    }

    #[test]
    fn exact_data_give_back_their_parameters() {
        let problem = Decay::new(3.0, 0.4, &[0.0]);
        let only = FitChoice {
            objectives: vec![0],
            ..FitChoice::default()
        };
        let fitted = fit(&problem, &[0.9, 0.9], &only).unwrap();
        let values = problem.space.values(&fitted.places);
        assert!(
            (values[0] - 3.0).abs() < 1e-8 && (values[1] - 0.4).abs() < 1e-8,
            "{values:?}"
        );
    }

    #[test]
    fn a_least_square_agrees_with_an_independent_one_whatever_the_units_of_a_second_objective() {
        let problem = Decay::new(3.0, 0.4, &[0.05, -0.02, 0.01, 0.04, -0.03]);
        let both = fit(&problem, &[0.5, 0.5], &FitChoice::default()).unwrap();
        let mut best = (f64::INFINITY, 0.0, 0.0);
        for i in 0..400 {
            for j in 0..400 {
                let places = [0.29 + 1e-4 * f64::from(i), 0.38 + 1e-4 * f64::from(j)];
                let mut out = Vec::new();
                problem.differences(&places, &mut out).unwrap();
                let sum = sum_of_squares(&out[0]);
                if sum < best.0 {
                    best = (sum, places[0], places[1]);
                }
            }
        }
        let off = (both.places[0] - best.1)
            .abs()
            .max((both.places[1] - best.2).abs());
        assert!(off < 1e-4, "{:?} {best:?}", both.places);
        assert!(both.sums[0] <= best.0);
    }

    /// The same where it can be evaluated up to a limit of b alone, just above the best value.
    struct Limited(Decay, f64);

    impl TuningProblem for Limited {
        fn space(&self) -> &ParameterSpace {
            self.0.space()
        }
        fn objectives(&self) -> &[String] {
            self.0.objectives()
        }
        fn differences(&self, places: &[f64], out: &mut Vec<Vec<f64>>) -> Result<(), TuningError> {
            if places[1] > self.1 {
                return Err(TuningError::Model("b is too large".into()));
            }
            self.0.differences(places, out)
        }
    }

    /// Trials that fail are failed trials: the fit goes round them, and ends without the start alone.
    #[test]
    fn a_fit_goes_on_beside_trials_that_fail() {
        let only = FitChoice {
            objectives: vec![0],
            ..FitChoice::default()
        };
        let problem = Limited(Decay::new(3.0, 0.4, &[0.0]), 0.4 + 5e-5);
        let fitted = fit(&problem, &[0.9, 0.1], &only).unwrap();
        let values = problem.space().values(&fitted.places);
        assert!((values[0] - 3.0).abs() < 1e-6, "{values:?}");
        assert!((values[1] - 0.4).abs() < 1e-6, "{values:?}");
        assert!(matches!(
            fit(&problem, &[0.9, 0.9], &only),
            Err(TuningError::Model(_))
        ));
    }

    #[test]
    fn a_parameter_that_would_leave_its_bounds_rests_there_and_a_fixed_one_stays() {
        let problem = Decay::new(12.0, 0.4, &[0.0]);
        let only = |fixed| FitChoice {
            objectives: vec![0],
            fixed,
        };
        let fitted = fit(&problem, &[0.5, 0.5], &only(vec![])).unwrap();
        assert_eq!(fitted.places[0], 1.0);
        let fitted = fit(&problem, &[0.5, 0.5], &only(vec![(1, 0.25)])).unwrap();
        assert_eq!((fitted.places[1], fitted.free), (0.25, vec![0]));
    }
}
