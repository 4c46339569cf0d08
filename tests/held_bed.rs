//! A bed that moves is held for a time and let go again within one run (`motion.held`): it stays where it lay, walls and
//! feeds wait for it, the run resumes to the same bits, and its ledger closes; natively and with LIGGGHTS.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::{Series, arrays, collection};
use calcine_coupler::physics::Vec3;

use crate::support::killed;
use crate::support::program;

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/inputs/good/{name}.toml"))
}

/// Centres in m in the snapshot of a process time in s.
fn centres(out: &Path, time: f64) -> Vec<Vec3> {
    let files = collection(out, "particles.pvd").unwrap();
    let at = |wanted: f64| move |file: &&(f64, PathBuf)| (file.0 - wanted).abs() < 1e-9;
    let (_, file) = files.iter().find(at(time)).unwrap();
    let arrays = arrays(file).unwrap();
    let points = arrays["points"].values.chunks_exact(3);
    points.map(Vec3::from_column_slice).collect()
}

/// The farthest that one of the first particles of both is from the other in m.
fn apart(one: &[Vec3], other: &[Vec3]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// Rows of a series between two process times in s, without the first.
fn between(series: &Series, name: &str, from: f64, to: f64) -> Vec<f64> {
    let times = series.column("process_time").iter();
    let rows = times.zip(series.column(name));
    let within = rows.filter(|(time, _)| (from + 1e-9..to + 1e-9).contains(*time));
    within.map(|(_, value)| *value).collect()
}

/// A bed of 978 beads that has settled is held for a second, and let go: it does not jump.
fn lets_go(particles: &str) {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "time.end=1.66 s",
        "time.acceleration=[[\"0 s\", 1], [\"0.6 s\", 20], [\"1.6 s\", 1]]",
        "motion.held=[[\"0.6 s\", \"1.6 s\"]]",
        "output.every=0.2 s",
        "gas.controls.outer_tolerance=1e-8",
    ];
    let (case, out) = (program::shipped("settled-bed"), folder.path().join("held"));
    program::run(&case, &out, &["--particles", particles], &set);
    let (laid, kept) = (centres(&out, 0.6), centres(&out, 1.6));
    assert_eq!(apart(&laid, &kept), 0.0, "{particles}: it moved while held");
    let series = Series::read(&out).unwrap();
    let speeds = between(&series, "quantities.mean_speed", 0.6, 1.6);
    assert!(speeds.len() > 20 && speeds.iter().all(|speed| *speed == 0.0));
    let fastest = |from: f64, to: f64| {
        let rows = between(&series, "quantities.mean_speed", from, to);
        rows.into_iter().fold(0.0, f64::max)
    };
    let (before, after) = (fastest(0.58, 0.6), fastest(1.6, 1.66));
    let moved = apart(&kept, &centres(&out, 1.66));
    println!(
        "{particles}: mean speed {before:.1e} m/s before, {after:.1e} m/s after, which moves it by {moved:.1e} m"
    );
    assert!(after <= before, "it jumped: {before} m/s, {after} m/s");
    // No bead goes farther than the mean speed of before would have carried it.
    assert!(moved < before * 0.06, "{moved} m at {before} m/s");
}

#[test]
fn a_bed_that_lies_stays_where_it_lies_when_it_is_let_go() {
    lets_go("native");
}

#[test]
fn a_bed_in_liggghts_stays_where_it_lies_when_it_is_let_go() {
    lets_go("liggghts");
}

#[test]
fn a_drum_that_stands_carries_nothing_and_goes_on_from_where_it_stood() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, set: &[&str]| {
        let out = folder.path().join(name);
        program::run(&good("held-drum"), &out, &[], set);
        out
    };
    let held = run("held", &[]);
    assert_eq!(centres(&held, 0.5), centres(&held, 2.0));
    assert_eq!(centres(&held, 2.5), centres(&held, 4.0));
    let turned = apart(&centres(&held, 2.0), &centres(&held, 2.5));
    // 30 rpm over half a second are a quarter of a turn of a wall at 20 mm.
    assert!(turned > 0.25 * TAU / 4.0 * 0.02, "{turned}");
    // Summed up it has turned as long as one that is never held.
    let set = [
        "time.end=1.5 s",
        "time.acceleration=1",
        "motion.held=[[\"1.4999 s\", \"2 s\"]]",
    ];
    let through = Series::read(&run("through", &set)).unwrap();
    let series = Series::read(&held).unwrap();
    let mean = |series: &Series, from: f64, to: f64| {
        let rows = between(series, "quantities.surface_angle", from, to);
        rows.iter().sum::<f64>().to_degrees() / rows.len() as f64
    };
    let (one, other) = (mean(&series, 4.2, 4.49), mean(&through, 1.2, 1.49));
    println!("surface at {one:.1} degrees with stops, {other:.1} degrees without");
    assert!((one - other).abs() < 8.0, "{one} {other}");
}

/// Kills a run while the bed is held and after it was let go, resumes it, compares every bit, and closes its ledger.
fn resumes(particles: &str) {
    let directory = tempfile::tempdir().unwrap();
    let command = |out: &Path| -> Command {
        let set = ["time.checkpoint.every=40 ms"];
        program::command(&good("held-bed"), out, &["--particles", particles], &set)
    };
    // 100 rows of 2 ms fall before the hold, 50 into it.
    let whole = killed::resumes_to_the_same_bits(directory.path(), &[125, 180], command);
    let summary = Summary::read(&whole).unwrap();
    for (name, line) in &summary.ledger.lines {
        println!("{particles}, {name}: {:.1e}", line.relative_error);
    }
    for name in ["mass", "energy", "energy_exchange", "particle_mass"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-11, "{name}: {error}");
    }
    let momentum = &summary.ledger.lines["particle_momentum"];
    assert!(momentum.throughput > 0.0 && momentum.relative_error < 1e-11);
    let series = Series::read(&whole).unwrap();
    let warm = between(&series, "quantities.mean_temperature", 0.2, 2.2);
    let (first, last) = (warm[0], warm[warm.len() - 1]);
    println!("{particles}: {first:.2} K to {last:.2} K while it is held");
    assert!(last > first + 5.0, "{first} K {last} K");
    // The feed waits while the bed is held, and owes nothing afterwards: 0.4 s of it are 0.2 g, or 19 beads.
    assert_eq!(summary.particles, 75 + 19);
}

#[test]
fn a_bed_resumes_to_the_same_bits_while_it_is_held_and_after() {
    resumes("native");
}

#[test]
fn a_bed_in_liggghts_resumes_to_the_same_bits_while_it_is_held_and_after() {
    resumes("liggghts");
}

#[test]
fn native_particles_and_liggghts_are_held_and_let_go_alike() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("comparison");
    let pairings = "native+native,native+liggghts";
    let comparison = program::compare(&good("held-bed"), &out, pairings, &[""; 0]);
    for quantity in comparison["quantities"].as_array().unwrap() {
        println!("{}: {}", quantity["name"], quantity["largest"]);
    }
}
