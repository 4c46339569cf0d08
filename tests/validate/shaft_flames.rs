//! Flames in the shaft furnace (docs/theory.md, SHF-1): premixed burners whose fuel burns in the bed, natively and with OpenFOAM and
//! LIGGGHTS, within the case's bands, with eddies that end at the bed and with eddies in it, and against the same burners that let in burnt gas.

use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::{self, Series};
use calcine_coupler::ledger::STORAGE_CLOCK;

use crate::{program, run_with, shipped};

/// What methane and air of 300 K at λ = 1.1 reach without loss and dissociation, in K, as `shaft_furnace` finds it.
const COMPLETE: f64 = 2190.0;
/// Laws of the eddies in the bed, `gas.turbulence.bed`.
const BED_EDDIES: [&str; 2] = ["none", "nakayama-kuwahara"];
/// Lower than this in K no burner's cell may be at its hottest: none is lit by half.
const LIT: f64 = 1900.0;
/// 1 % of what lies between feed and burners in K: what it may matter to the particles how burners are described.
const ALIKE: f64 = 19.0;
/// Time in s over which both are averaged: at a time the hottest particle of one bed is 22 K from that of another that
/// differed by nanometres at the start.
const OVER: f64 = 240.0;
/// Height in m above which no fuel may be left: two cells above the burners, in which it is some 1e-6 of the gas.
pub const ABOVE: f64 = 0.34;
/// The largest mass fraction that counts as none.
pub const LEFT: f64 = 1e-5;

/// The gas' momentum closes to some 0.06 of the outer tolerance, in proportion to it (2e-5 in this case, as reactions are repeatable
/// to five times their own 3e-6; 1e-7 where it is 2e-6): a tenth of it.
pub const MOMENTUM: f64 = 2e-6;

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let end = "time.end=600 s";
    let pairings = ["native+native", "openfoam+liggghts"];
    let case = shipped("shaft-furnace");
    let burnt = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/shaft-burnt.toml");
    let production = ["--gas", "openfoam", "--particles", "liggghts"];
    let burnt = [&[][..], &production].map(|options| {
        let name = format!("burnt-{}", options.len());
        run_with(&burnt, folder.path(), &name, &[end.to_owned()], options).1
    });
    for law in BED_EDDIES {
        println!("  eddies in the bed: {law}");
        let both = folder.path().join(law);
        let eddies = format!("gas.turbulence.bed={{ law = \"{law}\" }}");
        let compared = program::compare(&case, &both, &pairings.join(","), &[end, &eddies]);
        for quantity in compared["quantities"].as_array().unwrap() {
            let (largest, end) = (&quantity["largest"]["difference"], &quantity["end_values"]);
            println!(
                "  {}: apart by {largest}, at the end {end}",
                quantity["name"]
            );
        }
        for (pairing, burnt) in pairings.iter().zip(&burnt) {
            println!("  {pairing}");
            flames(&both.join(pairing), burnt);
        }
    }
}

/// Asserts what a run with flames found, beside one of the same pairing with burnt gas.
fn flames(out: &Path, burnt: &Series) {
    let (summary, flames) = (Summary::read(out).unwrap(), Series::read(out).unwrap());
    let (gas, wall) = (&summary.convergence, &summary.wall_time_s);
    println!(
        "  {} of {} windows unconverged, {:.1} outer iterations an attempt, gas {:.0} of {:.0} s",
        gas.unconverged_windows,
        summary.windows,
        gas.outer_iterations as f64 / summary.windows as f64,
        wall.gas,
        wall.total
    );
    let (ledger, elements) = (&summary.ledger.lines, &summary.ledger.elements);
    for (name, line) in ledger.iter().chain(elements) {
        println!("  ledger, {name}: {:.1e}", line.relative_error);
        let limit = match name.as_str() {
            "gas_momentum" => MOMENTUM,
            // No error, but what two clocks owe.
            STORAGE_CLOCK => 1.0,
            _ => 1e-10,
        };
        assert!(line.relative_error < limit, "{name}");
    }
    let left = fuel(out);
    println!("  methane above {ABOVE} m: {left:.1e} of the gas at most");
    assert!(left < LEFT, "{left}");

    for name in ["hottest_gas", "hottest_particle", "mean_temperature"] {
        let (one, other) = (mean(&flames, name), mean(burnt, name));
        println!(
            "  {name}: {one:.1} K by flames, {other:.1} K by burnt gas, in the mean of {OVER} s"
        );
        assert!(
            name == "hottest_gas" || (one - other).abs() < ALIKE,
            "{name}: {one} {other}"
        );
    }
    let hottest = mean(&flames, "hottest_gas");
    assert!(LIT < hottest && hottest < COMPLETE, "{hottest}");
}

/// A quantity of a run in the mean of its last records.
fn mean(series: &Series, name: &str) -> f64 {
    let times = series.column("process_time");
    let from = times.last().unwrap() - OVER;
    let values = times
        .iter()
        .zip(series.column(&format!("quantities.{name}")));
    let last: Vec<f64> = values
        .filter(|(time, _)| **time > from)
        .map(|(_, value)| *value)
        .collect();
    last.iter().sum::<f64>() / last.len() as f64
}

/// Largest mass fraction of methane above the burners at the end.
pub fn fuel(out: &Path) -> f64 {
    let files = read::collection(out, "gas.pvd").unwrap();
    let arrays = read::arrays(&files.last().unwrap().1).unwrap();
    let points = arrays["points"].values.as_chunks::<3>().0;
    let corners = &arrays["connectivity"].values;
    let mut begin = 0;
    let mut most = 0.0_f64;
    for (end, methane) in arrays["offsets"].values.iter().zip(&arrays["CH4"].values) {
        let end = *end as usize;
        let heights = corners[begin..end].iter().map(|k| points[*k as usize][2]);
        if heights.fold(f64::MAX, f64::min) > ABOVE - 1e-6 {
            most = most.max(*methane);
        }
        begin = end;
    }
    most
}
