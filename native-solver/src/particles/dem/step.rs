//! How the time step compares with the times that bound it.

use calcine_coupler::motion::Contacts;
use calcine_coupler::physics::contact::PairConstants;
use calcine_coupler::physics::contact::time_step::{hertz_collision, rayleigh};
use calcine_coupler::setup::ParticleSetup;

/// The step as a share of the times that bound it, and the particles that set them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepCheck {
    /// Smallest Rayleigh time in s.
    pub rayleigh: f64,
    /// Step over the Rayleigh time; 0.2 and less are usual for dense beds.
    pub rayleigh_fraction: f64,
    /// Shortest duration in s of a collision at the speed asked for.
    pub collision: f64,
    /// Step over that duration; 0.1 and less keep the restitution to about a percent.
    pub collision_fraction: f64,
    /// Row of the particle with the smallest Rayleigh time.
    pub particle: usize,
}

/// Compares the step with the Rayleigh time and with the collision of the lightest pair at a speed in m/s;
/// nothing where there is no particle.
pub fn check_step(setup: &ParticleSetup, contacts: &Contacts, speed: f64) -> Option<StepCheck> {
    let material = |row: usize| {
        let index = contacts.material_of.get(setup.population[row] as usize)?;
        contacts.materials.get(*index)
    };
    let (mut particle, mut shortest, mut collision) = (0, f64::INFINITY, f64::INFINITY);
    for row in 0..setup.radius.len() {
        let elastic = material(row)?;
        let (radius, density) = (setup.radius[row], setup.density[row]);
        let time = rayleigh(radius, density, elastic.young, elastic.poisson);
        if time < shortest {
            (particle, shortest) = (row, time);
        }
        let own = [elastic.young, elastic.poisson];
        let pair = PairConstants::new(own, own, 1.0);
        let mass = 2.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * density;
        collision = collision.min(hertz_collision(0.5 * radius, mass, pair.young, speed));
    }
    shortest.is_finite().then(|| StepCheck {
        rayleigh: shortest,
        rayleigh_fraction: contacts.step / shortest,
        collision,
        collision_fraction: contacts.step / collision,
        particle,
    })
}
