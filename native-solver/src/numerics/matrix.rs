//! Sparse matrices on the graph of a grid: a diagonal, and rows of neighbours.

use std::sync::Arc;

use rayon::prelude::*;

use super::grid::MeshGraph;
use super::parallel::{self, ALONE, CHUNK};

/// A matrix with one row per cell and one entry per pair of neighbours.
#[derive(Clone, Debug)]
pub struct Matrix {
    grid: Arc<MeshGraph>,
    diagonal: Vec<f64>,
    neighbours: Vec<f64>,
}

impl Matrix {
    /// A matrix of zeros.
    pub fn new(grid: Arc<MeshGraph>) -> Self {
        let (cells, entries) = (grid.cells(), grid.columns().len());
        Self {
            grid,
            diagonal: vec![0.0; cells],
            neighbours: vec![0.0; entries],
        }
    }

    /// The grid whose graph it has.
    pub fn grid(&self) -> &Arc<MeshGraph> {
        &self.grid
    }

    /// Entries on the diagonal.
    #[inline]
    pub fn diagonal(&self) -> &[f64] {
        &self.diagonal
    }

    /// Entries on the diagonal, to change them.
    #[inline]
    pub fn diagonal_mut(&mut self) -> &mut [f64] {
        &mut self.diagonal
    }

    /// Columns and values of a row's neighbours, columns ascending.
    #[inline]
    pub fn row(&self, cell: usize) -> (&[u32], &[f64]) {
        let offsets = self.grid.row_offsets();
        let range = offsets[cell] as usize..offsets[cell + 1] as usize;
        (&self.grid.columns()[range.clone()], &self.neighbours[range])
    }

    /// Sets every row: `row(cell, diagonal, neighbours)` starts from zeros and adds; `neighbours`
    /// is indexed by a link's slot.
    pub fn assemble(&mut self, row: impl Fn(usize, &mut f64, &mut [f64]) + Sync) {
        let offsets = self.grid.row_offsets();
        let chunk = |first: usize, diagonal: &mut [f64], mut values: &mut [f64]| {
            values.fill(0.0);
            for (i, diagonal) in diagonal.iter_mut().enumerate() {
                let cell = first + i;
                let length = (offsets[cell + 1] - offsets[cell]) as usize;
                let (own, rest) = std::mem::take(&mut values).split_at_mut(length);
                values = rest;
                *diagonal = 0.0;
                row(cell, diagonal, own);
            }
        };
        if self.diagonal.len() <= ALONE {
            chunk(0, &mut self.diagonal, &mut self.neighbours);
            return;
        }
        let mut rest = &mut self.neighbours[..];
        let mut parts = Vec::with_capacity(self.diagonal.len().div_ceil(CHUNK));
        for (k, diagonal) in self.diagonal.chunks_mut(CHUNK).enumerate() {
            let (first, last) = (k * CHUNK, k * CHUNK + diagonal.len());
            let length = (offsets[last] - offsets[first]) as usize;
            let (own, tail) = std::mem::take(&mut rest).split_at_mut(length);
            rest = tail;
            parts.push((first, diagonal, own));
        }
        parts
            .into_par_iter()
            .for_each(|(first, diagonal, values)| chunk(first, diagonal, values));
    }

    /// One row of A x.
    #[inline]
    pub fn row_times(&self, cell: usize, x: &[f64]) -> f64 {
        let (columns, values) = self.row(cell);
        let mut sum = self.diagonal[cell] * x[cell];
        for (&column, value) in columns.iter().zip(values) {
            sum += value * x[column as usize];
        }
        sum
    }

    /// y = A x.
    pub fn times(&self, x: &[f64], y: &mut [f64]) {
        parallel::fill(y, |cell| self.row_times(cell, x));
    }

    /// r = b − A x.
    pub fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]) {
        parallel::fill(r, |cell| b[cell] - self.row_times(cell, x));
    }

    /// Σ (|A| |x| + |b|): what the terms of A x = b amount to.
    pub fn terms(&self, x: &[f64], b: &[f64]) -> f64 {
        parallel::sum(x.len(), |cell| {
            let (columns, values) = self.row(cell);
            let mut sum = (self.diagonal[cell] * x[cell]).abs() + b[cell].abs();
            for (&column, value) in columns.iter().zip(values) {
                sum += (value * x[column as usize]).abs();
            }
            sum
        })
    }
}
