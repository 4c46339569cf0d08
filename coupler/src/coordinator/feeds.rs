//! Particles that come and go between two windows, in every part alike.

use calcine_interior::{Newcomer, without};
use calcine_physics::Vec3;
use calcine_physics::thermo::Element;

use super::{CoupledRun, RunError};
use crate::feeds::WindowSpan;
use crate::ledger::Ledger;
use crate::part::ParticleFields;
use crate::supervisor::Supervisor;
use crate::time::Window;

impl CoupledRun {
    /// Lets feeds and outlets act before a window, and books what they moved. They stand while the bed is held.
    pub(super) fn feed_and_discharge(
        &mut self,
        supervisor: &Supervisor,
        window: &Window,
    ) -> Result<(), RunError> {
        if self.plan.feeds_and_outlets.is_none() || self.holds(window) {
            return Ok(());
        }
        let moment = WindowSpan {
            window: window.index,
            span: window.span.process.seconds(),
            acceleration: window.acceleration(),
        };
        let fields = self.parts.particles.fields();
        let due = self.plan.feeds_and_outlets.decide(moment, &fields)?;
        if due.change.is_empty() {
            return Ok(());
        }
        let held = |masses: &[f64]| masses.iter().sum::<f64>();
        let before = held(fields.mass);
        let momentum_before = momentum(&fields);
        let [mut came, mut went] = self.ledger.fed_and_discharged;
        let (gone_before, left_before) = (went.mass, went.momentum);
        for &row in &due.rows {
            let enthalpy = self.parts.interior.enthalpy(row);
            went.add(fields.mass[row], enthalpy, fields.velocity[row]);
        }
        let reacting = self.parts.interior.reactions();
        let elements = reacting.map(|one| {
            [
                one.elements(0..fields.len()),
                one.elements(due.rows.iter().copied()),
            ]
        });
        self.parts.particles.change(supervisor, &due.change)?;

        // New ids are the highest: their rows are the last ones.
        let fields = self.parts.particles.fields();
        let first = fields.len() - due.change.insert.len();
        let newcomers: Vec<Newcomer> = (first..fields.len())
            .zip(&due.temperature)
            .map(|(row, &temperature)| {
                let population = fields.population[row] as usize;
                let substance = self.plan.substance.get(population);
                Newcomer {
                    mass: fields.mass[row],
                    material: substance.copied().unwrap_or_default(),
                    temperature,
                }
            })
            .collect();
        self.parts.interior.change(&due.rows, &newcomers);
        if let (Some(before), Some(reacting)) = (elements, self.parts.interior.reactions()) {
            let after = reacting.elements(0..fields.len());
            let brought = reacting.elements_brought(&newcomers);
            book_elements(&mut self.ledger, before, after, brought);
        }
        let (brought_before, carried_before) = (came.mass, came.momentum);
        for row in first..fields.len() {
            let enthalpy = self.parts.interior.enthalpy(row);
            came.add(fields.mass[row], enthalpy, fields.velocity[row]);
        }
        let (brought, taken) = (came.mass - brought_before, went.mass - gone_before);
        let after = held(fields.mass);
        self.ledger.fed_and_discharged = [came, went];
        self.ledger
            .particle_mass
            .book(after - before - brought + taken, brought + taken);
        let carried = [came.momentum - carried_before, went.momentum - left_before];
        let left = momentum(&fields) - momentum_before - carried[0] + carried[1];
        self.ledger
            .particle_momentum
            .book(left.norm(), carried[0].norm() + carried[1].norm());

        let work = &mut self.work;
        without(&mut work.exchange.heat, &due.rows);
        without(&mut work.other, &due.rows);
        without(&mut work.free, &due.rows);
        work.exchange.heat.resize(fields.len(), 0.0);
        for row in first..fields.len() {
            let population = fields.population[row] as usize;
            let free = self.plan.free.get(population).copied().unwrap_or(false);
            work.free.push(free);
            work.other.push(fields.mass[row] * self.plan.gravity);
        }
        work.push.force.clear();
        work.push.force.resize(fields.len(), Vec3::zeros());
        debug_assert!(work.other.len() == fields.len() && work.free.len() == fields.len());
        debug_assert!(
            self.work
                .other
                .iter()
                .all(|force: &Vec3| force.norm().is_finite())
        );
        Ok(())
    }
}

/// The mass in kg of each element that particles held before the change, and that of those that went, against what
/// they hold now and what the newcomers' compositions say.
fn book_elements(
    ledger: &mut Ledger,
    [before, gone]: [Vec<f64>; 2],
    after: Vec<f64>,
    brought: Vec<f64>,
) {
    for (name, line) in &mut ledger.elements {
        let found = Element::ALL.iter().position(|one| one.symbol() == name);
        if let Some(k) = found {
            let left = after[k] - before[k] - brought[k] + gone[k];
            line.book(left, brought[k] + gone[k]);
        }
    }
}

/// Momentum of all particles in N s.
pub(super) fn momentum(fields: &ParticleFields<'_>) -> Vec3 {
    let pairs = fields.mass.iter().zip(fields.velocity);
    pairs.map(|(mass, velocity)| *mass * velocity).sum()
}
