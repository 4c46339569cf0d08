//! Beds that move in LIGGGHTS: settling, fluidised and sinking ones. LIGGGHTS takes part: `cargo xtask
//! test` builds its host.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/moving.rs"]
mod moving;
#[path = "support/results_equal.rs"]
mod results_equal;

use std::f64::consts::PI;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use calcine::results::Summary;
use calcine::results::read::Series;
use moving::{case, command, run};

fn closed(directory: &Path, within: f64) {
    let summary = Summary::read(directory).unwrap();
    for (name, line) in &summary.ledger.lines {
        let limit = if name == "gas_momentum" { 1e-6 } else { within };
        assert!(line.relative_error < limit, "{name}: {line:?}");
    }
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
    assert!((0.54..0.66).contains(&fraction), "{fraction}");
    closed(directory.path(), 1e-10);
}

#[test]
fn a_fluidised_bed_weighs_on_the_flow_with_its_buoyant_weight() {
    let directory = tempfile::tempdir().unwrap();
    run(&case("fluidised-bed"), directory.path(), &[]);
    let series = Series::read(directory.path()).unwrap();
    let times = series.column("process_time");
    let drops = series.column("quantities.pressure_drop");
    let count = Summary::read(directory.path()).unwrap().particles as f64;
    let area = 0.016f64 * 0.016;
    let weight = count * PI / 6.0 * 0.002f64.powi(3) * (2500.0 - 998.0) * 9.81 / area;
    let of_water = 998.0 * 9.81 * 0.12;
    let speed = |t: f64| {
        if t < 0.5 {
            0.04
        } else {
            0.04 - 0.009 * (t - 0.5)
        }
    };
    let points: Vec<(f64, f64, f64)> = times
        .iter()
        .zip(drops)
        .map(|(&t, &drop)| (t, speed(t), drop - of_water))
        .collect();

    // Of the decreasing flow, 40 to 30 mm/s; before 0.5 s the bed still expands from its packing.
    let plateau: Vec<f64> = points
        .iter()
        .filter(|(t, ..)| (0.5..1.6).contains(t))
        .map(|point| point.2)
        .collect();
    let plateau = plateau.iter().sum::<f64>() / plateau.len() as f64;
    println!("plateau {plateau} Pa, buoyant weight {weight} Pa per area");
    assert!((plateau / weight - 1.0).abs() < 0.02, "{plateau} {weight}");

    closed(directory.path(), 1e-10);
}

#[test]
fn a_moving_bed_is_the_same_at_any_pace() {
    let directory = tempfile::tempdir().unwrap();
    let (slow, fast) = (directory.path().join("1"), directory.path().join("50"));
    let set = [
        "time.end=60 s",
        "time.acceleration=5",
        "time.motion_window=20 ms",
    ];
    run(&case("moving-bed"), &slow, &set);
    run(&case("moving-bed"), &fast, &["time.end=60 s"]);
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
