//! Curves that models are compared with.

use crate::TuningError;
use crate::law::KineticLaw;
use crate::model::{HeatingRun, PreparedSample, SampleModel, SampleResponse};
use crate::problem::TuningProblem;
use crate::programme::RateQuadrature;
use crate::space::ParameterSpace;
use calcine_physics::gas::GAS_CONSTANT;

/// What is compared at each time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ComparedQuantity {
    /// Temperature of the sample in K.
    Temperature,
    /// Mass relative to that at the start: thermogravimetry.
    Mass,
    /// Rate at which that falls in 1/s: derivative thermogravimetry.
    LossRate,
}

impl ComparedQuantity {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Temperature, Self::Mass, Self::LossRate];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Temperature => "temperature",
            Self::Mass => "mass",
            Self::LossRate => "loss_rate",
        }
    }

    fn of(self, response: &SampleResponse) -> &[f64] {
        match self {
            Self::Temperature => &response.temperature,
            Self::Mass => &response.mass,
            Self::LossRate => &response.loss_rate,
        }
    }
}

/// How differences are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DifferenceForm {
    /// In the unit of the quantity.
    #[default]
    Absolute,
    /// Relative to the measured value, as in the paper: (measured − model)/measured.
    Relative,
}

/// One measured or computed run.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetCurve {
    /// Its name.
    pub name: String,
    /// What the sample went through, with the times of the values.
    pub run: HeatingRun,
    /// Values of each quantity that is compared, at all times of the run.
    pub values: Vec<(ComparedQuantity, Vec<f64>)>,
    /// Which times count; all where empty.
    pub counted: Vec<bool>,
}

impl TargetCurve {
    /// Values of a quantity.
    pub fn of(&self, quantity: ComparedQuantity) -> Option<&[f64]> {
        let found = self.values.iter().find(|(one, _)| *one == quantity)?;
        Some(&found.1)
    }

    /// Conversion at each time, from the mass at the start and the end.
    pub fn conversion(&self) -> Option<Vec<f64>> {
        let mass = self.of(ComparedQuantity::Mass)?;
        let (first, last) = (*mass.first()?, *mass.last()?);
        Some(mass.iter().map(|m| (first - m) / (first - last)).collect())
    }

    /// Counts only times at which the conversion lies between two values: from the first time above the lower one to the
    /// first above the upper one.
    pub fn count_within(&mut self, low: f64, high: f64) {
        if let Some(conversion) = self.conversion() {
            let first = |limit: f64| conversion.iter().position(|&x| x > limit);
            let from = first(low).unwrap_or(conversion.len());
            let to = first(high).unwrap_or(conversion.len());
            self.counted = (0..conversion.len()).map(|k| k >= from && k < to).collect();
        }
    }

    fn counts(&self, k: usize) -> bool {
        self.counted.get(k).copied().unwrap_or(true)
    }
}

/// A model of a sample against curves: one objective a quantity, over all curves.
pub struct SampleProblem {
    space: ParameterSpace,
    objectives: Vec<String>,
    quantities: Vec<ComparedQuantity>,
    form: DifferenceForm,
    targets: Vec<TargetCurve>,
    prepared: Vec<Box<dyn PreparedSample>>,
    /// Values of all numbers of the model, those that are tuned included.
    values: Vec<f64>,
    /// Of each tuned parameter its place among the numbers of the model.
    tuned: Vec<usize>,
    guesses: Vec<Vec<f64>>,
}

impl SampleProblem {
    /// The numbers of the model that the space names are tuned; the others keep their values.
    pub fn new(
        model: &dyn SampleModel,
        space: ParameterSpace,
        targets: Vec<TargetCurve>,
        form: DifferenceForm,
    ) -> Result<Self, TuningError> {
        let numbers = model.parameters();
        let place = |name: &str| {
            let known = || {
                numbers
                    .iter()
                    .map(|one| one.name.as_str())
                    .collect::<Vec<_>>()
            };
            let found = numbers.iter().position(|one| one.name == name);
            found.ok_or_else(|| TuningError::UnknownParameter {
                name: name.into(),
                known: known().join(", "),
            })
        };
        let tuned = space.parameters().iter().map(|one| place(&one.name));
        let tuned: Vec<usize> = tuned.collect::<Result<_, _>>()?;
        let mut quantities = Vec::new();
        for quantity in ComparedQuantity::ALL {
            if targets.iter().any(|target| target.of(quantity).is_some()) {
                quantities.push(quantity);
            }
        }
        Ok(Self {
            values: numbers.iter().map(|one| one.value).collect(),
            prepared: targets.iter().map(|one| model.prepare(&one.run)).collect(),
            objectives: quantities.iter().map(|one| one.name().to_owned()).collect(),
            space,
            quantities,
            form,
            targets,
            tuned,
            guesses: Vec::new(),
        })
    }

