//! Meshes of one duct: of boxes, and of prisms.

use calcine_coupler::mesh::{Mesh, Patch, Topology};
use calcine_coupler::physics::Vec3;

/// Cells of the duct along x, y and z.
pub const CELLS: [usize; 3] = [2, 2, 12];
/// Edge lengths of the duct in m.
pub const SIZE: [f64; 3] = [0.01, 0.01, 0.12];

/// A box of hexahedra with the patches `side`, `bottom`, `top`.
pub fn duct() -> Mesh {
    let [nx, ny, nz] = CELLS;
    let point = |i: usize, j: usize, k: usize| (i + (nx + 1) * (j + (ny + 1) * k)) as u32;
    let cell = |i: usize, j: usize, k: usize| (i + nx * (j + ny * k)) as u32;
    let mut topology = Topology::default();
    for (k, j, i) in triples(nz + 1, ny + 1, nx + 1) {
        let at = |n: usize, axis: usize| n as f64 * SIZE[axis] / CELLS[axis] as f64;
        topology
            .points
            .push(Vec3::new(at(i, 0), at(j, 1), at(k, 2)));
    }
    let across = |i, j, k| {
        [
            point(i, j, k),
            point(i, j + 1, k),
            point(i, j + 1, k + 1),
            point(i, j, k + 1),
        ]
    };
    let along_y = |i, j, k| {
        [
            point(i, j, k),
            point(i, j, k + 1),
            point(i + 1, j, k + 1),
            point(i + 1, j, k),
        ]
    };
    let along_z = |i, j, k| {
        [
            point(i, j, k),
            point(i + 1, j, k),
            point(i + 1, j + 1, k),
            point(i, j + 1, k),
        ]
    };
    let (mut inner, mut side, mut bottom, mut top) = (vec![], vec![], vec![], vec![]);
    for (k, j, i) in triples(nz, ny, nx) {
        let own = cell(i, j, k);
        if i + 1 < nx {
            inner.push((own, Some(cell(i + 1, j, k)), across(i + 1, j, k)));
        } else {
            side.push((own, None, across(nx, j, k)));
        }
        if i == 0 {
            side.push((own, None, reversed(across(0, j, k))));
        }
        if j + 1 < ny {
            inner.push((own, Some(cell(i, j + 1, k)), along_y(i, j + 1, k)));
        } else {
            side.push((own, None, along_y(i, ny, k)));
        }
        if j == 0 {
            side.push((own, None, reversed(along_y(i, 0, k))));
        }
        if k + 1 < nz {
            inner.push((own, Some(cell(i, j, k + 1)), along_z(i, j, k + 1)));
        } else {
            top.push((own, None, along_z(i, j, nz)));
        }
        if k == 0 {
            bottom.push((own, None, reversed(along_z(i, j, 0))));
        }
    }
    finish(topology.points, [inner, side, bottom, top])
}

/// A face: owner, neighbour, points.
type Face<P> = (u32, Option<u32>, P);

/// The mesh of internal faces, then those of `side`, `bottom`, `top`.
fn finish<P: AsRef<[u32]>>(points: Vec<Vec3>, faces: [Vec<Face<P>>; 4]) -> Mesh {
    let mut topology = Topology {
        points,
        face_offsets: vec![0],
        ..Topology::default()
    };
    let mut start = faces[0].len();
    for (name, list) in ["side", "bottom", "top"].into_iter().zip(&faces[1..]) {
        topology.patches.push(Patch {
            name: name.into(),
            start,
            count: list.len(),
        });
        start += list.len();
    }
    for (owner, neighbour, points) in faces.into_iter().flatten() {
        topology.owner.push(owner);
        topology.neighbour.extend(neighbour);
        topology.face_points.extend(points.as_ref());
        let end = topology.face_points.len() as u32;
        topology.face_offsets.push(end);
    }
    Mesh::new(topology).unwrap()
}

/// The same duct of twelve layers, each of two prisms on either side of a diagonal.
pub fn prisms() -> Mesh {
    let layers = CELLS[2] as u32;
    let mut points = Vec::new();
    for layer in 0..=layers {
        let z = f64::from(layer) * SIZE[2] / f64::from(layers);
        for (x, y) in [
            (0.0, 0.0),
            (SIZE[0], 0.0),
            (SIZE[0], SIZE[1]),
            (0.0, SIZE[1]),
        ] {
            points.push(Vec3::new(x, y, z));
        }
    }
    let (mut inner, mut side, mut bottom, mut top) = (vec![], vec![], vec![], vec![]);
    for layer in 0..layers {
        let (low, high) = (4 * layer, 4 * layer + 4);
        // The walls of corner a to corner b, seen from outside.
        let wall = |a: u32, b: u32| vec![low + a, low + b, high + b, high + a];
        let (right, left) = (2 * layer, 2 * layer + 1);
        inner.push((right, Some(left), wall(2, 0)));
        side.extend([(right, None, wall(0, 1)), (right, None, wall(1, 2))]);
        side.extend([(left, None, wall(2, 3)), (left, None, wall(3, 0))]);
        for (cell, corners) in [(right, [0, 1, 2]), (left, [0, 2, 3])] {
            let lid = corners.map(|corner| high + corner).to_vec();
            if layer + 1 < layers {
                inner.push((cell, Some(cell + 2), lid));
            } else {
                top.push((cell, None, lid));
            }
            if layer == 0 {
                bottom.push((cell, None, corners.into_iter().rev().collect()));
            }
        }
    }
    finish(points, [inner, side, bottom, top])
}

fn triples(a: usize, b: usize, c: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..a).flat_map(move |k| (0..b).flat_map(move |j| (0..c).map(move |i| (k, j, i))))
}

fn reversed(mut points: [u32; 4]) -> [u32; 4] {
    points.reverse();
    points
}
