//! Fits from many starts, and searches for fronts.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::TuningError;
use crate::least_squares::{FitChoice, FittedPlaces, deviance, fit};
use crate::nsga::{
    ArchivedPoint, Nsga2, ParetoArchive, VariationSettings, hypervolume, latin_hypercube,
};
use crate::problem::{TuningProblem, objectives_at, sum_of_squares};
use crate::random::SearchRandom;

/// How a fit looks for its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StartSettings {
    /// Points of a Latin hypercube that are tried beside the problem's guesses.
    pub samples: usize,
    /// How many of the best are followed.
    pub starts: usize,
    /// Seed.
    pub seed: u64,
}

/// The best of several fits, from the best of the problem's guesses and of a Latin hypercube.
pub fn fit_globally(
    problem: &dyn TuningProblem,
    choice: &FitChoice,
    settings: &StartSettings,
    stop: &AtomicBool,
) -> Result<FittedPlaces, TuningError> {
    let count = problem.space().len();
    let mut random = SearchRandom::new(settings.seed);
    let mut candidates = problem.guesses();
    candidates.extend(latin_hypercube(count, settings.samples, &mut random));
    let tried = candidates.len();
    let of = |places: &Vec<f64>| -> Result<f64, TuningError> {
        if stop.load(Ordering::Relaxed) {
            return Err(TuningError::Interrupted);
        }
        let mut out = Vec::new();
        problem.differences(places, &mut out)?;
        let chosen = |k: &usize| choice.objectives.is_empty() || choice.objectives.contains(k);
        let lists = (0..out.len()).filter(chosen).map(|k| &out[k]);
        let (sums, counts): (Vec<f64>, Vec<usize>) =
            lists.map(|list| (sum_of_squares(list), list.len())).unzip();
        Ok(deviance(&sums, &counts))
    };
    let values: Vec<Result<f64, TuningError>> = candidates.par_iter().map(of).collect();
    let mut ranked = Vec::new();
    let mut cause = TuningError::Interrupted;
    for (places, value) in candidates.into_iter().zip(values) {
        match value {
            Ok(value) if value.is_finite() => ranked.push((value, places)),
            Ok(_) => cause = TuningError::Model("differences that are not finite".into()),
            Err(TuningError::Interrupted) => return Err(TuningError::Interrupted),
            Err(error) => cause = error,
        }
    }
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    ranked.truncate(settings.starts.max(1));
    let fits: Vec<Result<FittedPlaces, TuningError>> = ranked
        .par_iter()
        .map(|(_, places)| match stop.load(Ordering::Relaxed) {
            true => Err(TuningError::Interrupted),
            false => fit(problem, places, choice),
        })
        .collect();
    let mut best: Option<FittedPlaces> = None;
    for fitted in fits {
        match fitted {
            Ok(fitted) => {
                let better = |best: &FittedPlaces| fitted.deviance() < best.deviance();
                if best.as_ref().is_none_or(better) {
                    best = Some(fitted);
                }
            }
            Err(TuningError::Interrupted) => return Err(TuningError::Interrupted),
            Err(error) => cause = error,
        }
    }
    best.ok_or_else(|| TuningError::NoneEvaluated {
        tried,
        cause: cause.to_string(),
    })
}

/// How a front is searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontSettings {
    /// Size of the population.
    pub population: usize,
    /// Generations, the start included.
    pub generations: usize,
    /// How children differ from their parents.
    pub variation: VariationSettings,
    /// Seed.
    pub seed: u64,
}

/// One evaluation of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchEvaluation {
    /// Generation, from zero.
    pub generation: usize,
    /// Places of the parameters.
    pub places: Vec<f64>,
    /// Objectives; infinite where the problem could not be evaluated.
    pub objectives: Vec<f64>,
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct SearchedFront {
    /// The front of all evaluations.
    pub archive: ParetoArchive,
    /// All evaluations in their order.
    pub evaluations: Vec<SearchEvaluation>,
    /// Point that is worse than all of the first generation that could be evaluated: hypervolumes are measured from it.
    pub reference: Vec<f64>,
    /// How many of the evaluations were known from before.
    pub replayed: usize,
    /// Hypervolume of the front after each generation, relative to the box between reference and zero.
    pub hypervolumes: Vec<f64>,
}

