//! The optional diffusion F of what particles spread over cells (docs/theory.md, VFS-6).

use std::sync::Arc;

use super::graph::Graph;
use super::scratch::{Kept, Scratch};
use super::sparse::{Sparse, Stencil};
use calcine_numerics::parallel;

/// Diffusion over a length ℓ: F = Xᵐ with X = I − τ L V⁻¹ and mτ = ℓ², L the Laplacian of the
/// conductances and V the cell volumes. It approaches the heat kernel of variance 2ℓ² per axis, as the
/// implicit (I − ∇·ℓ²∇)⁻¹ does to first order, but conserves to round-off and has an exact transpose.
/// Steps are as long as keeps every new solid fraction an average of old ones: no new maxima.
///
/// The spectrum of Y = 2X − I lies within −1 and 1, and there
/// Xᵐ = 4⁻ᵐ Σ_k C(2m, m + k) T_|k|(Y), −m ≤ k ≤ m, with Chebyshev's polynomials T: the shares of a
/// binomial distribution of variance m/2. What lies beyond its first few deviations (`TAIL` in all) is left out
/// and the rest made to sum up to 1, so that the work grows with d/h where steps one by one would
/// grow with (d/h)².
#[derive(Clone, Debug)]
pub(super) struct Diffusion {
    graph: Arc<Graph>,
    /// Share of each of Chebyshev's polynomials, the first that of T₀.
    series: Arc<Vec<f64>>,
    /// 2τ V⁻¹ times the conductances: what a product with Yᵀ takes of each neighbour's difference.
    shares: Arc<Stencil>,
}

/// What of the series may be left out.
const TAIL: f64 = 1e-12;

/// The shares of T₀ … T_n in Xᵐ, n ≤ m.
fn series(steps: u32) -> Vec<f64> {
    let m = f64::from(steps);
    let mut share: f64 = (1..=steps).map(|i| 1.0 - 0.5 / f64::from(i)).product();
    let mut series = vec![share];
    let mut sum = share;
    for k in 0..steps {
        if 1.0 - sum <= TAIL {
            break;
        }
        let k = f64::from(k);
        share *= (m - k) / (m + k + 1.0);
        series.push(2.0 * share);
        sum += 2.0 * share;
    }
    let sum: f64 = series.iter().rev().sum();
    series.iter_mut().for_each(|share| *share /= sum);
    series
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
                let share = 2.0 * step * conductance / graph.volume[cell];
                row.push(neighbour as u32, share);
            }
        });
        Ok(Self {
            graph,
            series: Arc::new(series(needed as u32)),
            shares: Arc::new(Stencil::new(&shares)),
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

    /// Fᵀ applied to fields: Chebyshev's recurrence T_{k+1} = 2 Yᵀ T_k − T_{k−1}.
    pub fn apply_transposed<T: Kept>(&self, field: &mut [T], scratch: &Scratch) {
        let cells = field.len();
        scratch.with(cells, |first: &mut [T]| {
            scratch.with(cells, |second: &mut [T]| {
                first.copy_from_slice(field);
                let (mut last, mut next) = (first, second);
                let zeroth = self.series.first().copied().unwrap_or(1.0);
                parallel::update(field, |_, sum| *sum = *sum * zeroth);
                for (k, &share) in self.series.iter().enumerate().skip(1) {
                    self.polynomial(k, last, next, field, share);
                    std::mem::swap(&mut last, &mut next);
                }
            });
        });
    }

    /// From T_{k−1} f in `last` and T_{k−2} f in `next` (k > 1) to T_k f in `next`, its share added to the sum.
    fn polynomial<T: Kept>(&self, k: usize, last: &[T], next: &mut [T], sum: &mut [T], share: f64) {
        let shares = &self.shares;
        let factor = if k == 1 { 1.0 } else { 2.0 };
        parallel::update_both(next, sum, |cell, next, sum| {
            let mut product = last[cell];
            product += shares.differences(cell, last);
            *next = if k == 1 {
                product
            } else {
                product * 2.0 - *next
            };
            *sum += *next * share;
        });
        for (place, &cell) in shares.long.iter().enumerate() {
            let rest = shares.differences_beyond(place, last) * factor;
            next[cell as usize] += rest;
            sum[cell as usize] += rest * share;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Xᵐ at an eigenvalue y = cos θ of Y is cos²ᵐ(θ/2).
    #[test]
    fn the_series_is_the_power_at_every_eigenvalue_and_grows_with_its_root() {
        for (steps, most) in [(1, 2), (3, 4), (43, 35), (114, 56), (2000, 230)] {
            let series = series(steps);
            assert!(series.len() <= most, "{steps} steps: {}", series.len());
            for i in 0..=100 {
                let angle = std::f64::consts::PI * f64::from(i) / 100.0;
                let terms = series.iter().enumerate();
                let sum: f64 = terms
                    .map(|(k, share)| share * (k as f64 * angle).cos())
                    .sum();
                let power = (0.5 * angle).cos().powi(2 * steps as i32);
                assert!((sum - power).abs() < 5e-12, "{steps} steps: {sum} {power}");
            }
        }
    }
}
