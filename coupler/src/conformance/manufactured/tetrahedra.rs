//! Boxes of tetrahedra: Kuhn's six in place of each hexahedron.

use calcine_physics::Vec3;

use super::meshes::{RawFace, joined, mean, tetrahedra, triangles};
use crate::mesh::block::{BoxSpec, box_mesh};
use crate::mesh::{Mesh, MeshError};

/// The box with six tetrahedra in place of each hexahedron, its points as `displaced` puts them.
pub fn tetrahedron_box(
    spec: &BoxSpec,
    displaced: impl Fn(Vec3) -> Vec3,
) -> Result<Mesh, MeshError> {
    let upright = box_mesh(spec)?;
    let points = upright.topology().points.clone();
    let patches = upright.patches().iter();
    let names: Vec<&str> = patches.map(|patch| patch.name.as_str()).collect();
    let cells = tetrahedra(spec.cells);
    let face = |(key, beside): (&[u32; 3], &Vec<u32>)| {
        let out = mean(&points, key) - mean(&points, &cells[beside[0] as usize]);
        let side = side(spec, key);
        let found = side.and_then(|side| names.iter().position(|name| *name == spec.patches[side]));
        RawFace {
            owner: beside[0],
            neighbour: beside.get(1).copied(),
            patch: found.unwrap_or_default(),
            points: key.to_vec(),
            out,
        }
    };
    let faces = triangles(&cells).iter().map(face).collect();
    Mesh::new(joined(points, faces, &names, displaced))
}

/// The side of the box that a triangle of its points is on.
fn side(spec: &BoxSpec, triangle: &[u32; 3]) -> Option<usize> {
    let [nx, ny, _] = spec.cells.map(|count| count + 1);
    let place = |point: u32| {
        let point = point as usize;
        [point % nx, point / nx % ny, point / (nx * ny)]
    };
    let on = |axis: usize, at: usize| triangle.iter().all(|&point| place(point)[axis] == at);
    (0..6).find(|side| on(side / 2, (side % 2) * spec.cells[side / 2]))
}

#[cfg(test)]
mod tests {
    use super::super::prisms::prism_box;
    use super::*;

    #[test]
    fn prisms_and_tetrahedra_fill_the_box() {
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(2.0, 1.0, 0.5),
            cells: [4, 3, 2],
            patches: ["in", "out", "wall", "wall", "floor", "lid"].map(str::to_owned),
        };
        let prisms = prism_box(&spec, |point| point).unwrap();
        let tetrahedra = tetrahedron_box(&spec, |point| point).unwrap();
        for (mesh, of_each) in [(prisms, 2), (tetrahedra, 6)] {
            assert_eq!(mesh.cells(), of_each * 24);
            let each = 1.0 / (24 * of_each) as f64;
            let alike = |volume: &f64| (volume - each).abs() < 1e-15;
            assert!(mesh.cell_volume().iter().all(alike));
            for (name, area) in [
                ("in", Vec3::new(-0.5, 0.0, 0.0)),
                ("out", Vec3::new(0.5, 0.0, 0.0)),
                ("wall", Vec3::zeros()),
                ("floor", Vec3::new(0.0, 0.0, -2.0)),
                ("lid", Vec3::new(0.0, 0.0, 2.0)),
            ] {
                let faces = mesh.patch(name).unwrap().faces();
                let sum = faces.map(|face| mesh.face_area()[face]).sum::<Vec3>();
                assert!((sum - area).norm() < 1e-14, "{name}");
            }
        }
    }
}
