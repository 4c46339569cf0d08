//! Boxes of prisms: each hexahedron cut along a diagonal of its section across z.

use calcine_physics::Vec3;

use super::meshes::{RawFace, joined};
use crate::mesh::block::{BoxSpec, box_mesh};
use crate::mesh::{Mesh, MeshError};

/// The box with two triangular prisms in place of each hexahedron, their edges along z, its points as `displaced` puts them.
pub fn prism_box(spec: &BoxSpec, displaced: impl Fn(Vec3) -> Vec3) -> Result<Mesh, MeshError> {
    let upright = box_mesh(spec)?;
    let points = upright.topology().points.clone();
    let [nx, ny, nz] = spec.cells;
    let patches = upright.patches().iter();
    let names: Vec<&str> = patches.map(|patch| patch.name.as_str()).collect();
    let patch = |side: usize| {
        let found = names.iter().position(|name| *name == spec.patches[side]);
        found.unwrap_or_default()
    };
    let point = |i: usize, j: usize, k: usize| (i + (nx + 1) * (j + (ny + 1) * k)) as u32;
    // The prism below the diagonal from (0, 0) to (1, 1), and the one above it.
    let cell = |[i, j, k]: [usize; 3], above: bool| {
        (2 * (i + nx * (j + ny * k))) as u32 + u32::from(above)
    };
    let mut faces = Vec::new();
    let mut add = |cells: [Option<u32>; 2], side: usize, corners: &[u32]| {
        let mut out = Vec3::zeros();
        out[side / 2] = 1.0;
        let (owner, neighbour, out) = match cells {
            [Some(low), high] => (low, high, out),
            [None, high] => (high.unwrap_or_default(), None, -out),
        };
        faces.push(RawFace {
            owner,
            neighbour,
            patch: patch(side),
            points: corners.to_vec(),
            out,
        });
    };
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let p = |a: usize, b: usize, c: usize| point(i + a, j + b, k + c);
                if j < ny && k < nz {
                    let low = (i > 0).then(|| cell([i.saturating_sub(1), j, k], false));
                    let high = (i < nx).then(|| cell([i, j, k], true));
                    let corners = [p(0, 0, 0), p(0, 1, 0), p(0, 1, 1), p(0, 0, 1)];
                    add([low, high], usize::from(i > 0), &corners);
                }
                if i < nx && k < nz {
                    let low = (j > 0).then(|| cell([i, j.saturating_sub(1), k], true));
                    let high = (j < ny).then(|| cell([i, j, k], false));
                    let corners = [p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)];
                    add([low, high], 2 + usize::from(j > 0), &corners);
                }
                if i < nx && j < ny {
                    for above in [false, true] {
                        let low = (k > 0).then(|| cell([i, j, k.saturating_sub(1)], above));
                        let high = (k < nz).then(|| cell([i, j, k], above));
                        let third = if above { p(0, 1, 0) } else { p(1, 0, 0) };
                        let corners = [p(0, 0, 0), third, p(1, 1, 0)];
                        add([low, high], 4 + usize::from(k > 0), &corners);
                    }
                }
                if i < nx && j < ny && k < nz {
                    let corners = [p(0, 0, 0), p(1, 1, 0), p(1, 1, 1), p(0, 0, 1)];
                    let cells = [false, true].map(|above| Some(cell([i, j, k], above)));
                    add(cells, 2, &corners);
                }
            }
        }
    }
    Mesh::new(joined(points, faces, &names, displaced))
}
