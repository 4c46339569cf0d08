//! Cells joined by conductances: how excess and diffusion pass between neighbours.

use super::sparse::Sparse;
use crate::mapping::Amount;
use crate::mesh::Mesh;
use calcine_numerics::parallel;

/// Symmetric conductances g = |S_f|/|d_f| in m between neighbouring cells, fixed by the mesh
/// (docs/theory.md, VFS-4), across periodic planes too, zero into excluded cells. L is their Laplacian,
/// (L y)_i = Σ_j g_ij (y_i − y_j).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Graph {
    /// g of each cell's neighbours, by ascending neighbour.
    pub conductance: Sparse,
    /// Sum of each cell's conductances in m.
    pub total: Vec<f64>,
    /// Cell volumes in m³.
    pub volume: Vec<f64>,
}

impl Graph {
    pub fn new(mesh: &Mesh, excluded: &[bool]) -> Self {
        let mut joined: Vec<(u32, u32, f64)> = Vec::with_capacity(mesh.neighbour().len());
        for (face, &neighbour) in mesh.neighbour().iter().enumerate() {
            let (a, b) = (mesh.owner()[face], neighbour);
            if excluded[a as usize] || excluded[b as usize] {
                continue;
            }
            let distance = (mesh.cell_centre()[b as usize] - mesh.cell_centre()[a as usize]).norm();
            let conductance = mesh.face_area()[face].norm() / distance;
            joined.push((a.min(b), a.max(b), conductance));
        }
        for pair in mesh.periodic_faces() {
            let [a, b] = [pair.face, pair.partner].map(|face| mesh.owner()[face]);
            if excluded[a as usize] || excluded[b as usize] {
                continue;
            }
            let centre = |cell: u32| mesh.cell_centre()[cell as usize];
            let distance = (centre(b) - centre(a) - pair.translation).norm();
            let conductance = mesh.face_area()[pair.face].norm() / distance;
            joined.push((a.min(b), a.max(b), conductance));
        }
        // By cell, then neighbour: lower neighbours arrive before higher ones.
        joined.sort_by_key(|&(low, high, _)| (low, high));
        // Two cells across a periodic direction meet on both sides.
        joined.dedup_by(|next, kept| {
            let same = (next.0, next.1) == (kept.0, kept.1);
            if same {
                kept.2 += next.2;
            }
            same
        });
        let conductance = Sparse::from_entries(mesh.cells(), |entry| {
            for &(low, high, conductance) in &joined {
                entry(high, low, conductance);
            }
            for &(low, high, conductance) in &joined {
                entry(low, high, conductance);
            }
        });
        Self::of(conductance, mesh.cell_volume().to_vec())
    }

    /// The graph of given conductances and cell volumes.
    pub fn of(conductance: Sparse, volume: Vec<f64>) -> Self {
        let total = |cell| conductance.row(cell).map(|(_, g)| g).sum();
        Self {
            total: (0..volume.len()).map(total).collect(),
            conductance,
            volume,
        }
    }

    pub fn cells(&self) -> usize {
        self.volume.len()
    }

    /// Number of the connected region of each cell, and how many regions there are.
    pub fn regions(&self) -> (Vec<u32>, usize) {
        const NONE: u32 = u32::MAX;
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
        (region, count as usize)
    }

    /// −(L y) of a cell: Σ over neighbours of g (value of the neighbour − value of the cell). What
    /// one of two neighbours gets is, to the bit, what the other gives.
    #[inline]
    pub fn inflow<T: Amount>(&self, cell: usize, value: impl Fn(usize) -> T) -> T {
        let own = value(cell);
        let mut sum = T::ZERO;
        for (neighbour, conductance) in self.conductance.row(cell) {
            sum += (value(neighbour) - own) * conductance;
        }
        sum
    }

    /// A − C = b − Lφ of all cells, where `excess` is b = A₀ − C and `potential` φ = U/G.
    pub fn excess(&self, excess: &[f64], potential: &[f64], left: &mut [f64]) {
        parallel::fill(left, |cell| {
            excess[cell] + self.inflow(cell, |c| potential[c])
        });
    }
}
