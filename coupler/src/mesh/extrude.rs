//! Hexahedral meshes from a plane quadrilateral mesh, drawn out along z.

use std::collections::HashMap;

use calcine_physics::Vec3;

use super::{Mesh, MeshError, Patch, Topology};

/// A plane mesh of quadrilaterals.
pub(super) struct Plane {
    /// Points in m.
    pub points: Vec<[f64; 2]>,
    /// Corners of each cell, counter-clockwise.
    pub cells: Vec<[u32; 4]>,
}

/// Cells run through the plane, then along z; internal faces are in upper-triangular order. `names`
/// are those of the sides, then bottom and top; `side` tells the side at a boundary edge's middle.
/// Equal names make one patch.
pub(super) fn extrude(
    plane: &Plane,
    levels: &[f64],
    names: &[String],
    side: impl Fn([f64; 2]) -> usize,
) -> Result<Mesh, MeshError> {
    let (width, layers) = (plane.cells.len(), levels.len().saturating_sub(1));
    let stored = (plane.points.len().max(width) * 12).checked_mul(levels.len());
    if stored.is_none_or(|stored| stored > u32::MAX as usize) {
        return Err(MeshError::Inconsistent(format!(
            "{width} cells across and {layers} layers are too many for 32-bit numbering"
        )));
    }
    let level = plane.points.len() as u32;
    let mut topology = Topology {
        points: levels
            .iter()
            .flat_map(|&z| plane.points.iter().map(move |p| Vec3::new(p[0], p[1], z)))
            .collect(),
        face_offsets: vec![0],
        ..Topology::default()
    };
    let (inner, outer) = edges(plane);
    let upright = |[a, b]: [u32; 2], layer: usize| {
        let low = layer as u32 * level;
        [a + low, b + low, b + low + level, a + low + level]
    };
    let flat = |cell: usize, layer: usize| plane.cells[cell].map(|p| p + layer as u32 * level);
    let id = |cell: usize, layer: usize| (layer * width + cell) as u32;
    for layer in 0..layers {
        for (cell, across) in inner.iter().enumerate() {
            for &(other, edge) in across {
                push(&mut topology, upright(edge, layer), id(cell, layer));
                topology.neighbour.push(id(other, layer));
            }
            if layer + 1 < layers {
                push(&mut topology, flat(cell, layer + 1), id(cell, layer));
                topology.neighbour.push(id(cell, layer + 1));
            }
        }
    }
    let sides = names.len() - 2;
    for (index, name) in names.iter().enumerate() {
        if names[..index].contains(name) {
            continue;
        }
        let start = topology.owner.len();
        for same in (index..names.len()).filter(|&other| names[other] == *name) {
            if same < sides {
                for layer in 0..layers {
                    for &(cell, edge) in &outer {
                        let [a, b] = edge.map(|p| plane.points[p as usize]);
                        if side([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]) == same {
                            push(&mut topology, upright(edge, layer), id(cell, layer));
                        }
                    }
                }
                continue;
            }
            let top = same == sides + 1;
            for cell in 0..width {
                let mut corners = flat(cell, if top { layers } else { 0 });
                if !top {
                    corners.reverse();
                }
                push(
                    &mut topology,
                    corners,
                    id(cell, if top { layers - 1 } else { 0 }),
                );
            }
        }
        topology.patches.push(Patch {
            name: name.clone(),
            start,
            count: topology.owner.len() - start,
        });
    }
    Mesh::new(topology)
}

type Inner = Vec<Vec<(usize, [u32; 2])>>;
type Outer = Vec<(usize, [u32; 2])>;

/// Edges to each cell's higher neighbours, in their order, and those of the boundary; each runs
/// counter-clockwise about its owner.
fn edges(plane: &Plane) -> (Inner, Outer) {
    let around = |corners: &[u32; 4]| {
        let corners = *corners;
        (0..4).map(move |i| [corners[i], corners[(i + 1) % 4]])
    };
    let mut owner = HashMap::new();
    for (cell, corners) in plane.cells.iter().enumerate() {
        owner.extend(around(corners).map(|edge| (edge, cell)));
    }
    let (mut inner, mut outer) = (vec![Vec::new(); plane.cells.len()], Vec::new());
    for (cell, corners) in plane.cells.iter().enumerate() {
        for edge in around(corners) {
            match owner.get(&[edge[1], edge[0]]) {
                Some(&other) if other > cell => inner[cell].push((other, edge)),
                Some(_) => {}
                None => outer.push((cell, edge)),
            }
        }
        inner[cell].sort_unstable_by_key(|&(other, _)| other);
    }
    (inner, outer)
}

fn push(topology: &mut Topology, corners: [u32; 4], owner: u32) {
    topology.face_points.extend(corners);
    topology
        .face_offsets
        .push(topology.face_points.len() as u32);
    topology.owner.push(owner);
}
