//! The optional diffusion F of what particles spread over cells (requirements VFS-6).

use std::sync::Arc;

use super::graph::Graph;
use super::parallel;
use super::scratch::{Kept, Scratch};
use super::sparse::Sparse;

/// Diffusion over a length ℓ: F = (I − τ L V⁻¹)ᵐ with mτ = ℓ², L the Laplacian of the conductances
/// and V the cell volumes. It approaches the heat kernel of variance 2ℓ² per axis, as the implicit
/// (I − ∇·ℓ²∇)⁻¹ does to first order, but conserves to round-off and has an exact transpose.
/// Steps are as long as keeps every new solid fraction an average of old ones: no new maxima.
#[derive(Clone, Debug)]
pub(super) struct Diffusion {
    graph: Arc<Graph>,
    steps: u32,
    /// τ V⁻¹ times the conductances: what a step of Fᵀ takes of each neighbour's difference.
    shares: Arc<Sparse>,
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
        let step = length * length / needed;
        let shares = Sparse::build(graph.cells(), 6, |cell, row| {
            for (neighbour, conductance) in graph.conductance.row(cell) {
                row.push(neighbour as u32, step * conductance / graph.volume[cell]);
            }
        });
        Ok(Self {
            graph,
            steps: needed as u32,
            shares: Arc::new(shares.padded()),
        })
    }

    /// F applied to amounts: F = V Fᵀ V⁻¹.
    pub fn apply<T: Kept>(&self, amounts: &mut [T], scratch: &Scratch) {
        let volume = &self.graph.volume;
        parallel::update(amounts, |cell, value| {
            *value = *value * (1.0 / volume[cell])
        });
        self.apply_transposed(amounts, scratch);
        parallel::update(amounts, |cell, value| *value = *value * volume[cell]);
    }

    /// Fᵀ applied to fields.
    pub fn apply_transposed<T: Kept>(&self, field: &mut [T], scratch: &Scratch) {
        let shares = &self.shares;
        scratch.with(field.len(), |other: &mut [T]| {
            let (mut from, mut to) = (&mut *field, other);
            for _ in 0..self.steps {
                let old = &*from;
                parallel::fill(to, |cell| {
                    let own = old[cell];
                    let mut sum = own;
                    for (neighbour, share) in shares.row(cell) {
                        sum += (old[neighbour] - own) * share;
                    }
                    sum
                });
                std::mem::swap(&mut from, &mut to);
            }
            if self.steps % 2 == 1 {
                to.copy_from_slice(from);
            }
        });
    }
}
