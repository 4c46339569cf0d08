//! How much must pass through each cell so that none stays above its capacity.
//!
//! With the potential φ = U/G (U the solid volume that leaves a cell, G its conductance in all),
//! VFS-4's (I − P)U is Lφ, L the symmetric Laplacian of the conductances. With b = A₀ − C the
//! problem reads
//!
//! φ ≥ 0,   A − C = b − Lφ ≤ 0,   φ (b − Lφ) = 0.
//!
//! L is an M-matrix, so that the primal-dual active-set method (Newton's method for
//! min(φ, Lφ − b) = 0) ends after finitely many steps: each solves Lφ = b on the active cells with
//! φ = 0 elsewhere, then cells with φ < 0 leave the set and cells with b − Lφ > 0 join it. From the
//! second step on φ only rises, and never above the solution (M. Hintermüller, K. Ito, K. Kunisch,
//! SIAM J. Optim. 13 (2002) 865, DOI 10.1137/S1052623401383558). But the set grows by one layer of
//! cells a step; so some projected sweeps go before each, which rise likewise and grow it by several,
//! and the first step starts from the solution on a coarser graph.

use super::graph::Graph;
use super::multigrid::Multigrid;
use super::multigrid::level::Matrix;
use super::sparse::Sparse;
use calcine_numerics::parallel;

/// How exactly the problem is solved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Care {
    /// To start a finer graph from.
    Rough,
    /// To round-off.
    Full,
}

/// Steps of the active set after which it is given up.
const MOST_STEPS: usize = 60;
/// Projected sweeps before each step.
const SWEEPS: usize = 12;
/// Solid fractions that count as round-off.
const ROUND_OFF: f64 = 1e-12;

/// Changes the potential, at first a guess, to the solution; returns the steps taken, `None` where
/// they were not enough.
pub(super) fn settle(
    graph: &Graph,
    excess: &[f64],
    potential: &mut Vec<f64>,
    care: Care,
) -> Option<usize> {
    let cells = graph.cells();
    let mut left = vec![0.0; cells];
    let mut set = ActiveSet::default();
    let mut fine = false;
    let most = if care == Care::Rough { 8 } else { MOST_STEPS };
    for step in 1..=most {
        if !fine {
            project(graph, excess, potential, &mut left);
        }
        set.choose(graph, excess, potential);
        set.solve(
            excess,
            &graph.volume,
            potential,
            if fine { 1e-14 } else { 1e-7 },
        );
        graph.excess(excess, potential, &mut left);
        let round_off = if fine { ROUND_OFF } else { 1e-5 };
        let wrong = parallel::sum(cells, |cell| {
            let volume = graph.volume[cell];
            let negative = potential[cell] * graph.total[cell] < -round_off * volume;
            let above = potential[cell] == 0.0
                && graph.total[cell] > 0.0
                && left[cell] > round_off * volume;
            f64::from(u8::from(negative || above))
        });
        parallel::update(potential, |_, potential| *potential = potential.max(0.0));
        match (wrong == 0.0, fine || care == Care::Rough) {
            (true, true) => return Some(step),
            (true, false) => fine = true,
            (false, _) => fine = false,
        }
    }
    None
}

/// Projected sweeps, φ ← max(0, φ + (b − Lφ)/G).
fn project(graph: &Graph, excess: &[f64], potential: &mut Vec<f64>, spare: &mut Vec<f64>) {
    for _ in 0..SWEEPS {
        parallel::fill(spare, |cell| {
            let total = graph.total[cell];
            if total > 0.0 {
                let around = graph.conductance.gather(cell, potential);
                ((excess[cell] + around) / total).max(0.0)
            } else {
                0.0
            }
        });
        std::mem::swap(potential, spare);
    }
}

/// The active cells and the Laplacian among them.
#[derive(Default)]
struct ActiveSet {
    cells: Vec<u32>,
    multigrid: Option<Multigrid>,
}

impl ActiveSet {
    /// Makes the cells with a potential active. A region in which all have one has nowhere to
    /// send its excess: its cell with most room is left out.
    fn choose(&mut self, graph: &Graph, excess: &[f64], potential: &mut [f64]) {
        open(graph, excess, potential);
        let active = |&cell: &u32| potential[cell as usize] > 0.0;
        let cells: Vec<u32> = (0..graph.cells() as u32).filter(active).collect();
        if self.multigrid.is_none() || cells != self.cells {
            let diagonal = cells.iter().map(|&cell| graph.total[cell as usize]);
            let matrix = Matrix {
                diagonal: diagonal.collect(),
                pull: among(graph, &cells),
            };
            self.multigrid = Some(Multigrid::new(matrix));
            self.cells = cells;
        }
    }

