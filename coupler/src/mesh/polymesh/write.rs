//! Writing a polyMesh folder.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::error::PolyMeshError;
use crate::mesh::Mesh;

/// Writes the five files of a mesh, in ASCII, into a polyMesh folder, which is made if it is not
/// there. Coordinates are written with as many digits (at most 17) as read back to the same bits;
/// every patch gets the type `patch`, but joined ones `cyclic`.
pub fn write(mesh: &Mesh, dir: &Path) -> Result<(), PolyMeshError> {
    write_with(mesh, dir, |_| "patch")
}

/// The same with a type for each patch by its name, for example `wall`.
pub fn write_with(
    mesh: &Mesh,
    dir: &Path,
    kind: impl Fn(&str) -> &'static str,
) -> Result<(), PolyMeshError> {
    fs::create_dir_all(dir).map_err(|cause| PolyMeshError::Io {
        file: dir.to_path_buf(),
        cause,
    })?;
    let note = format!(
        "nPoints:{}  nCells:{}  nFaces:{}  nInternalFaces:{}",
        mesh.topology().points.len(),
        mesh.cells(),
        mesh.faces(),
        mesh.internal_faces()
    );
    let files = [
        ("points", "vectorField", None, points(mesh)),
        ("faces", "faceList", None, faces(mesh)),
        ("owner", "labelList", Some(&note), labels(mesh.owner())),
        (
            "neighbour",
            "labelList",
            Some(&note),
            labels(mesh.neighbour()),
        ),
        ("boundary", "polyBoundaryMesh", None, boundary(mesh, kind)),
    ];
    for (name, class, note, body) in files {
        let file = dir.join(name);
        let text = format!("{}\n{body}\n", header(name, class, note));
        fs::write(&file, text).map_err(|cause| PolyMeshError::Io { file, cause })?;
    }
    Ok(())
}

fn header(object: &str, class: &str, note: Option<&String>) -> String {
    let note = note.map_or(String::new(), |note| {
        format!("    note        \"{note}\";\n")
    });
    format!(
        "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {class};\n\
         {note}    location    \"constant/polyMesh\";\n    object      {object};\n}}\n"
    )
}

// Writing into a String cannot fail, so the results of write! below carry nothing.

/// A number that OpenFOAM reads as the same bits. It rounds what it reads to an extended double first and to a double then: the
/// shortest digits of a double may become its neighbour so.
fn digits(value: f64) -> String {
    match value == 0.0 {
        true => "0".to_owned(),
        false => format!("{value:.19e}"),
    }
}

fn points(mesh: &Mesh) -> String {
    let points = &mesh.topology().points;
    let mut text = format!("{}\n(\n", points.len());
    for point in points {
        let _ = writeln!(
            text,
            "({} {} {})",
            digits(point.x),
            digits(point.y),
            digits(point.z)
        );
    }
    text + ")\n"
}

fn faces(mesh: &Mesh) -> String {
    let mut text = format!("{}\n(\n", mesh.faces());
    for face in 0..mesh.faces() {
        let points: Vec<_> = mesh.face_points(face).iter().map(u32::to_string).collect();
        let _ = writeln!(text, "{}({})", points.len(), points.join(" "));
    }
    text + ")\n"
}

fn labels(list: &[u32]) -> String {
    let mut text = format!("{}\n(\n", list.len());
    for label in list {
        let _ = writeln!(text, "{label}");
    }
    text + ")\n"
}

fn boundary(mesh: &Mesh, kind: impl Fn(&str) -> &'static str) -> String {
    let mut text = format!("{}\n(\n", mesh.patches().len());
    for patch in mesh.patches() {
        let partner = mesh.partner(patch);
        let kind = partner.map_or_else(|| kind(&patch.name), |_| "cyclic");
        let more = partner.map_or_else(String::new, |partner| {
            format!("        neighbourPatch  {};\n", partner.name)
        });
        let _ = writeln!(
            text,
            "    {}\n    {{\n        type            {kind};\n        nFaces          {};\n        \
             startFace       {};\n{more}    }}",
            patch.name, patch.count, patch.start
        );
    }
    text + ")\n"
}
