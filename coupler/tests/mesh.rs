//! Meshes: generated boxes and polyMesh folders.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Command;

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

const FILES: [&str; 5] = ["points", "faces", "owner", "neighbour", "boundary"];

/// A written mesh, one file of it changed.
fn with(folder: &Path, file: &str, change: impl FnOnce(String) -> Vec<u8>) {
    write(&mesh([2, 1, 1]), folder).unwrap();
    let text = fs::read_to_string(folder.join(file)).unwrap();
    fs::write(folder.join(file), change(text)).unwrap();
}

fn error_after(file: &str, change: impl FnOnce(String) -> Vec<u8>) -> PolyMeshError {
    let folder = tempfile::tempdir().unwrap();
    with(folder.path(), file, change);
    read(folder.path()).unwrap_err()
}

/// A file's header in the given format, and its class.
fn header(class: &str, format: &str) -> Vec<u8> {
    format!(
        "/* banner */\nFoamFile\n{{\n version 2.0;\n format {format};\n class {class};\n \
         arch \"LSB;label=32;scalar=64\";\n note \"a;b\";\n}}\n// * * *\n\n"
    )
    .into_bytes()
}

/// A binary list as OpenFOAM 1912 writes it.
fn raw(count: usize, bytes: impl IntoIterator<Item = u8>) -> Vec<u8> {
    let mut list = format!("{count}\n(").into_bytes();
    list.extend(bytes);
    list.extend(b")\n");
    list
}

fn raw_labels(labels: &[u32]) -> Vec<u8> {
    raw(
        labels.len(),
        labels.iter().flat_map(|label| label.to_le_bytes()),
    )
}

#[test]
fn binary_files_and_compact_faces_read_as_the_same_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = mesh([2, 3, 1]);
    write(&mesh, folder.path()).unwrap();
    let topology = mesh.topology();
    let put = |name: &str, class: &str, body: Vec<u8>| {
        fs::write(
            folder.path().join(name),
            [header(class, "binary"), body].concat(),
        )
        .unwrap();
    };
    let coordinates = topology.points.iter().flat_map(|p| [p.x, p.y, p.z]);
    let bytes: Vec<u8> = coordinates.flat_map(f64::to_le_bytes).collect();
    put("points", "vectorField", raw(topology.points.len(), bytes));
    let faces = [
        raw_labels(&topology.face_offsets),
        raw_labels(&topology.face_points),
    ];
    put("faces", "faceCompactList", faces.concat());
    put("owner", "labelList", raw_labels(&topology.owner));
    put("neighbour", "labelList", raw_labels(&topology.neighbour));
    assert_eq!(read(folder.path()).unwrap(), mesh);
}

#[test]
fn comments_lists_without_length_and_uniform_lists_are_read() {
    let folder = tempfile::tempdir().unwrap();
    with(folder.path(), "owner", |text| {
        let list = text.find("11\n(").unwrap();
        let text = format!("{}/* eleven */ {}", &text[..list], &text[list + 3..]);
        text.replacen('(', "( // faces\n", 1).into_bytes()
    });
    let neighbour = folder.path().join("neighbour");
    fs::write(
        &neighbour,
        [header("labelList", "ascii"), b"1{1}".to_vec()].concat(),
    )
    .unwrap();
    let boundary = folder.path().join("boundary");
    let text = fs::read_to_string(&boundary).unwrap().replace(
        "type            patch;",
        "type wall; inGroups List<word> 1(wall); extra { deep { a 1; } }",
    );
    fs::write(&boundary, text).unwrap();
    assert_eq!(read(folder.path()).unwrap(), mesh([2, 1, 1]));
}

#[test]
fn errors_name_the_file_and_the_line() {
    let text = |error: PolyMeshError| error.to_string();
    // The list of the file `owner` begins on line 12, its entries on line 13.
    let error = text(error_after("owner", |text| {
        text.replacen("\n0\n", "\n0.5\n", 1).into_bytes()
    }));
    assert!(
        error.ends_with("owner, line 13: expected a label, 0 or more, found `0.5`"),
        "{error}"
    );
    let error = text(error_after("points", |text| {
        text.replacen("12\n(", "13\n(", 1).into_bytes()
    }));
    assert!(
        error.contains("points, line 24: a list of 12 entries that announces 13"),
        "{error}"
    );
    let error = text(error_after("boundary", |text| {
        text.replace("nFaces", "faces").into_bytes()
    }));
    assert!(error.contains("patch `side` lacks `nFaces`"), "{error}");
    let error = text(error_after("faces", |_| b"1 ( )".to_vec()));
    assert!(
        error.contains("faces, line 1: expected the header `FoamFile`"),
        "{error}"
    );
    let error = text(error_after("neighbour", |text| {
        text.replace("ascii", "xml").into_bytes()
    }));
    assert!(
        error.contains("only `ascii` and `binary` are known"),
        "{error}"
    );
    let error = text(error_after("owner", |text| (text + "1").into_bytes()));
    assert!(error.contains("text after the end of the list"), "{error}");
    let error = text(error_after("boundary", |text| {
        text.replace("3\n(", "4\n(").into_bytes()
    }));
    assert!(
        error.contains("a list of 3 entries that announces 4"),
        "{error}"
    );
}

