//! Beds that move in LIGGGHTS: settling, fluidised and sinking ones. LIGGGHTS takes part: `cargo xtask
//! test` builds its host.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use calcine::results::Summary;
use calcine::results::read::Series;
use calcine_coupler::ledger::STORAGE_CLOCK;

use crate::support::fluidised::{Hold, examine};
use crate::support::moving::{case, command, run};
use crate::support::results_equal;

fn closed(directory: &Path, within: f64) {
    let summary = Summary::read(directory).unwrap();
    // What two clocks owe is no error.
    let lines = summary.ledger.lines.iter();
    for (name, line) in lines.filter(|(name, _)| *name != STORAGE_CLOCK) {
        // As far as the outer loop of the gas solves it.
        let limit = if name == "gas_momentum" { 1e-6 } else { within };
        assert!(line.relative_error < limit, "{name}: {line:?}");
    }
    let momentum = &summary.ledger.lines["particle_momentum"];
    assert!(momentum.throughput > 0.0, "{momentum:?}");
}

#[test]
fn a_bed_settles_and_comes_to_rest() {
    let directory = tempfile::tempdir().unwrap();
    run(&case("settled-bed"), directory.path(), &[]);
    let series = Series::read(directory.path()).unwrap();
    let last = |name: &str| *series.column(name).last().unwrap();
    let (height, speed) = (
        last("quantities.mean_height"),
        last("quantities.mean_speed"),
    );
    let count = Summary::read(directory.path()).unwrap().particles as f64;
    // Solid fraction of a layer twice as high as its mean height, wall layers included.
    let fraction = count * PI / 6.0 * 0.002f64.powi(3) / (0.016f64.powi(2) * 2.0 * height);
    println!("{count} beads, mean height {height} m, solid fraction {fraction}, {speed} m/s");
    assert!(speed < 1e-3, "{speed} m/s");
    // Between loosest and closest random packing, 0.55 and 0.64 (Onoda and Liniger 1990, doi 10.1103/PhysRevLett.64.2727; Scott
    // 1960, doi 10.1038/188908a0).
    assert!((0.55..0.64).contains(&fraction), "{fraction}");
    closed(directory.path(), 1e-10);
}

#[test]
fn a_fluidised_bed_weighs_its_buoyant_weight_and_packs_by_the_drag_law() {
    let directory = tempfile::tempdir().unwrap();
    let flow = r#"gas.patch.bottom.inlet.superficial_velocity=[["0 s", "38 mm/s"], ["0.7 s", "38 mm/s"],
        ["0.9 s", "18 mm/s"], ["1.4 s", "18 mm/s"], ["1.5 s", "9 mm/s"], ["1.8 s", "9 mm/s"]]"#;
    // Half as high as the shipped one, and three seconds shorter.
    let set = [
        "time.end=1.8 s",
        r#"mesh.box.size="16 16 80 mm""#,
        "mesh.box.cells=[1, 1, 20]",
        "particles[0].place.height=32 mm",
        "output.every=0.1 s",
        flow,
    ];
    run(&case("fluidised-bed"), directory.path(), &set);
    let hold = |from: f64, to: f64, speed: f64| Hold { from, to, speed };
    let found = examine(
        &case("fluidised-bed"),
        &set.map(String::from),
        directory.path(),
        &[hold(0.4, 0.7, 0.038)],
        &[hold(1.2, 1.4, 0.018), hold(1.65, 1.8, 0.009)],
    );
    for share in found.plateau {
        assert!((share - 1.0).abs() < 0.02, "{share}");
    }
    for share in found.packed {
        assert!((share - 1.0).abs() < 0.01, "{share}");
    }
    let apart = found.crossing / found.by_particles - 1.0;
    assert!(apart.abs() < 0.05, "{apart}");
    closed(directory.path(), 1e-10);
}

#[test]
fn a_moving_bed_is_the_same_at_any_pace() {
    let directory = tempfile::tempdir().unwrap();
    let (slow, fast) = (directory.path().join("1"), directory.path().join("50"));
    let set = [
        "time.end=10 s",
        "time.acceleration=1",
        "time.motion_window=20 ms",
    ];
    run(&case("moving-bed"), &slow, &set);
    run(&case("moving-bed"), &fast, &["time.end=10 s"]);
    let [a, b] = [&slow, &fast].map(|folder| Series::read(folder).unwrap());
    let name = "quantities.mean_temperature";
    let (a, b) = (a.column(name), b.column(name));
    let worst = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    println!("largest difference of the mean temperature: {worst} K of 100 K");
    assert!(worst < 1.0, "{worst} K");
    for folder in [&slow, &fast] {
        closed(folder, 1e-10);
    }
    // Fifty times faster is fifty times nearer to collisions; less, where settling makes most of it.
    let [slow, fast] = [&slow, &fast].map(|folder| Summary::read(folder).unwrap().pace.unwrap());
    println!("inertial numbers {slow:?} {fast:?}");
    assert!(slow.inertial_number_mean < 0.01, "{slow:?}");
    assert!(fast.inertial_number_mean > 3.0 * slow.inertial_number_mean);
    assert!(slow.warning().is_none() && fast.warning().is_some());
}

#[test]
fn a_moving_bed_with_feed_and_outlet_is_resumed_to_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let set = [
        "time.end=40 s",
        "time.checkpoint.every=5 s",
        "output.every=10 s",
        "output.series_every=1 s",
    ];
    let (whole, killed) = (
        directory.path().join("whole"),
        directory.path().join("killed"),
    );
    run(&case("moving-bed"), &whole, &set);
    let mut child = command(&case("moving-bed"), &killed, &set)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !killed.join("checkpoint/coordinator.state").is_file() {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "no checkpoint in time"
        );
        assert!(
            child.try_wait().unwrap().is_none(),
            "it ended before a checkpoint"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let output = command(&case("moving-bed"), &killed, &set)
        .arg("--resume")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    let differing = results_equal::differences(&whole, &killed);
    assert!(differing.is_empty(), "{differing:?}");
}
