//! Locally refined boxes and cylinders.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::HashMap;
use std::fs;
use std::process::Command;

use calcine_coupler::mapping::{Mapper, Method};
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::mesh::cylinder::{CylinderSpec, cylinder_mesh};
use calcine_coupler::mesh::grading::{Stretch, shared, uniform};
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::mesh::polymesh::{read, write};
use calcine_coupler::mesh::refine::{Refinement, refine};
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::mesh::{Mesh, MeshError};
use calcine_coupler::physics::Vec3;

fn plain() -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::new(-0.5, 0.0, 1.0),
        size: Vec3::new(0.6, 0.5, 0.7),
        cells: [6, 5, 7],
        patches: ["a", "side", "side", "b", "bottom", "top"].map(String::from),
    })
    .unwrap()
}

fn tube() -> Mesh {
    cylinder_mesh(&CylinderSpec {
        origin: Vec3::new(0.01, -0.02, 0.1),
        diameter: 0.05,
        length: 0.1,
        cells_across: 8,
        along: uniform(10),
        patches: ["side", "bottom", "top"].map(String::from),
    })
    .unwrap()
}

fn part(low: [f64; 3], high: [f64; 3], levels: u32) -> Refinement {
    let (low, high) = (Vec3::from(low), Vec3::from(high));
    let zone = Zone::Box { low, high };
    Refinement { zone, levels }
}

/// A corner of the box split thrice, a part inside it once.
fn refined_box() -> Mesh {
    let corner = part([-0.5, 0.0, 1.0], [-0.4, 0.1, 1.1], 3);
    refine(
        &plain(),
        &[corner, part([-0.2, 0.2, 1.3], [0.0, 0.4, 1.5], 1)],
    )
    .unwrap()
}

fn refined_tube() -> Mesh {
    let zone = Zone::Cylinder {
        from: Vec3::new(0.01, -0.02, 0.13),
        to: Vec3::new(0.02, -0.02, 0.17),
        radius: 0.012,
    };
    let near_the_wall = part([-0.02, -0.01, 0.1], [0.04, 0.01, 0.12], 1);
    refine(&tube(), &[Refinement { zone, levels: 2 }, near_the_wall]).unwrap()
}

/// (coarse mesh, refined mesh)
fn both() -> [(Mesh, Mesh); 2] {
    [(plain(), refined_box()), (tube(), refined_tube())]
}

#[test]
fn volume_and_patch_areas_stay() {
    for (coarse, fine) in both() {
        assert!(fine.cells() > coarse.cells());
        let volume = |mesh: &Mesh| mesh.cell_volume().iter().sum::<f64>();
        assert!((volume(&fine) / volume(&coarse) - 1.0).abs() < 1e-13);
        for patch in coarse.patches() {
            let area = |mesh: &Mesh| {
                let faces = mesh.patch(&patch.name).unwrap().faces();
                faces.map(|face| mesh.face_area()[face]).sum::<Vec3>()
            };
            assert!(
                (area(&fine) - area(&coarse)).norm() < 1e-13,
                "{}",
                patch.name
            );
        }
    }
}

#[test]
fn cells_of_a_box_have_the_sizes_of_their_levels_two_to_one_at_most() {
    let mesh = refined_box();
    let level = |cell: usize| (1e-3 / mesh.cell_volume()[cell]).log2() / 3.0;
    let mut count = HashMap::new();
    for cell in 0..mesh.cells() {
        assert!((level(cell) - level(cell).round()).abs() < 1e-9);
        *count.entry(level(cell).round() as u32).or_insert(0) += 1;
    }
    // The corner's cell in 8³. Balance splits the seven cells around it, the children that touch it
    // once more: 4 for each of the 3 cells at its sides, 2 at its edges, 1 at its corner.
    assert_eq!(count[&3], 512);
    assert_eq!(count[&2], 8 * (3 * 4 + 3 * 2 + 1));
    for (face, &other) in mesh.neighbour().iter().enumerate() {
        let difference = level(mesh.owner()[face] as usize) - level(other as usize);
        assert!(difference.abs() < 1.0 + 1e-9);
    }
}

