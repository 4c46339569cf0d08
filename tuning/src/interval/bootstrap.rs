use rayon::prelude::*;

use crate::TuningError;
use crate::least_squares::{FitChoice, fit};
use crate::problem::TuningProblem;
use crate::random::SearchRandom;
use crate::space::ParameterSpace;

/// How data are drawn anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BootstrapSettings {
    /// Sets of data that are drawn and fitted.
    pub replicates: usize,
    /// Differences that are drawn in one piece: 1 for noise without memory, more where neighbours go together.
    pub block: usize,
    /// Seed.
    pub seed: u64,
}

/// Fits of data drawn anew: the best fit's curves plus its own differences in another order, drawn in blocks with
/// replacement, objective by objective. Gives the places of each set that could be fitted, in the order of the sets.
///
/// Source: Efron and Tibshirani, An Introduction to the Bootstrap (1993), section 9.4; blocks after Künsch, Ann. Stat. 17
/// (1989) 1217, doi 10.1214/aos/1176347265.
pub fn bootstrap(
    problem: &dyn TuningProblem,
    best: &[f64],
    choice: &FitChoice,
    settings: &BootstrapSettings,
) -> Result<Vec<Vec<f64>>, TuningError> {
    let mut lists = Vec::new();
    problem.differences(best, &mut lists)?;
    // Fits leave smaller differences than the noise has: n/(n − p).
    let values: usize = lists.iter().map(Vec::len).sum();
    let free = best.len() - choice.fixed.len() + problem.scales();
    if values <= free {
        return Err(TuningError::TooFewValues {
            values,
            parameters: free,
        });
    }
    let inflated = (values as f64 / (values - free) as f64).sqrt();
    let sets = (0..settings.replicates).into_par_iter().map(|set| {
        let seed = settings
            .seed
            .wrapping_mul(0x2545_f491_4f6c_dd1d)
            .wrapping_add(set as u64);
        let mut random = SearchRandom::new(seed);
        let shifts = lists.iter().map(|list| {
            let mut drawn = Vec::with_capacity(list.len());
            while drawn.len() < list.len() {
                let start = random.below(list.len());
                let block = (start..start + settings.block.max(1)).map(|k| list[k % list.len()]);
                drawn.extend(block);
            }
            // Data are curve − difference: the new data shift the differences by what is drawn less what was.
            let pairs = drawn.iter().zip(list);
            pairs.map(|(new, old)| inflated * new - old).collect()
        });
        let shifted = ShiftedProblem {
            problem,
            shifts: shifts.collect(),
        };
        fit(&shifted, best, choice).ok().map(|fitted| fitted.places)
    });
    let sets: Vec<Option<Vec<f64>>> = sets.collect();
    Ok(sets.into_iter().flatten().collect())
}

/// A problem whose data are shifted.
struct ShiftedProblem<'a> {
    problem: &'a dyn TuningProblem,
    shifts: Vec<Vec<f64>>,
}

impl TuningProblem for ShiftedProblem<'_> {
    fn space(&self) -> &ParameterSpace {
        self.problem.space()
    }

    fn objectives(&self) -> &[String] {
        self.problem.objectives()
    }

    fn differences(&self, places: &[f64], out: &mut Vec<Vec<f64>>) -> Result<(), TuningError> {
        self.problem.shifted(places, &self.shifts, out)
    }

    fn step(&self) -> f64 {
        self.problem.step()
    }
}
