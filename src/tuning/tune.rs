//! Tuning a model of a sample: fits, laws, intervals, analysis.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use calcine_tuning::analysis::{SmoothedRun, friedman, kissinger, ozawa_flynn_wall};
use calcine_tuning::information::{akaike, akaike_weights, choose};
use calcine_tuning::interval::{
    BootstrapSettings, ParameterPair, ParameterProfile, bootstrap, correlated, lag_one, profile,
};
use calcine_tuning::least_squares::{FitChoice, FittedPlaces, deviance, fit, slopes};
use calcine_tuning::nsga::VariationSettings;
use calcine_tuning::search::{
    FrontSettings, SearchEvaluation, SearchedFront, StartSettings, fit_globally, search_front,
};
use calcine_tuning::{
    ComparedQuantity, ParameterSpace, SampleProblem, TargetCurve, TuningError, TuningProblem,
};

use super::case::{LawCandidate, TuningCase};
use super::outcome::{
    FittedCurve, FoundParameter, LawFit, LawFreeEnergies, TuningOutcome, unit_of,
};
use super::warn;
use super::write::unit_name;

/// Places nearer to a bound than this stand on it.
const ON_BOUND: f64 = 1e-6;
/// Differences whose neighbours go together by more than this are drawn in blocks.
const MEMORY: f64 = 0.3;
/// Longest block of the bootstrap.
const LONGEST_BLOCK: f64 = 50.0;

/// What a tuning tells while it runs.
pub trait TuningObserver {
    /// A stage begins.
    fn stage(&mut self, _name: &str) {}
    /// A generation of a search has been evaluated.
    fn generation(&mut self, _stage: &str, _generation: usize, _new: &[SearchEvaluation]) {}
    /// Evaluations that are known from before, of a stage.
    fn known(&mut self, _stage: &str) -> Vec<SearchEvaluation> {
        Vec::new()
    }
}

/// A problem that counts its evaluations, and gives up when it is told to.
struct WatchedProblem<'a> {
    problem: &'a dyn TuningProblem,
    stop: &'a AtomicBool,
    count: &'a AtomicUsize,
}

impl TuningProblem for WatchedProblem<'_> {
    fn space(&self) -> &ParameterSpace {
        self.problem.space()
    }
    fn objectives(&self) -> &[String] {
        self.problem.objectives()
    }
    fn differences(&self, places: &[f64], out: &mut Vec<Vec<f64>>) -> Result<(), TuningError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(TuningError::Interrupted);
        }
        self.count.fetch_add(1, Ordering::Relaxed);
        self.problem.differences(places, out)
    }
    fn shifted(
        &self,
        places: &[f64],
        shifts: &[Vec<f64>],
        out: &mut Vec<Vec<f64>>,
    ) -> Result<(), TuningError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(TuningError::Interrupted);
        }
        self.count.fetch_add(1, Ordering::Relaxed);
        self.problem.shifted(places, shifts, out)
    }
    fn scales(&self) -> usize {
        self.problem.scales()
    }
    fn step(&self) -> f64 {
        self.problem.step()
    }
    fn guesses(&self) -> Vec<Vec<f64>> {
        self.problem.guesses()
    }
}

/// A fit of one problem.
pub(super) struct Search {
    pub fitted: FittedPlaces,
    pub front: Option<SearchedFront>,
}

/// The tools that all stages share.
pub(super) struct Bench<'a> {
    pub case: &'a TuningCase,
    pub stop: &'a AtomicBool,
    pub count: AtomicUsize,
}

