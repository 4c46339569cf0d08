//! Particles that react as the coordinator sees them.

use calcine_physics::thermo::Element;

use super::chemistry::{HIGHEST, LOWEST};
use super::step::TemperatureBeyond;
use super::{Amounts, Reacting};
use crate::column::{ColumnKind, Ragged, StateColumn};
use crate::error::ModelError;
use crate::model::{
    At, Bodies, Channel, GasLines, Inventory, NetworkHeat, Newcomer, ParticleModel, SurfaceLine,
    Surroundings, Tally, Transfer,
};
use crate::thin::{SECANT, TEMPERATURE};
use crate::without;

/// By what share the temperature that the balance of energy gives a particle may be off from the one that its integration
/// came to. What is left of a particle that burns holds so little heat that the last per mille of what it exchanged would be
/// thousands of kelvin: it has the temperature of the integration, and the heat is owed to it.
const APART: f64 = 0.02;

impl ParticleModel for Reacting {
    fn columns(&self) -> &[StateColumn] {
        &self.columns
    }

    fn read(&self, column: usize, out: &mut Ragged) {
        let solids = self.chemistry.solids.len();
        let particles = self.committed.amount.chunks_exact(solids);
        out.reset(ColumnKind::Real);
        match column.checked_sub(1) {
            None => {
                for kelvin in &self.committed.temperature {
                    out.push_reals(&[*kelvin]);
                }
            }
            Some(solid) if solid < solids => {
                particles.for_each(|amounts| out.push_reals(&[amounts[solid]]));
            }
            Some(place) if place == solids => {
                let masses = &self.committed.first_mass;
                masses.iter().for_each(|mass| out.push_reals(&[*mass]));
            }
            Some(place) if place == solids + 1 => {
                let heats = &self.committed.owed;
                heats.iter().for_each(|heat| out.push_reals(&[*heat]));
            }
            Some(place) => {
                let solid = place - solids - 2;
                let molar = self.chemistry.solids[solid].molar_mass();
                let masses = &self.bodies[1].mass;
                for (amounts, mass) in particles.zip(masses) {
                    out.push_reals(&[amounts[solid] * molar / mass]);
                }
            }
        }
    }

    fn load(&mut self, from: &[Ragged]) -> Result<(), ModelError> {
        let (rows, solids) = (self.count(), self.chemistry.solids.len());
        for (column, (of, values)) in self.columns.iter().zip(from).enumerate() {
            if !of.is_state() {
                continue;
            }
            let list = values.to_scalars(&of.name, rows)?;
            match column.checked_sub(1) {
                None => self.committed.temperature.copy_from_slice(list),
                Some(place) if place == solids => self.committed.first_mass.copy_from_slice(list),
                Some(place) if place == solids + 1 => self.committed.owed.copy_from_slice(list),
                Some(solid) => {
                    let amounts = self.committed.amount.chunks_exact_mut(solids);
                    for (amounts, value) in amounts.zip(list) {
                        amounts[solid] = *value;
                    }
                }
            }
        }
        self.begin();
        Ok(())
    }

