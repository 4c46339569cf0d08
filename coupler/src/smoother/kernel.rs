//! The smoother S of one bed as a linear operator.
//!
//! VFS-6 defines S = Σ_k s (P q)ᵏ: of what passes a cell the share s = A/(A + U) stays and q = 1 − s
//! goes on to the neighbours by the shares P = g/G. What passes, y = x + P q y, has the potential
//! ψ = q y/G. With φ = U/G the bed's own potential and D = A/φ, y_i = (D_i + G_i) ψ_i on the active cells
//! (φ > 0), and y = x + P q y becomes symmetric:
//!
//! H ψ = x,   H = L + D on the active cells,   S = I − L H⁻¹,
//!
//! ψ = 0 elsewhere. For x = A₀ it is ψ = φ, so S A₀ = A. Let B be any fixed symmetric operator in
//! the place of H⁻¹, then
//!
//! S = I − L B,   Sᵀ = I − B L
//!
//! keeps what is spread (columns of L sum to 0, and what L takes from a cell it gives to its
//! neighbour), samples a uniform field as it is (rows of L do too), and the two are adjoint, however
//! well B approximates H⁻¹. Two B are used.
//!
//! Sweeps: K Jacobi steps for H from 0. Their diagonal is G + D, so that each is one sweep, and
//! S = Σ_{k<K} s (P q)ᵏ + (P q)ᴷ: what still moves after K sweeps stays where it is. All terms are
//! non-negative, so S is.
//!
//! Multigrid: where K would be large, a Chebyshev polynomial in V-cycles, with as many cycles as make
//! B equal H⁻¹ to round-off; a polynomial in a symmetric operator and H, B is fixed and symmetric. H is
//! an M-matrix, H⁻¹ ≥ 0, and what stays in an active cell is D ψ ≥ 0, so S is non-negative as far as B is
//! H⁻¹: weights are above −1e-12 of the share that is spread, not by construction but by accuracy. (Fewer cycles would make them negative by as much as is left out;
//! no short polynomial with positive coefficients reaches as far as excess must go.)

use std::sync::Arc;

use super::graph::Graph;
use super::multigrid::Multigrid;
use super::multigrid::level::Matrix;
use super::obstacle;
use super::scratch::{Kept, Scratch};
use super::sparse::Sparse;
use crate::mapping::Amount;
use calcine_numerics::parallel;

/// S and its transpose. Takes about 120 bytes per active cell with sweeps, 340 with multigrid.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    graph: Arc<Graph>,
    /// Cells that pass something on, ascending.
    active: Vec<u32>,
    /// D of each active cell in m.
    stays: Vec<f64>,
    /// Conductance of each active cell to cells that are not.
    leak: Vec<f64>,
    /// Cells that are not active but next to active ones.
    rim: Vec<u32>,
    /// Conductances from active cells to each cell of the rim.
    outward: Sparse,
    inverse: Inverse,
    scratch: Scratch,
}

/// B ≈ H⁻¹.
#[derive(Clone, Debug)]
enum Inverse {
    Sweeps {
        matrix: Matrix,
        /// 1/(G + D).
        inverse: Vec<f64>,
        count: u32,
    },
    Cycles {
        multigrid: Multigrid,
        /// Smallest eigenvalue of the cycle times H; the largest is 1.
        least: f64,
        /// Cycles, at least 2.
        count: u32,
    },
}

/// Shares q below this are round-off; what passes there stays.
const LEAST_SHARE: f64 = 1e-14;
/// What the cycles leave of an error.
const ROUND_OFF: f64 = 1e-15;

impl Kernel {
    /// The operator of the bed that keeps `after` = A of what is in active cells before, with its
    /// potential φ.
    pub fn new(graph: &Arc<Graph>, after: &[f64], potential: &[f64]) -> Self {
        let passes = |cell: usize| {
            let moved = potential[cell] * graph.total[cell];
            after[cell] > 0.0 && moved > LEAST_SHARE * (after[cell] + moved)
        };
        let active: Vec<u32> = (0..graph.cells())
            .filter(|&cell| passes(cell))
            .map(|cell| cell as u32)
            .collect();
        let of = |cell: &u32| after[*cell as usize] / potential[*cell as usize];
        let stays: Vec<f64> = active.iter().map(of).collect();
        let total = active.iter().map(|&cell| graph.total[cell as usize]);
        let matrix = Matrix {
            diagonal: total.zip(&stays).map(|(g, d)| g + d).collect(),
            pull: obstacle::among(graph, &active).padded(),
        };
        let (leak, rim, outward) = border(graph, &active);
        Self {
            graph: graph.clone(),
            active,
            stays,
            leak,
            rim,
            outward,
            inverse: Inverse::Sweeps {
                inverse: matrix.diagonal.iter().map(|d| 1.0 / d).collect(),
                matrix,
                count: 0,
            },
            scratch: Scratch::default(),
        }
    }

