//! Meshes: generated boxes and polyMesh folders.

use std::fs;
use std::path::Path;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::mesh::polymesh::{PolyMeshError, read, write};
use calcine_coupler::physics::Vec3;
use proptest::prelude::*;

fn spec(cells: [usize; 3]) -> BoxSpec {
    BoxSpec {
        origin: Vec3::new(-0.1, 0.3, 1.0 / 3.0),
        size: Vec3::new(0.3, 0.7, 1.1),
        cells,
        patches: ["side", "side", "side", "side", "bottom", "top"].map(String::from),
    }
}

fn mesh(cells: [usize; 3]) -> Mesh {
    box_mesh(&spec(cells)).unwrap()
}

#[test]
fn the_cells_of_a_box_fill_it() {
    let mesh = mesh([3, 4, 5]);
    assert_eq!(mesh.cells(), 60);
    let each = 0.3 * 0.7 * 1.1 / 60.0;
    for (cell, volume) in mesh.cell_volume().iter().enumerate() {
        assert!((volume / each - 1.0).abs() < 1e-12, "cell {cell}: {volume}");
    }
    let first = Vec3::new(-0.05, 0.3875, 1.0 / 3.0 + 0.11);
    assert!((mesh.cell_centre()[0] - first).norm() < 1e-15);
}

#[test]
fn internal_faces_of_a_box_are_in_upper_triangular_order() {
    let mesh = mesh([3, 1, 4]);
    let pairs: Vec<_> = mesh.owner().iter().zip(mesh.neighbour()).collect();
    assert!(pairs.is_sorted());
    assert!(pairs.iter().all(|(owner, neighbour)| owner < neighbour));
}

#[test]
fn sides_of_equal_names_make_one_patch_with_outward_normals() {
    let mesh = mesh([2, 3, 4]);
    let names: Vec<_> = mesh.patches().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["side", "bottom", "top"]);
    let area = |name: &str| -> Vec3 {
        let faces = mesh.patch(name).unwrap().faces();
        faces.map(|face| mesh.face_area()[face]).sum()
    };
    assert!((area("top") - Vec3::new(0.0, 0.0, 0.21)).norm() < 1e-14);
    assert!((area("bottom") + Vec3::new(0.0, 0.0, 0.21)).norm() < 1e-14);
    assert_eq!(mesh.patch("side").unwrap().count, 2 * 4 * (2 + 3));
}

#[test]
fn a_box_without_cells_or_extent_is_refused() {
    let mut flat = spec([2, 0, 2]);
    assert!(
        box_mesh(&flat)
            .unwrap_err()
            .to_string()
            .contains("0 cells along y")
    );
    flat = spec([2, 2, 2]);
    flat.size.z = 0.0;
    assert!(
        box_mesh(&flat)
            .unwrap_err()
            .to_string()
            .contains("0 m along z")
    );
    let huge = box_mesh(&spec([usize::MAX - 1, 2, 2])).unwrap_err();
    assert!(huge.to_string().contains("too large"));
}

#[test]
fn a_written_mesh_reads_back_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = mesh([2, 3, 4]);
    write(&mesh, folder.path()).unwrap();
    assert_eq!(read(folder.path()).unwrap(), mesh);
}
