//! How light a particle may become before the time step of contacts is too long for it.

use calcine_physics::contact::time_step::{linear_collision, rayleigh};
use calcine_physics::sphere;

use super::error::TooLight;
use crate::motion::{ContactForce, Contacts, Elastic, Resized};

/// Share of Rayleigh's time above which a contact solver's step is too long.
pub const LONGEST_STEP: f64 = 0.5;

/// What bounds the time step of particles that move.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactStepLimit {
    /// The step in s of motion time.
    pub step: f64,
    /// Elastic constants of each population.
    pub elastic: Vec<Elastic>,
    /// Stiffness in N/m of springs that are stated in their place.
    pub stiffness: Option<f64>,
}

impl ContactStepLimit {
    /// That of a contact solver.
    pub fn of(contacts: &Contacts) -> Self {
        let of = contacts.material_of.iter();
        Self {
            step: contacts.step,
            elastic: of.map(|&material| contacts.materials[material]).collect(),
            stiffness: match contacts.law.force {
                ContactForce::LinearSprings { stiffness, .. } => Some(stiffness),
                _ => None,
            },
        }
    }

    /// An error where a particle of a population has become too small or light for the step.
    pub(super) fn bears(&self, population: u32, new: &Resized) -> Result<(), TooLight> {
        let Some(elastic) = self.elastic.get(population as usize) else {
            return Ok(());
        };
        let density = sphere::density(new.mass, new.radius);
        let time = match self.stiffness {
            // Of two such particles: the impact bounds the step as half of it would Rayleigh's time.
            Some(stiffness) => 0.5 * linear_collision(0.5 * new.mass, stiffness),
            None => rayleigh(new.radius, density, elastic.young, elastic.poisson),
        };
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_particle_may_become_as_light_as_half_of_rayleighs_time_allows() {
        let step_limit = |step: f64| ContactStepLimit {
            step,
            elastic: vec![Elastic {
                young: 5e7,
                poisson: 0.22,
            }],
            stiffness: None,
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
        let springs = |step: f64| ContactStepLimit {
            stiffness: Some(1000.0),
            ..step_limit(step)
        };
        let quarter = 0.25 * PI * (0.5 * new.mass / 1000.0).sqrt();
        assert!(springs(0.99 * quarter).bears(0, &new).is_ok());
        assert!(springs(1.01 * quarter).bears(0, &new).is_err());
        let nothing = Resized { mass: 0.0, ..new };
        assert!(step_limit(1e-9).bears(0, &nothing).is_err());
    }
}
