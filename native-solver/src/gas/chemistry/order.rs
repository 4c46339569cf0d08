//! Cells in the order of the flow.

use crate::numerics::grid::MeshGraph;

/// Cells in levels: those of one are independent of each other but for diffusion, and stand behind those that they get gas
/// from. Where gas goes round, the first of the round that is found in the order of the cells opens it.
#[derive(Clone, Debug, Default)]
pub struct DownstreamOrder {
    /// Cells, level by level.
    cells: Vec<u32>,
    /// Where each level starts, and the end.
    starts: Vec<usize>,
}

impl DownstreamOrder {
    /// All cells, upstream first.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// The levels, upstream first.
    pub fn levels(&self) -> impl Iterator<Item = &[u32]> {
        self.starts
            .windows(2)
            .map(|pair| &self.cells[pair[0]..pair[1]])
    }

    /// Follows the mass fluxes of the faces in kg/s.
    pub fn update(&mut self, grid: &MeshGraph, flux: &[f64]) {
        const OPEN: u32 = u32::MAX;
        let count = grid.cells();
        let upstream = |cell: usize| {
            let links = grid.links(cell).iter();
            links
                .filter(|link| !link.is_boundary() && link.sign * flux[link.face as usize] < 0.0)
                .map(|link| link.other as usize)
        };
        // Depth first towards where gas comes from; a cell's level is known once those of its upstream cells are.
        let mut level = vec![OPEN; count];
        let mut seen = vec![false; count];
        let mut stack = Vec::new();
        for first in 0..count {
            if seen[first] {
                continue;
            }
            seen[first] = true;
            stack.push(first);
            while let Some(&cell) = stack.last() {
                if let Some(next) = upstream(cell).find(|&other| !seen[other]) {
                    seen[next] = true;
                    stack.push(next);
                    continue;
                }
                let above = upstream(cell).map(|other| level[other]);
                let above = above.filter(|&one| one != OPEN).max();
                level[cell] = above.map_or(0, |one| one + 1);
                stack.pop();
            }
        }
        let levels = level.iter().max().map_or(0, |most| *most as usize + 1);
        self.starts.clear();
        self.starts.resize(levels + 1, 0);
        for &one in &level {
            self.starts[one as usize + 1] += 1;
        }
        for k in 0..levels {
            self.starts[k + 1] += self.starts[k];
        }
        let mut next = self.starts.clone();
        self.cells.clear();
        self.cells.resize(count, 0);
        for (cell, &one) in level.iter().enumerate() {
            self.cells[next[one as usize]] = cell as u32;
            next[one as usize] += 1;
        }
    }
}