    /// Fixes B: a number of sweeps after which less than `moving` still moves and `enough(cells)` holds, or multigrid where `most` are too few.
    pub fn settle(
        &mut self,
        amounts: &[f64],
        moving: f64,
        most: u32,
        enough: impl Fn(&[f64]) -> bool,
    ) {
        let mut tried = self.first_count(amounts, moving, most);
        while let Some(count) = tried.filter(|&count| count <= most) {
            self.set_sweeps(count);
            let mut cells = amounts.to_vec();
            self.apply(&mut cells);
            if enough(&cells) {
                return;
            }
            tried = Some(count + 1 + count / 8);
        }
        let Inverse::Sweeps { matrix, .. } = &self.inverse else {
            return;
        };
        let multigrid = Multigrid::new(matrix.clone());
        // Lanczos approaches the smallest eigenvalue from above.
        let least = (0.9 * multigrid.least_eigenvalue()).min(0.95);
        let root = least.sqrt();
        let contraction = (1.0 - root) / (1.0 + root);
        // Each half of the cycles takes an error to twice the contraction's power.
        let count = (4.0 / ROUND_OFF).ln() / -contraction.ln();
        self.inverse = Inverse::Cycles {
            multigrid,
            least,
            count: count.ceil().clamp(2.0, 500.0) as u32,
        };
    }

    /// The first number of sweeps, up to `most`, after which less than `enough` still moves.
    fn first_count(&self, amounts: &[f64], enough: f64, most: u32) -> Option<u32> {
        let Inverse::Sweeps {
            matrix, inverse, ..
        } = &self.inverse
        else {
            return None;
        };
        let rhs: Vec<f64> = self.active.iter().map(|&c| amounts[c as usize]).collect();
        let mut potential = vec![0.0; rhs.len()];
        let mut next = potential.clone();
        for count in 0..=most {
            jacobi(matrix, inverse, &rhs, &potential, &mut next);
            // What another sweep would pass on.
            let moving = parallel::sum(rhs.len(), |row| {
                let total = self.graph.total[self.active[row] as usize];
                total * (next[row] - potential[row])
            });
            if moving <= enough {
                return Some(count);
            }
            std::mem::swap(&mut potential, &mut next);
        }
        None
    }

    fn set_sweeps(&mut self, sweeps: u32) {
        if let Inverse::Sweeps { count, .. } = &mut self.inverse {
            *count = sweeps;
        }
    }

    /// Sweeps, or cycles of the multigrid.
    pub fn count(&self) -> u32 {
        match self.inverse {
            Inverse::Sweeps { count, .. } | Inverse::Cycles { count, .. } => count,
        }
    }

    /// Whether it is the multigrid that stands for the sweeps.
    pub fn is_multigrid(&self) -> bool {
        matches!(self.inverse, Inverse::Cycles { .. })
    }

    /// Number of active cells.
    pub fn active(&self) -> usize {
        self.active.len()
    }

    /// S applied to amounts per cell: x − L B x.
    pub fn apply<T: Kept>(&self, cells: &mut [T]) {
        let active = self.active.len();
        self.scratch.with(self.needed(), |buffer| {
            let (rhs, rest) = buffer.split_at_mut(active);
            let (potential, rest) = rest.split_at_mut(active);
            let (correction, rest) = rest.split_at_mut(active);
            parallel::fill(rhs, |row| cells[self.active[row] as usize]);
            let is_corrected = self.solve(rhs, potential, correction, rest);
            for potential in [potential, correction]
                .iter()
                .take(1 + usize::from(is_corrected))
            {
                parallel::update(rhs, |row, amount| {
                    *amount += self.inflow(row, potential, self.leak[row]);
                });
                for (row, &cell) in self.rim.iter().enumerate() {
                    cells[cell as usize] += self.outward.gather(row, potential);
                }
            }
            for (&cell, &amount) in self.active.iter().zip(&*rhs) {
                cells[cell as usize] = amount;
            }
        });
    }

    /// Sᵀ applied to a field: y − B L y.
    pub fn apply_transposed<T: Kept>(&self, field: &mut [T]) {
        let active = self.active.len();
        self.scratch.with(self.needed(), |buffer| {
            let (rhs, rest) = buffer.split_at_mut(active);
            let (change, rest) = rest.split_at_mut(active);
            let (correction, rest) = rest.split_at_mut(active);
            // −L y
            parallel::fill(rhs, |row| {
                self.graph
                    .inflow(self.active[row] as usize, |cell| field[cell])
            });
            let is_corrected = self.solve(rhs, change, correction, rest);
            for change in [change, correction]
                .iter()
                .take(1 + usize::from(is_corrected))
            {
                for (&cell, &change) in self.active.iter().zip(change.iter()) {
                    field[cell as usize] += change;
                }
            }
        });
    }

    /// −(L x) of an active cell, or −(H x) with D added to `ground`.
    #[inline]
    fn inflow<T: Amount>(&self, row: usize, x: &[T], ground: f64) -> T {
        let own = x[row];
        let mut sum = own * -ground;
        for (other, g) in self.inverse.matrix().pull.row(row) {
            sum += (x[other] - own) * g;
        }
        sum
    }

