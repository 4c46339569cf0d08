//! A parcel of gas that reacts at constant pressure.

use calcine_numerics::rosenbrock::{IntegrationAccuracy, SystemDerivatives};
use calcine_numerics::{DenseMatrix, Dual, Number, Rosenbrock, RosenbrockTableau, StiffSystem};

use super::elements::Elements;
use super::error::KineticsError;
use super::mechanism::{Mechanism, MixtureState};
use crate::gas::GAS_CONSTANT;
use crate::thermo::mixture::MOST_SPECIES;

/// How exactly a reactor integrates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Error of a step relative to each mass fraction and the temperature.
    pub relative: f64,
    /// Error of a step in a mass fraction that counts as none.
    pub fraction: f64,
    /// Error of a step in the temperature that counts as none, in K.
    pub temperature: f64,
    /// Change of a mass fraction over the time, at the rates of the start, below which nothing is integrated and
    /// nothing changes.
    pub negligible: f64,
    /// Most steps.
    pub steps: usize,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            relative: 1e-6,
            fraction: 1e-10,
            temperature: 1e-3,
            negligible: 1e-12,
            steps: 100_000,
        }
    }
}

/// What an integration did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReactorStatistics {
    /// Steps it took; zero where nothing reacts.
    pub steps: usize,
}

/// A parcel of gas at constant pressure, adiabatic or of fixed temperature:
///
/// dY_i/dt = w_i/ρ;  dT/dt = −Σ h_i w_i/(ρ c_p), or 0,
///
/// by the stiffly accurate Rosenbrock method of fourth order ([`RosenbrockTableau::RODAS4`]) with the exact Jacobian. At the end negative
/// fractions are set to zero and the elements kept ([`Elements::restore`]), and the adiabatic temperature follows from the
/// mixture's enthalpy with that of formation, which is kept exactly.
#[derive(Clone, Debug)]
pub struct Reactor {
    pub(super) mechanism: Mechanism,
    pub(super) tolerances: Tolerances,
    pub(super) elements: Elements,
}

/// Memory of integrations, reused; no result depends on what it was used for before.
#[derive(Clone, Debug)]
pub struct ReactorWorkspace {
    pub(super) method: Rosenbrock<DenseMatrix>,
    pub(super) unknowns: Vec<f64>,
    pub(super) tolerance: Vec<f64>,
}

impl Default for ReactorWorkspace {
    fn default() -> Self {
        Self {
            method: Rosenbrock::new(&RosenbrockTableau::RODAS4, DenseMatrix::default()),
            unknowns: Vec::new(),
            tolerance: Vec::new(),
        }
    }
}

impl Reactor {
    /// A reactor of this mechanism.
    pub fn new(mechanism: &Mechanism, tolerances: Tolerances) -> Self {
        Self {
            elements: Elements::new(mechanism.mixture()),
            mechanism: mechanism.clone(),
            tolerances,
        }
    }

    /// Its mechanism.
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// Lets an adiabatic parcel react over a time in s at a pressure in Pa: mass fractions and temperature in K
    /// become those at its end. In error they stay.
    pub fn advance(
        &self,
        pressure: f64,
        temperature: &mut f64,
        fractions: &mut [f64],
        time: f64,
    ) -> Result<ReactorStatistics, KineticsError> {
        let mut workspace = ReactorWorkspace::default();
        self.advance_in(&mut workspace, pressure, temperature, fractions, time)
    }

    /// The same with memory that is reused.
    pub fn advance_in(
        &self,
        workspace: &mut ReactorWorkspace,
        pressure: f64,
        temperature: &mut f64,
        fractions: &mut [f64],
        time: f64,
    ) -> Result<ReactorStatistics, KineticsError> {
        self.run(workspace, (pressure, time), temperature, fractions, true)
    }

