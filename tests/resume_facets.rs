//! `--resume` after kill -9 with walls of triangles: beads that stream into a funnel of an STL file and run out of it,
//! in LIGGGHTS on one and on two ranks. Same bits, and a ledger that closes with what came and went.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::Summary;

use crate::support::killed;
use crate::support::program;

/// Corners of a square of a side in mm at a height in mm.
fn square(side: f64, z: f64) -> [[f64; 3]; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]| [0.5 * side * x, 0.5 * side * y, z])
}

/// A funnel with a square mouth of 80 mm and a hole of 28 mm, and in it a slanted plate that beads slide down.
fn funnel() -> String {
    let (hole, mouth) = (square(28.0, 30.0), square(80.0, 56.0));
    let mut triangles = Vec::new();
    for k in 0..4 {
        let next = (k + 1) % 4;
        triangles.push([hole[k], hole[next], mouth[next]]);
        triangles.push([hole[k], mouth[next], mouth[k]]);
    }
    triangles.push([[-10.0, -15.0, 46.0], [10.0, -15.0, 50.0], [0.0, 12.0, 52.0]]);
    let mut text = String::from("solid funnel\n");
    for corners in triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for [x, y, z] in corners {
            let _ = writeln!(text, "vertex {x} {y} {z}");
        }
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid funnel\n"
}

/// The shipped hopper with the funnel for its floor and a stream of beads from above.
fn case(folder: &Path) -> PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/hopper.toml");
    let text = fs::read_to_string(source).unwrap();
    let floor = text
        .lines()
        .find(|line| line.starts_with("cone = "))
        .unwrap();
    let text = text.replace(floor, "stl = \"funnel.stl\"\nscale = 1e-3");
    let text = text.replace(
        "[[outlets]]",
        "[[feeds]]\nname = \"stream\"\npopulation = \"beads\"\n\
         region = { cylinder = { from = \"0 0 118 mm\", to = \"0 0 128 mm\", radius = \"20 mm\" } }\n\
         mass_rate = \"300 g/s\"\nvelocity = \"0 0 -0.5 m/s\"\nseed = 3\n\n[[outlets]]",
    );
    let text = text + "\n[liggghts]\nwall_impulse = true\n";
    fs::write(folder.join("funnel.stl"), funnel()).unwrap();
    let path = folder.join("funnel.toml");
    fs::write(&path, text).unwrap();
    path
}

fn command(case: &Path, ranks: &str, out: &Path) -> Command {
    let set = [
        "time.end=0.15 s",
        "time.checkpoint.every=20 ms",
        "output.every=50 ms",
        "particles[0].place.region.from=60 mm",
        "particles[0].place.region.to=76 mm",
        "particles[0].place.solid_fraction=0.4",
    ];
    let words = ["--particles", "liggghts", "--ranks-particles", ranks];
    program::command(case, out, &words, &set)
}

#[test]
fn a_stream_through_a_funnel_of_triangles_resumes_to_the_same_bits_on_one_rank_and_on_two() {
    for ranks in ["1", "2"] {
        let directory = tempfile::tempdir().unwrap();
        let case = case(directory.path());
        let whole = killed::resumes_to_the_same_bits(directory.path(), &[16], |out| {
            command(&case, ranks, out)
        });
        let summary = Summary::read(&whole).unwrap();
        for name in ["particle_mass", "particle_momentum"] {
            let line = &summary.ledger.lines[name];
            println!("{ranks} ranks, {name}: {line:?}");
            assert!(line.throughput > 0.0);
            assert!(
                line.relative_error < 1e-13,
                "{ranks} ranks, {name}: {line:?}"
            );
        }
    }
}
