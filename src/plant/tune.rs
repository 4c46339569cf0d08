//! Keys of a plant that are tuned to measurements, and how what is measured depends on them.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use calcine_coupler::physics::dimension::Dimension;
use calcine_coupler::supervisor::Interrupts;
use calcine_flowsheet::{
    Derivatives, FlowWorkspace, MeasuredDistribution, MeasuredPlace, Plant, PlantError,
    PlantFamily, PlantRun,
};
use calcine_tuning::interval::{correlated, profile};
use calcine_tuning::least_squares::FitChoice;
use calcine_tuning::search::{StartSettings, fit_globally};
use calcine_tuning::{ParameterSpace, TunedParameter, TuningError, TuningProblem};

use super::measure::field;
use super::sensitivities::{Observed, sensitivities_of, write_sensitivities};
use super::steady::plant_with;
use super::summary::{PlantTunedParameter, PlantTuningSummary};
use super::trials::{TrialLog, hash_of};
use crate::case::plant::{
    OverTime, PlantCase, PlantField, PlantMeasure, PlantPlace, PlantTuningSpec,
};
use crate::results::ResultsError;

/// Tolerance of the runs at most: difference quotients need runs that are smooth in the parameters.
const TOLERANCE: f64 = 1e-8;
/// Step of a difference quotient, as a share of the bounds.
const STEP: f64 = 1e-4;

/// The plant of a case as a problem with parameters.
struct PlantProblem<'a> {
    case: &'a PlantCase,
    spec: &'a PlantTuningSpec,
    space: ParameterSpace,
    objectives: Vec<String>,
    /// Times in s of the measurements, rising; of the steady state one.
    times: Vec<f64>,
    trials: TrialLog,
    interrupts: &'a Interrupts,
}

/// The value of a key in the unit of the case, as a parameter of the tuning.
fn parameters(spec: &PlantTuningSpec) -> Result<ParameterSpace, TuningError> {
    let one = |own: &crate::case::plant::PlantTunedKey| TunedParameter {
        name: own.key.clone(),
        dimension: Dimension::NONE,
        low: own.bounds[0],
        high: own.bounds[1],
        logarithmic: own.logarithmic,
    };
    ParameterSpace::new(spec.parameters.iter().map(one).collect())
}

fn name_of(place: &MeasuredPlace) -> &str {
    match place {
        MeasuredPlace::Stream(name) | MeasuredPlace::Unit(name) => name,
    }
}

