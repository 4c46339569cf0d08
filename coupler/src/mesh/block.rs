//! Boxes of equal hexahedra, numbered as OpenFOAM's `blockMesh` numbers one block.

use calcine_physics::Vec3;

use super::{Mesh, MeshError, Patch, Topology};

/// A box divided into equal cells.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxSpec {
    /// Its lowest corner in m.
    pub origin: Vec3,
    /// Its edge lengths in m.
    pub size: Vec3,
    /// Number of cells along x, y, z.
    pub cells: [usize; 3],
    /// Patch names of the sides x−, x+, y−, y+, z−, z+; sides of equal names make one patch.
    pub patches: [String; 6],
}

/// The mesh of a box. Cells run along x, then y, then z; internal faces are in upper-triangular
/// order (by owner, then neighbour); patches come in the order of the first side that names them.
pub fn box_mesh(spec: &BoxSpec) -> Result<Mesh, MeshError> {
    check(spec)?;
    let [nx, ny, nz] = spec.cells;
    let grid = SphereGrid { cells: spec.cells };
    let mut topology = Topology {
        points: points(spec),
        face_offsets: vec![0],
        ..Topology::default()
    };
    for cell in grid.all() {
        for axis in 0..3 {
            if cell[axis] + 1 < spec.cells[axis] {
                let mut next = cell;
                next[axis] += 1;
                push_face(&mut topology, grid.corners(next, axis));
                topology.owner.push(grid.cell(cell));
                topology.neighbour.push(grid.cell(next));
            }
        }
    }
    for (side, name) in spec.patches.iter().enumerate() {
        if spec.patches[..side].contains(name) {
            continue;
        }
        let start = topology.owner.len();
        for same in (side..6).filter(|&other| spec.patches[other] == *name) {
            push_side(&mut topology, &grid, same);
        }
        topology.patches.push(Patch {
            name: name.clone(),
            start,
            count: topology.owner.len() - start,
        });
    }
    debug_assert_eq!(topology.points.len(), (nx + 1) * (ny + 1) * (nz + 1));
    Mesh::new(topology)
}

fn check(spec: &BoxSpec) -> Result<(), MeshError> {
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let length = spec.size[axis];
        if !(length.is_finite() && length > 0.0) {
            return wrong(format!("a box of {length} m along {letter}"));
        }
        if spec.cells[axis] == 0 {
            return wrong(format!(
                "a box of 0 cells along {letter}; it needs at least 1"
            ));
        }
    }
    // Every index, those into the list of face points included, must fit 32 bits.
    let stored = spec
        .cells
        .iter()
        .try_fold(12usize, |product, &n| product.checked_mul(n + 1));
    if stored.is_none_or(|stored| stored > u32::MAX as usize) {
        return wrong(format!(
            "a box of {:?} cells is too large for 32-bit numbering",
            spec.cells
        ));
    }
    Ok(())
}

fn points(spec: &BoxSpec) -> Vec<Vec3> {
    let [nx, ny, nz] = spec.cells;
    let at = |axis: usize, i: usize| {
        spec.origin[axis] + spec.size[axis] * (i as f64 / spec.cells[axis] as f64)
    };
    let mut points = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                points.push(Vec3::new(at(0, i), at(1, j), at(2, k)));
            }
        }
    }
    points
}

/// Numbering of the cells and points of a box.
struct SphereGrid {
    cells: [usize; 3],
}

impl SphereGrid {
    fn all(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [nx, ny, nz] = self.cells;
        (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
    }

    fn cell(&self, [i, j, k]: [usize; 3]) -> u32 {
        (i + self.cells[0] * (j + self.cells[1] * k)) as u32
    }

    fn point(&self, [i, j, k]: [usize; 3]) -> u32 {
        (i + (self.cells[0] + 1) * (j + (self.cells[1] + 1) * k)) as u32
    }

    /// Corners of the face at the lower end of a cell along an axis, normal along the axis.
    fn corners(&self, at: [usize; 3], axis: usize) -> [u32; 4] {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[along_b, along_c]| {
            let mut corner = at;
            corner[b] += along_b;
            corner[c] += along_c;
            self.point(corner)
        })
    }
}

fn push_side(topology: &mut Topology, grid: &SphereGrid, side: usize) {
    let (axis, upper) = (side / 2, side % 2 == 1);
    let layer = if upper { grid.cells[axis] - 1 } else { 0 };
    for cell in grid.all().filter(|cell| cell[axis] == layer) {
        let mut at = cell;
        at[axis] += usize::from(upper);
        let mut corners = grid.corners(at, axis);
        if !upper {
            corners.reverse();
        }
        push_face(topology, corners);
        topology.owner.push(grid.cell(cell));
    }
}

fn push_face(topology: &mut Topology, corners: [u32; 4]) {
    topology.face_points.extend(corners);
    topology
        .face_offsets
        .push(topology.face_points.len() as u32);
}