impl Bench<'_> {
    /// Ends where the user said so.
    fn go_on(&self) -> Result<(), TuningError> {
        match self.stop.load(Ordering::Relaxed) {
            true => Err(TuningError::Interrupted),
            false => Ok(()),
        }
    }

    /// The objective that chooses, as the fits take it.
    fn choice(&self, problem: &dyn TuningProblem) -> FitChoice {
        let named = self.case.method.choose.as_ref();
        let place = named.and_then(|name| problem.objectives().iter().position(|one| one == name));
        FitChoice {
            objectives: place.into_iter().collect(),
            fixed: Vec::new(),
        }
    }

    /// Searches the parameters of one problem.
    pub fn search(
        &self,
        problem: &dyn TuningProblem,
        stage: &str,
        observer: &mut dyn TuningObserver,
    ) -> Result<Search, TuningError> {
        let method = &self.case.method;
        let watched = WatchedProblem {
            problem,
            stop: self.stop,
            count: &self.count,
        };
        let choice = self.choice(problem);
        if !method.evolution {
            let settings = StartSettings {
                samples: method.samples,
                starts: method.starts,
                seed: method.seed,
            };
            let fitted = fit_globally(&watched, &choice, &settings, self.stop)?;
            self.go_on()?;
            return Ok(Search {
                fitted,
                front: None,
            });
        }
        let settings = FrontSettings {
            population: method.population,
            generations: method.generations,
            variation: VariationSettings::default(),
            seed: method.seed,
        };
        let known = observer.known(stage);
        let front = search_front(&watched, &settings, &known, self.stop, |generation, new| {
            observer.generation(stage, generation, new);
        })?;
        // A tuning that goes on counts as one that was not interrupted.
        self.count.fetch_add(front.replayed, Ordering::Relaxed);
        let objective = choice.objectives.first().copied();
        let best = match objective {
            Some(objective) => front.archive.best(objective).map(|one| one.genes.clone()),
            None => self.likeliest(&watched, &front)?,
        };
        let best = best.unwrap_or_default();
        let fitted = match method.polish {
            true => fit(&watched, &best, &choice)?,
            false => slopes(&watched, &best, &choice)?,
        };
        self.go_on()?;
        Ok(Search {
            fitted,
            front: Some(front),
        })
    }

    /// The point of a front with the largest likelihood over all objectives.
    fn likeliest(
        &self,
        problem: &dyn TuningProblem,
        front: &SearchedFront,
    ) -> Result<Option<Vec<f64>>, TuningError> {
        let mut out = Vec::new();
        let mut best: Option<(f64, &Vec<f64>)> = None;
        for point in front.archive.front() {
            problem.differences(&point.genes, &mut out)?;
            let counts: Vec<usize> = out.iter().map(Vec::len).collect();
            let value = deviance(&point.objectives, &counts);
            if best.is_none_or(|(least, _)| value < least) {
                best = Some((value, &point.genes));
            }
        }
        Ok(best.map(|(_, genes)| genes.clone()))
    }

    /// Intervals, correlations and warnings about what is known of the parameters.
    pub fn known(
        &self,
        problem: &dyn TuningProblem,
        fitted: &FittedPlaces,
        warnings: &mut Vec<String>,
        observer: &mut dyn TuningObserver,
    ) -> Result<KnownParameters, TuningError> {
        let watched = WatchedProblem {
            problem,
            stop: self.stop,
            count: &self.count,
        };
        let (choice, spec) = (self.choice(problem), &self.case.intervals);
        let mut profiles = Vec::new();
        if spec.profile {
            observer.stage("intervals: profiles of the likelihood");
            for parameter in 0..problem.space().len() {
                profiles.push(profile(&watched, fitted, &choice, parameter, spec.level)?);
            }
        }
        let mut out = Vec::new();
        problem.differences(&fitted.places, &mut out)?;
        let memory = out.iter().map(|list| lag_one(list)).fold(0.0, f64::max);
        let block = match memory > MEMORY {
            // Twice the time over which the memory of such a series fades.
            true => (2.0 / -memory.min(0.98).ln()).ceil().min(LONGEST_BLOCK),
            false => 1.0,
        };
        let exact = fitted
            .sums
            .iter()
            .zip(&fitted.counts)
            .all(|(sum, &n)| sum / (n.max(1) as f64) < 1e-12);
        if memory > MEMORY && !exact {
            warnings.push(warn::memory(memory));
        }
        let mut drawn = Vec::new();
        if spec.bootstrap > 0 {
            observer.stage("intervals: bootstrap");
            let settings = BootstrapSettings {
                replicates: spec.bootstrap,
                block: block as usize,
                seed: self.case.method.seed,
            };
            drawn = bootstrap(&watched, &fitted.places, &choice, &settings)?;
        }
        self.go_on()?;
        let space = problem.space();
        let found = space.parameters().iter().enumerate().map(|(k, one)| {
            let profile = profiles
                .iter()
                .find(|profile: &&ParameterProfile| profile.parameter == k);
            let place = fitted.places[k];
            FoundParameter {
                name: one.name.clone(),
                unit: unit_name(one.dimension),
                value: space.value(k, place),
                interval: profile
                    .map(|p| [space.value(k, p.low.place), space.value(k, p.high.place)]),
                open: profile.map_or([false; 2], |p| [p.low.at_bound, p.high.at_bound]),
                bootstrap: percentiles(&drawn, k, spec.level)
                    .map(|ends| ends.map(|p| space.value(k, p))),
                bounds: [one.low, one.high],
                at_bound: !(ON_BOUND..=1.0 - ON_BOUND).contains(&place),
            }
        });
        let found: Vec<FoundParameter> = found.collect();
        warnings.extend(warn::bounds(&found));
        let pairs = match correlated(fitted) {
            Some(pairs) => pairs,
            None => {
                warnings.push(warn::without_effect(space, fitted));
                Vec::new()
            }
        };
        Ok(KnownParameters {
            found,
            profiles,
            pairs,
        })
    }
}

