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
    /// First values whose mean the masses are relative to, where the mass at the start is not stated. That mean has an error,
    /// and with it the scale of the whole curve: it is fitted (docs/theory.md, TUN-13).
    pub start_values: Option<usize>,
}

impl TargetCurve {
    /// Values of a quantity.
    pub fn of(&self, quantity: ComparedQuantity) -> Option<&[f64]> {
        let found = self.values.iter().find(|(one, _)| *one == quantity)?;
        Some(&found.1)
    }

    /// Conversion at each time: what is lost since the start as a share of the loss at a conversion of one.
    pub fn conversion(&self, loss: f64) -> Option<Vec<f64>> {
        let mass = self.of(ComparedQuantity::Mass)?;
        Some(mass.iter().map(|m| (1.0 - m) / loss).collect())
    }

    /// Share of the mass that is lost at the end. The noise of a few values averages out.
    pub fn end_loss(&self) -> Option<f64> {
        let mass = self.of(ComparedQuantity::Mass)?;
        let few = (mass.len() / 50).max(1);
        let last = mass.get(mass.len() - few..)?;
        Some(1.0 - last.iter().sum::<f64>() / few as f64)
    }

    /// Counts only times at which the conversion, of the loss at a conversion of one, lies between two values: from the first
    /// time above the lower one to the first above the upper one.
    pub fn count_within(&mut self, low: f64, high: f64, loss: f64) {
        if let Some(conversion) = self.conversion(loss) {
            let first = |limit: f64| conversion.iter().position(|&x| x > limit);
            let from = first(low).unwrap_or(conversion.len());
            let to = first(high).unwrap_or(conversion.len());
            self.counted = (0..conversion.len()).map(|k| k >= from && k < to).collect();
        }
    }

    /// True where the scale of the masses is fitted.
    fn has_scale(&self) -> bool {
        self.start_values.is_some() && self.of(ComparedQuantity::Mass).is_some()
    }

    /// Weight of the mean of the first values: the root of the number of those that do not count themselves.
    fn start_weight(&self) -> f64 {
        let first = 0..self.start_values.unwrap_or(0);
        (first.filter(|&k| !self.counts(k)).count() as f64).sqrt()
    }

    fn counts(&self, k: usize) -> bool {
        self.counted.get(k).copied().unwrap_or(true)
    }
}

/// The loss of curves at a conversion of one, where nobody states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeLoss {
    /// Share of the mass.
    pub loss: f64,
    /// True where the curves end at unlike masses: some have not run to completion, or the samples differ.
    pub unlike: bool,
}

impl WholeLoss {
    /// The mean of what the curves lose where they agree, else the largest; `None` without a mass.
    pub fn of(targets: &[TargetCurve]) -> Option<Self> {
        let losses: Vec<f64> = targets.iter().filter_map(TargetCurve::end_loss).collect();
        let largest = losses.iter().copied().reduce(f64::max)?;
        let unlike = losses.iter().any(|loss| *loss < (1.0 - UNLIKE) * largest);
        let loss = match unlike {
            true => largest,
            false => losses.iter().sum::<f64>() / losses.len() as f64,
        };
        Some(Self { loss, unlike })
    }
}

