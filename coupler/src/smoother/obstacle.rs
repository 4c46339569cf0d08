//! How much must pass through each cell so that none stays above its capacity.

use rayon::prelude::*;

use super::graph::Graph;

/// The settled bed.
pub(super) struct Obstacle {
    /// Solid volume A of each cell in m³.
    pub solid: Vec<f64>,
    /// Solid volume U in m³ that was moved out of each cell, summed over sweeps.
    pub moved: Vec<f64>,
    /// Whether the last sweep was enough.
    pub settled: bool,
}

/// Sweeps as the paper does (requirements VFS-2): each moves the excess max(0, A − C) of every cell
/// to its neighbours by the fixed shares P. The limit solves the obstacle problem of VFS-4,
/// A = A₀ − (I − P)U ≤ C, U ≥ 0, U (C − A) = 0; all cells move at once, so that the result does not
/// depend on their numbering. Ends when `enough(total excess, solid)` or after `most` sweeps.
pub(super) fn solve(
    graph: &Graph,
    capacity: &[f64],
    before: &[f64],
    most: u32,
    enough: impl Fn(f64, &[f64]) -> bool,
) -> Obstacle {
    let mut solid = before.to_vec();
    let mut moved = vec![0.0; solid.len()];
    // Excess of each cell per conductance, so that neighbours gather g times it.
    let mut pressure = vec![0.0; solid.len()];
    for sweep in 0..=most {
        let mut total = 0.0;
        for cell in 0..solid.len() {
            let excess = f64::max(0.0, solid[cell] - capacity[cell]);
            total += excess;
            pressure[cell] = if graph.total[cell] > 0.0 {
                excess / graph.total[cell]
            } else {
                0.0
            };
        }
        let settled = enough(total, &solid);
        if settled || sweep == most {
            return Obstacle {
                solid,
                moved,
                settled,
            };
        }
        let given = |cell: usize| pressure[cell] * graph.total[cell];
        solid
            .par_iter_mut()
            .zip(&mut moved)
            .with_min_len(1024)
            .enumerate()
            .for_each(|(cell, (amount, moved))| {
                *moved += given(cell);
                *amount += graph.conductance.gather(cell, &pressure) - given(cell);
            });
    }
    Obstacle {
        solid,
        moved,
        settled: false,
    }
}
