//! How steady states and runs depend on parameters.

use nalgebra::{DMatrix, DVector};

use super::flows::{FlowWorkspace, Moment};
use super::run::{Integrator, PlantRun};
use super::steady::SteadyState;
use super::topology::Plant;
use crate::PlantError;

/// Values, and one column of derivatives for each parameter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Derivatives {
    /// Values.
    pub values: Vec<f64>,
    /// ∂values/∂parameter, parameter by parameter.
    pub columns: Vec<Vec<f64>>,
}

/// Plants that differ by parameters, and how they depend on them (docs/theory.md, FLS-7).
pub struct PlantFamily<F> {
    make: F,
    steps: Vec<f64>,
}

impl<F: Fn(&[f64]) -> Result<Plant, PlantError>> PlantFamily<F> {
    /// Plants of parameters, with the change of each by which difference quotients are taken: small against what bends the
    /// plant's answer, large against round-off (1e-4 of the parameter serves).
    pub fn new(make: F, steps: Vec<f64>) -> Result<Self, PlantError> {
        match steps
            .iter()
            .find(|step| !(step.is_finite() && **step > 0.0))
        {
            Some(step) => Err(PlantError::Value {
                place: "parameters".into(),
                quantity: "step of a difference quotient",
                value: *step,
                allowed: "it is finite and above zero",
            }),
            None => Ok(Self { make, steps }),
        }
    }

    /// The same plants with other steps; without any nothing is differentiated.
    pub(super) fn with_steps(&self, steps: Vec<f64>) -> PlantFamily<&F> {
        PlantFamily {
            make: &self.make,
            steps,
        }
    }

    pub(super) fn steps(&self) -> &[f64] {
        &self.steps
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.steps.len()
    }

    /// The plant of some parameters.
    pub fn plant(&self, at: &[f64]) -> Result<Plant, PlantError> {
        (self.make)(at)
    }

    /// The plants on both sides of a parameter.
    fn sides(&self, at: &[f64], parameter: usize) -> Result<[Plant; 2], PlantError> {
        let moved = |sign: f64| {
            let mut place = at.to_vec();
            place[parameter] += sign * self.steps[parameter];
            (self.make)(&place)
        };
        Ok([moved(1.0)?, moved(-1.0)?])
    }

    /// The steady state next to a guess, and the derivatives of its unknowns by J s = −∂f/∂p. What never changes (a fixed
    /// hold-up) follows from what it is set to.
    pub fn steady(
        &self,
        at: &[f64],
        guess: &[f64],
        time: f64,
    ) -> Result<(SteadyState, Derivatives), PlantError> {
        let plant = (self.make)(at)?;
        let state = plant.steady(guess, time)?;
        let (n, y) = (plant.unknowns(), &state.unknowns);
        let moment = Moment {
            time,
            end: f64::INFINITY,
        };
        let scales = plant.scales();
        let mut work = state.flows.clone();
        let mut rates = vec![0.0; n + plant.totals()];
        plant.rates(moment, y, &mut work, &mut rates)?;
        let mut entries = Vec::new();
        plant.jacobian(moment, y, &rates, &scales, &mut work, &mut entries, true)?;
        let mut matrix = DMatrix::from_row_slice(n, n, &entries);
        // Rows of what is held as it is set, in place of the equations that say nothing of it.
        let weight = matrix
            .diagonal()
            .iter()
            .map(|d| d.abs())
            .fold(0.0, f64::max);
        let mut place = y.clone();
        for column in 0..n {
            let step = 1e-5 * (scales[column] + y[column].abs());
            let mut put_back = |by: f64| {
                place.copy_from_slice(y);
                place[column] += by;
                let before = place.clone();
                plant.constrain(&mut place);
                let moved = place.iter().zip(before);
                moved
                    .map(|(after, before)| after - before)
                    .collect::<Vec<f64>>()
            };
            let (above, below) = (put_back(step), put_back(-step));
            for (row, (above, below)) in above.iter().zip(below).enumerate() {
                matrix[(row, column)] += weight * (above - below) / (2.0 * step);
            }
        }
        let factors = matrix.lu();
        let mut columns = Vec::new();
        for parameter in 0..self.steps.len() {
            let mut right = DVector::zeros(n);
            for (plant, sign) in self.sides(at, parameter)?.iter().zip([1.0, -1.0]) {
                let mut work = state.flows.clone();
                let mut rates = vec![0.0; n + plant.totals()];
                plant.rates(moment, y, &mut work, &mut rates)?;
                let mut place = y.clone();
                plant.constrain(&mut place);
                for row in 0..n {
                    let own = rates[row] + weight * (place[row] - y[row]);
                    right[row] -= sign * own / (2.0 * self.steps[parameter]);
                }
            }
            let Some(column) = factors.solve(&right) else {
                return Err(PlantError::NoSteadyState {
                    residual: state.residual,
                    iterations: state.iterations,
                });
            };
            columns.push(column.iter().copied().collect());
        }
        let values = y.clone();
        Ok((state, Derivatives { values, columns }))
    }

