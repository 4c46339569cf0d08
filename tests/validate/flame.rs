//! A flat flame on a burner whose place and peak do not depend on the acceleration factor (docs/theory.md, TSM-10), with OpenFOAM's own
//! chemistry as natively, and one flame by both. The native flame alone, at more factors: `native-solver/tests/flame.rs`.

use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::{self, Series};
use calcine_coupler::ledger::STORAGE_CLOCK;

use crate::{program, run_with};

/// Motion window in s, and height of a cell in mm.
const WINDOW: f64 = 3e-5;
const CELL: f64 = 0.4;
/// Mass fraction of methane that flows in: mole fraction 0.07752 of CH4, 0.1938 of O2, the rest N2.
const FRESH: f64 = 0.044_642;

/// Settings of so many windows at an acceleration factor.
fn settings(factor: f64, windows: u32) -> Vec<String> {
    let step = factor * WINDOW;
    let end = f64::from(windows) * step;
    vec![
        format!("time.acceleration={factor}"),
        format!("time.end={end:.9} s"),
        format!("output.every={end:.9} s"),
        format!("output.series_every={step:.9} s"),
    ]
}

/// Where half of the methane is left, in mm, and the highest temperature in K, of a run's last snapshot.
fn place_and_peak(out: &Path) -> (f64, f64) {
    let files = read::collection(out, "gas.pvd").unwrap();
    let arrays = read::arrays(&files.last().unwrap().1).unwrap();
    let methane = &arrays["CH4"].values;
    let half = 0.5 * FRESH;
    let above = methane.iter().position(|y| *y < half).unwrap();
    let share = (methane[above - 1] - half) / (methane[above - 1] - methane[above]);
    let kelvin = arrays["temperature"].values.iter();
    let peak = kelvin.copied().fold(0.0, f64::max);
    ((above as f64 - 0.5 + share) * CELL, peak)
}

/// Tells place and peak of a run, whether it is steady, and what it took.
fn told(what: &str, out: &Path) -> (f64, f64) {
    let (place, peak) = place_and_peak(out);
    let series = Series::read(out).unwrap();
    let peaks = series.column("gas.temperature_max");
    let moved = peaks[peaks.len() - 1] - peaks[peaks.len() - 2];
    let summary = Summary::read(out).unwrap();
    println!(
        "  {what}: {place:.5} mm, {peak:.3} K, of which the last window {moved:.1e} K; {} windows, {:.0} s",
        summary.windows, summary.wall_time_s.total
    );
    for (name, line) in summary.ledger.lines.iter().chain(&summary.ledger.elements) {
        let kept = name != "gas_momentum" && name != STORAGE_CLOCK;
        assert!(
            !kept || line.relative_error < 1e-10,
            "{what}, {name}: {line:?}"
        );
    }
    (place, peak)
}

pub fn run() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/flame.toml");
    let folder = tempfile::tempdir().unwrap();
    let both = folder.path().join("both");
    let pairings = "native+native,openfoam+native";
    let compared = program::compare(&case, &both, pairings, &settings(678.0, 14));
    for quantity in compared["quantities"].as_array().unwrap() {
        println!(
            "  {}: apart by {}",
            quantity["name"], quantity["largest"]["difference"]
        );
    }
    let (place, peak) = told("native, AF 678", &both.join("native+native"));
    let steady = both.join("openfoam+native");
    let (own_place, own_peak) = told("openfoam, AF 678", &steady);
    assert!(
        (own_place / place - 1.0).abs() < 1e-4,
        "{own_place} {place}"
    );
    assert!((own_peak - peak).abs() < 0.05, "{own_peak} {peak}");

    // From the same hot start at a slower pace, and on from the flame that stands.
    let on = steady.display().to_string();
    for (factor, windows, from) in [
        (50.0, 70, None),
        (20.0, 10, Some(&on)),
        (1.0, 100, Some(&on)),
    ] {
        let mut options = vec!["--gas", "openfoam"];
        options.extend(from.iter().flat_map(|path| ["--from", path.as_str()]));
        let name = format!("{factor}");
        let set = settings(factor, windows);
        let (out, _) = run_with(&case, folder.path(), &name, &set, &options);
        let start = if from.is_some() {
            "on at"
        } else {
            "from the hot start at"
        };
        let (found, hottest) = told(&format!("openfoam, {start} AF {factor}"), &out);
        assert!((found / own_place - 1.0).abs() < 1e-4, "{found}");
        assert!((hottest - own_peak).abs() < 0.05, "{hottest}");
    }
}