    fn bodies(&self, at: At) -> Bodies<'_> {
        let (state, measures) = match at {
            At::Attempt => (&self.now, &self.bodies[0]),
            At::Commit => (&self.committed, &self.bodies[1]),
        };
        Bodies {
            temperature: &state.temperature,
            mass: &measures.mass,
            radius: &measures.radius,
        }
    }

    fn channels(&self) -> &[Channel] {
        &self.channels
    }

    fn elements(&self) -> Vec<Element> {
        let solids = &self.chemistry.solids;
        let held = |one: &Element| solids.iter().any(|s| s.atoms()[*one as usize] > 0.0);
        Element::ALL.into_iter().filter(held).collect()
    }

    /// The heat of the last attempt's reactions counts as if it had come before.
    fn temperature_range(&self) -> (f64, f64) {
        let ranges = self.chemistry.solids.iter().map(|solid| solid.range());
        ranges.fold((0.0, f64::INFINITY), |(low, high), (from, to)| {
            (from.max(low), to.min(high))
        })
    }

    fn surface(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ModelError> {
        let count = self.chemistry.reactions.len();
        for (p, line) in out.iter_mut().enumerate() {
            let extents = &self.extents[p * count..(p + 1) * count];
            let heats = extents.iter().zip(&self.chemistry.heat);
            let heat: f64 = heats.map(|(extent, heat)| -extent * heat).sum();
            let heat = heat + self.unbound(p, extents);
            let capacity = self.secant(p, at[p]);
            let warmed = self.committed.temperature[p] + (heat + self.carried[p] * span) / capacity;
            let (gas, beside) = (around.conductance[p], around.temperature[p]);
            *line = SurfaceLine::of_one_temperature(capacity / span, warmed, gas, beside);
        }
        Ok(())
    }

    fn respond(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ModelError> {
        self.react(around, span, network)
            .map_err(|cause| ModelError::Particle {
                row: cause.row,
                cause: Box::new(cause),
            })?;
        out.conductance.copy_from_slice(&self.conductance);
        out.temperature.copy_from_slice(&self.start);
        out.released.copy_from_slice(&self.end);
        out.slope.copy_from_slice(&self.lines[0]);
        out.offset.copy_from_slice(&self.lines[1]);
        out.local_slope.copy_from_slice(&self.lines[2]);
        Ok(())
    }

    fn limit(&mut self, rates: &mut [f64], span: f64) {
        self.limit_all(rates, span);
    }

    fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ModelError> {
        let chemistry = &self.chemistry;
        let (solids, count) = (chemistry.solids.len(), chemistry.reactions.len());
        let channels = self.channels.len();
        self.carried.copy_from_slice(took.carried);
        for p in 0..self.committed.temperature.len() {
            let held = &self.committed.amount[p * solids..(p + 1) * solids];
            let amounts = &mut self.now.amount[p * solids..(p + 1) * solids];
            amounts.copy_from_slice(held);
            let extents = &mut self.extents[p * count..(p + 1) * count];
            for (c, reaction) in self.reaction_of.iter().enumerate() {
                extents[*reaction] = took.rates[p * channels + c] * span;
            }
            let mut released = 0.0;
            let turned = extents.iter().zip(&chemistry.reactions);
            for ((extent, reaction), heat) in turned.zip(&chemistry.heat) {
                for &(s, n) in &reaction.solids {
                    amounts[s] += n * extent;
                }
                released -= extent * heat;
            }
            let gained = (took.heat[p] + took.network[p] + took.carried[p]) * span + released;
            let before = chemistry.enthalpy(held, self.committed.temperature[p]);
            let amounts = &self.now.amount[p * solids..(p + 1) * solids];
            let unbound = chemistry.binding(held) - chemistry.binding(amounts);
            let enthalpy = before + gained + unbound + self.committed.owed[p];
            let followed = self.end[p];
            let found = chemistry.temperature(amounts, enthalpy, followed);
            let near = |kelvin: &f64| (kelvin - followed).abs() <= APART * followed;
            let used_up = self.is_used_up(p, chemistry.mass(amounts));
            (self.now.temperature[p], self.now.owed[p]) = match found {
                Ok(kelvin) if near(&kelvin) && !used_up => (kelvin, 0.0),
                Err(bound) if !(LOWEST..=HIGHEST).contains(&followed) => {
                    return Err(ModelError::Particle {
                        row: p,
                        cause: Box::new(TemperatureBeyond {
                            bound,
                            from: self.committed.temperature[p],
                            exchanged: gained - released,
                            released,
                        }),
                    });
                }
                _ => {
                    let held = chemistry.enthalpy(amounts, followed);
                    (followed, enthalpy - held)
                }
            };
        }
        self.measure(0);
        Ok(())
    }

    /// Energies count from the elements: of what is exchanged with the gas, the gas' own formation enthalpies stand
    /// in its balance.
    fn changed(&self, rows: &[usize]) -> Inventory {
        let chemistry = &self.chemistry;
        let (solids, count) = (chemistry.solids.len(), chemistry.reactions.len());
        let mut all = Inventory::default();
        for &p in rows {
            let own = p * solids..(p + 1) * solids;
            let (now, before) = (&self.now.amount[own.clone()], &self.committed.amount[own]);
            let mut formed = 0.0;
            for ((now, before), solid) in now.iter().zip(before).zip(&chemistry.solids) {
                let change = now - before;
                all.mass.add(solid.molar_mass() * change);
                formed += change * solid.formation_enthalpy();
                add_elements(&mut all, solid.atoms(), change);
            }
            let sensible = chemistry.enthalpy(now, self.now.temperature[p])
                - chemistry.enthalpy(before, self.committed.temperature[p])
                + (chemistry.binding(now) - chemistry.binding(before))
                + (self.now.owed[p] - self.committed.owed[p]);
            let extents = &self.extents[p * count..(p + 1) * count];
            let turned = extents.iter().zip(&chemistry.heat);
            let heat: f64 = turned.map(|(extent, heat)| (extent * heat).abs()).sum();
            all.energy += Tally {
                sum: formed + sensible,
                magnitude: sensible.abs() + heat,
            };
        }
        all
    }

    fn held(&self, rows: &[usize]) -> Inventory {
        let chemistry = &self.chemistry;
        let solids = chemistry.solids.len();
        let mut all = Inventory::default();
        for &row in rows {
            let amounts = &self.committed.amount[row * solids..(row + 1) * solids];
            let mut formed = 0.0;
            for (n, solid) in amounts.iter().zip(&chemistry.solids) {
                formed += n * solid.formation_enthalpy();
                add_elements(&mut all, solid.atoms(), *n);
            }
            all.mass.add(chemistry.mass(amounts));
            let sensible = chemistry.enthalpy(amounts, self.committed.temperature[row])
                + chemistry.binding(amounts)
                + self.committed.owed[row];
            all.energy.add(formed + sensible);
        }
        all
    }

    fn begin_again(&mut self) {
        self.begin();
    }

    fn commit(&mut self) -> Vec<usize> {
        self.committed.clone_from(&self.now);
        self.begin();
        let rows = self.bodies[1].mass.iter().enumerate();
        rows.filter(|(row, mass)| self.is_used_up(*row, **mass))
            .map(|(row, _)| row)
            .collect()
    }

    fn change(&mut self, gone: &[usize], new: &[Newcomer<'_>]) -> Result<(), ModelError> {
        let solids = self.chemistry.solids.len();
        let places: Vec<usize> = gone
            .iter()
            .flat_map(|row| row * solids..(row + 1) * solids)
            .collect();
        let Amounts {
            amount,
            temperature,
            first_mass,
            owed,
        } = &mut self.committed;
        without(amount, &places);
        without(temperature, gone);
        without(first_mass, gone);
        without(owed, gone);
        for one in new {
            one.only(&[TEMPERATURE])?;
            temperature.push(one.scalar(TEMPERATURE)?);
            first_mass.push(one.mass);
            owed.push(0.0);
            amount.extend(self.composition.iter().map(|n| n * one.mass));
        }
        self.begin();
        Ok(())
    }
}

impl Reacting {
    /// Heat in J that extents in mol set free by what binds water.
    fn unbound(&self, row: usize, extents: &[f64]) -> f64 {
        if self.chemistry.bound().is_none() {
            return 0.0;
        }
        let solids = self.chemistry.solids.len();
        let held = &self.committed.amount[row * solids..(row + 1) * solids];
        let mut amounts = held.to_vec();
        for (extent, reaction) in extents.iter().zip(&self.chemistry.reactions) {
            for &(s, n) in &reaction.solids {
                amounts[s] += n * extent;
            }
        }
        self.chemistry.binding(held) - self.chemistry.binding(&amounts)
    }

    /// Mean heat capacity in J/K of what a particle held at the last commit, between its temperature then and another
    /// in K.
    fn secant(&self, row: usize, kelvin: f64) -> f64 {
        let before = self.committed.temperature[row];
        let rise = kelvin - before;
        if rise.abs() < SECANT * kelvin {
            return self.capacity[row];
        }
        let solids = self.chemistry.solids.len();
        let amounts = &self.committed.amount[row * solids..(row + 1) * solids];
        let enthalpy = |at: f64| self.chemistry.enthalpy(amounts, at);
        (enthalpy(kelvin) - enthalpy(before)) / rise
    }
}

/// Adds the elements in an amount in mol.
fn add_elements(all: &mut Inventory, atoms: &[f64; Element::COUNT], amount: f64) {
    let each = all.elements.iter_mut().zip(atoms).zip(Element::ALL);
    for ((sum, atoms), element) in each.filter(|((_, atoms), _)| **atoms != 0.0) {
        sum.add(atoms * element.molar_mass() * amount);
    }
}
