//! Every shipped case runs, natively (what moves, with LIGGGHTS) and with both production solvers, its ledger closed and its
//! temperatures between those of its sources.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::Series;

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut found: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .filter(|path| calcine::case::kind_of(path, &[]).unwrap().name == "bed")
        .collect();
    found.sort();
    assert!(found.len() >= 2, "{found:?}");
    found
}

fn moves(case: &Path) -> bool {
    fs::read_to_string(case)
        .unwrap()
        .contains("motion = \"free\"")
}

/// True for parcels, which move natively.
fn has_parcels(case: &Path) -> bool {
    fs::read_to_string(case)
        .unwrap()
        .contains("motion = \"parcels\"")
}

/// Cases of hours, in steps of process time.
fn steps(case: &Path) -> bool {
    fs::read_to_string(case).unwrap().contains("process_step")
}

fn has_species(case: &Path) -> bool {
    fs::read_to_string(case).unwrap().contains("\nspecies = ")
}

fn named(case: &Path) -> String {
    case.file_stem().unwrap().to_string_lossy().into_owned()
}

/// Lowest and highest temperature of what a case starts from and lets in, in K.
fn sources(case: &Path) -> (f64, f64) {
    match &*named(case) {
        "shaft-furnace" => (300.0, 2190.0),
        "purged-bed" => (300.0, 600.0),
        "packed-column" => (293.15, 313.15),
        "iron-stack" => (675.0, 725.0),
        "bed-conductivity" => (850.0, 950.0),
        // Reactions heat and cool what they are in.
        "ore-reduction" => (1050.0, 1250.0),
        "lime-burning" => (1000.0, 1200.0),
        "calcining-stone" => (1000.0, 1400.0),
        "ore-pellet" => (1050.0, 1250.0),
        "char-particle" => (1050.0, 1180.0),
        "catalyst-pellet" => (670.0, 720.0),
        "dri-self-heating" => (300.0, 340.0),
        "wet-drum" => (330.0, 1200.0),
        "tg-furnace" => (293.15, 303.15),
        "tg-heap" => (293.15, 293.15),
        _ => (300.0, 400.0),
    }
}

#[test]
fn every_shipped_case_runs_natively_and_with_both_solvers_between_its_sources() {
    let directory = tempfile::tempdir().unwrap();
    for case in shipped() {
        for (gas, particles) in [("native", "native"), ("openfoam", "liggghts")] {
            let (particles, end) = match moves(&case) {
                // Five windows at its AF of 678: the burners open at 20 s.
                true if named(&case) == "shaft-furnace" => ("liggghts", "time.end=34 s"),
                true => ("liggghts", "time.end=0.05 s"),
                false if named(&case) == "pipe" => (particles, "time.end=6 s"),
                false if has_parcels(&case) => ("native", "time.end=0.05 s"),
                false if steps(&case) => (particles, "time.end=100 s"),
                false => (particles, "time.end=8 s"),
            };
            let name = format!("{}-{gas}", case.file_stem().unwrap().to_string_lossy());
            let out = directory.path().join(name);
            let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
                .arg("run")
                .arg(&case)
                .args(["--gas", gas, "--particles", particles, "--quiet"])
                .args(["--set", end])
                .arg("--out")
                .arg(&out)
                .output()
                .unwrap();
            let text = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {text}", case.display());
            let summary = Summary::read(&out).unwrap();
            let error = |name: &str| summary.ledger.lines[name].relative_error;
            assert!(
                error("mass") < 1e-10 && error("energy") < 1e-10,
                "{}",
                case.display()
            );
            assert!(error("momentum") < 1e-12, "{}", case.display());
            assert_eq!(has_species(&case), !summary.ledger.elements.is_empty());
            for (element, line) in &summary.ledger.elements {
                assert!(line.relative_error < 1e-10, "{}: {element}", case.display());
            }
            assert_eq!(
                summary.convergence.unsettled_windows,
                0,
                "{}",
                case.display()
            );
            let (coldest, hottest) = sources(&case);
            // With species the enthalpy is not linear in temperature, and under a moving bed limited fluxes
            // change from window to window: what the outer loop leaves, 1e-6 of a heat content from 0 K, may
            // show.
            let loose = has_species(&case) || moves(&case) || has_parcels(&case);
            let slack = if loose { 6e-4 } else { 1e-6 };
            let series = Series::read(&out).unwrap();
            for name in ["gas.temperature_min", "particles.temperature_min"] {
                let least = series.column(name).iter().copied().fold(f64::MAX, f64::min);
                assert!(
                    least > coldest - slack,
                    "{}: {name} {least} K",
                    case.display()
                );
            }
            for name in ["gas.temperature_max", "particles.temperature_max"] {
                let most = series.column(name).iter().copied().fold(f64::MIN, f64::max);
                assert!(
                    most < hottest + slack,
                    "{}: {name} {most} K",
                    case.display()
                );
            }
        }
    }
}
