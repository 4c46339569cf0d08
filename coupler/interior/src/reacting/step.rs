//! One window of particles that react, with the gas about them held.

use thiserror::Error;

use super::chemistry::ParticleSurroundings;
use super::ode::IntegrationStalled;
use super::{Reacting, Scratch};
use crate::model::Surroundings;

/// Errors of extents as a share of a particle's solids, and of its temperature in K, in a step.
const AMOUNT: f64 = 1e-6;
const KELVIN: f64 = 1e-2;
/// By how much the gas temperature is varied in K to see what the heat flow does.
const VARIED: f64 = 1.0;

/// A particle whose reactions cannot be followed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the reactions of a particle at {temperature} K in gas of {gas_temperature} K: {cause}")]
pub struct ReactError {
    /// Its row.
    pub row: usize,
    /// Its temperature in K at the start of the window.
    pub temperature: f64,
    /// That of the gas in K.
    pub gas_temperature: f64,
    /// What went wrong.
    pub cause: IntegrationStalled,
}

/// What a window does to one particle.
struct Outcome {
    /// Mean temperature of the particle in K.
    mean: f64,
    /// At the end.
    end: f64,
}

impl Reacting {
    /// Follows every particle over a process span in s, with the network's heat in W, and takes the lines from it
    /// that the exchange needs.
    pub(super) fn react(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[f64],
    ) -> Result<(), ReactError> {
        let mut scratch = std::mem::take(&mut self.scratch);
        let done = (0..self.count())
            .try_for_each(|p| self.follow(p, around, (span, network[p]), &mut scratch));
        self.scratch = scratch;
        done
    }

    fn follow(
        &mut self,
        p: usize,
        around: &Surroundings<'_>,
        (span, heat): (f64, f64),
        scratch: &mut Scratch,
    ) -> Result<(), ReactError> {
        let count = self.chemistry.reactions.len();
        let (hot, exchanged) = (around.temperature[p], around.conductance[p]);
        // Without reactions: the implicit step.
        let inert = exchanged / (1.0 + exchanged * span / self.capacity[p]);
        if !self.can_react(p) {
            self.conductance[p] = inert;
            self.start[p] = self.committed.temperature[p] + heat * span / self.capacity[p];
            self.end[p] = self.start[p] + inert * (hot - self.start[p]) * span / self.capacity[p];
            return Ok(());
        }
        let failed = |cause| ReactError {
            row: p,
            temperature: self.committed.temperature[p],
            gas_temperature: hot,
            cause,
        };
        let varied = if exchanged > 0.0 {
            let other = self.integrate(p, around, (hot + VARIED, heat, span), scratch, |_, _| ());
            Some(other.map_err(failed)?)
        } else {
            None
        };
        let mut slopes = vec![0.0; count];
        let mut state = (Vec::new(), 0.0);
        let outcome = self.integrate(p, around, (hot, heat, span), scratch, |step, rates| {
            for (sum, slope) in slopes.iter_mut().zip(rates) {
                *sum += step * slope;
            }
            state.1 += step;
        });
        let outcome = outcome.map_err(failed)?;
        state.0.extend_from_slice(&scratch.state);

        self.end[p] = outcome.end;
        let flow = exchanged * (hot - outcome.mean);
        let steeper = varied.map_or(0.0, |other| {
            (exchanged * (hot + VARIED - other.mean) - flow) / VARIED
        });
        // Only how fast attempts converge depends on the slope.
        let slope = steeper.clamp(0.2 * inert, exchanged.max(0.2 * inert));
        self.conductance[p] = slope;
        self.start[p] = if slope > 0.0 {
            hot - flow / slope
        } else {
            outcome.mean
        };
        self.extents[p * count..(p + 1) * count].copy_from_slice(&state.0[..count]);
        self.draw_lines(p, around, span, &slopes);
        Ok(())
    }

    /// The lines of a particle's channels from its mean rates and slopes.
    fn draw_lines(&mut self, p: usize, around: &Surroundings<'_>, span: f64, slopes: &[f64]) {
        let (count, channels) = (self.chemistry.reactions.len(), self.channels.len());
        let Some(gas) = &self.chemistry.gas else {
            return;
        };
        let species = gas.names().len();
        let composition = &around.composition[p * species..(p + 1) * species];
        let molar = gas.molar_mass(composition);
        for (c, reaction) in self.reaction_of.iter().copied().enumerate() {
            let Some(key) = self.channels[c].key else {
                continue;
            };
            let mean = self.extents[p * count + reaction] / span;
            let by_mass = molar / gas.species()[key].molar_mass();
            let slope = slopes[reaction] / span * by_mass;
            self.lines[0][p * channels + c] = slope;
            self.lines[1][p * channels + c] = slope * composition[key] - mean;
        }
    }