/// Searches for the front of a problem by NSGA-II. `after` is told each generation; evaluations run on threads and do not
/// depend on their number. `known` are evaluations of an earlier search with the same settings, from its start on: they are
/// taken as they are, and not told again, so that a search that was interrupted goes on with the same bits.
pub fn search_front(
    problem: &dyn TuningProblem,
    settings: &FrontSettings,
    known: &[SearchEvaluation],
    stop: &AtomicBool,
    mut after: impl FnMut(usize, &[SearchEvaluation]),
) -> Result<SearchedFront, TuningError> {
    let count = problem.space().len();
    let mut search = Nsga2::new(
        count,
        settings.population,
        settings.variation,
        settings.seed,
    );
    let mut found = SearchedFront {
        archive: ParetoArchive::default(),
        evaluations: Vec::new(),
        reference: vec![f64::NEG_INFINITY; problem.objectives().len()],
        replayed: 0,
        hypervolumes: Vec::new(),
    };
    for generation in 0..settings.generations.max(1) {
        if stop.load(Ordering::Relaxed) {
            return Err(TuningError::Interrupted);
        }
        let asked = search.ask().to_vec();
        let from = found.evaluations.len();
        let before: Vec<&SearchEvaluation> = known.iter().skip(from).take(asked.len()).collect();
        let same = |(one, places): (&&SearchEvaluation, &Vec<f64>)| one.places == *places;
        let replayed = before.len() == asked.len() && before.iter().zip(&asked).all(same);
        let of = |(k, places): (usize, &Vec<f64>)| match stop.load(Ordering::Relaxed) {
            true => None,
            false if replayed => Some(before[k].objectives.clone()),
            false => Some(objectives_at(problem, places)),
        };
        let told: Vec<Option<Vec<f64>>> = asked.par_iter().enumerate().map(of).collect();
        let told: Option<Vec<Vec<f64>>> = told.into_iter().collect();
        let told = told.ok_or(TuningError::Interrupted)?;
        // What an interrupt cut short counts as not evaluated.
        if stop.load(Ordering::Relaxed) {
            return Err(TuningError::Interrupted);
        }
        for (places, objectives) in asked.into_iter().zip(&told) {
            found.archive.offer(ArchivedPoint {
                evaluation: found.evaluations.len(),
                genes: places.clone(),
                objectives: objectives.clone(),
            });
            found.evaluations.push(SearchEvaluation {
                generation,
                places,
                objectives: objectives.clone(),
            });
        }
        let lacking = found.reference.iter().any(|one| !one.is_finite());
        if lacking {
            for (k, worst) in found.reference.iter_mut().enumerate() {
                let finite = told.iter().map(|one| one[k]).filter(|one| one.is_finite());
                *worst = finite.fold(*worst, f64::max);
            }
        }
        found.hypervolumes.push(relative_volume(&found));
        search.tell(told);
        if replayed {
            found.replayed += before.len();
        } else {
            after(generation, &found.evaluations[from..]);
        }
    }
    if found.archive.front().is_empty() {
        let tried = found.evaluations.len();
        let mut out = Vec::new();
        let first = &found.evaluations[0].places;
        let cause = match problem.differences(first, &mut out) {
            Err(error) => error.to_string(),
            Ok(()) => "differences that are not finite".into(),
        };
        return Err(TuningError::NoneEvaluated { tried, cause });
    }
    Ok(found)
}

fn relative_volume(found: &SearchedFront) -> f64 {
    if found.reference.iter().any(|one| !one.is_finite()) {
        return 0.0;
    }
    let front = found.archive.front();
    let points: Vec<&[f64]> = front.iter().map(|one| &one.objectives[..]).collect();
    let whole: f64 = found.reference.iter().product();
    if whole > 0.0 {
        hypervolume(&points, &found.reference) / whole
    } else {
        1.0
    }
}