/// What is known of the parameters.
pub(super) struct KnownParameters {
    pub found: Vec<FoundParameter>,
    pub profiles: Vec<ParameterProfile>,
    pub pairs: Vec<ParameterPair>,
}

fn root_mean_square(list: &[f64]) -> f64 {
    (calcine_tuning::sum_of_squares(list) / list.len().max(1) as f64).sqrt()
}

/// The ends between which this share of drawn places lies.
fn percentiles(drawn: &[Vec<f64>], parameter: usize, level: f64) -> Option<[f64; 2]> {
    let mut places: Vec<f64> = drawn.iter().map(|places| places[parameter]).collect();
    places.sort_by(f64::total_cmp);
    let last = places.len().checked_sub(1)?;
    let tail = 0.5 * (1.0 - level);
    let at = |share: f64| places[((share * places.len() as f64) as usize).min(last)];
    Some([at(tail), at(1.0 - tail)])
}

/// The problem of a sample with one of its laws, and curves.
fn problem_of(
    case: &TuningCase,
    candidate: &LawCandidate,
    targets: &[TargetCurve],
) -> Result<SampleProblem, TuningError> {
    let model = case.model.model(candidate);
    let space = case.space_of(&*model)?;
    let mut problem =
        SampleProblem::new(&*model, space, targets.to_vec(), case.method.differences)?;
    problem.guess_by(&case.model.reactions_with(candidate));
    Ok(problem)
}

