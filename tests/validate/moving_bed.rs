//! The moving bed at its own pace (AF 1) and fifty times faster: temperatures within 1 % of the span between
//! feed and hot gas, at all times, with native particles and LIGGGHTS', and with OpenFOAM's gas. The same with the
//! inside of its particles resolved, natively, up to 678 times faster.

use calcine::results::Summary;
use calcine::results::read::Series;
use calcine_coupler::ledger::STORAGE_CLOCK;

use crate::shipped;

/// Between the feed and the hot gas in K.
const SPAN: f64 = 100.0;

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("moving-bed");
    let runs = [
        ("native", "native"),
        ("native", "liggghts"),
        ("openfoam", "liggghts"),
    ];
    for (gas, particles) in runs {
        let pairing = ["--gas", gas, "--particles", particles];
        let pace = |factor: u32, window: &str| {
            let name = format!("{gas}-{particles}-{factor}");
            let set = [
                "time.end=60 s".to_owned(),
                format!("time.acceleration={factor}"),
                format!("time.motion_window={window}"),
            ];
            let (out, series) = crate::run_with(&case, folder.path(), &name, &set, &pairing);
            (Summary::read(&out).unwrap(), series)
        };
        let (slow, fast) = (pace(1, "20 ms"), pace(50, "10 ms"));
        for name in ["mean_temperature", "top_gas"] {
            let column = format!("quantities.{name}");
            let pairs = slow.1.column(&column).iter().zip(fast.1.column(&column));
            let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            println!("  {gas} gas, {particles} particles, {name}: {worst:.3} K of {SPAN} K");
            assert!(worst < 0.01 * SPAN, "{name}: {worst} K");
        }
        for (summary, _) in [&slow, &fast] {
            let errors = summary.ledger.lines.iter();
            for (name, line) in errors.filter(|(name, _)| *name != STORAGE_CLOCK) {
                let limit = if name == "gas_momentum" { 1e-6 } else { 1e-10 };
                assert!(line.relative_error < limit, "{name}: {line:?}");
            }
            if let Some(pace) = summary.pace {
                println!(
                    "    inertial number {:.1e} in the mean, {:.1e} at most",
                    pace.inertial_number_mean, pace.inertial_number_largest
                );
            }
        }
    }
}

/// Beads of 30 shells, λ 1 W/m/K, at AF 1, 50, 200 and 678, in windows of 0.5 s of process time where they are faster:
/// requirements 0.5 % of the span at AF 200, 1 % at 678.
pub fn run_resolved() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("moving-bed");
    let pace = |factor: u32, window: &str| {
        let set = [
            "time.end=60 s".to_owned(),
            format!("time.acceleration={factor}"),
            format!("time.motion_window={window}"),
            "materials.glass.inside=radial".to_owned(),
            "materials.glass.conductivity=1 W/m/K".to_owned(),
            "materials.glass.radial.shells=30".to_owned(),
        ];
        let (out, series) = crate::run(&case, folder.path(), &factor.to_string(), &set);
        let summary = Summary::read(&out).unwrap();
        for name in ["mass", "energy", "energy_exchange"] {
            let line = &summary.ledger.lines[name];
            assert!(line.relative_error < 1e-10, "{name}: {line:?}");
        }
        series
    };
    let own = pace(1, "20 ms");
    for (factor, window, share) in [
        (50, "10 ms", 0.005),
        (200, "2.5 ms", 0.005),
        (678, "0.737463 ms", 0.01),
    ] {
        let fast = pace(factor, window);
        for name in ["mean_temperature", "top_gas"] {
            let worst = furthest(&own, &fast, &format!("quantities.{name}"));
            println!("  resolved, AF {factor}, {name}: {worst:.3} K of {SPAN} K");
            assert!(worst < share * SPAN, "AF {factor}: {name}: {worst} K");
        }
    }
}

/// Largest difference of a column of a series to one that is linear between its rows.
fn furthest(one: &Series, other: &Series, column: &str) -> f64 {
    let [times, values] = ["process_time", column].map(|name| one.column(name));
    let at = |time: f64| {
        let after = times
            .partition_point(|own| *own < time)
            .clamp(1, times.len() - 1);
        let share = (time - times[after - 1]) / (times[after] - times[after - 1]);
        values[after - 1] + share * (values[after] - values[after - 1])
    };
    let rows = other
        .column("process_time")
        .iter()
        .zip(other.column(column));
    let inside = rows.filter(|(time, _)| **time <= times[times.len() - 1]);
    inside
        .map(|(time, value)| (value - at(*time)).abs())
        .fold(0.0, f64::max)
}
