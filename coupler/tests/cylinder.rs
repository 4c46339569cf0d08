//! Cylinders and graded boxes.

#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_4, PI};
use std::fs;
use std::process::Command;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::mesh::cylinder::{
    CylinderSpec, GradedBoxSpec, cylinder_mesh, graded_box_mesh, outline,
};
use calcine_coupler::mesh::grading::{Region, levels, uniform};
use calcine_coupler::mesh::polymesh::write;
use calcine_coupler::physics::Vec3;

fn spec(across: usize, along: Vec<Region>) -> CylinderSpec {
    CylinderSpec {
        origin: Vec3::new(0.01, -0.02, 0.1),
        diameter: 0.05,
        length: 0.3,
        cells_across: across,
        along,
        patches: ["side", "bottom", "top"].map(String::from),
    }
}

/// Three regions, the middle one fine, sizes meeting at their ends.
fn fine_in_the_middle() -> Vec<Region> {
    let region = |share, cells, expansion| Region {
        share,
        cells,
        expansion,
    };
    vec![
        region(0.4, 8, 0.2),
        region(0.2, 20, 1.0),
        region(0.4, 8, 5.0),
    ]
}

fn mesh(across: usize) -> Mesh {
    cylinder_mesh(&spec(across, uniform(5))).unwrap()
}

/// Largest angle between a face's normal and the line of its cells' centres, in degrees.
fn non_orthogonality(mesh: &Mesh) -> f64 {
    let angle = |face: usize| {
        let [own, other] = [mesh.owner()[face], mesh.neighbour()[face]];
        let line = mesh.cell_centre()[other as usize] - mesh.cell_centre()[own as usize];
        line.angle(&mesh.face_area()[face]).to_degrees()
    };
    (0..mesh.internal_faces()).map(angle).fold(0.0, f64::max)
}

#[test]
fn a_cylinder_has_the_volume_of_its_diameter() {
    let exact = FRAC_PI_4 * 0.05 * 0.05 * 0.3;
    for across in [3, 8, 12, 33] {
        let volume: f64 = mesh(across).cell_volume().iter().sum();
        assert!((volume / exact - 1.0).abs() < 1e-12, "{across}: {volume}");
    }
}

#[test]
fn the_outline_of_a_cylinder_is_a_regular_polygon_of_its_area() {
    let mesh = mesh(8);
    let outline = outline(8);
    assert_eq!(outline.sides, 16);
    // A regular polygon of n sides whose corners are at R has the area n/2 R² sin(2π/n).
    let corners = outline.across_corners;
    assert!((8.0 * corners * corners * (PI / 8.0).sin() / PI - 1.0).abs() < 1e-14);
    let from_axis = |at: Vec3| (at - Vec3::new(0.01, -0.02, at.z)).norm() / 0.025;
    for face in mesh.patch("side").unwrap().faces() {
        assert!((from_axis(mesh.face_centre()[face]) - outline.across_sides).abs() < 1e-12);
    }
    let points = mesh.topology().points.iter();
    let farthest = points.map(|&at| from_axis(at)).fold(0.0, f64::max);
    assert!((farthest - corners).abs() < 1e-12);
}

#[test]
fn a_cylinder_is_orthogonal_within_45_degrees() {
    for across in 3..=40 {
        let angle = non_orthogonality(&mesh(across));
        assert!(angle < 45.0, "{across} across: {angle} degrees");
    }
}

#[test]
fn internal_faces_of_a_cylinder_are_in_upper_triangular_order() {
    let mesh = mesh(12);
    let pairs: Vec<_> = mesh.owner().iter().zip(mesh.neighbour()).collect();
    assert!(pairs.is_sorted());
    assert!(pairs.iter().all(|(owner, neighbour)| owner < neighbour));
}

