//! Reacting beds through the program: the ledger, the order in the window, mass against oxygen, resuming.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;

use crate::support::program;

fn run(case: &str, out: &Path, settings: &[&str]) -> Summary {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(case);
    program::run(&path, out, &[], settings);
    Summary::read(out).unwrap()
}

fn value(summary: &Summary, name: &str) -> f64 {
    summary.quantities[name].value.unwrap()
}

fn closes(summary: &Summary) {
    for name in ["mass", "energy", "energy_exchange", "particle_mass"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-11, "{name}: {error}");
    }
    assert!(summary.ledger.elements.len() >= 3);
    for (element, line) in &summary.ledger.elements {
        assert!(
            line.relative_error < 1e-11,
            "{element}: {}",
            line.relative_error
        );
    }
}

#[test]
fn burning_lime_converges_with_its_windows_and_closes_elements_and_energy() {
    let folder = tempfile::tempdir().unwrap();
    let lime = |step: &str| {
        let step = format!("time.process_step={step}");
        let out: PathBuf = folder.path().join(step.replace(['=', ' '], "-"));
        let settings = [
            "time.end=640 s",
            "output.every=640 s",
            "output.series_every=640 s",
            &step,
        ];
        let summary = run("cases/lime-burning.toml", &out, &settings);
        closes(&summary);
        value(&summary, "lime")
    };
    let [coarse, middle, fine] = ["80 s", "40 s", "20 s"].map(lime);
    let order = ((coarse - middle) / (middle - fine)).abs().log2();
    // First order, as an implicit step of the gas and held gas about the particles are.
    assert!(fine > 0.04 && (fine / middle - 1.0).abs() < 0.04);
    assert!(
        (order - 1.0).abs() < 0.15,
        "{order}: {coarse} {middle} {fine}"
    );
}

/// Baker (1962), J. Chem. Soc. 464: the pressure of carbon dioxide over calcite and lime in Pa.
fn over_lime(temperature: f64) -> f64 {
    101_325.0 * 10f64.powf(7.079 - 8308.0 / temperature)
}

#[test]
fn a_stone_in_a_closed_box_of_its_own_gas_ends_at_equilibrium_whatever_the_window() {
    let case = "tests/inputs/good/calcining-box.toml";
    let folder = tempfile::tempdir().unwrap();
    // Windows shorter and longer than the box takes to come to equilibrium.
    let runs = [("60 s", "10"), ("600 s", "30")];
    let pressures = runs.map(|(step, attempts)| {
        let settings = [
            &*format!("time.process_step={step}"),
            "time.end=2 h",
            &*format!("coupling.exchange.attempts={attempts}"),
        ];
        let summary = run(case, &folder.path().join(attempts), &settings);
        assert!(!summary.warnings.contains_key("exchange_attempts"));
        for element in ["C", "O", "Ca"] {
            let error = summary.ledger.elements[element].relative_error;
            assert!(error < 1e-9, "{element}: {error}");
        }
        let pressure = value(&summary, "pressure");
        // As far as published equilibria lie apart.
        let expected = over_lime(value(&summary, "stone_temperature"));
        assert!(
            (pressure / expected - 1.0).abs() < 0.08,
            "{step}: {pressure} {expected}"
        );
        pressure
    });
    assert!(
        (pressures[1] / pressures[0] - 1.0).abs() < 0.01,
        "{pressures:?}"
    );
}

/// How far the gas of the box is from equilibrium with its pellet, as the quotient of its amounts over the constant.
fn off_equilibrium(summary: &Summary) -> f64 {
    let moles = value(summary, "carbon_dioxide") / 44.0095 * 28.0101;
    let constant = (-0.3 + 100.0 / value(summary, "pellet_temperature")).exp();
    moles / value(summary, "carbon_monoxide") / constant - 1.0
}

