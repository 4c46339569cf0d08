//! Parcels that come, go and get another size between two windows.

use calcine_coupler::motion::ParticleChanges;
use calcine_coupler::physics::{Vec3, sphere};

use super::{NativeParcels, ParcelError};
use crate::particles::{check, retain};

impl NativeParcels {
    /// Takes parcels out, puts new ones in and gives others another size.
    pub(super) fn exchange(&mut self, change: &ParticleChanges) -> Result<(), ParcelError> {
        let populations = self.motion.walls.iter().map(|wall| wall.impact.len()).min();
        let gone = check::change(
            change,
            &self.rows.id,
            populations.unwrap_or(usize::MAX),
            check::AllowedWeights::Any,
        )?;
        let resized = check::resized(change, &self.rows.id)?;
        let mut comes = super::ParcelRows::default();
        for new in &change.insert {
            comes.id.push(new.id);
            comes.position.push(new.position);
        }
        let places = comes.places(&self.tetrahedra)?;
        let rows = &mut self.rows;
        for (row, new) in resized {
            rows.radius[row] = new.radius;
            rows.mass[row] = new.mass;
        }
        if change.rest {
            rows.velocity.fill(Vec3::zeros());
        }
        let mut keep = vec![true; rows.id.len()];
        for &row in &gone {
            keep[row] = false;
        }
        retain(&mut rows.id, &keep);
        retain(&mut rows.population, &keep);
        retain(&mut rows.position, &keep);
        retain(&mut rows.velocity, &keep);
        retain(&mut rows.radius, &keep);
        retain(&mut rows.mass, &keep);
        retain(&mut rows.weight, &keep);
        retain(&mut rows.place, &keep);
        for (new, place) in change.insert.iter().zip(places) {
            rows.id.push(new.id);
            rows.population.push(new.population);
            rows.position.push(new.position);
            rows.velocity.push(new.velocity);
            rows.radius.push(new.radius);
            rows.mass.push(sphere::mass(new.radius, new.density));
            rows.weight.push(new.weight);
            rows.place.push(place);
        }
        let count = rows.id.len();
        rows.spin = vec![Vec3::zeros(); count];
        self.impulse = vec![Vec3::zeros(); count];
        Ok(())
    }
}
