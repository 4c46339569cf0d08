//! What a window does with particles that react.

use super::window::timed;
use super::{CoupledRun, RunError};
use crate::time::Window;
use calcine_interior::reacting::{ExchangeTotals, Surroundings};

impl CoupledRun {
    /// True where some particles react.
    pub(super) fn reacts(&self) -> bool {
        self.parts.interior.reactions().is_some()
    }

    /// Mass transfer coefficients, where some particles react.
    pub(super) fn evaluate_films(&mut self, window: &Window) {
        if !self.reacts() {
            return;
        }
        let (mapped, work) = (&self.mapped, &mut self.work);
        let particles = self.parts.particles.fields();
        work.pressure.resize(particles.len(), 0.0);
        let gas = self.parts.gas.fields();
        mapped.operator.sample(gas.pressure, &mut work.pressure);
        self.closures.evaluate_films(
            &work.sampled_gas,
            &particles,
            &work.pressure,
            window.acceleration(),
            &mut work.coefficients,
        );
    }

    /// Follows the reactions over the window with the gas as it is.
    pub(super) fn react(&mut self, window: &Window) -> Result<(), RunError> {
        let (mapped, work, timing) = (&self.mapped, &mut self.work, &mut self.timing);
        let Some(reacting) = self.parts.interior.reacting() else {
            return Ok(());
        };
        let gas = self.parts.gas.fields();
        let span = window.span.process.seconds();
        work.sampled_gas.sample(&mapped.operator, &gas, &mapped.bed);
        mapped.operator.sample(gas.pressure, &mut work.pressure);
        let around = Surroundings {
            temperature: &work.sampled_gas.temperature,
            pressure: &work.pressure,
            composition: &work.sampled_gas.composition,
            conductance: &work.coefficients.conductance,
            film: &work.coefficients.film,
            radius: self.parts.particles.fields().radius,
        };
        timed(&mut timing.interior, || reacting.react(&around, span)).map_err(|cause| {
            RunError::React {
                window: window.index,
                cause,
            }
        })
    }

    /// Tells the exchange what reacts, where something does.
    pub(super) fn tell_rates(&mut self, window: &Window) {
        let (mapped, work, timing) = (&self.mapped, &mut self.work, &mut self.timing);
        let Some(reacting) = self.parts.interior.reacting() else {
            return;
        };
        let gas = self.parts.gas.fields();
        timed(&mut timing.exchange, || {
            let told = &mut work.exchange.cells.species;
            let properties = &self.closures.gas;
            let operator = &mapped.operator;
            work.species_coupling
                .linearise(operator, reacting, &gas, properties, told);
        });
        let conductance = &work.coefficients.conductance;
        let span = window.span.process.seconds();
        let interior = &self.parts.interior;
        interior.eliminated(conductance, span, &mut work.exchange.conductance);
    }

    /// How far what reacts, by the gas of the attempt, is from what it was before.
    pub(super) fn follow_rates(&mut self) -> f64 {
        let Some(reacting) = self.parts.interior.reactions() else {
            return 0.0;
        };
        let gas = self.parts.gas.fields();
        let species = self.closures.gas.species().len();
        let operator = &self.mapped.operator;
        self.work
            .species_coupling
            .follow(operator, reacting, &gas, species)
    }

    /// Fixes what particles give and take.
    pub(super) fn fix_rates(&mut self, window: &Window) {
        let work = &mut self.work;
        if let Some(reacting) = self.parts.interior.reacting() {
            work.species_coupling.fix(
                &self.mapped.operator,
                reacting,
                window.span.process.seconds(),
                &self.closures.gas,
                &mut work.exchange.cells.species,
            );
        }
    }

    /// Books what was fixed.
    pub(super) fn book_rates(&mut self, window: &Window) {
        let work = &mut self.work;
        let Some(reacting) = self.parts.interior.reacting() else {
            return;
        };
        let gas = self.parts.gas.fields();
        let operator = &self.mapped.operator;
        work.species_coupling
            .credit(operator, reacting, &gas, &self.closures.gas);
        let booking = ExchangeTotals {
            rates: &work.species_coupling.rates,
            carried: &work.species_coupling.carried,
        };
        reacting.book(&booking, window.span.process.seconds());
    }

    /// What particles are made of, for observers: their masses in kg and mass fractions of solids.
    pub(super) fn weigh(&mut self) {
        let work = &mut self.work;
        work.particle_mass.clear();
        work.solid_fractions.clear();
        match self.parts.interior.reactions() {
            None => {
                let mass = self.parts.particles.fields().mass;
                work.particle_mass.extend_from_slice(mass);
            }
            Some(reacting) => {
                reacting.masses(&mut work.particle_mass);
                let solids = &reacting.chemistry().solids;
                let amounts = reacting.amounts().iter().enumerate();
                work.solid_fractions.extend(amounts.map(|(at, amount)| {
                    let mass = work.particle_mass[at / solids.len()];
                    amount * solids[at % solids.len()].molar_mass() / mass
                }));
            }
        }
    }
}
