//! Stage: from places and radii of the particles to the operator W and the bed that the gas sees.

use std::sync::Arc;

use calcine_physics::{Vec3, sphere};
use rayon::prelude::*;

use super::error::RunError;
use super::meter::{Meter, Stage};
use crate::mapping::{Mapper, Method};
use crate::mesh::Mesh;
use crate::part::{Bed, ParticleFields};
use crate::smoother::{Operator, Smoother};

/// Bed and operator, valid for the places and radii they were made from.
pub(super) struct MappedBed {
    pub operator: Operator,
    pub bed: Bed,
    /// Of one real particle of each row, in m³.
    pub solid_volume: Vec<f64>,
    /// In m.
    pub position: Vec<Vec3>,
    radius: Vec<f64>,
}

/// Base mapping and smoother, and what they made of the particles last.
pub(super) struct BedStage {
    mapper: Mapper<Arc<Mesh>>,
    method: Method,
    smoother: Smoother,
    pub mapped: MappedBed,
}

impl BedStage {
    /// Maps the particles for the first time.
    pub fn new(
        mesh: Arc<Mesh>,
        method: Method,
        smoother: Smoother,
        particles: &ParticleFields<'_>,
        meter: &mut Meter,
    ) -> Result<Self, RunError> {
        let mapper = Mapper::new(mesh);
        let mapped = map(&mapper, method, &smoother, particles, meter)?;
        Ok(Self {
            mapper,
            method,
            smoother,
            mapped,
        })
    }

    /// True where particles have moved or changed their radii since they were mapped.
    pub fn is_of_other_places(&self, particles: &ParticleFields<'_>) -> bool {
        let before = &self.mapped;
        particles.position != before.position || particles.radius != before.radius
    }

    /// Rows of particles that stand in no cell, ascending.
    pub fn outside(&self, positions: &[Vec3]) -> Vec<usize> {
        let rows = positions.par_iter().enumerate().with_min_len(1024);
        let out = rows.filter(|(_, position)| !self.mapper.is_within(**position));
        out.map(|(row, _)| row).collect()
    }

    /// Maps the particles anew where any has moved or changed its radius; true where one has.
    pub fn update(
        &mut self,
        particles: &ParticleFields<'_>,
        meter: &mut Meter,
    ) -> Result<bool, RunError> {
        if !self.is_of_other_places(particles) {
            return Ok(false);
        }
        self.mapped = map(&self.mapper, self.method, &self.smoother, particles, meter)?;
        Ok(true)
    }
}

fn map(
    mapper: &Mapper<Arc<Mesh>>,
    method: Method,
    smoother: &Smoother,
    particles: &ParticleFields<'_>,
    meter: &mut Meter,
) -> Result<MappedBed, RunError> {
    let (position, radius) = (particles.position, particles.radius);
    let solid_volume: Vec<f64> = radius.iter().map(|&r| sphere::volume(r)).collect();
    let rows: Vec<f64> = (0..particles.len())
        .map(|row| particles.row_volume(row))
        .collect();
    let weights = meter.time(Stage::Mapping, || mapper.fill(method, position, radius))?;
    let operator = meter.time(Stage::Smoother, || smoother.operator(weights, &rows))?;
    let operator = match particles.has_weights() {
        true => operator.of_rows(particles.weight),
        false => operator,
    };
    let solid = operator.solid_fraction().iter();
    let void_fraction = solid.map(|alpha| 1.0 - alpha).collect();
    Ok(MappedBed {
        operator,
        bed: Bed { void_fraction },
        solid_volume,
        position: position.to_vec(),
        radius: radius.to_vec(),
    })
}