    /// The same at a fixed temperature in K: what heat is set free is taken away.
    pub fn advance_isothermal(
        &self,
        pressure: f64,
        temperature: f64,
        fractions: &mut [f64],
        time: f64,
    ) -> Result<ReactorStatistics, KineticsError> {
        let (mut workspace, mut fixed) = (ReactorWorkspace::default(), temperature);
        let (workspace, fixed) = (&mut workspace, &mut fixed);
        self.run(workspace, (pressure, time), fixed, fractions, false)
    }

    fn run(
        &self,
        workspace: &mut ReactorWorkspace,
        (pressure, time): (f64, f64),
        temperature: &mut f64,
        fractions: &mut [f64],
        adiabatic: bool,
    ) -> Result<ReactorStatistics, KineticsError> {
        self.sound(pressure, *temperature, fractions, time)?;
        let mixture = self.mechanism.mixture();
        let state = MixtureState {
            pressure,
            temperature: *temperature,
            fractions,
        };
        let mut rates = [0.0; MOST_SPECIES];
        let rates = &mut rates[..fractions.len()];
        self.mechanism.rates(state, rates);
        let density = mixture.density(pressure, *temperature, fractions);
        let fastest = rates.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        if fastest * time <= self.tolerances.negligible * density {
            return Ok(ReactorStatistics { steps: 0 });
        }
        let masses = self.elements.of(fractions);
        let enthalpy = |t: f64, y: &[f64]| mixture.enthalpy(t, y) + mixture.formation_enthalpy(y);
        let kept = enthalpy(*temperature, fractions);
        let state = (pressure, *temperature);
        let steps = self.integrate(workspace, state, fractions, time, adiabatic)?;
        let (reached, count) = (&mut workspace.unknowns, fractions.len());
        self.elements.restore(&masses, &mut reached[..count]);
        if adiabatic {
            let new = &reached[..count];
            let sensible = kept - mixture.formation_enthalpy(new);
            let found = mixture.temperature(sensible, new, reached[count]);
            *temperature = found.map_err(|error| KineticsError::Integration {
                state: self.words(pressure, *temperature, fractions),
                reached: time,
                time,
                why: error.to_string(),
            })?;
        }
        fractions.copy_from_slice(&reached[..count]);
        Ok(ReactorStatistics { steps })
    }

    /// Leaves mass fractions and temperature after the time in the workspace; the result is how many steps it took.
    fn integrate(
        &self,
        workspace: &mut ReactorWorkspace,
        (pressure, temperature): (f64, f64),
        fractions: &[f64],
        time: f64,
        adiabatic: bool,
    ) -> Result<usize, KineticsError> {
        let ReactorWorkspace {
            method,
            unknowns,
            tolerance,
        } = workspace;
        let count = fractions.len();
        unknowns.clear();
        unknowns.extend_from_slice(fractions);
        unknowns.push(temperature);
        tolerance.clear();
        tolerance.resize(count, self.tolerances.fraction);
        tolerance.push(self.tolerances.temperature);
        method.algebra().resize(count + 1);
        let mut law = ParcelEquations {
            mechanism: &self.mechanism,
            pressure,
            adiabatic,
        };
        let accuracy = IntegrationAccuracy {
            relative: self.tolerances.relative,
            absolute: tolerance,
            steps: self.tolerances.steps,
        };
        let done = method.integrate(&mut law, unknowns, time, accuracy);
        done.map(|done| done.steps).map_err(|stalled| {
            let names = self.mechanism.mixture().names();
            let worst = names
                .get(stalled.worst)
                .map_or("temperature", String::as_str);
            KineticsError::Integration {
                state: self.words(pressure, temperature, fractions),
                reached: stalled.reached,
                time,
                why: format!("{}; the largest error is that of {worst}", stalled.cause),
            }
        })
    }

