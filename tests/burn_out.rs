//! Particles that burn until nothing is left: they go out of the run, and what is left of them is booked.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::{killed, program};

/// Held beads in air.
const BEADS: &str = "burning-beads";

fn case(name: &str) -> PathBuf {
    let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good");
    inputs.join(format!("{name}.toml"))
}

fn run(name: &str, out: &Path, arguments: &[&str], settings: &[&str]) -> Summary {
    program::run(&case(name), out, arguments, settings);
    Summary::read(out).unwrap()
}

/// All four beads are gone, less than a share of their mass is left, and what they were made of is in the gas.
fn assert_burnt_out(summary: &Summary, share: f64) {
    assert_eq!(summary.particles, 0);
    let used_up = summary.passed.used_up;
    assert_eq!(used_up.rows, 4);
    // Four beads of 1 mm and 1000 kg/m³; round-off may leave less than nothing of them.
    let first = 2.0944e-6;
    assert!(
        (-f64::EPSILON * first..=share * first).contains(&used_up.mass_kg),
        "{used_up:?}"
    );
    let lines = &summary.ledger.lines;
    for name in ["mass", "energy", "particle_mass"] {
        let error = lines[name].relative_error;
        assert!(error < 1e-12, "{name}: {error}");
    }
    assert_elements_close(summary);
}

/// Every element closes, carbon too, of which a thousandth of what passes is made.
fn assert_elements_close(summary: &Summary) {
    for (element, line) in &summary.ledger.elements {
        assert!(line.relative_error < 1e-12, "{element}: {line:?}");
    }
}

#[test]
fn beads_burn_out_in_windows_short_and_longer_than_their_life() {
    let folder = tempfile::tempdir().unwrap();
    for step in ["0.5 s", "2 s", "16 s"] {
        let out = folder.path().join(step.replace(' ', "-"));
        let settings = [&*format!("time.process_step={step}")];
        assert_burnt_out(&run(BEADS, &out, &[], &settings), 1e-6);
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains("Particles that came and went") && page.contains("used up"));
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
        run(BEADS, &out, &[], &settings);
        let series = Series::read(&out).unwrap();
        let mass = series.column("quantities.mass");
        let time = series.column("process_time");
        let square = |row: usize| (mass[row] / mass[0]).powf(2.0 / 3.0);
        // From a moment at which the beads are hot: the line to zero.
        let row_at = |seconds: f64| time.iter().position(|t| *t >= seconds - 1e-9).unwrap();
        let (first, last) = (row_at(2.1), row_at(4.9));
        let slope = (square(last) - square(first)) / (time[last] - time[first]);
        time[last] - square(last) / slope
    };
    // They live 7 s.
    let [fine, coarse] = ["0.1 s", "0.7 s"].map(life);
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} {fine}");
}

#[test]
fn what_the_laws_saw_is_written_in_the_window_of_a_burn_out_too() {
    let folder = tempfile::tempdir().unwrap();
    // A snapshot after each window.
    let held: &[&str] = &["time.process_step=0.5 s", "output.every=0.5 s"];
    let free: &[&str] = &["output.every=0.2 s"];
    for (case, particles, windows) in [
        (BEADS, "native", held),
        ("burning-moving", "native", free),
        (BEADS, "liggghts", held),
    ] {
        let out = folder.path().join(format!("{case}-{particles}"));
        let fields = r#"output.particles=["slip", "void_fraction"]"#;
        let settings = [windows, &[fields]].concat();
        let summary = run(case, &out, &["--particles", particles], &settings);
        assert_eq!(summary.passed.used_up.rows, 4);
    }
}

#[test]
fn so_they_do_in_liggghts() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--particles", "liggghts"];
    let summary = run(BEADS, folder.path(), &arguments, &["time.process_step=1 s"]);
    assert_burnt_out(&summary, 1e-6);
}

#[test]
fn a_gas_that_is_held_gives_and_takes_through_its_reservoir() {
    let folder = tempfile::tempdir().unwrap();
    for solver in ["native", "liggghts"] {
        let out = folder.path().join(solver);
        let settings = ["gas.held=true", "time.process_step=0.5 s"];
        let summary = run(BEADS, &out, &["--particles", solver], &settings);
        assert_burnt_out(&summary, 1e-6);
        // The beads' carbon goes to the reservoir as CO2; with that, twice their mass passes.
        let carbon = summary.ledger.elements["C"].throughput;
        assert!((carbon / (2.0 * 2.0944e-6) - 1.0).abs() < 1e-3, "{carbon}");
    }
}

#[test]
fn beads_that_fall_and_collide_burn_out_in_both_solvers() {
    let folder = tempfile::tempdir().unwrap();
    for solver in ["native", "liggghts"] {
        let out = folder.path().join(solver);
        let summary = run("burning-moving", &out, &["--particles", solver], &[]);
        assert_burnt_out(&summary, 0.02);
        let momentum = summary.ledger.lines["particle_momentum"].relative_error;
        assert!(momentum < 1e-12, "{momentum}");
    }
}

#[test]
fn a_run_killed_while_beads_burn_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    // So many windows that it can be killed before and after the beads are gone, at some 11 s.
    let settings = [
        "time.process_step=5 ms",
        "output.series_every=20 ms",
        "time.checkpoint.every=0.1 s",
    ];
    for solver in ["native", "liggghts"] {
        killed::resumes_to_the_same_bits(&folder.path().join(solver), &[300, 600], |out| {
            program::command(&case(BEADS), out, &["--particles", solver], &settings)
        });
    }
}
