//! The files that a case reads, and what is in them: a changed bed, mesh or wall is another case.

use std::collections::BTreeMap;

use calcine_coupler::motion::WallShape;
use sha2::{Digest, Sha256};

use super::model::{Case, MeshSpec, PlacementSpec};

/// SHA-256 (hex) of what each file of a case holds, by its path; of the triangles of a wall, scale applied, by the key of the
/// wall.
pub(super) fn sums(case: &Case) -> BTreeMap<String, String> {
    let places = case.particles.iter().filter_map(|one| match &one.place {
        PlacementSpec::File { path, .. } => Some(path.clone()),
        _ => None,
    });
    let mesh = match &case.mesh {
        MeshSpec::PolyMesh(folder) => ["points", "faces", "owner", "neighbour", "boundary"]
            .map(|name| folder.join(name))
            .to_vec(),
        MeshSpec::Box { .. } | MeshSpec::Cylinder { .. } => Vec::new(),
    };
    let files = places.chain(mesh).chain(case.gas_files.iter().cloned());
    let mut sums: BTreeMap<String, String> = files
        .map(|file| {
            // A file that cannot be read is an error of the mesh or of the bed, told there.
            let content = std::fs::read(&file).unwrap_or_default();
            let name = file.strip_prefix(directory(case)).unwrap_or(&file);
            (name.display().to_string(), hex(Sha256::digest(content)))
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

fn directory(case: &Case) -> &std::path::Path {
    case.path.parent().unwrap_or(&case.path)
}

/// A hash extended by those of files; as it is where there are none.
pub(super) fn extended(hash: String, sums: &BTreeMap<String, String>) -> String {
    if sums.is_empty() {
        return hash;
    }
    let mut digest = Sha256::new();
    digest.update(hash.as_bytes());
    for sum in sums.values() {
        digest.update(sum.as_bytes());
    }
    hex(digest.finalize())
}

/// Bytes in hexadecimal digits.
pub(super) fn hex(bytes: impl IntoIterator<Item = u8>) -> String {
    let digits = bytes.into_iter().map(|byte| format!("{byte:02x}"));
    digits.collect()
}
