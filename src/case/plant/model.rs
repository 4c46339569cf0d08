//! A plant's case as it was read.

use std::path::PathBuf;
use std::time::Duration;

use calcine_flowsheet::{Integrator, MeasuredDistribution, Plant, WaveformSettings};

use super::bed::PlantBedSpec;
use super::words::{LimitField, OverTime, PlantField, SteadyField, SteadyFrom};
use crate::case::model::ToleranceBand;

/// The case of a plant, in SI units.
pub struct PlantCase {
    /// Name of the file without its ending.
    pub name: String,
    /// Title for people.
    pub title: String,
    /// The file.
    pub path: PathBuf,
    /// SHA-256 (hex) of its values.
    pub hash: String,
    /// What `--set` changed, in words.
    pub changes: Vec<String>,
    /// The text with `--set` applied.
    pub effective: String,
    /// End of the run in s.
    pub end: f64,
    /// Time in s between checkpoints.
    pub checkpoint_every: Option<f64>,
    /// Wall time between checkpoints.
    pub checkpoint_wall: Option<Duration>,
    /// How it is followed.
    pub method: PlantMethod,
    /// The plant.
    pub plant: Plant,
    /// Kinds of its units, in their order.
    pub kinds: Vec<&'static str>,
    /// Beds that are cases of their own, in the order of their units.
    pub beds: Vec<PlantBedSpec>,
    /// Time in s between rows of the series.
    pub row_every: f64,
    /// Time in s between distributions; without it at the start and the end alone.
    pub distributions_every: Option<f64>,
    /// Quantities of interest.
    pub quantities: Vec<PlantQuantity>,
    /// The steady state that is looked for.
    pub steady: Option<SteadySpec>,
    /// Steady states over a key.
    pub continuation: Option<ContinuationSpec>,
    /// Keys that are tuned to measurements.
    pub tuning: Option<PlantTuningSpec>,
}

/// How a plant is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantMethod {
    /// What follows the unknowns.
    pub integrator: Integrator,
    /// Error of a step that is allowed, relative to the size of the unknowns.
    pub tolerance: f64,
    /// Windows of waveform relaxation; `None`: recycles are closed at every evaluation.
    pub waveform: Option<WaveformSettings>,
}

impl PlantMethod {
    /// The word of `method.recycles`.
    pub fn recycles(&self) -> &'static str {
        match self.waveform {
            None => "monolithic",
            Some(_) => "waveform",
        }
    }

    /// The word of `method.integrator`.
    pub fn integrator(&self) -> &'static str {
        match self.integrator {
            Integrator::Explicit => "explicit",
            Integrator::Stabilised => "stabilised",
            Integrator::Stiff => "stiff",
        }
    }
}

/// A quantity of interest of a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantQuantity {
    /// Name.
    pub name: String,
    /// What is measured.
    pub measure: PlantMeasure,
    /// Unit in which it is told: SI.
    pub unit: String,
    /// Expected value at the end, and how far off it may be.
    pub expect: Option<(f64, ToleranceBand)>,
    /// Largest difference between runs that are compared.
    pub agree: Option<ToleranceBand>,
}

/// What is measured.
#[derive(Clone, Debug, PartialEq)]
pub enum PlantMeasure {
    /// A field over time.
    OverTime {
        /// Of what.
        of: PlantPlace,
        /// Which field.
        field: PlantField,
        /// Compound of the field `compound`, by its place among those of the plant.
        compound: Option<usize>,
        /// What is taken of its values.
        over: OverTime,
        /// Time in s from which values count.
        from: f64,
    },
    /// Of the steady state.
    Steady(SteadyField),
    /// Of the first limit of stability.
    Limit(LimitField),
}

/// A stream or a unit, by its place in the plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlantPlace {
    /// A stream.
    Stream(usize),
    /// What a unit holds.
    Unit(usize),
}

/// `steady`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SteadySpec {
    /// What the iteration begins with.
    pub from: SteadyFrom,
    /// How many modes are written.
    pub modes: usize,
}

/// `continuation`.
#[derive(Clone, Debug, PartialEq)]
pub struct ContinuationSpec {
    /// Keys that get each value.
    pub keys: Vec<String>,
    /// Values, in the unit of the case.
    pub values: Vec<f64>,
    /// The unit behind each number; empty for plain numbers.
    pub unit: String,
    /// How closely limits are found, relative to the value.
    pub width: f64,
}

impl ContinuationSpec {
    /// The settings of `--set` that stand for a value.
    pub fn settings(&self, value: f64) -> Vec<String> {
        let text = match self.unit.as_str() {
            "" => format!("{value}"),
            unit => format!("{value} {unit}"),
        };
        let keys = self.keys.iter();
        keys.map(|key| format!("{key}={text}")).collect()
    }
}

/// Keys of a plant that are tuned to measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantTuningSpec {
    /// True where the measurements are of the steady state.
    pub steady: bool,
    /// The keys.
    pub parameters: Vec<PlantTunedKey>,
    /// Sieve analyses.
    pub distributions: Vec<MeasuredDistribution>,
    /// Other measurements.
    pub values: Vec<PlantMeasuredValues>,
    /// Sets of parameters that are tried, and how many of them are followed.
    pub sets: [usize; 2],
    /// Seed of the sets.
    pub seed: u64,
    /// Probability with which intervals hold the true value.
    pub level: f64,
    /// Files of measurements.
    pub files: Vec<PathBuf>,
}

/// A key that is tuned.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantTunedKey {
    /// The key, as `--set` names it.
    pub key: String,
    /// Bounds in the unit of the case.
    pub bounds: [f64; 2],
    /// The unit; empty for plain numbers.
    pub unit: String,
    /// Whether it is searched by its logarithm.
    pub logarithmic: bool,
}

impl PlantTunedKey {
    /// The setting of `--set` that stands for a value.
    pub fn setting(&self, value: f64) -> String {
        match self.unit.as_str() {
            "" => format!("{}={value:?}", self.key),
            unit => format!("{}={value:?} {unit}", self.key),
        }
    }
}

/// Values of one field that were measured.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantMeasuredValues {
    /// What they are called.
    pub name: String,
    /// Of what.
    pub of: PlantPlace,
    /// Which field.
    pub field: PlantField,
    /// Compound of the field `compound`.
    pub compound: Option<usize>,
    /// Unit: SI.
    pub unit: String,
    /// Times in s, and values.
    pub points: Vec<(f64, f64)>,
    /// Standard deviation of a value.
    pub deviation: f64,
}
