//! Curves that models are compared with.

use crate::TuningError;
use crate::model::{HeatingRun, PreparedSample, SampleModel, SampleReaction, SampleResponse};
use crate::problem::{TuningProblem, sum_of_squares};
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

    /// Share of the mass that is lost at each time: by the mass, else by the integral of the rate.
    fn lost(&self) -> Option<Vec<f64>> {
        if let Some(mass) = self.of(ComparedQuantity::Mass) {
            return Some(mass.iter().map(|m| 1.0 - m).collect());
        }
        let rate = self.of(ComparedQuantity::LossRate)?;
        let times = self.run.times.windows(2).map(|t| t[1] - t[0]);
        let steps = times.zip(rate.windows(2).map(|r| 0.5 * (r[0] + r[1])));
        let mut lost = vec![0.0];
        let mut sum = 0.0;
        lost.extend(steps.map(|(time, rate)| {
            sum += time * rate;
            sum
        }));
        Some(lost)
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

    /// Adds guesses: places at which each reaction is half done when the curves have lost the half of its share, for energies all
    /// over the bounds and reactions in any order. Other parameters stand in the middle. A rate does not tell where to look for
    /// the reaction, as it is zero on both sides of its peak: curves of rates alone are integrated (docs/theory.md, TUN-14).
    pub fn guess_by(&mut self, reactions: &[SampleReaction]) {
        let mut found: Vec<Vec<f64>> = Vec::new();
        let middle = vec![0.5; self.space.len()];
        let share = |one: &SampleReaction| {
            let of = |own, value| self.value_at(&middle, one, own, value);
            of("reactant", one.reactant) * of("mass_loss", one.mass_loss)
        };
        let all: f64 = reactions.iter().map(share).sum();
        let lost: Vec<Option<Vec<f64>>> = self.targets.iter().map(TargetCurve::lost).collect();
        let ends = lost.iter().flatten().filter_map(|lost| lost.last());
        let largest = ends.copied().fold(0.0, f64::max);
        let whole = WholeLoss::of(&self.targets).map_or(largest, |one| one.loss);
        for order in orders(reactions.len()) {
            let mut before = 0.0;
            let halves: Vec<(&SampleReaction, Vec<RateQuadrature>)> = order
                .into_iter()
                .map(|k| {
                    let own = share(&reactions[k]) / all;
                    let half = (before + 0.5 * own) * whole;
                    before += own;
                    let curves = self.targets.iter().zip(&lost);
                    let passed = curves.filter_map(|(one, lost)| up_to(one, lost.as_ref()?, half));
                    (&reactions[k], passed.collect())
                })
                .collect();
            for k in 0..GUESSES {
                let places = self.guess(&halves, (f64::from(k) + 0.5) / f64::from(GUESSES));
                found.extend(places.filter(|places| !found.contains(places)));
            }
        }
        self.guesses.append(&mut found);
    }

    /// The guess with all energies at a place; none where no curve shows any of the reactions whose factor is tuned.
    fn guess(
        &self,
        halves: &[(&SampleReaction, Vec<RateQuadrature>)],
        energy: f64,
    ) -> Option<Vec<f64>> {
        let mut places = vec![0.5; self.space.len()];
        let mut out = Vec::new();
        let mut any = false;
        for (reaction, passed) in halves {
            if let Some(k) = self.tuned_number(reaction, "activation_energy") {
                places[k] = energy;
            }
            let factor = self.tuned_number(reaction, "pre_exponential");
            let Some(factor) = factor.filter(|_| !passed.is_empty()) else {
                continue;
            };
            any = true;
            let of = |own: &str, value| self.value_at(&places, reaction, own, value);
            let own = reaction.law.parameters.iter().zip(&reaction.law_numbers);
            let own: Vec<f64> = own.map(|(one, &value)| of(one.name, value)).collect();
            let x = (reaction.law.make)(&own.into()).reduced_time(0.5);
            let theta = of("activation_energy", reaction.activation_energy) / GAS_CONSTANT;
            let logarithms = passed.iter().map(|one| {
                one.integrate(theta, &mut out);
                (x / out[0]).ln()
            });
            let mean = logarithms.sum::<f64>() / passed.len() as f64;
            places[factor] = self.space.place(factor, mean.exp());
        }
        any.then_some(places)
    }

    /// Place of a reaction's number among those that are tuned.
    fn tuned_number(&self, reaction: &SampleReaction, own: &str) -> Option<usize> {
        let name = reaction.number_name(own);
        let mut tuned = self.space.parameters().iter();
        tuned.position(|one| one.name == name)
    }

    /// Value of a reaction's number: at its place where it is tuned, else the one it has.
    fn value_at(&self, places: &[f64], reaction: &SampleReaction, own: &str, value: f64) -> f64 {
        self.tuned_number(reaction, own)
            .map_or(value, |k| self.space.value(k, places[k]))
    }

    /// The least part, among masses and rates, that a model leaves of what a sample that does not react leaves: the sum of
    /// squares over that about a constant mass, or a rate of zero. Near one and above, the model is no better than no reaction.
    pub fn left_of_no_reaction(&self, places: &[f64]) -> Result<f64, TuningError> {
        let mut out = Vec::new();
        self.differences(places, &mut out)?;
        let parts = self.quantities.iter().zip(&out);
        let parts = parts.filter(|(quantity, _)| **quantity != ComparedQuantity::Temperature);
        let parts = parts.map(|(quantity, list)| {
            let none = self.without_reaction(*quantity);
            sum_of_squares(list) / none.max(f64::MIN_POSITIVE)
        });
        Ok(parts.fold(f64::INFINITY, f64::min))
    }

    /// Sum of squares about a constant mass, the nearest one of each curve, or a rate of zero.
    fn without_reaction(&self, quantity: ComparedQuantity) -> f64 {
        let of_curve = |target: &TargetCurve| {
            let measured = target.of(quantity)?.iter().enumerate();
            let counted = measured.filter(|(k, _)| target.counts(*k));
            let pairs: Vec<(f64, f64)> = counted.map(|(_, &x)| self.pair(1.0, x, 0.0)).collect();
            let dot: f64 = pairs.iter().map(|(model, x)| model * x).sum();
            let size: f64 = pairs.iter().map(|(model, _)| model * model).sum();
            let constant = match quantity {
                ComparedQuantity::LossRate => 0.0,
                ComparedQuantity::Temperature | ComparedQuantity::Mass => dot / size,
            };
            let differences = pairs
                .iter()
                .map(|(model, x)| (constant * model - x).powi(2));
            Some(differences.sum::<f64>())
        };
        self.targets.iter().filter_map(of_curve).sum()
    }
}

/// Energies that are guessed.
const GUESSES: u32 = 16;
/// Reactions that are guessed in any order: more have too many orders.
const MOST_ORDERED: usize = 3;

/// The orders in which so many reactions are guessed to follow each other.
fn orders(count: usize) -> Vec<Vec<usize>> {
    if count > MOST_ORDERED {
        return vec![(0..count).collect()];
    }
    let mut all = vec![Vec::new()];
    for _ in 0..count {
        let longer = all.iter().flat_map(|order: &Vec<usize>| {
            let next = (0..count).filter(|k| !order.contains(k));
            next.map(|k| order.iter().copied().chain([k]).collect())
        });
        all = longer.collect();
    }
    all
}

/// The programme of a curve up to the time at which this share of the mass is lost.
fn up_to(target: &TargetCurve, lost: &[f64], share: f64) -> Option<RateQuadrature> {
    let passed = lost.iter().position(|&one| one >= share)?;
    let time = target.run.times[passed];
    // Before the second time nothing has been integrated.
    (passed > 0).then(|| RateQuadrature::new(&target.run.programme, &[time]))
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