/// Losses that differ by more than this share are unlike.
const UNLIKE: f64 = 0.05;

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
        let all = self.targets.iter().zip(&self.prepared);
        let all = all.map(|(target, prepared)| {
            let mut out = SampleResponse::default();
            prepared.respond(&values, &mut out)?;
            let scale = self.scale(target, &out, &[]);
            let lists = [&mut out.mass, &mut out.loss_rate];
            lists.into_iter().flatten().for_each(|one| *one *= scale);
            Ok(out)
        });
        all.collect()
    }

    /// A model's value and a measured one, lower by a shift, in the form that is counted: their difference is one of these.
    fn pair(&self, model: f64, measured: f64, shift: f64) -> (f64, f64) {
        match self.form {
            DifferenceForm::Absolute => (model, measured - shift),
            DifferenceForm::Relative => (model / measured, 1.0 - shift),
        }
    }

    /// The scale by which a model's masses are nearest to the measured ones, in the sense of least squares; `shifts` begin with
    /// those of the curve, and are none where empty.
    fn scale(&self, target: &TargetCurve, response: &SampleResponse, shifts: &[f64]) -> f64 {
        let measured = target.of(ComparedQuantity::Mass);
        let (Some(measured), true) = (measured, target.has_scale()) else {
            return 1.0;
        };
        let mut shifts = shifts.iter().copied().chain(std::iter::repeat(0.0));
        let (mut above, mut below) = (0.0, 0.0);
        let mut add = |(model, measured): (f64, f64)| {
            above += model * measured;
            below += model * model;
        };
        for (k, (&x, &model)) in measured.iter().zip(&response.mass).enumerate() {
            if target.counts(k) {
                add(self.pair(model, x, shifts.next().unwrap_or(0.0)));
            }
        }
        let weight = target.start_weight();
        if weight > 0.0 {
            add((weight, weight - shifts.next().unwrap_or(0.0)));
        }
        if below > 0.0 { above / below } else { 1.0 }
    }

    /// Differences from measured values that are lower by shifts, of which there are none where empty.
    fn compare(
        &self,
        places: &[f64],
        shifts: &[Vec<f64>],
        out: &mut Vec<Vec<f64>>,
    ) -> Result<(), TuningError> {
        let values = self.numbers(places);
        out.resize(self.quantities.len(), Vec::new());
        out.iter_mut().for_each(Vec::clear);
        let mut response = SampleResponse::default();
        let of_mass = self
            .quantities
            .iter()
            .position(|one| *one == ComparedQuantity::Mass);
        for (target, prepared) in self.targets.iter().zip(&self.prepared) {
            prepared.respond(&values, &mut response)?;
            let own = of_mass.and_then(|k| shifts.get(k)?.get(out[k].len()..));
            let scale = self.scale(target, &response, own.unwrap_or(&[]));
            for (q, quantity) in self.quantities.iter().enumerate() {
                let Some(measured) = target.of(*quantity) else {
                    continue;
                };
                let scale = match quantity {
                    ComparedQuantity::Temperature => 1.0,
                    ComparedQuantity::Mass | ComparedQuantity::LossRate => scale,
                };
                let list = &mut out[q];
                let shift = |k: usize| shifts.get(q).map_or(0.0, |list| list[k]);
                for (k, (&x, &model)) in measured.iter().zip(quantity.of(&response)).enumerate() {
                    if target.counts(k) {
                        let (model, x) = self.pair(scale * model, x, shift(list.len()));
                        list.push(model - x);
                    }
                }
                let weight = target.start_weight();
                if *quantity == ComparedQuantity::Mass && target.has_scale() && weight > 0.0 {
                    list.push(weight * (scale - 1.0) + shift(list.len()));
                }
            }
        }
        Ok(())
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
        let whole = WholeLoss::of(&self.targets).map_or(f64::NAN, |one| one.loss);
        let halves = self.targets.iter().filter_map(|one| half_way(one, whole));
        let halves: Vec<RateQuadrature> = halves.collect();
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
fn half_way(target: &TargetCurve, loss: f64) -> Option<RateQuadrature> {
    let conversion = target.conversion(loss)?;
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
        self.compare(places, &[], out)
    }

    fn shifted(
        &self,
        places: &[f64],
        shifts: &[Vec<f64>],
        out: &mut Vec<Vec<f64>>,
    ) -> Result<(), TuningError> {
        self.compare(places, shifts, out)
    }

    fn scales(&self) -> usize {
        self.targets.iter().filter(|one| one.has_scale()).count()
    }

    fn guesses(&self) -> Vec<Vec<f64>> {
        self.guesses.clone()
    }
}
