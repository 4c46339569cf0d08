//! Particles that burn until nothing is left: they go out of the run, and what is left of them is booked.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::program;

fn run(out: &Path, arguments: &[&str], settings: &[&str]) -> Summary {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/burning-beads.toml");
    program::run(&case, out, arguments, settings);
    Summary::read(out).unwrap()
}

/// All four beads are gone without a trace, and what they were made of is in the gas.
fn assert_burnt_out(summary: &Summary) {
    assert_eq!(summary.particles, 0);
    let used_up = summary.passed.used_up;
    assert_eq!(used_up.rows, 4);
    // Less than the share of the first mass at which a particle is used up: 4 beads of 1 mm and 1000 kg/m³.
    assert!(
        (0.0..=1e-6 * 2.1e-6).contains(&used_up.mass_kg),
        "{used_up:?}"
    );
    let lines = &summary.ledger.lines;
    for name in ["mass", "energy", "particle_mass"] {
        let error = lines[name].relative_error;
        assert!(error < 1e-12, "{name}: {error}");
    }
    for (element, line) in &summary.ledger.elements {
        // Carbon is two parts in ten thousand of what passes.
        let allowed = if element == "C" { 2e-11 } else { 1e-12 };
        assert!(line.relative_error < allowed, "{element}: {line:?}");
    }
}

#[test]
fn beads_burn_out_in_windows_short_and_longer_than_their_life() {
    let folder = tempfile::tempdir().unwrap();
    for step in ["0.5 s", "2 s", "16 s"] {
        let out = folder.path().join(step.replace(' ', "-"));
        let summary = run(&out, &[], &[&format!("time.process_step={step}")]);
        assert_burnt_out(&summary);
    }
}

#[test]
fn the_square_of_their_diameter_falls_linearly_whatever_the_window_up_to_a_tenth_of_their_life() {
    let folder = tempfile::tempdir().unwrap();
    let life = |step: &str| {
        let out = folder.path().join(step.replace(' ', "-"));
        let settings = [
            &*format!("time.process_step={step}"),
            &*format!("output.series_every={step}"),
        ];
        run(&out, &[], &settings);
        let series = Series::read(&out).unwrap();
        let mass = series.column("quantities.mass");
        let time = series.column("process_time");
        let square = |row: usize| (mass[row] / mass[0]).powf(2.0 / 3.0);
        // From a moment at which the beads are hot: the line to zero.
        let row_at = |seconds: f64| time.iter().position(|t| *t >= seconds - 1e-9).unwrap();
        let (first, last) = (row_at(3.0), row_at(8.0));
        let slope = (square(last) - square(first)) / (time[last] - time[first]);
        time[last] - square(last) / slope
    };
    let [fine, coarse] = ["0.1 s", "1 s"].map(life);
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} {fine}");
}

#[test]
fn so_they_do_in_liggghts() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--particles", "liggghts"];
    assert_burnt_out(&run(folder.path(), &arguments, &["time.process_step=1 s"]));
}