    /// x = B rhs; x + correction where true is returned. In tall beds potentials are thousands of
    /// times what is spread, and so is their round-off; only differences matter. So the second half of
    /// the cycles works on what the first half left, found from differences, and adds a small
    /// potential of its own.
    fn solve<T: Amount>(
        &self,
        rhs: &[T],
        x: &mut [T],
        correction: &mut [T],
        scratch: &mut [T],
    ) -> bool {
        match &self.inverse {
            Inverse::Sweeps { count: 0, .. } => {
                x.fill(T::ZERO);
                false
            }
            Inverse::Sweeps {
                matrix,
                inverse,
                count,
            } => {
                parallel::fill(x, |row| rhs[row] * inverse[row]);
                let (mut from, mut to) = (x, correction);
                for _ in 1..*count {
                    jacobi(matrix, inverse, rhs, from, to);
                    std::mem::swap(&mut from, &mut to);
                }
                if count % 2 == 0 {
                    to.copy_from_slice(from);
                }
                false
            }
            Inverse::Cycles {
                multigrid,
                least,
                count,
            } => {
                let (left, rest) = scratch.split_at_mut(rhs.len());
                let first = count / 2;
                chebyshev(multigrid, *least, first, rhs, x, rest);
                parallel::fill(left, |row| {
                    let mut left = rhs[row];
                    left += self.inflow(row, x, self.leak[row] + self.stays[row]);
                    left
                });
                chebyshev(multigrid, *least, count - first, left, correction, rest);
                true
            }
        }
    }

    /// Elements of scratch memory that an application takes.
    fn needed(&self) -> usize {
        let rows = self.active.len();
        match &self.inverse {
            Inverse::Sweeps { .. } => 3 * rows,
            Inverse::Cycles { multigrid, .. } => 7 * rows + multigrid.scratch(),
        }
    }
}

impl Inverse {
    fn matrix(&self) -> &Matrix {
        match self {
            Self::Sweeps { matrix, .. } => matrix,
            Self::Cycles { multigrid, .. } => multigrid.matrix(),
        }
    }
}

/// One Jacobi step for H, which is one sweep: x ← (rhs + Σ g x)/(G + D).
#[inline]
fn jacobi<T: Amount>(matrix: &Matrix, inverse: &[f64], rhs: &[T], from: &[T], to: &mut [T]) {
    parallel::fill(to, |row| {
        let mut sum = rhs[row];
        sum += matrix.pull.gather(row, from);
        sum * inverse[row]
    });
}

/// x = B rhs, B the Chebyshev iteration of some steps for eigenvalues in [least, 1] of the cycle
/// times H (Y. Saad, Iterative Methods for Sparse Linear Systems, 2nd ed. 2003, algorithm 12.1).
fn chebyshev<T: Amount>(
    multigrid: &Multigrid,
    least: f64,
    steps: u32,
    rhs: &[T],
    x: &mut [T],
    scratch: &mut [T],
) {
    let rows = rhs.len();
    let (residual, rest) = scratch.split_at_mut(rows);
    let (through, rest) = rest.split_at_mut(rows);
    let (change, rest) = rest.split_at_mut(rows);
    let (middle, half) = (0.5 * (1.0 + least), 0.5 * (1.0 - least));
    let ratio = middle / half;
    let mut rho = 1.0 / ratio;
    multigrid.cycle(rhs, through, rest);
    parallel::fill(change, |row| through[row] * (1.0 / middle));
    x.copy_from_slice(change);
    for _ in 1..steps {
        parallel::fill(residual, |row| multigrid.matrix().residual(row, rhs, x));
        multigrid.cycle(residual, through, rest);
        let next = 1.0 / (2.0 * ratio - rho);
        let (keep, add) = (next * rho, 2.0 * next / half);
        parallel::update(change, |row, change| {
            *change = *change * keep;
            *change += through[row] * add;
        });
        parallel::update(x, |row, x| *x += change[row]);
        rho = next;
    }
}

/// Conductance of active cells to others, the others, and what leads to them.
fn border(graph: &Graph, active: &[u32]) -> (Vec<f64>, Vec<u32>, Sparse) {
    let mut position = vec![u32::MAX; graph.cells()];
    for (index, &cell) in active.iter().enumerate() {
        position[cell as usize] = index as u32;
    }
    let mut leak = vec![0.0; active.len()];
    let mut rim = Vec::new();
    for (leak, &cell) in leak.iter_mut().zip(active) {
        for (other, g) in graph.conductance.row(cell as usize) {
            if position[other] == u32::MAX {
                *leak += g;
                rim.push(other as u32);
            }
        }
    }
    rim.sort_unstable();
    rim.dedup();
    let mut outward = Sparse::with_capacity(rim.len(), 3 * rim.len());
    for &cell in &rim {
        for (other, g) in graph.conductance.row(cell as usize) {
            if position[other] != u32::MAX {
                outward.push(position[other], g);
            }
        }
        outward.end_row();
    }
    (leak, rim, outward)
}