    /// The curves.
    pub fn targets(&self) -> &[TargetCurve] {
        &self.targets
    }

    /// What is compared, objective by objective.
    pub fn quantities(&self) -> &[ComparedQuantity] {
        &self.quantities
    }

    /// Values of all numbers of the model at places of the tuned ones.
    fn numbers(&self, places: &[f64]) -> Vec<f64> {
        let mut values = self.values.clone();
        for (&number, value) in self.tuned.iter().zip(self.space.values(places)) {
            values[number] = value;
        }
        values
    }

    /// The model's response of each curve.
    pub fn responses(&self, places: &[f64]) -> Result<Vec<SampleResponse>, TuningError> {
        let values = self.numbers(places);
        let all = self.prepared.iter().map(|prepared| {
            let mut out = SampleResponse::default();
            prepared.respond(&values, &mut out).map(|()| out)
        });
        all.collect()
    }

    /// Adds guesses: places at which a law of one reaction is half done when the measured curves are, for energies all over
    /// the bounds. `factor` and `energy` are the names of the reaction's numbers; where neither is tuned, nothing is added.
    /// Other parameters stand in the middle.
    pub fn guess_by(&mut self, law: &dyn KineticLaw, model: &dyn SampleModel, names: [&str; 2]) {
        let numbers = model.parameters();
        let Some(energy) = numbers.iter().position(|one| one.name == names[1]) else {
            return;
        };
        let tuned = |name: &str| {
            self.space
                .parameters()
                .iter()
                .position(|one| one.name == name)
        };
        let (factor, tuned_energy) = (tuned(names[0]), tuned(names[1]));
        let halves: Vec<RateQuadrature> = self.targets.iter().filter_map(half_way).collect();
        let Some(factor) = factor.filter(|_| !halves.is_empty()) else {
            return;
        };
        let x = law.reduced_time(0.5);
        let mut out = Vec::new();
        let count = if tuned_energy.is_some() { GUESSES } else { 1 };
        for k in 0..count {
            let mut places = vec![0.5; self.space.len()];
            let mut joule = numbers[energy].value;
            if let Some(energy) = tuned_energy {
                places[energy] = (k as f64 + 0.5) / count as f64;
                joule = self.space.value(energy, places[energy]);
            }
            let logarithms = halves.iter().map(|half| {
                half.integrate(joule / GAS_CONSTANT, &mut out);
                (x / out[0]).ln()
            });
            let mean = logarithms.sum::<f64>() / halves.len() as f64;
            places[factor] = self.space.place(factor, mean.exp());
            self.guesses.push(places);
        }
    }
}

/// Energies that are guessed.
const GUESSES: usize = 16;

/// The programme of a curve up to the time at which it is half done.
fn half_way(target: &TargetCurve) -> Option<RateQuadrature> {
    let conversion = target.conversion()?;
    let half = conversion.iter().position(|&x| x >= 0.5)?;
    let time = target.run.times[half];
    Some(RateQuadrature::new(&target.run.programme, &[time]))
}

impl TuningProblem for SampleProblem {
    fn space(&self) -> &ParameterSpace {
        &self.space
    }

    fn objectives(&self) -> &[String] {
        &self.objectives
    }

    fn differences(&self, places: &[f64], out: &mut Vec<Vec<f64>>) -> Result<(), TuningError> {
        let values = self.numbers(places);
        out.resize(self.quantities.len(), Vec::new());
        out.iter_mut().for_each(Vec::clear);
        let mut response = SampleResponse::default();
        for (target, prepared) in self.targets.iter().zip(&self.prepared) {
            prepared.respond(&values, &mut response)?;
            for (quantity, list) in self.quantities.iter().zip(out.iter_mut()) {
                let Some(measured) = target.of(*quantity) else {
                    continue;
                };
                for (k, (x, model)) in measured.iter().zip(quantity.of(&response)).enumerate() {
                    if target.counts(k) {
                        list.push(match self.form {
                            DifferenceForm::Absolute => model - x,
                            DifferenceForm::Relative => (model - x) / x,
                        });
                    }
                }
            }
        }
        Ok(())
    }

    fn guesses(&self) -> Vec<Vec<f64>> {
        self.guesses.clone()
    }
}
