//! A bed that settled is held, heated, and let go again: each case takes its particles from the last snapshot of the one
//! before (`particles.place.file`), with sizes and temperatures.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::{Series, arrays, collection};
use calcine::results::voids::VoidProfiles;

use crate::support::program;

/// The shipped settled bed; its lines by their beginnings replaced.
fn case(folder: &Path, name: &str, replaced: &[(&str, String)]) -> PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/settled-bed.toml");
    let text = fs::read_to_string(source).unwrap();
    let line = |line: &str| {
        let own = replaced.iter().find(|(begin, _)| line.starts_with(begin));
        own.map_or_else(|| line.to_owned(), |(_, text)| text.clone())
    };
    let lines: Vec<String> = text.lines().map(line).collect();
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, lines.join("\n")).unwrap();
    path
}

/// Runs a case; the last snapshot of its particles.
fn run(case: &Path, out: &Path, set: &[&str]) -> PathBuf {
    program::run(case, out, &[], set);
    let files = collection(out, "particles.pvd").unwrap();
    files.last().unwrap().1.clone()
}

fn values(file: &Path, name: &str) -> Vec<f64> {
    arrays(file).unwrap()[name].values.clone()
}

/// Asserts that a run began from what a snapshot holds, to the bit.
fn took_over(out: &Path, snapshot: &Path, names: &[&str]) {
    let begin = &collection(out, "particles.pvd").unwrap()[0].1;
    for name in names {
        assert_eq!(values(begin, name), values(snapshot, name), "{name}");
    }
}

fn last(out: &Path, name: &str) -> f64 {
    *Series::read(out).unwrap().column(name).last().unwrap()
}

#[test]
fn a_settled_bed_is_held_heated_and_let_go_where_it_lies() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let settled = run(&case(folder.path(), "settle", &[]), &out("settle"), &[]);

    // The report shows how its void fraction goes; in a box there is no distance from one wall.
    let voids = VoidProfiles::read(&out("settle")).unwrap().unwrap();
    assert!(voids.wall.place.is_empty());
    let points = voids.height.place.iter().zip(&voids.height.void_fraction);
    let inner = points.filter(|(z, _)| (0.006..0.018).contains(*z));
    let inner: Vec<f64> = inner.map(|(_, void_fraction)| *void_fraction).collect();
    let mean = inner.iter().sum::<f64>() / inner.len() as f64;
    println!("void fraction from 6 to 18 mm: {mean:.3}");
    assert!((0.38..0.46).contains(&mean), "{mean}");
    let page = fs::read_to_string(out("settle").join("report.html")).unwrap();
    assert!(page.contains("Void fraction over the height"));
    assert!(!page.contains("Void fraction from the wall inwards"));

    let place = |file: &Path| format!("place = {{ file = \"{}\" }}", file.display());
    let held = case(
        folder.path(),
        "held",
        &[
            ("place = ", place(&settled)),
            ("motion = ", "motion = \"frozen\"".into()),
            (
                "heat_transfer = ",
                "heat_transfer = { law = \"gunn\" }".into(),
            ),
            ("particles = [", "particles = [\"temperature\"]".into()),
            (
                "wall = { velocity = \"slip\", heat = \"adiabatic\" }",
                "wall = { velocity = \"slip\", heat = { temperature = \"400 K\" } }".into(),
            ),
        ],
    );
    let set = [
        "time.end=20 s",
        "time.acceleration=20",
        "output.every=20 s",
        "output.series_every=1 s",
    ];
    let heated = run(&held, &out("held"), &set);
    took_over(&out("held"), &settled, &["points", "radius"]);
    assert_eq!(values(&heated, "points"), values(&settled, "points"));
    let warm = last(&out("held"), "particles.temperature_mean");
    assert!(warm > 300.5, "{warm}");

    let free = case(
        folder.path(),
        "free",
        &[
            ("place = ", place(&heated)),
            ("particles = [", "particles = [\"temperature\"]".into()),
        ],
    );
    let let_go = run(&free, &out("free"), &["time.end=0.1 s"]);
    // It lay, and lies: contacts build their springs anew, over a part of an overlap.
    took_over(&out("free"), &heated, &["points", "radius", "temperature"]);
    let [first, last_points] = [&settled, &let_go].map(|file| values(file, "points"));
    // A bead on the top may roll a little; none sinks or rises.
    let moved = |axes: &[usize]| {
        let pairs = last_points.iter().zip(&first).enumerate();
        let chosen = pairs.filter(|(at, _)| axes.contains(&(at % 3)));
        chosen.map(|(_, (a, b))| (a - b).abs()).fold(0.0, f64::max)
    };
    let (aside, along) = (moved(&[0, 1]), moved(&[2]));
    let speed = last(&out("free"), "quantities.mean_speed");
    let kept = last(&out("free"), "particles.temperature_mean");
    println!(
        "let go: {along:.1e} m along and {aside:.1e} m across gravity, {speed:.1e} m/s; {warm:.3} K held, {kept:.3} K"
    );
    assert!(along < 1e-5 && aside < 2e-4, "{along} m, {aside} m");
    assert!(speed < 1e-3, "{speed} m/s");
    assert!((kept - warm).abs() < 0.5, "{warm} {kept}");
    let summary = Summary::read(&out("free")).unwrap();
    assert_eq!(3 * summary.particles, first.len());
}
