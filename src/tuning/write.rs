//! Files of a tuning's results folder.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use calcine_coupler::physics::dimension::Dimension;
use calcine_tuning::search::SearchEvaluation;
use serde_json::{Map, Value, json};

use super::case::TuningCase;
use super::outcome::TuningOutcome;
use crate::results::{CASE, ResultsError, SUMMARY, files};

/// Evaluations of a search, one a line; a search that was interrupted goes on from it.
pub const EVALUATIONS: &str = "evaluations.csv";
/// The front.
pub const FRONT: &str = "front.csv";
/// Measured values and the model's.
pub const CURVES: &str = "curves.csv";
/// Profiles of the likelihood.
pub const PROFILES: &str = "profiles.csv";

/// Name of a unit in results.
pub fn unit_name(dimension: Dimension) -> String {
    match dimension {
        Dimension::ANGULAR_VELOCITY => "1/s".into(),
        Dimension::ENERGY_OF_MASS => "J/kg".into(),
        other => other.unit(),
    }
}

/// The state of a tuning, in `summary.json` from its start on.
pub fn write_state(folder: &Path, case: &TuningCase, verdict: &str) -> Result<(), ResultsError> {
    files::replace_json(&folder.join(SUMMARY), &head(case, verdict))
}

fn head(case: &TuningCase, verdict: &str) -> Value {
    json!({
        "calcine": env!("CARGO_PKG_VERSION"),
        "kind": "tuning",
        "case": { "name": case.name, "title": case.title, "hash": case.hash, "changes": case.changes },
        "verdict": verdict,
    })
}

/// Hash and verdict of what a results folder holds; `None` where it holds no tuning.
pub fn state(folder: &Path) -> Option<(String, String)> {
    let text = std::fs::read_to_string(folder.join(SUMMARY)).ok()?;
    let summary: Value = serde_json::from_str(&text).ok()?;
    (summary["kind"] == "tuning").then_some(())?;
    let hash = summary["case"]["hash"].as_str()?.to_owned();
    Some((hash, summary["verdict"].as_str()?.to_owned()))
}

/// Writes all results of a tuning that came to its end.
pub fn write(folder: &Path, case: &TuningCase, found: &TuningOutcome) -> Result<(), ResultsError> {
    files::replace(&folder.join(CASE), case.effective.as_bytes())?;
    files::replace(&folder.join(CURVES), curves(found).as_bytes())?;
    if let Some(text) = front(found) {
        files::replace(&folder.join(FRONT), text.as_bytes())?;
    }
    if !found.profiles.is_empty() {
        files::replace(&folder.join(PROFILES), profiles(found).as_bytes())?;
    }
    let mut summary = head(case, "finished");
    summary["tuning"] = tuning(case, found);
    summary["warnings"] = json!(found.warnings);
    files::replace_json(&folder.join(SUMMARY), &summary)
}

