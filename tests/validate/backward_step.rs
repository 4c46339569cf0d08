//! Air over a backward-facing step of a third of the channel behind it: how far behind the step, of height h, the flow
//! meets the floor again. Kim, Kline and Johnston 1980 (doi 10.1115/1.3240686) measured 7 ± 0.5 h; the standard
//! k-epsilon model is known for falling short of it (Thangam and Speziale 1992, doi 10.2514/3.11066: up to 6.3 h on fine
//! meshes). Natively on two meshes, and by OpenFOAM's own model from the same keys on the coarser one.

use std::fs;
use std::path::Path;

use crate::run_with;

/// Height of the step in m.
const STEP: f64 = 0.02;

pub fn run() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/backward-step.toml");
    let folder = tempfile::tempdir().unwrap();
    let length = |name: &str, set: &[&str], gas: &str| {
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        run_with(&case, folder.path(), name, &set, &["--gas", gas]);
        let length = reattachment(&folder.path().join(name)) / STEP;
        println!("  {name}: the flow meets the floor {length:.2} heights behind the step");
        length
    };
    let coarse = length("native", &[], "native");
    let finer = [
        "mesh.box.cells=[36, 1, 200]",
        "time.motion_window=0.5 ms",
        "probes[0].line.from=0.8 5 1.75 mm",
        "probes[0].line.to=0.8 5 698.25 mm",
        "probes[0].line.points=200",
    ];
    let fine = length("native-finer", &finer, "native");
    let foam = length("openfoam", &[], "openfoam");
    assert!((coarse - foam).abs() < 0.05);
    assert!(coarse > 4.0 && fine > coarse && fine < 6.3);
}

/// Where the speed along the floor passes zero, farthest downstream, in m: probes know its magnitude alone, so
/// that it changes its sign at its least value behind the fastest backward flow.
fn reattachment(results: &Path) -> f64 {
    let mut files: Vec<_> = fs::read_dir(results.join("probes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    let text = fs::read_to_string(files.last().unwrap()).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|other| other.contains(name)).unwrap();
    let (place, speed) = (column("z [m]"), column("velocity [m/s]"));
    let points: Vec<(f64, f64)> = lines
        .map(|line| {
            let values: Vec<&str> = line.split(',').collect();
            (
                values[place].parse().unwrap(),
                values[speed].parse().unwrap(),
            )
        })
        .collect();
    // The corner's own eddy ends within two heights.
    let behind = points.partition_point(|point| point.0 < 2.0 * STEP);
    let before_outlet = points.partition_point(|point| point.0 < 12.0 * STEP);
    let least = (behind..before_outlet)
        .min_by(|a, b| points[*a].1.total_cmp(&points[*b].1))
        .unwrap();
    // The smaller neighbour lies on the other side of zero.
    let (one, other) = if points[least - 1].1 < points[least + 1].1 {
        (points[least - 1], points[least])
    } else {
        (points[least], points[least + 1])
    };
    one.0 + (other.0 - one.0) * one.1 / (one.1 + other.1)
}