    /// What is observed of a steady state, from its unknowns and streams, with derivatives.
    pub fn observe_steady(
        &self,
        at: &[f64],
        guess: &[f64],
        time: f64,
        observe: impl Fn(&Plant, &[f64], &FlowWorkspace) -> Vec<f64>,
    ) -> Result<Derivatives, PlantError> {
        let (state, of_unknowns) = self.steady(at, guess, time)?;
        let plant = (self.make)(at)?;
        let values = observe(&plant, &state.unknowns, &state.flows);
        let moment = Moment {
            time,
            end: f64::INFINITY,
        };
        let mut columns = Vec::new();
        for (parameter, slope) in of_unknowns.columns.iter().enumerate() {
            let step = self.steps[parameter];
            let mut seen = Vec::new();
            for (plant, sign) in self.sides(at, parameter)?.iter().zip([1.0, -1.0]) {
                let pairs = state.unknowns.iter().zip(slope);
                let y: Vec<f64> = pairs.map(|(y, s)| y + sign * step * s).collect();
                let mut work = state.flows.clone();
                plant.flows(moment, &y, &mut work)?;
                seen.push(observe(plant, &y, &work));
            }
            columns.push(quotient(&seen[0], &seen[1], step));
        }
        Ok(Derivatives { values, columns })
    }

    /// What is observed of a run at rising times in s, one after the other, with derivatives. Runs on both sides of a parameter
    /// take the steps of the run between them, so that their differences are not of the control of steps.
    ///
    /// Source: internal numerical differentiation, Bock, in Modelling of Chemical Reaction Systems (1981) 102,
    /// doi 10.1007/978-3-642-68220-9_8.
    pub fn observe_run(
        &self,
        at: &[f64],
        integrator: Integrator,
        tolerance: f64,
        times: &[f64],
        observe: impl Fn(usize, &PlantRun<'_>) -> Vec<f64>,
    ) -> Result<Derivatives, PlantError> {
        let plant = (self.make)(at)?;
        let mut run = PlantRun::new(&plant, integrator, tolerance)?;
        let (mut values, mut spans) = (Vec::new(), Vec::new());
        for (index, time) in times.iter().enumerate() {
            spans.push(run.advance_and_tell(*time)?);
            values.extend(observe(index, &run));
        }
        let mut columns = Vec::new();
        for parameter in 0..self.steps.len() {
            let mut seen = [Vec::new(), Vec::new()];
            for (plant, seen) in self.sides(at, parameter)?.iter().zip(&mut seen) {
                let mut run = PlantRun::new(plant, integrator, tolerance)?;
                for (index, (time, steps)) in times.iter().zip(&spans).enumerate() {
                    run.advance_by(*time, steps)?;
                    seen.extend(observe(index, &run));
                }
            }
            columns.push(quotient(&seen[0], &seen[1], self.steps[parameter]));
        }
        Ok(Derivatives { values, columns })
    }
}

fn quotient(above: &[f64], below: &[f64], step: f64) -> Vec<f64> {
    let pairs = above.iter().zip(below);
    pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect()
}