fn tuning(case: &TuningCase, found: &TuningOutcome) -> Value {
    let mut parameters = Map::new();
    for one in &found.parameters {
        let ends = |ends: Option<[f64; 2]>, k: usize| ends.map(|ends| ends[k]);
        parameters.insert(
            one.name.clone(),
            json!({
                "value": one.value,
                "low": ends(one.interval.or(one.bootstrap), 0),
                "high": ends(one.interval.or(one.bootstrap), 1),
                "unit": one.unit,
                "low_is_bound": one.open[0],
                "high_is_bound": one.open[1],
                "at_bound": one.at_bound,
                "bootstrap_low": ends(one.bootstrap, 0),
                "bootstrap_high": ends(one.bootstrap, 1),
            }),
        );
    }
    let mut objectives = Map::new();
    for ((name, sum), count) in found.objectives.iter().zip(&found.sums).zip(&found.counts) {
        let rms = (sum / (*count).max(1) as f64).sqrt();
        objectives.insert(
            name.clone(),
            json!({ "value": sum, "values": count, "rms": rms }),
        );
    }
    let curves = found.curves.iter().map(|one| {
        let errors = one.errors(case.loss);
        json!({
            "target": one.target,
            "quantity": one.quantity.name(),
            "unit": one.unit,
            "fitted": one.is_fitted,
            "rms": errors.root_mean_square,
            "mean_relative_error": errors.mean_relative,
            "largest_error_of_loss": errors.largest_of_loss,
        })
    });
    let names = |k: usize| found.space.parameters()[k].name.clone();
    let laws = found.laws.iter().map(|one| {
        let values: Map<String, Value> = one
            .values
            .iter()
            .map(|(name, value)| (name.clone(), json!(value)))
            .collect();
        json!({ "law": one.law, "aic": one.criterion, "weight": one.weight, "parameters": values })
    });
    let pairs = found.pairs.iter().map(|pair| {
        json!({ "parameters": [names(pair.first), names(pair.second)], "correlation": pair.correlation })
    });
    let energies = |list: &[calcine_tuning::analysis::ConversionEnergy]| -> Vec<Value> {
        let row = |one: &calcine_tuning::analysis::ConversionEnergy| json!({ "conversion": one.conversion, "energy": one.energy, "error": one.error });
        list.iter().map(row).collect()
    };
    let kissinger = found.energies.kissinger.as_ref().map(|one| {
        json!({ "energy": one.energy, "error": one.energy_error, "pre_exponential": one.pre_exponential, "peaks": one.peaks })
    });
    json!({
        "algorithm": if case.method.evolution { "nsga2" } else { "least-squares" },
        "seed": case.method.seed,
        "evaluations": found.evaluations,
        "law": found.laws.get(found.chosen).map(|one| one.law),
        "parameters": parameters,
        "objectives": objectives,
        "curves": curves.collect::<Vec<_>>(),
        "level": case.intervals.level,
        "laws": laws.collect::<Vec<_>>(),
        "correlated": pairs.collect::<Vec<_>>(),
        "front": found.front.as_ref().map(|front| json!({
            "points": front.archive.front().len(),
            "reference": front.reference,
            "hypervolume": front.hypervolumes.last(),
            "hypervolumes": front.hypervolumes,
        })),
        "energies": {
            "unit": "J/mol",
            "kissinger": kissinger,
            "friedman": energies(&found.energies.friedman),
            "ozawa_flynn_wall": energies(&found.energies.ozawa_flynn_wall),
            "notes": found.energies.notes,
        },
    })
}