impl<'a> PlantProblem<'a> {
    fn new(
        case: &'a PlantCase,
        spec: &'a PlantTuningSpec,
        trials: TrialLog,
        interrupts: &'a Interrupts,
    ) -> Result<Self, TuningError> {
        let mut objectives: Vec<String> = Vec::new();
        for one in &spec.distributions {
            let name = format!("sizes of {}", name_of(&one.place));
            if !objectives.contains(&name) {
                objectives.push(name);
            }
        }
        objectives.extend(spec.values.iter().map(|one| one.name.clone()));
        let sieved = spec.distributions.iter().map(|one| one.time);
        let values = spec.values.iter();
        let values = values.flat_map(|one| one.points.iter().map(|point| point.0));
        let mut times: Vec<f64> = sieved.chain(values).collect();
        if spec.steady {
            times = vec![case.end];
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        Ok(Self {
            case,
            spec,
            space: parameters(spec)?,
            objectives,
            times,
            trials,
            interrupts,
        })
    }

    /// The plant of some values.
    fn plant(&self, values: &[f64]) -> Result<Plant, PlantError> {
        let keys = self.spec.parameters.iter().zip(values);
        let settings: Vec<String> = keys.map(|(key, value)| key.setting(*value)).collect();
        plant_with(
            self.case,
            &settings,
            values.first().copied().unwrap_or(f64::NAN),
        )
    }

    fn now(&self, time: f64, of: f64) -> bool {
        self.spec.steady || of == time
    }

    /// What is compared at one of the times, in the order of [`Self::seen`].
    fn list(&self, time: f64) -> Vec<Observed> {
        let mut all = Vec::new();
        let objective = |name: &str| self.objectives.iter().position(|own| own == name);
        for one in self
            .spec
            .distributions
            .iter()
            .filter(|one| self.now(time, one.time))
        {
            let name = name_of(&one.place);
            for (edges, share) in one.edges.windows(2).zip(&one.shares) {
                all.push(Observed {
                    place: name.to_owned(),
                    time,
                    what: format!("share of {} m to {} m", edges[0], edges[1]),
                    unit: "1".into(),
                    measured: Some([*share, one.deviation]),
                    objective: objective(&format!("sizes of {name}")),
                });
            }
        }
        for one in &self.spec.values {
            for (_, value) in one.points.iter().filter(|point| self.now(time, point.0)) {
                all.push(Observed {
                    place: one.name.clone(),
                    time,
                    what: "value".into(),
                    unit: one.unit.clone(),
                    measured: Some([*value, one.deviation]),
                    objective: objective(&one.name),
                });
            }
        }
        if self.times.last() == Some(&time) {
            for (name, unit, ..) in self.quantities() {
                all.push(Observed {
                    place: name.to_owned(),
                    time,
                    what: "quantity".into(),
                    unit: unit.to_owned(),
                    measured: None,
                    objective: None,
                });
            }
        }
        all
    }

    /// Quantities of the case that are last values.
    fn quantities(
        &self,
    ) -> impl Iterator<Item = (&str, &str, PlantPlace, PlantField, Option<usize>)> {
        self.case
            .quantities
            .iter()
            .filter_map(|one| match one.measure {
                PlantMeasure::OverTime {
                    of,
                    field,
                    compound,
                    over: OverTime::Last,
                    ..
                } => Some((one.name.as_str(), one.unit.as_str(), of, field, compound)),
                _ => None,
            })
    }

    /// What the plant does, in the order of [`Self::list`], from its streams and what its units hold.
    fn seen(&self, plant: &Plant, time: f64, state: impl Fn(PlantPlace) -> Vec<f64>) -> Vec<f64> {
        let layout = plant.layout();
        let mut all = Vec::new();
        let of = |one: &MeasuredDistribution| match &one.place {
            MeasuredPlace::Stream(name) => plant.stream(name).map(PlantPlace::Stream),
            MeasuredPlace::Unit(name) => plant.unit(name).map(PlantPlace::Unit),
        };
        for one in self
            .spec
            .distributions
            .iter()
            .filter(|one| self.now(time, one.time))
        {
            let masses = of(one).map(|place| layout.by_size(&state(place)));
            all.extend(one.shares_of(layout.grid(), &masses.unwrap_or_default()));
        }
        for one in &self.spec.values {
            for _ in one.points.iter().filter(|point| self.now(time, point.0)) {
                all.push(field(layout, &state(one.of), one.field, one.compound));
            }
        }
        if self.times.last() == Some(&time) {
            for (_, _, place, own, compound) in self.quantities() {
                all.push(field(layout, &state(place), own, compound));
            }
        }
        all
    }

    fn seen_in_run(&self, run: &PlantRun<'_>, plant: &Plant, time: f64) -> Vec<f64> {
        self.seen(plant, time, |place| super::measure::state(run, place))
    }

    fn seen_steady(&self, plant: &Plant, y: &[f64], flows: &FlowWorkspace) -> Vec<f64> {
        let time = self.case.end;
        self.seen(plant, time, |place| match place {
            PlantPlace::Stream(stream) => flows.stream(plant, stream).to_vec(),
            PlantPlace::Unit(unit) => plant.held_by(unit, y),
        })
    }

    /// All that is compared.
    fn observed(&self) -> Vec<Observed> {
        self.times
            .iter()
            .flat_map(|time| self.list(*time))
            .collect()
    }

    /// What the plant of some values does, in the order of [`Self::observed`].
    fn look(&self, values: &[f64]) -> Result<Vec<f64>, PlantError> {
        let plant = self.plant(values)?;
        if self.spec.steady {
            let found = plant.steady(&plant.start(), self.case.end)?;
            return Ok(self.seen_steady(&plant, &found.unknowns, &found.flows));
        }
        let method = &self.case.method;
        let tolerance = method.tolerance.min(TOLERANCE);
        let mut run = PlantRun::new(&plant, method.integrator, tolerance)?;
        let mut all = Vec::new();
        for time in &self.times {
            run.advance(*time)?;
            all.extend(self.seen_in_run(&run, &plant, *time));
        }
        Ok(all)
    }

    /// The same with derivatives by all keys (docs/theory.md, FLS-7).
    fn derivatives(&self, values: &[f64]) -> Result<Derivatives, PlantError> {
        let keys = self.spec.parameters.iter();
        let steps = keys
            .map(|key| STEP * (key.bounds[1] - key.bounds[0]))
            .collect();
        let family = PlantFamily::new(|at: &[f64]| self.plant(at), steps)?;
        if self.spec.steady {
            let plant = self.plant(values)?;
            let guess = plant.start();
            return family.observe_steady(values, &guess, self.case.end, |plant, y, flows| {
                self.seen_steady(plant, y, flows)
            });
        }
        let method = &self.case.method;
        let tolerance = method.tolerance.min(TOLERANCE);
        // Places do not depend on the parameters: any plant of the family has them.
        let plant = &self.case.plant;
        family.observe_run(
            values,
            method.integrator,
            tolerance,
            &self.times,
            |index, run| self.seen_in_run(run, plant, self.times[index]),
        )
    }
}

impl TuningProblem for PlantProblem<'_> {
    fn space(&self) -> &ParameterSpace {
        &self.space
    }

