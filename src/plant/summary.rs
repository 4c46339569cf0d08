//! `summary.json` of a plant: what was run and what came out, under stable names.

use std::collections::BTreeMap;
use std::path::Path;

use calcine_flowsheet::PlantLedger;
use serde::{Deserialize, Serialize};

use crate::results::files;
use crate::results::summary::{CaseName, QuantityResult, RunFailure};
use crate::results::{ResultsError, SUMMARY, Verdict};

/// The word of `kind` in the file.
pub(super) const KIND: &str = "flowsheet";

/// The file; units are in the names or beside the values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantSummary {
    /// Version of these names.
    pub format: u32,
    /// Version of Calcine.
    pub calcine: String,
    /// Kind of the case: `flowsheet`.
    pub kind: String,
    /// The case.
    pub case: CaseName,
    /// Results folder of the run whose state this one began from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// The verdict over all quantities.
    pub verdict: Verdict,
    /// How recycles are closed: `monolithic` or `waveform`.
    pub recycles: String,
    /// What follows the unknowns.
    pub integrator: String,
    /// Error of a step that is allowed.
    pub tolerance: f64,
    /// Time reached in s.
    pub time_s: f64,
    /// End of the run in s.
    pub end_s: f64,
    /// Size classes.
    pub classes: usize,
    /// Unknowns of all units.
    pub unknowns: usize,
    /// Streams that recycles are torn at.
    pub tears: Vec<String>,
    /// Steps of this process.
    pub steps: usize,
    /// Steps that were repeated.
    pub repeated_steps: usize,
    /// Ways round the recycles in this process.
    pub rounds: usize,
    /// Balances.
    pub ledger: PlantLedgerSummary,
    /// Quantities of interest by name.
    pub quantities: BTreeMap<String, QuantityResult>,
    /// The steady state.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady: Option<PlantSteadySummary>,
    /// Why no steady state, or none of a value of the key, was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_steady: Option<String>,
    /// Its dominant mode.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<PlantMode>,
    /// Steady states over a key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub continuation: Option<PlantContinuationSummary>,
    /// Keys that were tuned to measurements before the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tuning: Option<PlantTuningSummary>,
    /// Wall time in s.
    pub wall_time_s: f64,
    /// Why the run ended with an error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<RunFailure>,
}

/// Balances since the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlantLedgerSummary {
    /// Largest difference of a tear stream from itself, relative to its flow.
    pub loop_closure: f64,
    /// The same of each tear stream.
    #[serde(default)]
    pub tears: BTreeMap<String, f64>,
    /// Largest relative error of all balances.
    pub largest_relative_error: f64,
    /// The balances of each unit and of the plant.
    pub lines: Vec<PlantBalance>,
}

/// One balance, in kg, or J for the enthalpy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantBalance {
    /// Unit, or `plant`.
    pub place: String,
    /// Compound, `mass` or `enthalpy`.
    pub what: String,
    /// What came in.
    pub enters: f64,
    /// What went out.
    pub leaves: f64,
    /// By how much what is held grew.
    pub stored: f64,
    /// Heat from drives and heaters.
    pub heat: f64,
    /// What is missing.
    pub missing: f64,
    /// |missing| relative to the terms and what is held.
    pub relative_error: f64,
}

impl PlantLedgerSummary {
    /// As the crate has it.
    pub(super) fn of(ledger: &PlantLedger) -> Self {
        let lines = ledger.lines.iter().map(|line| PlantBalance {
            place: line.place.clone(),
            what: line.what.clone(),
            enters: line.enters,
            leaves: line.leaves,
            stored: line.stored,
            heat: line.heat,
            missing: line.missing,
            relative_error: line.relative_error,
        });
        Self {
            loop_closure: ledger.closure(),
            tears: ledger.tears.iter().cloned().collect(),
            largest_relative_error: ledger.worst(),
            lines: lines.collect(),
        }
    }
}

