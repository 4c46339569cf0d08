//! The optional diffusion F of what particles spread over cells (requirements VFS-6).

use std::sync::Arc;

use super::graph::Graph;
use super::parallel;
use super::scratch::{Kept, Scratch};

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
    pub fn apply<T: Kept>(&self, amounts: &mut [T], scratch: &Scratch) {
        let Self { graph, step, .. } = self;
        self.repeat(amounts, scratch, |old, cell| {
            graph.inflow(cell, |c| old[c] * (1.0 / graph.volume[c])) * *step
        });
    }

    /// Fᵀ applied to fields.
    pub fn apply_transposed<T: Kept>(&self, field: &mut [T], scratch: &Scratch) {
        let Self { graph, step, .. } = self;
        self.repeat(field, scratch, |old, cell| {
            graph.inflow(cell, |c| old[c]) * (step / graph.volume[cell])
        });
    }

    fn repeat<T: Kept>(
        &self,
        values: &mut [T],
        scratch: &Scratch,
        change: impl Fn(&[T], usize) -> T + Sync,
    ) {
        scratch.with(values.len(), |old: &mut [T]| {
            for _ in 0..self.steps {
                old.copy_from_slice(values);
                parallel::update(values, |cell, value| *value += change(old, cell));
            }
        });
    }
}