    /// Refuses a state in which nothing can be said.
    pub(super) fn sound(
        &self,
        pressure: f64,
        temperature: f64,
        fractions: &[f64],
        time: f64,
    ) -> Result<(), KineticsError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let right = positive(pressure)
            && positive(temperature)
            && time >= 0.0
            && time.is_finite()
            && fractions.len() == self.mechanism.species()
            && fractions.iter().all(|y| y.is_finite())
            && fractions.iter().any(|y| *y > 0.0);
        if right {
            return Ok(());
        }
        let state = self.words(pressure, temperature, fractions);
        let state = format!("{state} over {time} s");
        Err(KineticsError::State { state })
    }

    pub(super) fn words(&self, pressure: f64, temperature: f64, fractions: &[f64]) -> String {
        let names = self.mechanism.mixture().names().iter();
        let parts: Vec<String> = names
            .zip(fractions)
            .filter(|(_, y)| **y != 0.0)
            .map(|(name, y)| format!("{name} {y:.4e}"))
            .collect();
        format!(
            "{temperature:.2} K, {pressure:.6e} Pa, mass fractions {}",
            parts.join(", ")
        )
    }
}

/// The equations of a parcel; the unknowns are the mass fractions and the temperature.
struct ParcelEquations<'a> {
    mechanism: &'a Mechanism,
    pressure: f64,
    adiabatic: bool,
}

/// Columns of the Jacobian that one evaluation gives.
pub(super) const COLUMNS: usize = 8;

impl StiffSystem for ParcelEquations<'_> {
    fn unknowns(&self) -> usize {
        self.mechanism.species() + 1
    }

    fn rates(&mut self, x: &[f64], out: &mut [f64]) {
        self.evaluate(|k| x[k], out);
    }

    fn differentiate(&mut self, x: &[f64], out: &mut [f64], derivatives: &mut SystemDerivatives) {
        let n = x.len();
        let mut duals = [Dual::<COLUMNS>::constant(0.0); MOST_SPECIES + 1];
        for first in (0..n).step_by(COLUMNS) {
            let columns = first..(first + COLUMNS).min(n);
            let at = |k: usize| {
                if columns.contains(&k) {
                    Dual::along(x[k], k - first)
                } else {
                    Dual::constant(x[k])
                }
            };
            self.evaluate(at, &mut duals[..n]);
            for (row, dual) in duals[..n].iter().enumerate() {
                out[row] = dual.value;
                let slopes = &dual.slope[..columns.len()];
                derivatives.jacobian[row * n..][columns.clone()].copy_from_slice(slopes);
            }
        }
    }
}

impl ParcelEquations<'_> {
    /// Slopes of the unknowns in 1/s and K/s.
    fn evaluate<N: Number>(&self, at: impl Fn(usize) -> N, out: &mut [N]) {
        let species = self.mechanism.mixture().species();
        let count = species.len();
        let temperature = at(count);
        let t = temperature.value();
        // Amounts in mol/kg; they may be a little below zero.
        let mut amounts = [N::constant(0.0); MOST_SPECIES];
        let mut sum = N::constant(0.0);
        for (k, one) in species.iter().enumerate() {
            amounts[k] = at(k).times(1.0 / one.molar_mass());
            sum = sum + amounts[k];
        }
        let density = N::constant(self.pressure / GAS_CONSTANT) / (temperature * sum);
        for amount in &mut amounts[..count] {
            *amount = *amount * density;
        }
        let (rates, last) = out.split_at_mut(count);
        self.mechanism.mass_rates(temperature, &amounts, rates);
        let mut heating = N::constant(0.0);
        let mut capacity = N::constant(0.0);
        for (k, one) in species.iter().enumerate() {
            rates[k] = rates[k] / density;
            if self.adiabatic {
                let law = one.polynomial();
                let (h, c_p) = (law.enthalpy(t), law.heat_capacity(t));
                let slope = law.heat_capacity_slope(t);
                let per_mass = 1.0 / one.molar_mass();
                heating = heating - rates[k] * temperature.through(h, c_p).times(per_mass);
                capacity = capacity + at(k) * temperature.through(c_p, slope).times(per_mass);
            }
        }
        last[0] = if self.adiabatic {
            heating / capacity
        } else {
            N::constant(0.0)
        };
    }
}

#[cfg(test)]
mod tests;
