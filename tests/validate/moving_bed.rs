//! The moving bed at its own pace (AF 1) and fifty times faster: temperatures within 1 % of the span between
//! feed and hot gas, at all times, with native particles and LIGGGHTS', and with OpenFOAM's gas.

use calcine::results::Summary;
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
