//! The operator W of one bed and its transpose.

use calcine_physics::Vec3;

use super::diffusion::Diffusion;
use super::kernel::Kernel;
use super::scratch::{Kept, Recent, Scratch};
use crate::mapping::Weights;

/// W = F S W₀ for the bed that it was made for. Every column sums to 1: what particles spread
/// arrives in full, and a uniform field is sampled as it is.
#[derive(Clone, Debug)]
pub struct Operator {
    weights: Weights,
    kernel: Option<Kernel>,
    diffusion: Option<Diffusion>,
    solid_fraction: Vec<f64>,
    /// Share of the solid volume that S moved from cell to cell.
    moved: f64,
    scratch: Scratch,
    recent: Recent,
    /// Real particles that each row stands for; empty: one each.
    count: Vec<f64>,
}

impl Operator {
    /// `solid`: W₀ applied to the solid volumes in m³.
    pub(super) fn new(
        weights: Weights,
        kernel: Option<Kernel>,
        diffusion: Option<Diffusion>,
        cell_volume: &[f64],
        solid: Vec<f64>,
    ) -> Self {
        let scratch = Scratch::default();
        let total: f64 = solid.iter().sum();
        let mut fraction = solid;
        let mut moved = 0.0;
        if let Some(kernel) = &kernel {
            let before = fraction.clone();
            kernel.apply(&mut fraction);
            let changes = fraction.iter().zip(&before);
            let changed: f64 = changes.map(|(after, before)| (after - before).abs()).sum();
            moved = 0.5 * changed / total;
        }
        if let Some(diffusion) = diffusion.as_ref().filter(|_| total > 0.0) {
            diffusion.apply(&mut fraction, &scratch);
        }
        for (fraction, volume) in fraction.iter_mut().zip(cell_volume) {
            // F keeps to zero within 1e-12 where nothing is.
            *fraction = (*fraction / volume).max(0.0);
        }
        Self {
            weights,
            kernel,
            diffusion,
            solid_fraction: fraction,
            moved,
            scratch,
            recent: Recent::default(),
            count: Vec::new(),
        }
    }

    /// The same operator for rows that stand for several real particles: what is spread is given for one of them and
    /// arrives as many times as there are. What is sampled is what each of them sees.
    pub fn of_rows(mut self, count: &[f64]) -> Self {
        self.count = count.to_vec();
        self
    }

    /// Number of real particles that a row stands for.
    pub fn count(&self, row: usize) -> f64 {
        self.count.get(row).copied().unwrap_or(1.0)
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

    /// Share of the solid volume that the smoother S moved out of cells above the threshold; the diffusion F, which moves
    /// more, is not in it.
    pub fn moved_share(&self) -> f64 {
        self.moved
    }

    /// Sweeps of the smoother, or V-cycles of the multigrid that stands for them; 0 where no cell was
    /// above the threshold.
    pub fn sweeps(&self) -> u32 {
        self.kernel.as_ref().map_or(0, Kernel::count)
    }

    /// Whether multigrid stands for the sweeps.
    pub fn is_multigrid(&self) -> bool {
        self.kernel.as_ref().is_some_and(Kernel::is_multigrid)
    }

    /// Cells that pass on what is above the threshold.
    pub fn active_cells(&self) -> usize {
        self.kernel.as_ref().map_or(0, Kernel::active)
    }

    /// W x: amounts of particles (J, kg, N s) spread over cells, those of a row as many times as it stands for real
    /// particles. Slices must have the lengths `particles()` and `cells()`.
    pub fn spread(&self, per_particle: &[f64], per_cell: &mut [f64]) {
        self.spread_any(per_particle, per_cell);
    }

    /// Wᵀ y: what each particle sees of a field of cells.
    pub fn sample(&self, per_cell: &[f64], per_particle: &mut [f64]) {
        if self.kernel.is_none() && self.diffusion.is_none() {
            return self.sample_any(per_cell, per_particle);
        }
        self.recent.sample(per_cell, per_particle, |field, seen| {
            self.sample_any(field, seen);
        });
    }

    /// W x for vectors.
    pub fn spread_vectors(&self, per_particle: &[Vec3], per_cell: &mut [Vec3]) {
        self.spread_any(per_particle, per_cell);
    }

    /// Wᵀ y for vectors.
    pub fn sample_vectors(&self, per_cell: &[Vec3], per_particle: &mut [Vec3]) {
        self.sample_any(per_cell, per_particle);
    }

    fn spread_any<T: Kept>(&self, per_particle: &[T], per_cell: &mut [T]) {
        // What particles at rest, or solvers without an error to report, often give.
        if per_particle.iter().all(|value| *value == T::ZERO) {
            per_cell.fill(T::ZERO);
            return;
        }
        if self.count.is_empty() {
            self.weights.spread(per_particle, per_cell);
        } else {
            let pairs = per_particle.iter().zip(&self.count);
            let rows: Vec<T> = pairs.map(|(value, count)| *value * *count).collect();
            self.weights.spread(&rows, per_cell);
        }
        if let Some(kernel) = &self.kernel {
            kernel.apply(per_cell);
        }
        if let Some(diffusion) = &self.diffusion {
            diffusion.apply(per_cell, &self.scratch);
        }
    }

    fn sample_any<T: Kept>(&self, per_cell: &[T], per_particle: &mut [T]) {
        // A uniform field is sampled as it is.
        if let Some(first) = per_cell.first()
            && per_cell.iter().all(|value| value == first)
        {
            per_particle.fill(*first);
            return;
        }
        if self.kernel.is_none() && self.diffusion.is_none() {
            return self.weights.sample(per_cell, per_particle);
        }
        self.scratch.with(per_cell.len(), |field: &mut [T]| {
            field.copy_from_slice(per_cell);
            if let Some(diffusion) = &self.diffusion {
                diffusion.apply_transposed(field, &self.scratch);
            }
            if let Some(kernel) = &self.kernel {
                kernel.apply_transposed(field);
            }
            self.weights.sample(field, per_particle);
        });
    }
}
