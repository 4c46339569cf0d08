//! Files that a case names: triangles of walls (STL), and particles (CSV, dumps, VTK in its old and its XML form). No bytes make the
//! reader, or the check of what it accepts, panic, hang or ask for memory beyond measure.

use std::fs;
use std::path::{Path, PathBuf};

use calcine::assembly::PreparedCase;
use calcine::case::parse;
use tempfile::TempDir;

use crate::mutate::mutate;
use crate::random::Random;
use crate::{Files, Target, scratch};

/// Most particles that are still placed and mapped.
const MOST: usize = 200;

/// Particles with all that a file may hold.
const ALL_COLUMNS: &str = "id,type,x,y,z,radius,temperature,vx,vy,vz,omegax,omegay,omegaz\n\
                           7,1,0.005,0.005,0.29,0.001,300,0.1,0,-0.2,0,30,0\n\
                           3,2,0.015,0.015,0.28,0.0015,310,0,0,0,0,0,0\n";

/// A wall of two triangles.
const WALL: &str = "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 100\nvertex 20 0 100\nvertex 0 20 100\nendloop\nendfacet\n\
                    facet normal 0 0 1\nouter loop\nvertex 20 20 100\nvertex 0 20 100\nvertex 20 0 100\nendloop\nendfacet\nendsolid plate\n";

/// One file of a case whose others are good.
pub struct AttachedFiles {
    case: String,
    /// The extensions and contents that inputs are made from.
    corpus: Vec<(&'static str, Vec<u8>)>,
    /// The name that the case has for the file, without its extension.
    stem: &'static str,
    folder: TempDir,
}

impl AttachedFiles {
    /// Walls: `stl`; particles: `csv` with dumps, or `vtk`.
    pub fn new(kind: &str) -> Self {
        let good = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good");
        let read = |name: &str| fs::read(good.join(name)).unwrap();
        let case = String::from_utf8(read("springs-and-gates.toml")).unwrap();
        // Room for the particles of all files.
        let case = case.replace(
            "size = \"20 20 300 mm\"",
            "origin = \"-20 -20 0 mm\", size = \"40 40 300 mm\"",
        );
        let (stem, corpus) = match kind {
            "stl" => {
                let corpus = vec![
                    ("stl", read("plate.stl")),
                    ("stl", WALL.into()),
                    ("stl", binary(2)),
                    ("stl", binary(7)),
                ];
                ("plate", corpus)
            }
            "csv" => {
                let corpus = vec![
                    ("csv", read("bed.csv")),
                    ("csv", read("thrown.csv")),
                    ("csv", ALL_COLUMNS.into()),
                    ("txt", ALL_COLUMNS.replace(',', " , ").into()),
                    ("liggghts", read("bed.liggghts")),
                ];
                ("thrown", corpus)
            }
            _ => {
                let corpus = vec![
                    ("vtk", read("bed.vtk")),
                    ("vtp", read("bed.vtp")),
                    ("vtu", read("bed.vtp")),
                    ("vtp", appended()),
                ];
                ("thrown", corpus)
            }
        };
        let folder = scratch();
        for name in ["plate.stl", "thrown.csv"] {
            fs::write(folder.path().join(name), read(name)).unwrap();
        }
        Self {
            case,
            corpus,
            stem,
            folder,
        }
    }
}

/// A binary file of triangles, a strip.
fn binary(triangles: u32) -> Vec<u8> {
    let mut bytes = vec![0u8; 80];
    bytes.extend(triangles.to_le_bytes());
    for k in 0..triangles {
        let x = 3.0 * k as f32;
        let values = [
            0.0,
            0.0,
            1.0,
            x,
            0.0,
            100.0,
            x,
            20.0,
            100.0,
            x + 3.0,
            10.0,
            100.0,
        ];
        bytes.extend(values.iter().flat_map(|value: &f32| value.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

/// A `.vtp` file with raw appended arrays.
fn appended() -> Vec<u8> {
    let mut bytes = b"<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\
        <Piece NumberOfPoints=\"2\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>\
        <PointData><DataArray type=\"Float32\" Name=\"radius\" format=\"appended\" offset=\"56\"/></PointData></Piece></PolyData>\n\
        <AppendedData encoding=\"raw\">_"
        .to_vec();
    bytes.extend(48u64.to_le_bytes());
    for value in [0.005f64, 0.005, 0.2, 0.015, 0.015, 0.1] {
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(8u64.to_le_bytes());
    for value in [0.001f32, 0.0015] {
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(b"</AppendedData></VTKFile>\n");
    bytes
}

impl Target for AttachedFiles {
    fn input(&self, random: &mut Random) -> Files {
        let (extension, bytes) = random.one(&self.corpus);
        let mut bytes = bytes.clone();
        let others: Vec<&[u8]> = self.corpus.iter().map(|(_, bytes)| &bytes[..]).collect();
        for _ in 0..=random.below(2) * random.below(6) {
            mutate(&mut bytes, random, &others);
        }
        // Now and then by a name that promises something else.
        let extension = match random.once_in(16) {
            true => random.one(&self.corpus).0,
            false => extension,
        };
        vec![(format!("{}.{extension}", self.stem), bytes)]
    }

    fn execute(&mut self, files: &Files) -> bool {
        let (name, bytes) = &files[0];
        fs::write(self.folder.path().join(name), bytes).unwrap();
        let own = match self.stem {
            "plate" => "plate.stl",
            _ => "thrown.csv",
        };
        let text = self.case.replace(own, name);
        let place: PathBuf = self.folder.path().join("case.toml");
        let case = match parse(&place, &text, &[]) {
            Ok(case) => case,
            Err(errors) => {
                assert!(!errors.render().is_empty());
                return false;
            }
        };
        match PreparedCase::new(&case) {
            Ok(prepared) => {
                let particles = &prepared.particles;
                assert!(particles.radius.iter().all(|radius| *radius > 0.0));
                assert!(
                    particles
                        .position
                        .iter()
                        .flatten()
                        .all(|place| place.is_finite())
                );
                if particles.id.len() <= MOST
                    && let Ok(packing) = prepared.packing(&case)
                {
                    let report = calcine::case::check_report(
                        &case,
                        &prepared.mesh,
                        particles,
                        &packing,
                        Default::default(),
                    );
                    assert!(!report.is_empty());
                }
                true
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                false
            }
        }
    }
}