#[test]
fn lists_that_announce_a_million_million_entries_are_refused_before_they_are_stored() {
    for count in ["1000000000000", "18446744073709551615"] {
        for file in ["points", "faces", "owner", "neighbour", "boundary"] {
            let error = error_after(file, |text| {
                let (head, list) = text.split_once("\n(").unwrap();
                let (head, _) = head.rsplit_once('\n').unwrap();
                format!("{head}\n{count}\n({list}").into_bytes()
            });
            let text = error.to_string();
            assert!(text.contains(&format!("announces {count}")), "{text}");
        }
        let body = format!("{count}\n(\0\0\0\0)").into_bytes();
        let binary = [header("vectorField", "binary"), body].concat();
        let text = error_after("points", |_| binary).to_string();
        assert!(
            text.contains("the file ends within a binary list"),
            "{text}"
        );
    }
    // One value for all is stored as often as there are faces at most.
    let uniform = [header("labelList", "ascii"), b"1000000000000{0}".to_vec()].concat();
    let text = error_after("owner", |_| uniform).to_string();
    assert!(
        text.contains("a list of 1000000000000 equal entries; at most 12"),
        "{text}"
    );
}

#[test]
fn offsets_of_faces_up_to_the_largest_number_are_refused() {
    for offset in [u32::MAX, u32::MAX - 1, 1, 2] {
        let mut topology = mesh([2, 1, 1]).topology().clone();
        topology.face_offsets[1] = offset;
        let error = Mesh::new(topology).unwrap_err().to_string();
        assert!(error.contains("at least three points"), "{error}");
    }
}

#[test]
fn files_that_contradict_each_other_and_missing_ones_are_named() {
    let error = error_after("owner", |text| {
        text.replacen("\n0\n", "\n7\n", 1).into_bytes()
    });
    assert!(matches!(error, PolyMeshError::Mesh { .. }), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let error = read(folder.path()).unwrap_err();
    assert!(matches!(&error, PolyMeshError::Io { file, .. } if file.ends_with("points")));
}

/// Runs one of Debian's OpenFOAM tools on a case with this mesh, written in `format`; its output, or
/// `None` where it is not installed.
fn openfoam(case: &Path, mesh: &Mesh, format: &str, command: &[&str]) -> Option<String> {
    write(mesh, &case.join("constant/polyMesh")).unwrap();
    fs::create_dir(case.join("system")).unwrap();
    let control = format!(
        "startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;\n\
         writeControl timeStep; writeInterval 1; writeFormat {format};\n"
    );
    let schemes = "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {}\n";
    let dictionaries = [
        ("controlDict", control.as_str()),
        ("fvSchemes", schemes),
        ("fvSolution", "solvers {}\n"),
    ];
    for (name, body) in dictionaries {
        let head = "FoamFile\n{\n version 2.0;\n format ascii;\n class dictionary;\n object ";
        let text = format!("{head}{name};\n}}\n{body}");
        fs::write(case.join("system").join(name), text).unwrap();
    }
    let output = Command::new(command[0])
        .args(&command[1..])
        .arg("-case")
        .arg(case)
        .env("WM_PROJECT_DIR", "/usr/share/openfoam")
        // OpenFOAM takes no working directory with a space in its path.
        .current_dir(case)
        .env("PWD", case)
        .output();
    let Ok(output) = output else {
        eprintln!("SKIPPED: {} is not installed", command[0]);
        return None;
    };
    let said = [output.stdout, output.stderr].concat();
    Some(String::from_utf8_lossy(&said).into_owned())
}

/// Debian's checkMesh, where it is installed, as an independent judge of the numbering.
#[test]
fn openfoam_accepts_a_written_box() {
    let case = tempfile::tempdir().unwrap();
    let command = ["checkMesh", "-allGeometry", "-allTopology"];
    if let Some(text) = openfoam(case.path(), &mesh([4, 3, 5]), "ascii", &command) {
        assert!(text.contains("Mesh OK."), "{text}");
        assert!(text.contains("hexahedra:     60"), "{text}");
        assert!(!text.contains("***"), "{text}");
    }
}

#[test]
fn a_mesh_that_openfoam_converted_to_binary_reads_back_to_the_bit() {
    let case = tempfile::tempdir().unwrap();
    let written = mesh([4, 3, 5]);
    let command = ["foamFormatConvert", "-constant"];
    if let Some(text) = openfoam(case.path(), &written, "binary", &command) {
        let folder = case.path().join("constant/polyMesh");
        let points = fs::read(folder.join("points")).unwrap();
        let binary = points.windows(6).any(|bytes| bytes == b"binary");
        assert!(binary, "{text}");
        assert_eq!(read(&folder).unwrap(), written);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn mutated_files_never_panic(
        file in 0..FILES.len(),
        binary in any::<bool>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..4u8, any::<u8>()), 1..6),
    ) {
        let folder = tempfile::tempdir().unwrap();
        with(folder.path(), FILES[file], |text| {
            let text = if binary { text.replace("ascii", "binary") } else { text };
            let mut bytes = text.into_bytes();
            for (at, kind, byte) in edits {
                if bytes.is_empty() {
                    break;
                }
                let at = at.index(bytes.len());
                match kind {
                    0 => bytes[at] = byte,
                    1 => bytes[at] = b"0123456789(){};/*\" -e."[byte as usize % 22],
                    2 => drop(bytes.remove(at)),
                    _ => bytes.truncate(at),
                }
            }
            bytes
        });
        // Either a mesh or an error that says where.
        if let Err(error) = read(folder.path()) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}