    fn objectives(&self) -> &[String] {
        &self.objectives
    }

    fn differences(&self, places: &[f64], out: &mut Vec<Vec<f64>>) -> Result<(), TuningError> {
        if self.interrupts.count() > 0 {
            return Err(TuningError::Interrupted);
        }
        let seen = self.trials.trial(places, || {
            let seen = self.look(&self.space.values(places));
            seen.map_err(|error| error.to_string())
        });
        // A trial that fails is a failed candidate: the search goes on without it.
        let seen = seen.map_err(TuningError::Model)?;
        out.clear();
        out.resize(self.objectives.len(), Vec::new());
        for (one, value) in self.observed().iter().zip(seen) {
            if let (Some([measured, deviation]), Some(objective)) = (one.measured, one.objective) {
                out[objective].push((value - measured) / deviation);
            }
        }
        Ok(())
    }

    fn step(&self) -> f64 {
        1e-3
    }
}

/// Tunes the keys of a plant: what was found, with its tables written into the folder. It may go on with the trials that are there.
pub(crate) fn tune_plant(
    case: &PlantCase,
    spec: &PlantTuningSpec,
    out: &Path,
    go_on: bool,
    interrupts: &Interrupts,
) -> Result<PlantTuningSummary, TuningError> {
    let told = |error: ResultsError| TuningError::Model(error.to_string());
    let keys: Vec<&str> = spec.parameters.iter().map(|one| one.key.as_str()).collect();
    let trials = TrialLog::open(out, &hash_of(case, spec), &keys, go_on).map_err(told)?;
    let problem = PlantProblem::new(case, spec, trials, interrupts)?;
    let choice = FitChoice::default();
    let settings = StartSettings {
        samples: spec.sets[0],
        starts: spec.sets[1],
        seed: spec.seed,
    };
    let stop = AtomicBool::new(false);
    let fitted = fit_globally(&problem, &choice, &settings, &stop)?;
    let values = problem.space.values(&fitted.places);
    let mut found = Vec::new();
    for (index, key) in spec.parameters.iter().enumerate() {
        let profile = profile(&problem, &fitted, &choice, index, spec.level)?;
        let [low, high] =
            [profile.low, profile.high].map(|end| problem.space.value(index, end.place));
        found.push(PlantTunedParameter {
            key: key.key.clone(),
            unit: key.unit.clone(),
            value: values[index],
            interval: [low, high],
            open: [profile.low.at_bound, profile.high.at_bound],
            bounds: key.bounds,
        });
    }
    let mut sensitivities = Vec::new();
    let mut not_sensitive = None;
    match problem.derivatives(&values) {
        Ok(derivatives) => {
            let observed = problem.observed();
            write_sensitivities(out, spec, &observed, &derivatives).map_err(told)?;
            sensitivities = sensitivities_of(&observed, &derivatives);
        }
        // Beside the best values there are some of which there is no plant.
        Err(error) => not_sensitive = Some(error.to_string()),
    }
    let count = problem.trials.count().map_err(told)?;
    let correlated = correlated(&fitted).unwrap_or_default().into_iter();
    let sums = problem
        .objectives
        .iter()
        .zip(&fitted.sums)
        .zip(&fitted.counts);
    Ok(PlantTuningSummary {
        parameters: found,
        level: spec.level,
        deviations: sums
            .map(|((name, sum), count)| (name.clone(), (sum / (*count).max(1) as f64).sqrt()))
            .collect(),
        correlated: correlated
            .map(|pair| (pair.first, pair.second, pair.correlation))
            .collect(),
        sensitivities,
        not_sensitive,
        evaluations: fitted.evaluations,
        trials: count.tried,
        failed: count.failed,
        failure: count.failure,
    })
}
