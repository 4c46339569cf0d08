//! The files that a case reads, and what is in them: a changed bed, mesh, wall, template or script is another case.

use calcine_coupler::regular_file;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use calcine_coupler::motion::WallShape;
use sha2::{Digest, Sha256};

use super::model::{Case, MeshSpec, PlacementSpec};
use crate::hex::hex;

/// Folders of a template or a start for OpenFOAM that are looked through, with all that is in them.
const OPENFOAM: [&str; 3] = ["0", "constant", "system"];

/// SHA-256 (hex) of what each file of a case holds, by the key of the case that names it, wherever the file lies; of a wall
/// of triangles, scale applied.
pub(super) fn sums(case: &Case) -> BTreeMap<String, String> {
    let mut files: Vec<(String, PathBuf)> = Vec::new();
    for population in &case.particles {
        if let PlacementSpec::File { path, .. } = &population.place {
            let key = format!("particles.{}.place.file", population.name);
            files.push((key, path.clone()));
        }
    }
    if let MeshSpec::PolyMesh(folder) = &case.mesh {
        for name in ["points", "faces", "owner", "neighbour", "boundary"] {
            files.push((format!("mesh.polymesh/{name}"), folder.join(name)));
        }
    }
    for (index, file) in case.gas_files.iter().enumerate() {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        files.push((format!("gas/{}/{name}", index + 1), file.clone()));
    }
    let openfoam = [
        ("openfoam.template", &case.openfoam.template),
        ("openfoam.start", &case.openfoam.start),
    ];
    for (key, folder) in openfoam {
        let folder = folder.as_deref();
        for (name, folder) in folder.into_iter().flat_map(|folder| {
            let own = [(String::new(), folder.to_owned())];
            let parts = OPENFOAM.map(|part| (format!("/{part}"), folder.join(part)));
            own.into_iter().chain(parts)
        }) {
            let within = !name.is_empty();
            add_folder(&format!("{key}{name}"), &folder, within, &mut files);
        }
    }
    if let Some(script) = &case.liggghts.template {
        files.push(("liggghts.template".into(), script.clone()));
    }
    let mut sums: BTreeMap<String, String> = files
        .into_iter()
        .map(|(key, file)| {
            // A file that cannot be read is an error of the mesh or of the bed, told there.
            let content = regular_file::read(&file).unwrap_or_default();
            (key, hex(Sha256::digest(content)))
        })
        .collect();
    for wall in &case.walls {
        if let WallShape::Mesh { triangles } = &wall.shape {
            let mut digest = Sha256::new();
            for value in triangles.iter().flatten().flat_map(|corner| corner.iter()) {
                digest.update(value.to_le_bytes());
            }
            sums.insert(format!("walls.{}.stl", wall.name), hex(digest.finalize()));
        }
    }
    sums
}

/// The files of a folder, and of those within it where told.
fn add_folder(key: &str, folder: &Path, within: bool, files: &mut Vec<(String, PathBuf)>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name());
        let key = format!("{key}/{}", name.to_string_lossy());
        if path.is_file() {
            files.push((key, path));
        } else if within && path.is_dir() {
            add_folder(&key, &path, within, files);
        }
    }
}

/// A hash extended by those of files; as it is where there are none.
pub(super) fn extended(hash: String, sums: &BTreeMap<String, String>) -> String {
    if sums.is_empty() {
        return hash;
    }
    let mut digest = Sha256::new();
    digest.update(hash.as_bytes());
    for (name, sum) in sums {
        digest.update(name.as_bytes());
        digest.update(sum.as_bytes());
    }
    hex(digest.finalize())
}
