//! polyMesh folders: no five files make the reader panic, hang or ask for memory beyond measure,
//! and what it accepts is a mesh that can be worked with.

use std::fs;

use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::mesh::cylinder::{CylinderSpec, cylinder_mesh};
use calcine_coupler::mesh::grading::uniform;
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::mesh::{Mesh, polymesh};
use calcine_coupler::physics::Vec3;
use tempfile::TempDir;

use crate::mutate::mutate;
use crate::random::Random;
use crate::{Files, Target, scratch};

const FILES: [&str; 5] = ["points", "faces", "owner", "neighbour", "boundary"];

/// Folders of small meshes, ASCII and binary, and the folder that inputs are written to.
pub struct PolyMeshes {
    corpus: Vec<Files>,
    folder: TempDir,
}

impl PolyMeshes {
    pub fn new() -> Self {
        let mut corpus = Vec::new();
        for mesh in meshes() {
            corpus.push(ascii(&mesh));
            for (label, scalar) in [(4, 8), (8, 8), (4, 4), (8, 4)] {
                corpus.push(binary(&mesh, label, scalar));
            }
        }
        Self {
            corpus,
            folder: scratch(),
        }
    }
}

fn meshes() -> [Mesh; 3] {
    let block = |cells| {
        box_mesh(&BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(0.01, 0.02, 0.1),
            cells,
            patches: ["side", "side", "side", "side", "bottom", "top"].map(String::from),
        })
    };
    let tube = cylinder_mesh(&CylinderSpec {
        origin: Vec3::zeros(),
        diameter: 0.05,
        length: 0.1,
        cells_across: 4,
        along: uniform(2),
        patches: ["side", "bottom", "top"].map(String::from),
    });
    [
        block([1, 1, 1]).unwrap(),
        block([2, 2, 3]).unwrap(),
        tube.unwrap(),
    ]
}

/// The files as our own writer writes them.
fn ascii(mesh: &Mesh) -> Files {
    let folder = tempfile::tempdir().unwrap();
    polymesh::write(mesh, folder.path()).unwrap();
    let read = |name: &str| (name.to_owned(), fs::read(folder.path().join(name)).unwrap());
    FILES.map(read).to_vec()
}

/// The same with lists in binary, as OpenFOAM 1912 writes them, labels and scalars of so many
/// bytes.
fn binary(mesh: &Mesh, label: usize, scalar: usize) -> Files {
    let topology = mesh.topology();
    let file = |name: &str, class: &str, lists: &[(usize, Vec<u8>)]| {
        let mut bytes = format!(
            "FoamFile\n{{\n version 2.0;\n format binary;\n class {class};\n \
             arch \"LSB;label={};scalar={}\";\n object {name};\n}}\n",
            8 * label,
            8 * scalar
        )
        .into_bytes();
        for (count, list) in lists {
            bytes.extend(format!("{count}\n(").as_bytes());
            bytes.extend(list);
            bytes.extend(b")\n");
        }
        (name.to_owned(), bytes)
    };
    let labels = |list: &[u32]| {
        let bytes = list
            .iter()
            .flat_map(|&n| u64::from(n).to_le_bytes()[..label].to_vec());
        (list.len(), bytes.collect())
    };
    let coordinates = topology
        .points
        .iter()
        .flat_map(|point| [point.x, point.y, point.z]);
    let bytes = coordinates.flat_map(|x| match scalar {
        4 => (x as f32).to_le_bytes().to_vec(),
        _ => x.to_le_bytes().to_vec(),
    });
    let points = (topology.points.len(), bytes.collect());
    let faces = [
        labels(&topology.face_offsets),
        labels(&topology.face_points),
    ];
    let mut files = ascii(mesh);
    files[0] = file("points", "vectorField", &[points]);
    files[1] = file("faces", "faceCompactList", &faces);
    files[2] = file("owner", "labelList", &[labels(&topology.owner)]);
    files[3] = file("neighbour", "labelList", &[labels(&topology.neighbour)]);
    files
}

impl Target for PolyMeshes {
    fn input(&self, random: &mut Random) -> Files {
        let mut files = random.one(&self.corpus).clone();
        if random.once_in(8) {
            // One file of another mesh.
            let at = random.below(files.len());
            files[at] = random.one(&self.corpus)[at].clone();
        }
        for _ in 0..=random.below(2) * random.below(4) {
            let at = random.below(files.len());
            let others: Vec<&[u8]> = random.one(&self.corpus).iter().map(|f| &f.1[..]).collect();
            mutate(&mut files[at].1, random, &others);
        }
        if random.once_in(200) {
            files.remove(random.below(files.len()));
        }
        files
    }

    fn execute(&mut self, files: &Files) -> bool {
        for name in FILES {
            let path = self.folder.path().join(name);
            match files.iter().find(|(other, _)| other == name) {
                Some((_, bytes)) => fs::write(path, bytes).unwrap(),
                None => drop(fs::remove_file(path)),
            }
        }
        match polymesh::read(self.folder.path()) {
            Ok(mesh) => {
                work_with(&mesh);
                true
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                false
            }
        }
    }
}

/// What a run asks of a mesh: volumes above zero, faces of patches, cells by position.
fn work_with(mesh: &Mesh) {
    assert!(mesh.cell_volume().iter().all(|&volume| volume > 0.0));
    for patch in mesh.patches() {
        assert!(patch.faces().all(|face| face < mesh.faces()));
    }
    let locator = Locator::new(mesh);
    for cell in 0..mesh.cells() {
        let centre = mesh.cell_centre()[cell];
        let found = locator.cell_at(centre);
        assert!(found.is_none_or(|cell| cell < mesh.cells()));
        for &face in mesh.faces_of(cell) {
            assert!(
                mesh.outward(cell, face as usize)
                    .iter()
                    .all(|x| !x.is_nan())
            );
        }
    }
}
