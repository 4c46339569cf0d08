//! The smoother S of one bed, as sweeps over the cells that it concerns.

use crate::mapping::{Amount, Rows};

use super::graph::Graph;

/// The operator S = Σ_{k<K} s (Pq)ᵏ + (Pq)ᴷ (requirements VFS-6): of what arrives in a cell the
/// share s = A/(A+U) stays and q = 1 − s moves on to the neighbours, by the fixed shares P. After
/// K sweeps what still moves stays where it is. Columns sum to 1, whatever K.
#[derive(Clone, Debug)]
pub(super) struct Sweeps {
    /// Cells that pass something on.
    active: Vec<u32>,
    /// s and q of the active cells.
    stays: Vec<f64>,
    moves: Vec<f64>,
    /// Cells that receive something, the neighbours of active ones.
    reached: Vec<u32>,
    /// Position of each reached cell in `active`, if it is active.
    reached_active: Vec<Option<u32>>,
    /// P: by reached cell, columns are positions in `active`.
    arriving: Rows,
    /// Pᵀ: by active cell, columns are cells.
    leaving: Rows,
    count: u32,
}

impl Sweeps {
    /// The operator that takes `before` to what settles when `moved` passes through the cells.
    pub fn new(graph: &Graph, settled: &[f64], moved: &[f64]) -> Self {
        let active: Vec<u32> = (0..graph.cells())
            .filter(|&cell| moved[cell] > 0.0)
            .map(|cell| cell as u32)
            .collect();
        let mut position = vec![None; graph.cells()];
        for (index, &cell) in active.iter().enumerate() {
            position[cell as usize] = Some(index as u32);
        }
        let of = |cell: u32| {
            let (stays, moves) = (settled[cell as usize], moved[cell as usize]);
            (stays / (stays + moves), moves / (stays + moves))
        };
        let (stays, moves) = active.iter().map(|&cell| of(cell)).unzip();
        let leaving = Rows::from_rows(active.iter().map(|&cell| {
            let total = graph.total[cell as usize];
            let share = |(neighbour, conductance)| (neighbour as u32, conductance / total);
            graph.conductance.row(cell as usize).map(share).collect()
        }));
        let mut reached: Vec<u32> = (0..active.len())
            .flat_map(|index| leaving.row(index).map(|(cell, _)| cell as u32))
            .collect();
        reached.sort_unstable();
        reached.dedup();
        let arriving = Rows::from_rows(reached.iter().map(|&cell| {
            let from = graph.conductance.row(cell as usize);
            from.filter_map(|(neighbour, conductance)| {
                Some((position[neighbour]?, conductance / graph.total[neighbour]))
            })
            .collect()
        }));
        let reached_active = reached.iter().map(|&c| position[c as usize]).collect();
        Self {
            active,
            stays,
            moves,
            reached,
            reached_active,
            arriving,
            leaving,
            count: 0,
        }
    }

    /// Fixes K: the first number of sweeps after which `enough(moving, settled)` holds, where
    /// `moving` is the amount that the active cells would still pass on. False if `most` are too few.
    pub fn settle(
        &mut self,
        amounts: &[f64],
        most: u32,
        mut enough: impl FnMut(f64, &[f64]) -> bool,
    ) -> bool {
        let mut cells = amounts.to_vec();
        self.count = 0;
        let moves = &self.moves;
        let mut left = most;
        let mut settled = false;
        let mut count = 0;
        self.sweep(&mut cells, |moving, cells| {
            let to_move = moving.iter().zip(moves).map(|(x, q)| x * q).sum();
            settled = enough(to_move, cells);
            if settled || left == 0 {
                return false;
            }
            left -= 1;
            count += 1;
            true
        });
        self.count = count;
        settled
    }

    /// Number of sweeps K.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// S applied to amounts per cell.
    pub fn apply<T: Amount>(&self, cells: &mut [T]) {
        let mut left = self.count;
        self.sweep(cells, |_, _| {
            let more = left > 0;
            left = left.saturating_sub(1);
            more
        });
    }

    /// Sweeps while `more(moving, cells)`; `cells` always holds everything: what has settled and
    /// what is moving.
    fn sweep<T: Amount>(&self, cells: &mut [T], mut more: impl FnMut(&[T], &[T]) -> bool) {
        let mut moving: Vec<T> = self.active.iter().map(|&c| cells[c as usize]).collect();
        let mut parting = moving.clone();
        while more(&moving, cells) {
            for (index, &cell) in self.active.iter().enumerate() {
                parting[index] = moving[index] * self.moves[index];
                // What has settled stays; what moved on is taken out.
                cells[cell as usize] = cells[cell as usize] - parting[index];
                moving[index] = T::ZERO;
            }
            for (index, &cell) in self.reached.iter().enumerate() {
                let arrived = self.arriving.gather(index, &parting);
                cells[cell as usize] += arrived;
                if let Some(active) = self.reached_active[index] {
                    moving[active as usize] = arrived;
                }
            }
        }
    }

    /// Sᵀ applied to a field: v ← s y + q Pᵀ v, K times, from v = y.
    pub fn apply_transposed<T: Amount>(&self, field: &mut [T]) {
        let own: Vec<T> = self.active.iter().map(|&c| field[c as usize]).collect();
        let mut next = own.clone();
        for _ in 0..self.count {
            for (index, value) in next.iter_mut().enumerate() {
                let around = self.leaving.gather(index, field);
                *value = own[index] * self.stays[index];
                *value += around * self.moves[index];
            }
            for (&cell, &value) in self.active.iter().zip(&next) {
                field[cell as usize] = value;
            }
        }
    }
}