/// A field of a table, quoted where it holds a comma.
fn field(text: &str) -> String {
    match text.contains([',', '"']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

fn curves(found: &TuningOutcome) -> String {
    let mut text = "target,quantity,unit,time in s,temperature in K,measured,model\n".to_owned();
    for curve in &found.curves {
        let (target, quantity, unit) = (
            field(&curve.target),
            curve.quantity.name(),
            field(&curve.unit),
        );
        for k in 0..curve.time.len() {
            let temperature = curve
                .temperature
                .get(k)
                .map(f64::to_string)
                .unwrap_or_default();
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{target},{quantity},{unit},{},{temperature},{},{}",
                curve.time[k], curve.measured[k], curve.model[k]
            );
        }
    }
    text
}

fn front(found: &TuningOutcome) -> Option<String> {
    let front = found.front.as_ref()?;
    let names: Vec<String> = found
        .space
        .parameters()
        .iter()
        .map(|one| field(&one.name))
        .collect();
    let mut text = format!(
        "evaluation,{},{}\n",
        names.join(","),
        found.objectives.join(",")
    );
    for point in front.archive.front() {
        let values = found
            .space
            .values(&point.genes)
            .into_iter()
            .chain(point.objectives.iter().copied());
        let values: Vec<String> = values.map(|one| format!("{one:e}")).collect();
        let _ = writeln!(text, "{},{}", point.evaluation, values.join(","));
    }
    Some(text)
}

fn profiles(found: &TuningOutcome) -> String {
    let mut text = "parameter,unit,value,rise of the deviance,threshold\n".to_owned();
    for profile in &found.profiles {
        let one = &found.space.parameters()[profile.parameter];
        let (name, unit) = (field(&one.name), unit_name(one.dimension));
        for (place, rise) in &profile.points {
            let value = found.space.value(profile.parameter, *place);
            let _ = writeln!(
                text,
                "{name},{unit},{value:e},{rise:e},{:e}",
                profile.threshold
            );
        }
    }
    text
}

/// The evaluations of all searches of a tuning, written as they come.
pub struct EvaluationLog {
    path: PathBuf,
    names: Vec<String>,
    objectives: Vec<String>,
    known: Vec<(String, SearchEvaluation)>,
    lines: Vec<(String, usize, String)>,
}

impl EvaluationLog {
    /// The log of a folder; what it holds of the same tuning is kept where that goes on, and removed else.
    pub fn open(folder: &Path, go_on: bool) -> Self {
        let path = folder.join(EVALUATIONS);
        let before = match go_on {
            true => std::fs::read_to_string(&path).unwrap_or_default(),
            false => String::new(),
        };
        let mut log = Self {
            path,
            names: Vec::new(),
            objectives: Vec::new(),
            known: Vec::new(),
            lines: Vec::new(),
        };
        for line in before.lines().skip(1) {
            let Some(one) = parse(line) else {
                break;
            };
            log.lines
                .push((one.0.clone(), one.1.generation, line.to_owned()));
            log.known.push(one);
        }
        log
    }

    /// The evaluations that are known of a stage.
    pub fn known(&self, stage: &str) -> Vec<SearchEvaluation> {
        let own = self.known.iter().filter(|(name, _)| name == stage);
        own.map(|(_, one)| one.clone()).collect()
    }

    /// Names of the columns.
    pub fn name(&mut self, parameters: Vec<String>, objectives: Vec<String>) {
        (self.names, self.objectives) = (parameters, objectives);
    }

    /// Adds a generation and writes the log anew; it is replaced as a whole, so that an interrupt leaves the one before.
    pub fn add(&mut self, stage: &str, new: &[SearchEvaluation]) -> Result<(), ResultsError> {
        // An interrupt may have left a part of this generation.
        if let Some(first) = new.first() {
            let before = |(of, generation, _): &(String, usize, String)| {
                of != stage || *generation < first.generation
            };
            self.lines.retain(before);
        }
        for one in new {
            let list = |values: &[f64]| -> String {
                let values = values.iter().map(|value| format!("{value:e}"));
                values.collect::<Vec<_>>().join(" ")
            };
            let (places, objectives) = (list(&one.places), list(&one.objectives));
            let line = format!("{stage},{},{places},{objectives}", one.generation);
            self.lines.push((stage.to_owned(), one.generation, line));
        }
        let head = format!(
            "stage,generation,places from 0 to 1 between the bounds of {},sums of squares of {}\n",
            self.names.join(" "),
            self.objectives.join(" ")
        );
        let lines = self.lines.iter().map(|(_, _, line)| format!("{line}\n"));
        let text: String = lines.collect();
        files::replace(&self.path, (head + &text).as_bytes())
    }
}

fn parse(line: &str) -> Option<(String, SearchEvaluation)> {
    let mut fields = line.split(',');
    let stage = fields.next()?.to_owned();
    let generation = fields.next()?.parse().ok()?;
    let list = |text: &str| -> Option<Vec<f64>> {
        text.split_whitespace()
            .map(|one| one.parse().ok())
            .collect()
    };
    Some((
        stage,
        SearchEvaluation {
            generation,
            places: list(fields.next()?)?,
            objectives: list(fields.next()?)?,
        },
    ))
}
