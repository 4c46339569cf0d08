//! Particles that react become lighter, heavier, larger or smaller; the solver that moves them has them as
//! they are.
//!
//! Only the mass of a particle changes, not how fast it moves: what it gives takes its own velocity v along. In the gas
//! it has the velocity u of the gas from the start ([`SpeciesExchange`](crate::part::SpeciesExchange)): the
//! momentum ṁ (u − v) that this takes is not counted.

use calcine_physics::Vec3;

use super::CoupledRun;
use super::error::RunError;
use super::particles::momentum;
use crate::motion::{ParticleChanges, Resized};
use crate::supervisor::Supervisor;

/// Radii and masses count as the same within this share.
const SAME: f64 = 1e-12;

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
            let gained = fields.weight_of(row) * (mass - fields.mass[row]);
            asked += gained;
            turned += gained.abs();
            carried += gained * fields.velocity[row];
            change.resize.push(new);
        }
        if change.is_empty() {
            return Ok(());
        }
        let before = fields.mass.to_vec();
        let momentum_before = momentum(&fields);
        self.parts.particles.change(supervisor, &change)?;
        let fields = self.parts.particles.fields();
        let done: f64 = before
            .iter()
            .enumerate()
            .map(|(row, before)| fields.weight_of(row) * (fields.mass[row] - before))
            .sum();
        let left = momentum(&fields) - momentum_before - carried;
        self.ledger.particle_mass.book(done - asked, turned);
        self.ledger
            .particle_momentum
            .book(left.norm(), carried.norm());
        Ok(())
    }
}
