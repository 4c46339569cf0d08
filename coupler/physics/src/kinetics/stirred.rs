//! A cell of gas that reacts while gas flows through it: a stirred reactor.

use calcine_numerics::rosenbrock::{IntegrationAccuracy, SystemDerivatives};
use calcine_numerics::{Dual, LinearAlgebra, Number, StiffSystem};

use super::error::KineticsError;
use super::mechanism::{Mechanism, MixtureState};
use super::reactor::{COLUMNS, Reactor, ReactorStatistics, ReactorWorkspace};
use crate::gas::GAS_CONSTANT;
use crate::thermo::mixture::MOST_SPECIES;

/// Mixtures between a cell's gas and the one that would be there without reactions, at which it is asked whether
/// anything reacts.
const SAMPLES: usize = 5;

/// What flows, diffuses and is conducted through a cell of gas, per kg of its gas at the start of a window and constant
/// over it. Without reactions
///
/// r dY_k/dt = e_k − l_k Y_k,   r dh/dt = e_h − l_h h,   r = 1 + θ (ρ/ρ_start − 1),
///
/// of the mass fractions Y and the sensible enthalpy h, r the gas of the cell over that at the start.
#[derive(Clone, Copy, Debug)]
pub struct Throughflow<'a> {
    /// e_k of each species in 1/s.
    pub entering: &'a [f64],
    /// l_k of each species in 1/s, not negative: one over its residence time.
    pub leaving: &'a [f64],
    /// e_h in W/kg.
    pub heat_entering: f64,
    /// l_h in 1/s, not negative.
    pub heat_leaving: f64,
    /// θ, the share of the cell's contraction that flow fills, and of its expansion that leaves, within the window: 0 in a closed
    /// cell, 1 where gas passes many times. The rest counts as at the window's end, as implicit Euler has it.
    pub opening: f64,
    /// Mixing time of the partially stirred reactor in s; zero where the cell is mixed.
    pub mixing: f64,
}

impl Reactor {
    /// What reactions make of each species over a window of `time` in a cell through which gas flows, the chemistry of
    /// balanced splitting (docs/theory.md, CHM-2). The cell's gas starts with `temperature` and `fractions` and follows
    ///
    /// dY_k/dt = κ w_k/ρ + (e_k − l_k Y_k)/r,   dh/dt = (e_h − l_h h)/r − Σ h°_k κ w_k/ρ,
    ///
    /// κ = t_c/(t_c + t_k) of [`super::pasr`] at each state. `made` becomes
    ///
    /// ζ_k = ∫ r κ w_k/ρ dt/(1 + l_k time),
    ///
    /// by which the fractions at the end of the window by implicit Euler, (Y_k + time e_k)/(1 + l_k time) + ζ_k, are larger
    /// than without reactions. These are means of the reactor's fractions at its end and of what left it: none is negative that was not so without reactions, and Σ (1 + l_k time) ζ_k is free of every element.
    pub fn flow_through(
        &self,
        workspace: &mut ReactorWorkspace,
        state: MixtureState<'_>,
        flow: &Throughflow<'_>,
        time: f64,
        made: &mut [f64],
    ) -> Result<ReactorStatistics, KineticsError> {
        let MixtureState {
            pressure,
            temperature,
            fractions,
        } = state;
        made.fill(0.0);
        self.sound(pressure, temperature, fractions, time)?;
        if flow.mixing.is_infinite() || !self.reacts(state, flow, time) {
            return Ok(ReactorStatistics { steps: 0 });
        }
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
        tolerance.resize(2 * count + 1, self.tolerances.fraction);
        method.algebra().resize(count + 1);
        let mut law = CellEquations {
            mechanism: &self.mechanism,
            pressure,
            flow,
            time,
            start: self
                .mechanism
                .mixture()
                .density(pressure, temperature, fractions),
        };
        let accuracy = IntegrationAccuracy {
            relative: self.tolerances.relative,
            absolute: tolerance,
            steps: self.tolerances.steps,
        };
        let done = method.integrate(&mut law, unknowns, time, accuracy);
        let done = done.map_err(|stalled| {
            let names = self.mechanism.mixture().names();
            let place = match stalled.worst {
                worst if worst > count => worst - count - 1,
                worst => worst,
            };
            let worst = names.get(place).map_or("temperature", String::as_str);
            KineticsError::Integration {
                state: self.words(pressure, temperature, fractions),
                reached: stalled.reached,
                time,
                why: format!("{}; the largest error is that of {worst}", stalled.cause),
            }
        })?;
        made.copy_from_slice(method.integrals());
        self.keep_positive(fractions, flow, time, made);
        Ok(ReactorStatistics { steps: done.steps })
    }