#[test]
fn the_patches_of_a_cylinder_face_outwards() {
    let mesh = mesh(12);
    let names: Vec<_> = mesh.patches().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["side", "bottom", "top"]);
    for face in mesh.patch("side").unwrap().faces() {
        let mut from_axis = mesh.face_centre()[face] - Vec3::new(0.01, -0.02, 0.0);
        from_axis.z = 0.0;
        let cosine = from_axis
            .normalize()
            .dot(&mesh.face_area()[face].normalize());
        assert!(cosine > 1.0 - 1e-12);
    }
    for face in mesh.patch("bottom").unwrap().faces() {
        assert!(mesh.face_area()[face].z < 0.0 && (mesh.face_centre()[face].z - 0.1).abs() < 1e-15);
    }
    for face in mesh.patch("top").unwrap().faces() {
        assert!(mesh.face_area()[face].z > 0.0 && (mesh.face_centre()[face].z - 0.4).abs() < 1e-15);
    }
}

#[test]
fn an_expansion_is_the_ratio_of_the_last_cell_to_the_first() {
    let at = levels(1.0, 2.0, &fine_in_the_middle()).unwrap();
    assert_eq!(at.len(), 37);
    let size = |i: usize| at[i + 1] - at[i];
    assert!((size(7) / size(0) - 0.2).abs() < 1e-12);
    assert!((size(35) / size(28) - 5.0).abs() < 1e-12);
    assert!((at[8] - 1.8).abs() < 1e-14 && (at[28] - 2.2).abs() < 1e-14);
    assert!((size(1) / size(0) - 0.2f64.powf(1.0 / 7.0)).abs() < 1e-12);
    assert_eq!(at[36], 3.0);
}

#[test]
fn a_graded_box_of_equal_cells_is_the_plain_box() {
    let (origin, size) = (Vec3::new(-0.1, 0.3, 1.0), Vec3::new(0.3, 0.7, 1.1));
    let patches = ["a", "side", "side", "b", "bottom", "top"].map(String::from);
    let graded = graded_box_mesh(&GradedBoxSpec {
        origin,
        size,
        along: [uniform(3), uniform(4), uniform(5)],
        patches: patches.clone(),
    })
    .unwrap();
    let plain = box_mesh(&BoxSpec {
        origin,
        size,
        cells: [3, 4, 5],
        patches,
    })
    .unwrap();
    assert_eq!(graded.owner(), plain.owner());
    assert_eq!(graded.neighbour(), plain.neighbour());
    assert_eq!(graded.patches(), plain.patches());
    for (a, b) in graded.face_area().iter().zip(plain.face_area()) {
        assert!((a - b).norm() < 1e-14);
    }
}

#[test]
fn cylinders_that_cannot_be_are_refused_with_the_number() {
    let said = |change: fn(&mut CylinderSpec)| {
        let mut spec = spec(12, uniform(5));
        change(&mut spec);
        cylinder_mesh(&spec).unwrap_err().to_string()
    };
    assert!(said(|s| s.cells_across = 2).contains("2 cells across; it needs 3"));
    assert!(said(|s| s.diameter = -1.0).contains("-1 m diameter"));
    assert!(said(|s| s.length = f64::NAN).contains("NaN m"));
    assert!(said(|s| s.along.clear()).contains("0 regions"));
    assert!(said(|s| s.along[0].cells = 0).contains("region 0 has 0 cells"));
    assert!(said(|s| s.along[0].expansion = 0.0).contains("expansion of 0"));
    assert!(said(|s| s.along[0].cells = 4_000_000).contains("too many"));
}

/// Debian's checkMesh, where it is installed, as an independent judge.
#[test]
fn openfoam_accepts_a_locally_refined_cylinder() {
    let case = tempfile::tempdir().unwrap();
    let mesh = cylinder_mesh(&spec(12, fine_in_the_middle())).unwrap();
    write(&mesh, &case.path().join("constant/polyMesh")).unwrap();
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
        .args(["-allGeometry", "-allTopology", "-case"])
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
    assert!(text.contains("Mesh OK."), "{text}");
    assert!(
        text.contains(&format!("hexahedra:     {}", mesh.cells())),
        "{text}"
    );
}