/// Over windows of a thousand times what the box takes to equilibrium, a pellet reacts in full or not at all, by the gas
/// that it is asked about: the rates agree long before the gas does. Such a window is cut, or told where it may not be.
#[test]
fn a_window_over_which_the_gas_of_a_closed_box_does_not_settle_is_cut() {
    let case = "tests/inputs/good/wustite-box.toml";
    let folder = tempfile::tempdir().unwrap();
    let short = run(case, &folder.path().join("short"), &[]);
    assert!(!short.warnings.contains_key("exchange_attempts"));
    assert!(off_equilibrium(&short).abs() < 2e-3);
    let mut ends = Vec::new();
    for (name, step) in [("long", "1e5 s"), ("longer", "1e6 s")] {
        let step = [
            &*format!("time.process_step={step}"),
            "time.end=1e6 s",
            "output.every=1e6 s",
            "gas.controls.outer_tolerance=1e-8",
        ];
        let cut = run(case, &folder.path().join(name), &step);
        assert!(cut.warnings.is_empty(), "{:?}", cut.warnings);
        assert!(cut.convergence.cuts > 0, "{:?}", cut.convergence);
        assert!(off_equilibrium(&cut).abs() < 2e-3, "{name}");
        ends.push(value(&cut, "wustite"));
        for element in ["C", "O", "Fe"] {
            let error = cut.ledger.elements[element].relative_error;
            assert!(error < 1e-9, "{element}: {error}");
        }
    }
    // The short run has a hundredth of their time, and is not quite at the end.
    assert!((ends[1] / ends[0] - 1.0).abs() < 1e-6, "{ends:?}");
    assert!((ends[0] / value(&short, "wustite") - 1.0).abs() < 5e-3);
    let whole = [
        "time.process_step=1e6 s",
        "time.end=1e6 s",
        "output.every=1e6 s",
        "coupling.exchange.cuts=0",
    ];
    let whole = run(case, &folder.path().join("whole"), &whole);
    assert_eq!(whole.warnings["exchange_attempts"].windows, 1);
    assert_eq!(whole.convergence.cuts, 0);
    let apart = value(&whole, "wustite") / value(&short, "wustite") - 1.0;
    assert!(apart.abs() > 0.1, "it has settled: {apart}");
}

/// Pellets whose interfaces are at equilibrium take gases that the reactions of others make, and layers are thin at first.
/// With K in place of its root in equations of 0.788 moles, carbon monoxide and hydrogen went round in opposite circles, without end.
#[test]
fn pellets_at_equilibrium_with_two_gases_react_without_fractions_below_zero() {
    let folder = tempfile::tempdir().unwrap();
    let summary = run("tests/inputs/good/stiff-ore.toml", folder.path(), &[]);
    closes(&summary);
    assert!(
        !summary.warnings.contains_key("mass_fraction"),
        "{:?}",
        summary.warnings
    );
    // Where a window is cut as often as it may be, it may leave 3 % in the wrong place.
    let worst = summary.warnings.get("exchange_attempts");
    assert!(
        worst.is_none_or(|one| one.worst < 0.03),
        "{:?}",
        summary.warnings
    );
    // 16 pellets of 0.117 g cannot lose more oxygen than the gas of a minute takes.
    let left = value(&summary, "pellet_mass");
    assert!(left < 1.1729e-4 && left > 1.0e-4, "{left}");
}

#[test]
fn every_key_of_reactions_runs_and_closes() {
    let folder = tempfile::tempdir().unwrap();
    let summary = run("tests/inputs/good/reactions.toml", folder.path(), &[]);
    closes(&summary);
    assert!(
        value(&summary, "oxide") > 0.05,
        "{}",
        value(&summary, "oxide")
    );
}

#[test]
fn ore_is_reduced_step_by_step_and_its_oxygen_leaves_with_the_gas() {
    let folder = tempfile::tempdir().unwrap();
    let summary = run(
        "cases/ore-reduction.toml",
        folder.path(),
        &["time.end=100 s"],
    );
    closes(&summary);
    assert!(summary.ledger.elements.contains_key("Fe"));
    assert!(value(&summary, "magnetite") > value(&summary, "wustite"));
    assert!(value(&summary, "wustite") > value(&summary, "iron"));
    assert!(value(&summary, "iron") > 1e-3);
}

/// Kind `regression`: highest temperature of the flame in K as `native-solver/tests/flame.rs` records it for the same flame,
/// built there without a case file.
const REGRESSION_PEAK: f64 = 1933.69;

/// From the case file to the ledger: the built-in mechanism, one of CHEMKIN's form with PaSR and k-epsilon, and
/// reactions that the case states.
#[test]
fn gas_that_reacts_with_itself_runs_and_closes() {
    let folder = tempfile::tempdir().unwrap();
    for (name, settings) in [
        (
            "flame",
            &[
                "time.acceleration=678",
                "time.end=220 ms",
                "gas.controls.outer_tolerance=1e-8",
            ][..],
        ),
        ("gas-mechanism", &[]),
        ("gas-reactions", &[]),
    ] {
        let case = format!("tests/inputs/good/{name}.toml");
        let out = folder.path().join(name);
        let summary = run(&case, &out, settings);
        closes(&summary);
        for element in ["C", "H", "O", "N"] {
            let moved = summary.ledger.elements[element].throughput;
            assert!(moved > 0.0, "{name}: {element}");
        }
        if name == "flame" {
            let peak = value(&summary, "peak");
            println!("flame: {peak:.2} K");
            assert!((peak - REGRESSION_PEAK).abs() < 0.5, "regression: {peak} K");
        }
    }
}
