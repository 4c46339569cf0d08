//! The optional diffusion F of what particles spread over cells (requirements VFS-6).

use std::sync::Arc;

use rayon::prelude::*;

use super::graph::Graph;
use crate::mapping::Amount;

/// Diffusion over a length ℓ: F = (I − τ L V⁻¹)ᵐ with mτ = ℓ², L the Laplacian of the conductances
/// and V the cell volumes. It approaches the heat kernel of variance 2ℓ² per axis, as the implicit
/// (I − ∇·ℓ²∇)⁻¹ does to first order, but conserves to round-off and has an exact transpose.
/// Steps are as long as keeps every new solid fraction an average of old ones: no new maxima.
#[derive(Clone, Debug)]
pub(super) struct Diffusion {
    graph: Arc<Graph>,
    steps: u32,
    /// τ in m².
    step: f64,
}

impl Diffusion {
    /// Most steps that a diffusion may take; beyond, cells are too small for the length.
    pub const MOST_STEPS: u32 = 10_000;

    /// The diffusion over a length in m; the number of steps it would need where they are too many.
    pub fn new(graph: Arc<Graph>, length: f64) -> Result<Self, f64> {
        let fastest = graph
            .total
            .iter()
            .zip(&graph.volume)
            .map(|(total, volume)| total / volume)
            .fold(0.0, f64::max);
        let needed = (2.0 * length * length * fastest).ceil().max(1.0);
        if needed > f64::from(Self::MOST_STEPS) {
            return Err(needed);
        }
        Ok(Self {
            graph,
            steps: needed as u32,
            step: length * length / needed,
        })
    }

    /// F applied to amounts.
    pub fn apply<T: Amount>(&self, amounts: &mut [T]) {
        self.repeat(amounts, |old, cell| {
            let fraction = |c: usize| old[c] * (1.0 / self.graph.volume[c]);
            self.graph.laplacian(cell, fraction) * self.step
        });
    }

    /// Fᵀ applied to fields.
    pub fn apply_transposed<T: Amount>(&self, field: &mut [T]) {
        self.repeat(field, |old, cell| {
            self.graph.laplacian(cell, |c| old[c]) * (self.step / self.graph.volume[cell])
        });
    }

    fn repeat<T: Amount>(&self, values: &mut [T], change: impl Fn(&[T], usize) -> T + Sync) {
        let mut old = values.to_vec();
        for _ in 0..self.steps {
            old.copy_from_slice(values);
            let from = &old;
            values
                .par_iter_mut()
                .with_min_len(1024)
                .enumerate()
                .for_each(|(cell, value)| *value += change(from, cell));
        }
    }
}