    /// How what a cell reaches by implicit Euler with the rates of the window's end follows what would be there without
    /// reactions: the matrix of the derivatives of mass fractions and sensible enthalpy by those, row by row, with
    /// enthalpies in units of `unit` in J/kg. `state` is that of the window's end.
    pub fn response(
        &self,
        workspace: &mut ReactorWorkspace,
        (start, state): (f64, MixtureState<'_>),
        flow: &Throughflow<'_>,
        time: f64,
        unit: f64,
    ) -> Vec<f64> {
        let mixture = self.mechanism.mixture();
        let count = state.fractions.len();
        let width = count + 1;
        let mut law = CellEquations {
            mechanism: &self.mechanism,
            pressure: state.pressure,
            flow,
            time,
            start,
        };
        let mut at = [0.0; MOST_SPECIES + 1];
        at[..count].copy_from_slice(state.fractions);
        at[count] = state.temperature;
        let mut rates = [0.0; 2 * MOST_SPECIES + 1];
        let mut derivatives = SystemDerivatives {
            jacobian: vec![0.0; width * width],
            integrals: vec![0.0; count * width],
            parameters: Vec::new(),
        };
        law.differentiate(&at[..width], &mut rates[..count + width], &mut derivatives);
        // What reactions change, by fractions and enthalpy: T follows h = Σ Y_k h_k(T).
        let capacity = mixture.heat_capacity(state.temperature, state.fractions);
        let mut change = vec![0.0; width * width];
        let (rows, last) = change.split_at_mut(count * width);
        for k in 0..count {
            let slopes = &derivatives.integrals[k * width..(k + 1) * width];
            let by_temperature = time * slopes[count] / capacity;
            let row = &mut rows[k * width..(k + 1) * width];
            let weight = 1.0 + flow.leaving[k] * time;
            let released = mixture.species()[k].formation_enthalpy() * weight
                / ((1.0 + flow.heat_leaving * time) * unit);
            for j in 0..count {
                let sensible = mixture.species_enthalpy(j, state.temperature);
                row[j] = time * slopes[j] - by_temperature * sensible;
            }
            row[count] = by_temperature * unit;
            for (sum, slope) in last.iter_mut().zip(row.iter()) {
                *sum -= released * slope;
            }
        }
        let algebra = workspace.method.algebra();
        algebra.resize(width);
        let mut response = vec![0.0; width * width];
        if !algebra.factorise(1.0, &change) {
            return response;
        }
        let mut column = [0.0; MOST_SPECIES + 1];
        for j in 0..width {
            let column = &mut column[..width];
            column.fill(0.0);
            column[j] = 1.0;
            algebra.solve(column);
            for (i, value) in column.iter().enumerate() {
                response[i * width + j] = *value;
            }
        }
        response
    }

    /// Whether the rates at mixtures between the gas of the start and the one that would be there without reactions would
    /// change a mass fraction by more than is negligible.
    fn reacts(&self, state: MixtureState<'_>, flow: &Throughflow<'_>, time: f64) -> bool {
        let mixture = self.mechanism.mixture();
        let start = state.fractions;
        let count = start.len();
        let mut end = [0.0; MOST_SPECIES];
        for k in 0..count {
            end[k] = without(start[k], flow.entering[k], flow.leaving[k], time).max(0.0);
        }
        let heat = mixture.enthalpy(state.temperature, start);
        let heat = without(heat, flow.heat_entering, flow.heat_leaving, time);
        let Ok(last) = mixture.temperature(heat, &end[..count], state.temperature) else {
            return true;
        };
        (0..SAMPLES).any(|sample| {
            let share = sample as f64 / (SAMPLES - 1) as f64;
            let mut fractions = [0.0; MOST_SPECIES];
            for k in 0..count {
                fractions[k] = start[k].max(0.0) + share * (end[k] - start[k].max(0.0));
            }
            let fractions = &fractions[..count];
            let temperature = state.temperature + share * (last - state.temperature);
            let mut rates = [0.0; MOST_SPECIES];
            let at = MixtureState {
                pressure: state.pressure,
                temperature,
                fractions,
            };
            self.mechanism.rates(at, &mut rates[..count]);
            let density = mixture.density(state.pressure, temperature, fractions);
            let change = |k: usize| rates[k].abs() * time / (1.0 + flow.leaving[k] * time);
            let most = (0..count).map(change).fold(0.0, f64::max);
            most > self.tolerances.negligible * density
        })
    }

    /// Takes round-off and the integration's tolerance out of fractions below zero, the elements kept.
    fn keep_positive(&self, start: &[f64], flow: &Throughflow<'_>, time: f64, made: &mut [f64]) {
        let count = start.len();
        // Of what is there without reactions, and with them, times 1 + l t: elements are kept of these.
        let (mut inert, mut all) = ([0.0; MOST_SPECIES], [0.0; MOST_SPECIES]);
        let mut below = false;
        for k in 0..count {
            let weight = 1.0 + flow.leaving[k] * time;
            inert[k] = start[k] + time * flow.entering[k];
            // Fractions that transport itself leaves below zero stay.
            all[k] = inert[k].max(0.0) + weight * made[k];
            below |= all[k] < 0.0;
        }
        if !below {
            return;
        }
        let masses = self.elements.of(&all[..count]);
        self.elements.restore(&masses, &mut all[..count]);
        for k in 0..count {
            made[k] = (all[k] - inert[k].max(0.0)) / (1.0 + flow.leaving[k] * time);
        }
    }
}

/// A value after a time by implicit Euler without reactions.
fn without(start: f64, entering: f64, leaving: f64, time: f64) -> f64 {
    (start + time * entering) / (1.0 + leaving * time)
}

/// The equations of a cell; the unknowns are the mass fractions and the temperature, the integrals the ζ of
/// [`Reactor::flow_through`].
struct CellEquations<'a> {
    mechanism: &'a Mechanism,
    pressure: f64,
    flow: &'a Throughflow<'a>,
    time: f64,
    /// Density at the start of the window in kg/m³.
    start: f64,
}

