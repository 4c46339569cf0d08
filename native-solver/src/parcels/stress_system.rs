//! The linear equations of a stress that drives solid through the faces of a mesh.

use std::sync::Arc;

use crate::numerics::grid::MeshGraph;
use crate::numerics::krylov::{Krylov, SolveTolerance};
use crate::numerics::matrix::Matrix;
use crate::numerics::preconditioner::{Incomplete, Preconditioner};

/// Iterations of a solve at most.
const ITERATIONS: u32 = 1000;

/// Σ_f k_f (τ_P − τ_N) + s_P τ_P = b_P, with the conductance k of each face between two cells.
#[derive(Debug)]
pub struct StressSystem {
    grid: Arc<MeshGraph>,
    matrix: Matrix,
    incomplete: Incomplete,
    krylov: Krylov,
}

impl StressSystem {
    /// That of a mesh.
    pub fn new(grid: &Arc<MeshGraph>) -> Self {
        Self {
            matrix: Matrix::new(Arc::clone(grid)),
            incomplete: Incomplete::default(),
            krylov: Krylov::default(),
            grid: Arc::clone(grid),
        }
    }

    /// Solves it from a first guess to a share of the residual. `stored` is s of a cell; where it is `None`, there is no stress.
    pub fn solve(
        &mut self,
        conductance: &[f64],
        stored: impl Fn(usize) -> Option<f64> + Sync,
        (right, stress): (&[f64], &mut [f64]),
        relative: f64,
    ) {
        let grid = &self.grid;
        self.matrix.assemble(|cell, diagonal, row| {
            let Some(stored) = stored(cell) else {
                *diagonal = 1.0;
                return;
            };
            *diagonal += stored;
            for link in grid.links(cell).iter().filter(|link| !link.is_boundary()) {
                let conductance = conductance[link.face as usize];
                *diagonal += conductance;
                row[link.slot as usize] -= conductance;
            }
        });
        self.incomplete.update(&self.matrix);
        let target = SolveTolerance {
            absolute: 0.0,
            of_terms: 0.0,
            relative,
            iterations: ITERATIONS,
        };
        self.krylov
            .symmetric(&self.matrix, &mut self.incomplete, right, stress, target);
    }
}