/// A mode of small deviations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantMode {
    /// Growth rate in 1/s; negative where it decays.
    pub growth_rate_per_s: f64,
    /// Period in s; `null` where it does not oscillate.
    pub period_s: Option<f64>,
}

impl PlantMode {
    /// A mode; its period is infinite where it does not oscillate.
    pub(super) fn new(growth_rate_per_s: f64, period: f64) -> Self {
        Self {
            growth_rate_per_s,
            period_s: period.is_finite().then_some(period),
        }
    }
}

/// A steady state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantSteadySummary {
    /// Iterations of Newton's method.
    pub iterations: usize,
    /// Largest rate of change, in sizes of the unknowns per second.
    pub residual_per_s: f64,
    /// Distance of the end of the run: the largest difference of an unknown mass relative to what its unit holds.
    pub distance: f64,
    /// The modes that decay last.
    pub modes: Vec<PlantMode>,
    /// Wall time in s, of the state and of its modes.
    pub wall_time_s: [f64; 2],
}

/// Steady states over a key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantContinuationSummary {
    /// The keys.
    pub keys: Vec<String>,
    /// Unit of the values.
    pub unit: String,
    /// The states that were followed.
    pub points: Vec<PlantContinuationPoint>,
    /// Values at which stability is gained or lost.
    pub limits: Vec<PlantContinuationPoint>,
}

/// The steady state of one value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantContinuationPoint {
    /// Value of the key.
    pub value: f64,
    /// Dominant mode.
    #[serde(flatten)]
    pub mode: PlantMode,
}

/// Keys that were tuned to measurements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantTuningSummary {
    /// The keys.
    pub parameters: Vec<PlantTunedParameter>,
    /// Probability with which the intervals hold the true values.
    pub level: f64,
    /// Root mean square of the differences of each objective, in standard deviations of its measurements.
    pub deviations: BTreeMap<String, f64>,
    /// Pairs of keys whose errors go together by more than 0.95, and by how much.
    pub correlated: Vec<(usize, usize, f64)>,
    /// Derivatives of the case's quantities at their last values.
    pub sensitivities: Vec<PlantSensitivity>,
    /// Why there are none of these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_sensitive: Option<String>,
    /// Evaluations of the best fit.
    pub evaluations: usize,
    /// Sets of values that were tried, those of the intervals too.
    #[serde(default)]
    pub trials: usize,
    /// How many of these could not be followed.
    #[serde(default)]
    pub failed: usize,
    /// What one of these said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// A key that was tuned.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantTunedParameter {
    /// The key.
    pub key: String,
    /// Unit of the values.
    pub unit: String,
    /// The value found.
    pub value: f64,
    /// The interval.
    pub interval: [f64; 2],
    /// True where the measurements do not end the interval: the bound does, or trials beyond it fail.
    pub open: [bool; 2],
    /// The bounds.
    pub bounds: [f64; 2],
}

/// How a quantity depends on the keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantSensitivity {
    /// The quantity.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Its derivative by each key, per unit of the key.
    pub by: Vec<f64>,
}

impl PlantSummary {
    /// Reads the summary of a results folder.
    pub fn read(directory: &Path) -> Result<Self, ResultsError> {
        let path = directory.join(SUMMARY);
        if !path.exists() {
            return Err(ResultsError::NoResults {
                path: directory.to_owned(),
                fact: "it holds no summary.json",
            });
        }
        serde_json::from_str(&files::read(&path)?)
            .map_err(|error| ResultsError::content(&path, error.to_string()))
    }

    /// Replaces the summary of a results folder.
    pub(crate) fn replace(&self, directory: &Path) -> Result<(), ResultsError> {
        files::replace_json(&directory.join(SUMMARY), self)
    }

    /// True where the run came to its end.
    pub fn is_complete(&self) -> bool {
        !matches!(self.verdict, Verdict::Running | Verdict::Stopped)
    }
}
