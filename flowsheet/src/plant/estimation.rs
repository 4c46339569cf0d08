//! Differences from measured distributions.

use super::flows::FlowWorkspace;
use super::run::{Integrator, PlantRun};
use super::sensitivity::{Derivatives, PlantFamily};
use super::topology::Plant;
use crate::measured_place::MeasuredPlace;
use crate::{PlantError, SizeGrid};

/// Differences between what a plant does and what was measured, as functions of parameters: what an estimation needs.
pub trait PlantResiduals {
    /// Number of parameters.
    fn parameters(&self) -> usize;

    /// Differences, each divided by the standard deviation of its measurement.
    fn residuals(&self, at: &[f64]) -> Result<Vec<f64>, PlantError>;

    /// The same with their derivatives.
    fn jacobian(&self, at: &[f64]) -> Result<Derivatives, PlantError>;
}

/// A sieve analysis: shares of the mass between sieves.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredDistribution {
    /// Where.
    pub place: MeasuredPlace,
    /// When, in s.
    pub time: f64,
    /// Apertures of the sieves in m, rising.
    pub edges: Vec<f64>,
    /// Share of the mass between each aperture and the next.
    pub shares: Vec<f64>,
    /// Standard deviation of a share.
    pub deviation: f64,
}

impl MeasuredDistribution {
    /// Looks at the numbers.
    pub fn check(&self) -> Result<(), PlantError> {
        let refuse = |quantity, value, allowed| {
            let name = match &self.place {
                MeasuredPlace::Stream(name) | MeasuredPlace::Unit(name) => name,
            };
            Err(PlantError::Value {
                place: format!("distribution measured of \"{name}\" at {} s", self.time),
                quantity,
                value,
                allowed,
            })
        };
        if self.edges.len() != self.shares.len() + 1 {
            let value = self.shares.len() as f64;
            return refuse("number of shares", value, "one less than sieves");
        }
        let rises = |pair: &[f64]| pair[0].is_finite() && pair[1] > pair[0] && pair[1].is_finite();
        if let Some(pair) = self.edges.windows(2).find(|pair| !rises(pair)) {
            return refuse("aperture in m", pair[1], "apertures are finite and rise");
        }
        if let Some(share) = self.shares.iter().find(|s| !(0.0..=1.0).contains(*s)) {
            return refuse("share", *share, "it is 0 to 1");
        }
        if !(self.deviation.is_finite() && self.deviation > 0.0) {
            return refuse("standard deviation", self.deviation, "it is above zero");
        }
        Ok(())
    }

    /// Shares of masses by size class between the apertures: what the sieves would show.
    pub fn shares_of(&self, grid: &SizeGrid, masses: &[f64]) -> Vec<f64> {
        let all: f64 = masses.iter().sum();
        let below = |d: f64| -> f64 {
            let edges = grid.edges().windows(2);
            let inside = edges.zip(masses).map(|(edge, mass)| {
                let part = (d - edge[0]) / (edge[1] - edge[0]);
                mass * part.clamp(0.0, 1.0)
            });
            inside.sum::<f64>() / all
        };
        let pairs = self.edges.windows(2);
        pairs.map(|edge| below(edge[1]) - below(edge[0])).collect()
    }

    /// Differences of masses by size class from what was measured.
    fn differences(&self, grid: &SizeGrid, masses: &[f64], to: &mut Vec<f64>) {
        let found = self.shares_of(grid, masses).into_iter();
        let pairs = found.zip(&self.shares);
        to.extend(pairs.map(|(found, share)| (found - share) / self.deviation));
    }

    fn find(&self, plant: &Plant) -> Result<usize, PlantError> {
        let unknown = |name: &str, known: Vec<&str>| {
            PlantError::UnknownUnit(name.to_owned(), known.join(", "))
        };
        match &self.place {
            MeasuredPlace::Stream(name) => plant
                .stream(name)
                .ok_or_else(|| unknown(name, plant.streams().iter().map(String::as_str).collect())),
            MeasuredPlace::Unit(name) => plant.unit(name).ok_or_else(|| {
                unknown(
                    name,
                    plant
                        .units()
                        .iter()
                        .map(|unit| unit.name.as_str())
                        .collect(),
                )
            }),
        }
    }

    fn of(&self, plant: &Plant, y: &[f64], flows: &FlowWorkspace, to: &mut Vec<f64>) {
        let Ok(index) = self.find(plant) else { return };
        let layout = plant.layout();
        let masses = match &self.place {
            MeasuredPlace::Stream(_) => layout.by_size(flows.stream(plant, index)),
            MeasuredPlace::Unit(_) => layout.by_size(&y[plant.units()[index].state.clone()]),
        };
        self.differences(layout.grid(), &masses, to);
    }
}

/// When the plant is compared with what was measured.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasuredState {
    /// At rest, from a guess of the unknowns.
    Steady(Vec<f64>),
    /// At the times of the measurements.
    Run {
        /// Integrator.
        integrator: Integrator,
        /// Its tolerance.
        tolerance: f64,
    },
}

/// Measured distributions and the plants that they are compared with.
pub struct PlantEstimation<F> {
    family: PlantFamily<F>,
    measured: Vec<MeasuredDistribution>,
    state: MeasuredState,
    times: Vec<f64>,
}

impl<F: Fn(&[f64]) -> Result<Plant, PlantError>> PlantEstimation<F> {
    /// Compares plants with distributions.
    pub fn new(
        family: PlantFamily<F>,
        mut measured: Vec<MeasuredDistribution>,
        state: MeasuredState,
    ) -> Result<Self, PlantError> {
        measured.iter().try_for_each(MeasuredDistribution::check)?;
        measured.sort_by(|a, b| a.time.total_cmp(&b.time));
        let mut times: Vec<f64> = measured.iter().map(|one| one.time).collect();
        times.dedup();
        Ok(Self {
            family,
            measured,
            state,
            times,
        })
    }

    fn look(&self, at: &[f64], family: &PlantFamily<&F>) -> Result<Derivatives, PlantError> {
        let plant = self.family.plant(at)?;
        self.measured
            .iter()
            .try_for_each(|one| one.find(&plant).map(|_| ()))?;
        match &self.state {
            MeasuredState::Steady(guess) => {
                let time = self.times.first().copied().unwrap_or(0.0);
                family.observe_steady(at, guess, time, |plant, y, flows| {
                    let mut found = Vec::new();
                    self.measured
                        .iter()
                        .for_each(|one| one.of(plant, y, flows, &mut found));
                    found
                })
            }
            MeasuredState::Run {
                integrator,
                tolerance,
            } => {
                let observe = |index: usize, run: &PlantRun<'_>| {
                    let mut found = Vec::new();
                    let now = self
                        .measured
                        .iter()
                        .filter(|one| one.time == self.times[index]);
                    now.for_each(|one| one.of(run.plant, &run.now.y, &run.now.work, &mut found));
                    found
                };
                family.observe_run(at, *integrator, *tolerance, &self.times, observe)
            }
        }
    }
}

impl<F: Fn(&[f64]) -> Result<Plant, PlantError>> PlantResiduals for PlantEstimation<F> {
    fn parameters(&self) -> usize {
        self.family.parameters()
    }

    fn residuals(&self, at: &[f64]) -> Result<Vec<f64>, PlantError> {
        let still = self.family.with_steps(Vec::new());
        Ok(self.look(at, &still)?.values)
    }

    fn jacobian(&self, at: &[f64]) -> Result<Derivatives, PlantError> {
        self.look(at, &self.family.with_steps(self.family.steps().to_vec()))
    }
}