impl StiffSystem for CellEquations<'_> {
    fn unknowns(&self) -> usize {
        self.mechanism.species() + 1
    }

    fn integrals(&self) -> usize {
        self.mechanism.species()
    }

    fn rates(&mut self, x: &[f64], out: &mut [f64]) {
        self.evaluate(|k| x[k], out);
    }

    fn differentiate(&mut self, x: &[f64], out: &mut [f64], derivatives: &mut SystemDerivatives) {
        let n = x.len();
        let mut duals = [Dual::<COLUMNS>::constant(0.0); 2 * MOST_SPECIES + 1];
        let duals = &mut duals[..out.len()];
        for first in (0..n).step_by(COLUMNS) {
            let columns = first..(first + COLUMNS).min(n);
            let at = |k: usize| {
                if columns.contains(&k) {
                    Dual::along(x[k], k - first)
                } else {
                    Dual::constant(x[k])
                }
            };
            self.evaluate(at, duals);
            for (row, dual) in duals.iter().enumerate() {
                out[row] = dual.value;
                let slopes = &dual.slope[..columns.len()];
                let target = match row.checked_sub(n) {
                    None => &mut derivatives.jacobian[row * n..],
                    Some(integral) => &mut derivatives.integrals[integral * n..],
                };
                target[columns.clone()].copy_from_slice(slopes);
            }
        }
    }
}

impl CellEquations<'_> {
    /// Slopes of the unknowns in 1/s and K/s, then those of the integrals in 1/s.
    fn evaluate<N: Number>(&self, at: impl Fn(usize) -> N, out: &mut [N]) {
        let species = self.mechanism.mixture().species();
        let count = species.len();
        let flow = self.flow;
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
        let (unknowns, made) = out.split_at_mut(count + 1);
        let gained = self.mechanism.mass_rates(temperature, &amounts, made);
        let mut share = density.inverse();
        if flow.mixing > 0.0 && gained.value() > 0.0 {
            // 1 + t_k/t_c, with t_c = n Σ c/gained.
            let all = (density * sum).times(self.mechanism.steps().len() as f64);
            share = share / (N::constant(1.0) + gained.times(flow.mixing) / all);
        }
        // Gas of the cell over that at the start, and one over it.
        let held = N::constant(1.0 - flow.opening) + density.times(flow.opening / self.start);
        let thin = held.inverse();
        let mut heating = thin.times(flow.heat_entering);
        let mut capacity = N::constant(0.0);
        for (k, one) in species.iter().enumerate() {
            let law = one.polynomial();
            let per_mass = 1.0 / one.molar_mass();
            let (h, c_p) = (law.enthalpy(t) * per_mass, law.heat_capacity(t) * per_mass);
            let slope = law.heat_capacity_slope(t) * per_mass;
            let sensible = temperature.through(h - one.formation_enthalpy(), c_p);
            let rate = made[k] * share;
            let carried = (N::constant(flow.entering[k]) - at(k).times(flow.leaving[k])) * thin;
            unknowns[k] = rate + carried;
            made[k] = held * rate.times(1.0 / (1.0 + flow.leaving[k] * self.time));
            // −Σ h_k dY_k/dt − l_h h/r with h = Σ Y_k h_k, and the heat of reactions.
            heating = heating
                - rate * temperature.through(h, c_p)
                - (carried + at(k).times(flow.heat_leaving) * thin) * sensible;
            capacity = capacity + at(k) * temperature.through(c_p, slope);
        }
        unknowns[count] = heating / capacity;
    }
}

#[cfg(test)]
mod tests;