    fn solve(&self, excess: &[f64], volume: &[f64], potential: &mut [f64], tolerance: f64) {
        let Some(multigrid) = &self.multigrid else {
            return;
        };
        let of = |from: &[f64]| -> Vec<f64> {
            self.cells.iter().map(|&cell| from[cell as usize]).collect()
        };
        let (rhs, volume, mut solution) = (of(excess), of(volume), of(potential));
        multigrid.solve(&rhs, &mut solution, &volume, tolerance);
        for (&cell, &value) in self.cells.iter().zip(&solution) {
            potential[cell as usize] = value;
        }
    }
}

/// The conductances among some cells, given in ascending order.
pub(super) fn among(graph: &Graph, cells: &[u32]) -> Sparse {
    let mut position = vec![u32::MAX; graph.cells()];
    for (index, &cell) in cells.iter().enumerate() {
        position[cell as usize] = index as u32;
    }
    Sparse::build(cells.len(), 6, |row, among| {
        for (other, g) in graph.conductance.row(cells[row] as usize) {
            if position[other] != u32::MAX {
                among.push(position[other], g);
            }
        }
    })
}

/// Takes the potential from the cell with most room of each region where all cells have one.
fn open(graph: &Graph, excess: &[f64], potential: &mut [f64]) {
    let mut seen = vec![false; graph.cells()];
    let mut region = Vec::new();
    for seed in 0..graph.cells() {
        if seen[seed] || potential[seed] == 0.0 {
            continue;
        }
        region.clear();
        region.push(seed);
        seen[seed] = true;
        let mut is_open = false;
        let mut next = 0;
        while let Some(&cell) = region.get(next) {
            next += 1;
            for (other, _) in graph.conductance.row(cell) {
                if potential[other] == 0.0 {
                    is_open = true;
                } else if !seen[other] {
                    seen[other] = true;
                    region.push(other);
                }
            }
        }
        let room = |cell: usize| -excess[cell] / graph.volume[cell];
        let roomiest = region.iter().max_by(|&&a, &&b| room(a).total_cmp(&room(b)));
        if let (false, Some(&cell)) = (is_open, roomiest) {
            potential[cell] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::cascade::Cascade;
    use super::*;

    /// A box of 5 x 4 x 12 cells whose conductances and volumes differ by up to 10⁴ and 30.
    fn box_of(conductances: &[f64], volumes: &[f64]) -> Graph {
        let at = |i: usize, j: usize, k: usize| i + 5 * (j + 4 * k);
        let graph = Sparse::from_entries(240, |entry| {
            let mut next = conductances.iter().cycle();
            for k in 0..12 {
                for j in 0..4 {
                    for i in 0..5 {
                        let others = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
                        for (i2, j2, k2) in others
                            .into_iter()
                            .filter(|o| o.0 < 5 && o.1 < 4 && o.2 < 12)
                        {
                            let (a, b) = (at(i, j, k) as u32, at(i2, j2, k2) as u32);
                            let g = next.next().copied().unwrap_or(1.0);
                            entry(a, b, g);
                            entry(b, a, g);
                        }
                    }
                }
            }
        });
        Graph::of(graph, volumes.to_vec())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]
        /// The problem as it is stated: nothing negative, nothing above, and one of both 0.
        #[test]
        fn any_excess_for_which_there_is_room_is_settled(
            exponents in prop::collection::vec(-2.0..2.0f64, 101),
            volumes in prop::collection::vec(0.2..6.0f64, 240),
            filled in prop::collection::vec(0.0..1.0f64, 240),
            spikiness in 1..6i32,
            room in 1e-4..0.3f64,
        ) {
            let conductances: Vec<f64> = exponents.iter().map(|e| 10f64.powf(*e)).collect();
            let graph = box_of(&conductances, &volumes);
            let solid = |cell: usize| filled[cell].powi(spikiness) * volumes[cell];
            let (total, volume) = ((0..240).map(solid).sum::<f64>(), volumes.iter().sum::<f64>());
            let scale = (1.0 - room) * volume / total;
            let excess: Vec<f64> = (0..240).map(|c| scale * solid(c) - volumes[c]).collect();
            let mut potential = Cascade::new(&graph).start(&excess);
            prop_assert!(settle(&graph, &excess, &mut potential, Care::Full).is_some());
            let mut left = vec![0.0; 240];
            graph.excess(&excess, &potential, &mut left);
            for cell in 0..240 {
                prop_assert!(potential[cell] >= 0.0);
                // Round-off of what passes through the cell.
                let round_off = 1e-12 * (volumes[cell] + potential[cell] * graph.total[cell]);
                prop_assert!(left[cell] <= round_off, "{cell}: {}", left[cell]);
                if potential[cell] > 0.0 {
                    prop_assert!(left[cell] >= -round_off, "{cell}: {}", left[cell]);
                }
            }
        }
    }
}