/// Tunes a model of a sample.
pub fn tune_sample(
    case: &TuningCase,
    stop: &AtomicBool,
    observer: &mut dyn TuningObserver,
) -> Result<TuningOutcome, TuningError> {
    let bench = Bench {
        case,
        stop,
        count: AtomicUsize::new(0),
    };
    let mut fits = Vec::new();
    for candidate in &case.model.laws {
        let problem = problem_of(case, candidate, &case.targets)?;
        observer.stage(&format!("law {}", candidate.law.name));
        let search = bench.search(&problem, candidate.law.name, observer)?;
        fits.push((candidate.law.name, problem, search));
    }
    let numbers: Vec<(f64, usize)> = fits
        .iter()
        .map(|(_, problem, search)| {
            let (values, count) = (search.fitted.counts.iter().sum(), problem.space().len());
            // Sizes of the noise, and scales of curves.
            let sizes = search.fitted.counts.len() + problem.scales();
            (
                akaike(search.fitted.deviance(), values, count + sizes),
                count,
            )
        })
        .collect();
    let criteria: Vec<f64> = numbers.iter().map(|one| one.0).collect();
    let weights = akaike_weights(&criteria);
    let mut laws = Vec::new();
    let mut out = Vec::new();
    for ((law, problem, search), (&criterion, weight)) in
        fits.iter().zip(criteria.iter().zip(weights))
    {
        let names = problem
            .space()
            .parameters()
            .iter()
            .map(|one| one.name.clone());
        problem.differences(&search.fitted.places, &mut out)?;
        laws.push(LawFit {
            law,
            criterion,
            weight,
            values: names
                .zip(problem.space().values(&search.fitted.places))
                .collect(),
            errors: out.iter().map(|list| root_mean_square(list)).collect(),
            left: problem.left_of_no_reaction(&search.fitted.places)?,
        });
    }
    let chosen = choose(&numbers).unwrap_or(0);
    if laws[chosen].explains_nothing() {
        let names: Vec<&str> = laws.iter().map(|one| one.law).collect();
        return Err(TuningError::NothingReacts {
            laws: names.join(", "),
            left: 100.0 * laws[chosen].left,
        });
    }
    let (_, problem, search) = fits.swap_remove(chosen);
    let mut warnings = case.warnings.clone();
    warnings.extend(warn::explain_nothing(&laws));
    let known = bench.known(&problem, &search.fitted, &mut warnings, observer)?;
    observer.stage("energies without a law");
    let energies = energies(case);
    warnings.extend(warn::pairs(problem.space(), &known.pairs));
    warnings.extend(warn::one_rate(case, &laws, chosen, &known.found));
    warnings.extend(warn::energies_differ(&energies, &known.found, &laws));
    problem.differences(&search.fitted.places, &mut out)?;
    let mut all_curves = curves(&problem, &search.fitted.places, true)?;
    if !case.kept_back.is_empty() {
        let others = problem_of(case, &case.model.laws[chosen], &case.kept_back)?;
        all_curves.extend(curves(&others, &search.fitted.places, false)?);
    }
    Ok(TuningOutcome {
        objectives: problem.objectives().to_vec(),
        sums: out
            .iter()
            .map(|list| calcine_tuning::sum_of_squares(list))
            .collect(),
        counts: out.iter().map(Vec::len).collect(),
        laws,
        chosen,
        curves: all_curves,
        space: problem.space().clone(),
        parameters: known.found,
        front: search.front,
        profiles: known.profiles,
        pairs: known.pairs,
        energies,
        warnings,
        evaluations: bench.count.load(Ordering::Relaxed),
    })
}

/// The curves of a problem, and the model's; whether they were fitted.
pub fn curves(
    problem: &SampleProblem,
    places: &[f64],
    is_fitted: bool,
) -> Result<Vec<FittedCurve>, TuningError> {
    let responses = problem.responses(places)?;
    let mut all = Vec::new();
    for (target, response) in problem.targets().iter().zip(&responses) {
        for (quantity, measured) in &target.values {
            let model = match quantity {
                ComparedQuantity::Temperature => &response.temperature,
                ComparedQuantity::Mass => &response.mass,
                ComparedQuantity::LossRate => &response.loss_rate,
            };
            let times = &target.run.times;
            all.push(FittedCurve {
                target: target.name.clone(),
                quantity: *quantity,
                is_fitted,
                unit: unit_of(*quantity).to_owned(),
                time: times.clone(),
                temperature: times
                    .iter()
                    .map(|&t| target.run.programme.at(t).0)
                    .collect(),
                measured: measured.clone(),
                model: model.clone(),
            });
        }
    }
    Ok(all)
}

/// Kissinger, Friedman, and Ozawa, Flynn and Wall over all curves that have a mass.
fn energies(case: &TuningCase) -> LawFreeEnergies {
    let mut found = LawFreeEnergies::default();
    let mut runs = Vec::new();
    for target in &case.targets {
        match SmoothedRun::of(target, case.loss) {
            Some(run) => runs.push(run),
            None => found.notes.push(warn::left_out(&target.name)),
        }
    }
    if runs.len() < 2 {
        return found;
    }
    match kissinger(&runs) {
        Ok(result) => found.kissinger = Some(result),
        Err(error) => found.notes.push(error.to_string()),
    }
    match friedman(&runs) {
        Ok(list) => found.friedman = list,
        Err(error) => found.notes.push(error.to_string()),
    }
    match ozawa_flynn_wall(&runs) {
        Ok(list) => found.ozawa_flynn_wall = list,
        Err(error) => found.notes.push(error.to_string()),
    }
    found
}
