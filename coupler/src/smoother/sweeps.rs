//! The paper's sweeps: excess passed on to the neighbours, again and again.

use std::ops::Range;

use rayon::prelude::*;

use super::graph::Graph;

/// What sweeps left.
pub(super) struct Swept {
    /// Potential φ = U/G of each cell in m², U the solid volume that left it and G its conductance.
    pub potential: Vec<f64>,
    /// Sweeps done.
    pub sweeps: u32,
    /// Whether the last sweep was enough.
    pub settled: bool,
}

/// Excess that may stay.
pub(super) struct Enough {
    /// In all, in m³.
    pub total: f64,
    /// In a cell, as a solid fraction.
    pub largest: f64,
}

/// Cells of a block: those without excess are skipped as one.
const BLOCK: usize = 2048;

/// Sweeps that are not worth doing: active sets take as long as some hundreds.
pub(super) const MOST: u32 = 500;

/// Sweeps (docs/theory.md, VFS-2): each moves the excess max(0, A − C) of every cell to its neighbours
/// in proportion to the conductances. All cells move at once, so that the result does not depend on
/// their numbering. `excess` is A₀ − C. Ends with little enough excess, or without where it decays
/// so slowly that more than `MOST` sweeps are to be expected. Cells far from any excess cost
/// nothing: they are skipped by blocks.
pub(super) fn sweep(graph: &Graph, excess: &[f64], enough: &Enough) -> Swept {
    let blocks = Blocks::new(graph);
    let mut left = excess.to_vec();
    let mut potential = vec![0.0; left.len()];
    // Excess per conductance, so that neighbours gather g times it.
    let mut pressure = vec![0.0; left.len()];
    let mut states = vec![State::default(); blocks.reach.len()];
    let mut looked = Look {
        sweeps: 0,
        total: f64::INFINITY,
    };
    let mut sweeps = 0;
    loop {
        press(graph, &left, &mut pressure, &mut states);
        let total = states.iter().map(|state| state.total).sum();
        let largest = states.iter().map(|state| state.largest).fold(0.0, f64::max);
        let settled = total <= enough.total && largest <= enough.largest;
        if settled || looked.gives_up(sweeps, total, enough.total) {
            return Swept {
                potential,
                sweeps,
                settled,
            };
        }
        let states = &states;
        let passed = left
            .par_chunks_mut(BLOCK)
            .zip(potential.par_chunks_mut(BLOCK));
        passed.enumerate().for_each(|(block, (left, potential))| {
            let busy = |&other: &u32| states[other as usize].total > 0.0;
            if blocks.reach[block].iter().any(busy) {
                for (cell, (left, potential)) in
                    blocks.cells(block).zip(left.iter_mut().zip(potential))
                {
                    let own = pressure[cell];
                    *potential += own;
                    *left += graph.conductance.gather(cell, &pressure) - own * graph.total[cell];
                }
            }
        });
        sweeps += 1;
    }
}

/// The excess when it was last looked at.
struct Look {
    sweeps: u32,
    total: f64,
}

impl Look {
    /// Looks at the excess each time that the sweeps have doubled. Excess that is spread by sweeps
    /// decays exponentially at the best, and ever more slowly otherwise, so what is expected from its
    /// present rate is no more than what it will take.
    fn gives_up(&mut self, sweeps: u32, total: f64, enough: f64) -> bool {
        if sweeps >= MOST {
            return true;
        }
        if sweeps < 32 || !sweeps.is_power_of_two() {
            return false;
        }
        let rate = (self.total / total).ln() / f64::from(sweeps - self.sweeps);
        let expected = f64::from(sweeps) + (total / enough).ln() / rate;
        (self.sweeps, self.total) = (sweeps, total);
        expected > f64::from(MOST)
    }
}

/// Excess of a block of cells.
#[derive(Clone, Copy, Default)]
struct State {
    /// In all, in m³.
    total: f64,
    /// The largest, as a solid fraction.
    largest: f64,
    /// Whether its pressures may differ from 0.
    touched: bool,
}

/// Puts each cell's excess under pressure.
fn press(graph: &Graph, left: &[f64], pressure: &mut [f64], states: &mut [State]) {
    let blocks = pressure
        .par_chunks_mut(BLOCK)
        .zip(left.par_chunks(BLOCK))
        .zip(states);
    blocks
        .enumerate()
        .for_each(|(block, ((pressure, left), state))| {
            let first = block * BLOCK;
            let total = &graph.total[first..first + left.len()];
            let volume = &graph.volume[first..first + left.len()];
            let before = *state;
            *state = State::default();
            if !before.touched && left.iter().all(|&left| left <= 0.0) {
                return;
            }
            for i in 0..left.len() {
                let excess = left[i].max(0.0);
                state.total += excess;
                state.largest = state.largest.max(excess / volume[i]);
                pressure[i] = if total[i] > 0.0 {
                    excess / total[i]
                } else {
                    0.0
                };
            }
            state.touched = state.total > 0.0;
        });
}

/// Blocks of cells that follow each other.
struct Blocks {
    cells: usize,
    /// Blocks with neighbours in each block, itself included.
    reach: Vec<Vec<u32>>,
}

impl Blocks {
    fn new(graph: &Graph) -> Self {
        let cells = graph.cells();
        let mut blocks = Self {
            cells,
            reach: Vec::new(),
        };
        let reach = (0..cells.div_ceil(BLOCK)).into_par_iter().map(|block| {
            let range = blocks.cells(block);
            let entries =
                graph.conductance.offsets[range.start]..graph.conductance.offsets[range.end];
            let columns = graph.conductance.columns[entries].iter();
            let mut reach = vec![block as u32];
            for other in columns.map(|&column| column / BLOCK as u32) {
                if reach.last() != Some(&other) {
                    reach.push(other);
                }
            }
            reach.sort_unstable();
            reach.dedup();
            reach
        });
        blocks.reach = reach.collect();
        blocks
    }

    fn cells(&self, block: usize) -> Range<usize> {
        block * BLOCK..self.cells.min((block + 1) * BLOCK)
    }
}