    /// True where a particle holds a solid that some reaction uses or makes.
    fn can_react(&self, p: usize) -> bool {
        let solids = self.chemistry.solids.len();
        let amounts = &self.committed.amount[p * solids..(p + 1) * solids];
        let reactions = self.chemistry.reactions.iter();
        reactions
            .flat_map(|reaction| &reaction.solids)
            .any(|&(s, _)| amounts[s] > 0.0)
    }

    /// Integrates a particle's extents and temperature; they are left in the scratch. `follow` is told the length
    /// of each step and the mean slopes of the rates in it.
    fn integrate(
        &self,
        p: usize,
        around: &Surroundings<'_>,
        (hot, heat, span): (f64, f64, f64),
        scratch: &mut Scratch,
        mut follow: impl FnMut(f64, &[f64]),
    ) -> Result<Outcome, IntegrationStalled> {
        let Scratch {
            method,
            rates,
            amounts,
            fractions,
            state,
            tolerance,
        } = scratch;
        let chemistry = &self.chemistry;
        let (solids, count) = (chemistry.solids.len(), chemistry.reactions.len());
        let held = &self.committed.amount[p * solids..(p + 1) * solids];
        let species = chemistry.gas.as_ref().map_or(0, |gas| gas.names().len());
        fractions.clear();
        fractions.resize(species, 0.0);
        if let Some(gas) = &chemistry.gas {
            let composition = &around.composition[p * species..(p + 1) * species];
            gas.mole_fractions(composition, fractions);
            for fraction in fractions.iter_mut() {
                *fraction = fraction.max(0.0);
            }
        }
        let size = self.size();
        let mut near = ParticleSurroundings {
            temperature: hot,
            pressure: around.pressure[p],
            fractions,
            film: &around.film[p * species..(p + 1) * species],
            radius: around.radius[p],
            volumes: size.volumes(),
        };
        let begin = self.committed.temperature[p];
        // The heat of a reaction follows temperature so slowly that a line will do here; what is booked is exact.
        let warmth: Vec<[f64; 2]> = (0..count)
            .map(|j| {
                let at = chemistry.warmth(j, begin, hot);
                [at, (chemistry.warmth(j, begin + 10.0, hot) - at) / 10.0]
            })
            .collect();
        let exchanged = around.conductance[p];
        let all: f64 = held.iter().sum();
        state.clear();
        state.resize(count + 1, 0.0);
        state[count] = begin;
        tolerance.clear();
        tolerance.resize(count, AMOUNT * all);
        tolerance.push(KELVIN);
        let mut evaluate = |y: &[f64], rates: &mut super::Rates| {
            amounts.clear();
            amounts.extend_from_slice(held);
            for (extent, reaction) in y.iter().zip(&chemistry.reactions) {
                for &(s, n) in &reaction.solids {
                    amounts[s] += n * extent;
                }
            }
            near.radius = size.radius(amounts).unwrap_or(near.radius);
            chemistry.rates(&near, amounts, y[count], rates);
            chemistry.heat_capacity(amounts, y[count])
        };
        let mut slopes = vec![0.0; count];
        let mut first = true;
        let mut before = vec![0.0; count];
        let mut heated = 0.0;
        // Rates at both ends of a step give the means of slopes; those at the end of one are those at the
        // start of the next.
        let mut own = super::Rates::default();
        let mut steps: Vec<(f64, Vec<f64>)> = Vec::new();
        method.integrate(
            |y, out| {
                let capacity = evaluate(y, rates);
                out[..count].copy_from_slice(&rates.rate);
                let warmed = rates.rate.iter().zip(&warmth);
                let released: f64 = warmed
                    .map(|(rate, [at, slope])| rate * (at + slope * (y[count] - begin)))
                    .sum();
                out[count] = (exchanged * (hot - y[count]) + heat + released) / capacity;
            },
            state,
            span,
            tolerance,
            |step, from, to| {
                heated += 0.5 * step * (from[count] + to[count]);
                if first {
                    steps.push((0.0, from.to_vec()));
                    first = false;
                }
                steps.push((step, to.to_vec()));
            },
        )?;
        for (k, (step, y)) in steps.iter().enumerate() {
            evaluate(y, &mut own);
            if k > 0 {
                let ends = before.iter().zip(&own.slope);
                for (mean, (a, b)) in slopes.iter_mut().zip(ends) {
                    *mean = 0.5 * (a + b);
                }
                follow(*step, &slopes);
            }
            before.copy_from_slice(&own.slope);
        }
        Ok(Outcome {
            mean: heated / span,
            end: state[count],
        })
    }
}
