//! Cells joined by conductances: how excess and diffusion pass between neighbours.

use crate::mapping::{Amount, Rows};
use crate::mesh::Mesh;

/// Symmetric conductances g = |S_f|/|d_f| in m between neighbouring cells, fixed by the mesh
/// (requirements VFS-4), zero into excluded cells.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Graph {
    /// g of each cell's neighbours, by ascending neighbour.
    pub conductance: Rows,
    /// Sum of each cell's conductances in m.
    pub total: Vec<f64>,
    /// Cell volumes in m³.
    pub volume: Vec<f64>,
}

impl Graph {
    pub fn new(mesh: &Mesh, excluded: &[bool]) -> Self {
        let mut rows = vec![Vec::new(); mesh.cells()];
        for (face, &neighbour) in mesh.neighbour().iter().enumerate() {
            let (a, b) = (mesh.owner()[face] as usize, neighbour as usize);
            if excluded[a] || excluded[b] {
                continue;
            }
            let distance = (mesh.cell_centre()[b] - mesh.cell_centre()[a]).norm();
            let conductance = mesh.face_area()[face].norm() / distance;
            rows[a].push((b as u32, conductance));
            rows[b].push((a as u32, conductance));
        }
        for row in &mut rows {
            row.sort_by_key(|&(cell, _)| cell);
        }
        let total = rows
            .iter()
            .map(|row| row.iter().map(|&(_, conductance)| conductance).sum())
            .collect();
        Self {
            conductance: Rows::from_rows(rows),
            total,
            volume: mesh.cell_volume().to_vec(),
        }
    }

    pub fn cells(&self) -> usize {
        self.volume.len()
    }

    /// Number of the connected region of each cell, and how many regions there are.
    pub fn regions(&self) -> (Vec<usize>, usize) {
        const NONE: usize = usize::MAX;
        let mut region = vec![NONE; self.cells()];
        let mut count = 0;
        let mut stack = Vec::new();
        for seed in 0..self.cells() {
            if region[seed] != NONE {
                continue;
            }
            stack.push(seed);
            region[seed] = count;
            while let Some(cell) = stack.pop() {
                for (neighbour, _) in self.conductance.row(cell) {
                    if region[neighbour] == NONE {
                        region[neighbour] = count;
                        stack.push(neighbour);
                    }
                }
            }
            count += 1;
        }
        (region, count)
    }

    /// Σ over neighbours of g (value of the neighbour − value of the cell).
    pub fn laplacian<T: Amount>(&self, cell: usize, value: impl Fn(usize) -> T) -> T {
        let own = value(cell);
        let mut sum = T::ZERO;
        for (neighbour, conductance) in self.conductance.row(cell) {
            sum += (value(neighbour) - own) * conductance;
        }
        sum
    }
}