#[test]
fn every_edge_of_a_cell_belongs_to_two_of_its_faces_once_in_each_direction() {
    for (_, mesh) in both() {
        for cell in 0..mesh.cells() {
            let mut edges = HashMap::new();
            for &face in mesh.faces_of(cell) {
                let face = face as usize;
                let points = mesh.face_points(face);
                let sign = if mesh.owner()[face] as usize == cell {
                    1
                } else {
                    -1
                };
                for i in 0..points.len() {
                    let (a, b) = (points[i], points[(i + 1) % points.len()]);
                    let turn = if a < b { sign } else { -sign };
                    let entry = edges.entry([a.min(b), a.max(b)]).or_insert((0, 0));
                    *entry = (entry.0 + turn, entry.1 + 1);
                }
            }
            assert!(edges.values().all(|&found| found == (0, 2)), "cell {cell}");
        }
    }
}

#[test]
fn internal_faces_are_in_upper_triangular_order() {
    for (_, mesh) in both() {
        let pairs: Vec<_> = mesh.owner().iter().zip(mesh.neighbour()).collect();
        assert!(pairs.is_sorted());
        assert!(pairs.iter().all(|(owner, neighbour)| owner < neighbour));
    }
}

#[test]
fn every_cell_is_found_at_its_centre_and_near_its_faces() {
    for (_, mesh) in both() {
        let locator = Locator::new(&mesh);
        for cell in 0..mesh.cells() {
            let centre = mesh.cell_centre()[cell];
            assert_eq!(locator.cell_at(centre), Some(cell));
            for &face in mesh.faces_of(cell) {
                let near = 0.99 * mesh.face_centre()[face as usize] + 0.01 * centre;
                assert_eq!(locator.cell_at(near), Some(cell));
            }
        }
    }
}

/// A mesh of five sizes of cells, so that bins of one size are crowded somewhere: what the locator
/// finds is what a search over all cells finds.
#[test]
fn the_locator_finds_all_cells_near_a_ball_whatever_their_sizes() {
    let mesh = refine(&plain(), &[part([-0.5, 0.0, 1.0], [-0.35, 0.15, 1.15], 4)]).unwrap();
    let locator = Locator::new(&mesh);
    let boxes: Vec<[Vec3; 2]> = (0..mesh.cells())
        .map(|cell| {
            let faces = mesh.faces_of(cell).iter();
            let points = faces.flat_map(|&face| mesh.face_points(face as usize));
            let infinity = Vec3::repeat(f64::INFINITY);
            points.fold([infinity, -infinity], |[low, high], &point| {
                let point = mesh.topology().points[point as usize];
                [low.inf(&point), high.sup(&point)]
            })
        })
        .collect();
    for cell in (0..mesh.cells()).step_by(97) {
        let centre = mesh.cell_centre()[cell] + Vec3::new(1e-4, 2e-4, -1e-4);
        for radius in [0.004, 0.03, 0.2] {
            let near =
                |[low, high]: &[Vec3; 2]| (centre.sup(low).inf(high) - centre).norm() < radius;
            let all = (0u32..).zip(&boxes).filter(|(_, ends)| near(ends));
            let expected: Vec<u32> = all.map(|(cell, _)| cell).collect();
            let mut found = vec![7];
            locator.cells_near(centre, radius, &mut found);
            assert_eq!(found, expected);
        }
        assert_eq!(locator.cell_at(mesh.cell_centre()[cell]), Some(cell));
    }
    assert_eq!(locator.cell_at(Vec3::new(-0.6, 0.1, 1.1)), None);
}

#[test]
fn a_ball_has_the_same_share_of_a_coarse_cell_whether_it_is_split_or_not() {
    for (coarse, fine) in both() {
        let locator = Locator::new(&coarse);
        let centre = fine.cell_centre()[fine.cells() / 2] + Vec3::new(1e-4, -2e-4, 3e-4);
        let radius = 0.7 * coarse.cell_volume()[0].cbrt();
        let weights = |mesh: &Mesh| {
            Mapper::new(mesh)
                .fill(Method::Overlap, &[centre], &[radius])
                .unwrap()
        };
        let mut shares = vec![0.0; coarse.cells()];
        for (cell, weight) in weights(&fine).of_particle(0) {
            shares[locator.cell_at(fine.cell_centre()[cell]).unwrap()] += weight;
        }
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for (cell, weight) in weights(&coarse).of_particle(0) {
            shares[cell] -= weight;
        }
        assert!(shares.iter().all(|rest| rest.abs() < 1e-12), "{shares:?}");
    }
}

