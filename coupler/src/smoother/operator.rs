//! The operator W of one bed and its transpose.

use calcine_physics::Vec3;

use super::diffusion::Diffusion;
use super::sweeps::Sweeps;
use crate::mapping::{Amount, Weights};

/// W = F S W₀ for the bed that it was made for. Every column sums to 1: what particles spread
/// arrives in full, and a uniform field is sampled as it is.
#[derive(Clone, Debug)]
pub struct Operator {
    weights: Weights,
    sweeps: Option<Sweeps>,
    diffusion: Option<Diffusion>,
    solid_fraction: Vec<f64>,
}

impl Operator {
    pub(super) fn new(
        weights: Weights,
        sweeps: Option<Sweeps>,
        diffusion: Option<Diffusion>,
        cell_volume: &[f64],
        solid_volume: &[f64],
    ) -> Self {
        let mut operator = Self {
            solid_fraction: Vec::new(),
            weights,
            sweeps,
            diffusion,
        };
        let mut fraction = vec![0.0; operator.cells()];
        operator.spread(solid_volume, &mut fraction);
        for (fraction, volume) in fraction.iter_mut().zip(cell_volume) {
            *fraction /= volume;
        }
        operator.solid_fraction = fraction;
        operator
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.weights.cells()
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.weights.particles()
    }

    /// The base weights W₀.
    pub fn weights(&self) -> &Weights {
        &self.weights
    }

    /// Solid volume fraction α of each cell: W applied to the particles' solid volumes, over V.
    pub fn solid_fraction(&self) -> &[f64] {
        &self.solid_fraction
    }

    /// Sweeps K of the smoother; 0 where no cell was above the threshold.
    pub fn sweeps(&self) -> u32 {
        self.sweeps.as_ref().map_or(0, Sweeps::count)
    }

    /// W x: amounts of particles (J, kg, N s) spread over cells. Slices must have the lengths
    /// `particles()` and `cells()`.
    pub fn spread(&self, per_particle: &[f64], per_cell: &mut [f64]) {
        self.spread_any(per_particle, per_cell);
    }

    /// Wᵀ y: what each particle sees of a field of cells.
    pub fn sample(&self, per_cell: &[f64], per_particle: &mut [f64]) {
        self.sample_any(per_cell, per_particle);
    }

    /// W x for vectors.
    pub fn spread_vectors(&self, per_particle: &[Vec3], per_cell: &mut [Vec3]) {
        self.spread_any(per_particle, per_cell);
    }

    /// Wᵀ y for vectors.
    pub fn sample_vectors(&self, per_cell: &[Vec3], per_particle: &mut [Vec3]) {
        self.sample_any(per_cell, per_particle);
    }

    fn spread_any<T: Amount>(&self, per_particle: &[T], per_cell: &mut [T]) {
        self.weights.spread(per_particle, per_cell);
        if let Some(sweeps) = &self.sweeps {
            sweeps.apply(per_cell);
        }
        if let Some(diffusion) = &self.diffusion {
            diffusion.apply(per_cell);
        }
    }

    fn sample_any<T: Amount>(&self, per_cell: &[T], per_particle: &mut [T]) {
        if self.sweeps.is_none() && self.diffusion.is_none() {
            return self.weights.sample(per_cell, per_particle);
        }
        let mut field = per_cell.to_vec();
        if let Some(diffusion) = &self.diffusion {
            diffusion.apply_transposed(&mut field);
        }
        if let Some(sweeps) = &self.sweeps {
            sweeps.apply_transposed(&mut field);
        }
        self.weights.sample(&field, per_particle);
    }
}
