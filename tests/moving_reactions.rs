//! Particles that react while they move: fed, burnt, shrunk, drawn off, at an acceleration factor above one; the
//! ledger closes in every line, whoever moves them.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::Series;

const CASE: &str = "tests/inputs/good/moving-reactions.toml";

fn run(out: &Path, settings: &[&str], options: &[&str]) -> Summary {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(CASE);
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.arg("run").arg(path).arg("--quiet").args(options);
    for setting in settings {
        command.args(["--set", setting]);
    }
    let output = command.arg("--out").arg(out).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    Summary::read(out).unwrap()
}

fn value(summary: &Summary, name: &str) -> f64 {
    summary.quantities[name].value.unwrap()
}

/// Elements and energy close, and so does the momentum of particles whose mass changes.
fn closes(summary: &Summary) {
    for (name, line) in &summary.ledger.lines {
        println!(
            "{name}: {:.1e} of {:.3e}",
            line.relative_error, line.throughput
        );
    }
    for name in [
        "mass",
        "energy",
        "energy_exchange",
        "particle_mass",
        "particle_momentum",
    ] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-11, "{name}: {error}");
    }
    assert!(summary.ledger.elements.contains_key("Ca"));
    for (element, line) in &summary.ledger.elements {
        println!("{element}: {:.1e}", line.relative_error);
        assert!(
            line.relative_error < 1e-11,
            "{element}: {}",
            line.relative_error
        );
        assert!(line.throughput > 0.0, "{element}");
    }
}

#[test]
fn stones_that_move_react_and_shrink_close_the_ledger_with_feed_and_discharge() {
    let folder = tempfile::tempdir().unwrap();
    let summary = run(folder.path(), &[], &[]);
    closes(&summary);
    let (lime, mass) = (value(&summary, "lime"), value(&summary, "mean_mass"));
    let (mean, least) = (
        value(&summary, "mean_diameter"),
        value(&summary, "least_diameter"),
    );
    println!("lime {lime:.4}, {mass:.4e} kg, diameters {mean:.5} and {least:.5} m");
    assert!(lime > 0.05, "{lime}");
    let fresh = 2700.0 * std::f64::consts::PI / 6.0 * 8e-3f64.powi(3);
    assert!(
        mass < 0.97 * fresh,
        "they lose carbon dioxide: {mass} of {fresh} kg"
    );
    // Lime of 1900 kg/m³ takes 56.077/100.086 · 2700/1900 = 0.796 of the room.
    let smallest = 8e-3 * (0.03f64 + 0.97 * 0.7962).cbrt();
    assert!(
        least < 7.9e-3 && least > smallest - 1e-6,
        "{least} {smallest}"
    );
    assert!(mean < 8e-3 && mean > least);
    let series = Series::read(folder.path()).unwrap();
    assert!(series.column("quantities.lime").len() > 15);
}

#[test]
fn the_acceleration_factor_does_not_show_in_what_has_reacted() {
    let folder = tempfile::tempdir().unwrap();
    let at = |factor: &str| {
        let set = [
            format!("time.acceleration={factor}"),
            "time.end=80 s".to_owned(),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let summary = run(&folder.path().join(factor), &set, &[]);
        ["lime", "mean_mass", "top_gas"].map(|name| value(&summary, name))
    };
    let [fast, slow] = ["200", "50"].map(at);
    println!("AF 200: {fast:?}, AF 50: {slow:?}");
    for (fast, slow) in fast.iter().zip(&slow) {
        assert!((fast / slow - 1.0).abs() < 0.02, "{fast} {slow}");
    }
}

#[test]
fn liggghts_has_sizes_and_masses_as_they_become() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["time.end=80 s"];
    let own = run(&folder.path().join("own"), &set, &[]);
    let other = run(
        &folder.path().join("liggghts"),
        &set,
        &["--particles", "liggghts"],
    );
    closes(&other);
    for (name, most) in [("lime", 0.03), ("mean_mass", 0.01), ("mean_diameter", 3e-3)] {
        let (a, b) = (value(&own, name), value(&other, name));
        println!("{name}: {a:.5e} {b:.5e}");
        assert!((a / b - 1.0).abs() < most, "{name}: {a} {b}");
    }
}
