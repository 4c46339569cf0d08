//! What a tuning found.

use calcine_tuning::analysis::{ConversionEnergy, KissingerResult};
use calcine_tuning::interval::{ParameterPair, ParameterProfile};
use calcine_tuning::search::SearchedFront;
use calcine_tuning::{ComparedQuantity, ParameterSpace};

/// One law of those that are compared.
#[derive(Clone, Debug)]
pub struct LawFit {
    /// Name of the law.
    pub law: &'static str,
    /// Akaike's criterion; lower is better.
    pub criterion: f64,
    /// Weight among the laws.
    pub weight: f64,
    /// Tuned parameters with their values in SI.
    pub values: Vec<(String, f64)>,
    /// Root mean square of the differences, objective by objective.
    pub errors: Vec<f64>,
    /// Share of the sum of squares about a sample that does not react that is left.
    pub left: f64,
}

/// A law that leaves more than this share explains nothing: a wrong law leaves less than half of it.
const EXPLAINS_NOTHING: f64 = 0.9;

impl LawFit {
    /// True where the fit is no better than no reaction: its values mean nothing.
    pub fn explains_nothing(&self) -> bool {
        self.left > EXPLAINS_NOTHING
    }
}

/// One parameter.
#[derive(Clone, Debug)]
pub struct FoundParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value in SI.
    pub value: f64,
    /// Ends of its interval in SI, where it was sought; the bound where the data do not end it.
    pub interval: Option<[f64; 2]>,
    /// True of an end that is the bound's, not the data's.
    pub open: [bool; 2],
    /// Interval by the bootstrap in SI.
    pub bootstrap: Option<[f64; 2]>,
    /// Bounds in SI.
    pub bounds: [f64; 2],
    /// True where the value stands on a bound.
    pub at_bound: bool,
}

/// A curve with what the model makes of it.
#[derive(Clone, Debug)]
pub struct FittedCurve {
    /// Name of the target.
    pub target: String,
    /// What is compared.
    pub quantity: ComparedQuantity,
    /// False of a curve that is kept back from the fit.
    pub is_fitted: bool,
    /// Unit of the values.
    pub unit: String,
    /// Times in s.
    pub time: Vec<f64>,
    /// Temperatures in K; empty where there are none.
    pub temperature: Vec<f64>,
    /// Measured values.
    pub measured: Vec<f64>,
    /// The model's.
    pub model: Vec<f64>,
}

/// How near the model comes to a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveErrors {
    /// Mean of the differences over the measured values, without signs; none where a measured value is zero.
    pub mean_relative: Option<f64>,
    /// Root mean square of the differences, in the curve's unit.
    pub root_mean_square: f64,
    /// Of a mass: largest difference over its whole loss, where the conversion is between 0.001 and 0.999.
    pub largest_of_loss: Option<f64>,
}

/// Conversions between which a sample reacts.
const REACTING: [f64; 2] = [0.001, 0.999];

impl FittedCurve {
    /// Errors of the curve; `loss` is the share of the sample that a conversion of one takes away.
    pub fn errors(&self, loss: f64) -> CurveErrors {
        let pairs = || self.measured.iter().zip(&self.model);
        let count = self.measured.len().max(1) as f64;
        let relative: f64 = pairs().map(|(x, m)| ((m - x) / x).abs()).sum();
        let squares: f64 = pairs().map(|(x, m)| (m - x).powi(2)).sum();
        let reacting = pairs().filter(|(x, _)| {
            let conversion = (1.0 - **x) / loss;
            REACTING[0] < conversion && conversion < REACTING[1]
        });
        let largest = reacting.map(|(x, m)| (m - x).abs() / loss).reduce(f64::max);
        CurveErrors {
            mean_relative: Some(relative / count).filter(|error| error.is_finite()),
            root_mean_square: (squares / count).sqrt(),
            largest_of_loss: largest.filter(|_| self.quantity == ComparedQuantity::Mass),
        }
    }
}

/// Energies without a law.
#[derive(Clone, Debug, Default)]
pub struct LawFreeEnergies {
    /// Kissinger's method.
    pub kissinger: Option<KissingerResult>,
    /// Friedman's method.
    pub friedman: Vec<ConversionEnergy>,
    /// The method of Ozawa, Flynn and Wall.
    pub ozawa_flynn_wall: Vec<ConversionEnergy>,
    /// What could not be had, and why.
    pub notes: Vec<String>,
}

/// All that a tuning found.
#[derive(Debug)]
pub struct TuningOutcome {
    /// Names of the objectives.
    pub objectives: Vec<String>,
    /// Sum of squares of each at the chosen place.
    pub sums: Vec<f64>,
    /// Number of values of each.
    pub counts: Vec<usize>,
    /// The laws that were compared; empty of whole cases.
    pub laws: Vec<LawFit>,
    /// Which of them was chosen.
    pub chosen: usize,
    /// The parameters.
    pub parameters: Vec<FoundParameter>,
    /// The space that they were searched in.
    pub space: ParameterSpace,
    /// The front, where evolution searched for one.
    pub front: Option<SearchedFront>,
    /// Profiles of the likelihood.
    pub profiles: Vec<ParameterProfile>,
    /// Pairs that are strongly correlated.
    pub pairs: Vec<ParameterPair>,
    /// Curves.
    pub curves: Vec<FittedCurve>,
    /// Energies without a law.
    pub energies: LawFreeEnergies,
    /// What is to be told.
    pub warnings: Vec<String>,
    /// Evaluations of the model in all.
    pub evaluations: usize,
}

/// Unit of a compared quantity.
pub fn unit_of(quantity: ComparedQuantity) -> &'static str {
    match quantity {
        ComparedQuantity::Temperature => "K",
        ComparedQuantity::Mass => "",
        ComparedQuantity::LossRate => "1/s",
    }
}
