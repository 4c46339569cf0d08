//! Particles that react become lighter, heavier, larger or smaller; the solver that moves them has them as
//! they are.
//!
//! Only the mass of a particle changes, not how fast it moves: what it gives takes its own velocity v along. In the gas
//! it has the velocity u of the gas from the start ([`SpeciesExchange`](crate::part::SpeciesExchange)): the
//! momentum ṁ (u − v) that this takes is not counted.

use std::f64::consts::PI;

use calcine_physics::Vec3;
use calcine_physics::contact::time_step::rayleigh;
use thiserror::Error;

use super::particles::momentum;
use super::{CoupledRun, RunError};
use crate::motion::{Contacts, Elastic, ParticleChanges, Resized};
use crate::supervisor::Supervisor;

/// Radii and masses count as the same within this share.
const SAME: f64 = 1e-12;
/// Share of Rayleigh's time above which a contact solver's step is too long.
pub const LONGEST_STEP: f64 = 0.5;

/// What bounds the time step of particles that move.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactStepLimit {
    /// The step in s of motion time.
    pub step: f64,
    /// Elastic constants of each population.
    pub elastic: Vec<Elastic>,
}

impl ContactStepLimit {
    /// That of a contact solver.
    pub fn of(contacts: &Contacts) -> Self {
        let of = contacts.material_of.iter();
        Self {
            step: contacts.step,
            elastic: of.map(|&material| contacts.materials[material]).collect(),
        }
    }

    /// An error where a particle of a population has become too small or light for the step.
    fn bears(&self, population: u32, new: &Resized) -> Result<(), TooLight> {
        let Some(elastic) = self.elastic.get(population as usize) else {
            return Ok(());
        };
        let density = new.mass / (4.0 / 3.0 * PI * new.radius.powi(3));
        let time = rayleigh(new.radius, density, elastic.young, elastic.poisson);
        // A time that is NaN bounds nothing and is refused too.
        if self.step <= LONGEST_STEP * time {
            return Ok(());
        }
        Err(TooLight {
            id: new.id,
            radius: new.radius,
            mass: new.mass,
            step: self.step,
            time,
        })
    }
}

/// A particle of which reactions have left too little.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "particle {id} has come to a radius of {radius} m and {mass} kg by what reacted in it: a surface wave \
     crosses it in {time} s, and the time step of contacts is {step} s; write a shorter `motion.motion_step`, \
     or a larger `least_diameter` in the size of its material"
)]
pub struct TooLight {
    /// Its id.
    pub id: u64,
    /// Its radius in m.
    pub radius: f64,
    /// Its mass in kg.
    pub mass: f64,
    /// The step in s.
    pub step: f64,
    /// Rayleigh's time in s.
    pub time: f64,
}

impl CoupledRun {
    /// Tells the solver of the particles what the window has made of them. A bed that is held only
    /// needs to know where a radius has changed.
    pub(super) fn resize(&mut self, supervisor: &Supervisor) -> Result<(), RunError> {
        let models = &self.interior.models;
        if !models.change_bodies() {
            return Ok(());
        }
        let fields = self.parts.particles.fields();
        let off = |now: f64, before: f64| (now - before).abs() > SAME * before;
        let held = self.plan.free.is_empty();
        let (mut change, mut asked, mut turned) = (ParticleChanges::default(), 0.0, 0.0);
        let mut carried = Vec3::zeros();
        let mut radii = fields.radius.to_vec();
        models.radii(&mut radii);
        for (row, &radius) in radii.iter().enumerate() {
            let mass = self.interior.mass[row];
            let heavier = off(mass, fields.mass[row]) && !held;
            if !heavier && !off(radius, fields.radius[row]) {
                continue;
            }
            let new = Resized {
                id: fields.id[row],
                radius,
                mass,
            };
            if let Some(step_limit) = self
                .plan
                .step_limit
                .as_ref()
                .filter(|_| self.motion.free[row])
            {
                step_limit.bears(fields.population[row], &new)?;
            }
            asked += mass - fields.mass[row];
            turned += (mass - fields.mass[row]).abs();
            carried += (mass - fields.mass[row]) * fields.velocity[row];
            change.resize.push(new);
        }
        if change.is_empty() {
            return Ok(());
        }
        let before = fields.mass.to_vec();
        let momentum_before = momentum(&fields);
        self.parts.particles.change(supervisor, &change)?;
        let fields = self.parts.particles.fields();
        let pairs = fields.mass.iter().zip(&before);
        let done: f64 = pairs.map(|(now, before)| now - before).sum();
        let left = momentum(&fields) - momentum_before - carried;
        self.ledger.particle_mass.book(done - asked, turned);
        self.ledger
            .particle_momentum
            .book(left.norm(), carried.norm());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_may_become_as_light_as_half_of_rayleighs_time_allows() {
        let step_limit = |step: f64| ContactStepLimit {
            step,
            elastic: vec![Elastic {
                young: 5e7,
                poisson: 0.22,
            }],
        };
        // 3.802 817 5e-5 s at 1 mm and 2500 kg/m³ (see the law).
        let new = Resized {
            id: 7,
            radius: 1e-3,
            mass: 2500.0 * 4.0 / 3.0 * PI * 1e-9,
        };
        assert!(step_limit(1.90e-5).bears(0, &new).is_ok());
        let error = step_limit(1.91e-5).bears(0, &new).unwrap_err().to_string();
        assert!(
            error.contains("particle 7") && error.contains("0.00003802"),
            "{error}"
        );
        let nothing = Resized { mass: 0.0, ..new };
        assert!(step_limit(1e-9).bears(0, &nothing).is_err());
    }
}