#[test]
fn nothing_to_split_leaves_the_mesh_as_it_is() {
    let mesh = plain();
    let same = refine(&mesh, &[]).unwrap();
    assert_eq!(same.owner(), mesh.owner());
    assert_eq!(same.neighbour(), mesh.neighbour());
    assert_eq!(same.patches(), mesh.patches());
    let pairs = same.cell_centre().iter().zip(mesh.cell_centre());
    pairs.for_each(|(a, b)| assert!((a - b).norm() < 1e-14));
}

#[test]
fn regions_without_a_cell_and_meshes_without_hexahedra_are_refused() {
    let error = refine(&plain(), &[part([9.0; 3], [10.0; 3], 1)]).unwrap_err();
    assert!(error.to_string().contains("region 0 holds no centre"));
    let deep = part([-0.5, 0.0, 1.0], [-0.4, 0.1, 1.1], 7);
    assert!(
        refine(&plain(), &[deep])
            .unwrap_err()
            .to_string()
            .contains("more than 6 times")
    );
    let MeshError::Inconsistent(text) = refine(&refined_box(), &[deep]).unwrap_err() else {
        panic!("not the error expected");
    };
    assert!(text.contains("no hexahedron"));
}

#[test]
fn cells_are_shared_out_by_the_largest_remainders() {
    let stretch = |cell_share| Stretch {
        length_share: 1.0,
        cell_share,
        expansion: 1.0,
    };
    let counts = |cells, shares: &[f64]| {
        let all: Vec<_> = shares.iter().map(|&share| stretch(share)).collect();
        let regions = shared(cells, &all).unwrap();
        regions
            .iter()
            .map(|region| region.cells)
            .collect::<Vec<_>>()
    };
    assert_eq!(counts(10, &[1.0, 1.0, 1.0]), [4, 3, 3]);
    assert_eq!(counts(10, &[0.26, 0.48, 0.26]), [3, 5, 2]);
    assert_eq!(counts(4, &[1e-9, 1.0, 1e-9]), [1, 2, 1]);
    assert_eq!(counts(7, &[]), [7]);
    assert!(shared(2, &[stretch(1.0); 3]).is_err());
    assert!(shared(9, &[stretch(0.0), stretch(1.0)]).is_err());
}

/// Debian's checkMesh, where it is installed, as an independent judge.
#[test]
fn openfoam_accepts_refined_boxes_and_cylinders() {
    for (_, mesh) in both() {
        let case = tempfile::tempdir().unwrap();
        let folder = case.path().join("constant/polyMesh");
        write(&mesh, &folder).unwrap();
        assert_eq!(read(&folder).unwrap().topology(), mesh.topology());
        fs::create_dir(case.path().join("system")).unwrap();
        let control = "startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;\n\
                       writeControl timeStep; writeInterval 1;\n";
        let schemes = "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {}\n";
        for (name, body) in [
            ("controlDict", control),
            ("fvSchemes", schemes),
            ("fvSolution", "solvers {}\n"),
        ] {
            let head = "FoamFile\n{\n version 2.0;\n format ascii;\n class dictionary;\n object ";
            let text = format!("{head}{name};\n}}\n{body}");
            fs::write(case.path().join("system").join(name), text).unwrap();
        }
        let output = Command::new("checkMesh")
            .args(["-allTopology", "-allGeometry", "-case"])
            .arg(case.path())
            .env("WM_PROJECT_DIR", "/usr/share/openfoam")
            // OpenFOAM takes no working directory with a space in its path.
            .current_dir(case.path())
            .env("PWD", case.path())
            .output();
        let Ok(output) = output else {
            eprintln!("SKIPPED: checkMesh is not installed");
            return;
        };
        let text = String::from_utf8_lossy(&output.stdout);
        // Of all its checks one objects, to parts of a face lying in one plane, as in any mesh that
        // OpenFOAM itself has refined; it is none of those that checkMesh makes by default.
        let failed: Vec<_> = text.lines().filter(|line| line.contains("***")).collect();
        let planar = " ***Concave cells (using face planes) found";
        let fine = failed.iter().all(|line| line.starts_with(planar));
        assert!(fine && failed.len() == 1, "{text}");
        assert!(text.contains("Failed 1 mesh checks."), "{text}");
    }
}
