//! Agreement of the native particles and LIGGGHTS' on a bed that moves, with feed and discharge, and of
//! LIGGGHTS on one rank and two, between which particles wander.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

#[test]
fn a_moving_bed_is_heated_alike_by_native_particles_and_by_liggghts() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("comparison");
    let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("compare")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/moving-bed.toml"))
        .args(["--pairings", "native+native,native+liggghts", "--quiet"])
        .args(["--set", "time.end=40 s"])
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}");
    let text = fs::read_to_string(out.join("compare.json")).unwrap();
    let comparison: Value = serde_json::from_str(&text).unwrap();
    for run in comparison["runs"].as_array().unwrap() {
        assert_eq!(run["complete"], true);
        assert!(run["ledger_error"].as_f64().unwrap() < 1e-10, "{run}");
    }
    // Feed and hot gas are 100 K apart; 0.5 % of that.
    for name in ["mean_temperature", "top_gas"] {
        let all = comparison["quantities"].as_array().unwrap();
        let quantity = all.iter().find(|entry| entry["name"] == name).unwrap();
        let most = quantity["largest"]["difference"].as_f64().unwrap();
        assert!(most < 0.5, "{name}: {most} K");
    }
}

#[test]
fn a_moving_bed_is_heated_alike_on_one_rank_of_liggghts_and_on_two() {
    let directory = tempfile::tempdir().unwrap();
    let [one, two] = ["1", "2"].map(|ranks| {
        let out = directory.path().join(ranks);
        let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
            .arg("run")
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/moving-bed.toml"))
            .args(["--particles", "liggghts", "--ranks-particles", ranks])
            .args(["--set", "time.end=20 s", "--quiet", "--out"])
            .arg(&out)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{text}");
        let text = fs::read_to_string(out.join("summary.json")).unwrap();
        serde_json::from_str::<Value>(&text).unwrap()
    });
    for (ranks, summary) in [(1, &one), (2, &two)] {
        for line in [
            "mass",
            "energy",
            "momentum",
            "particle_mass",
            "particle_momentum",
        ] {
            let error = summary["ledger"][line]["relative_error"].as_f64().unwrap();
            // On two ranks 1.5e-4 of the particles' momentum stays open (docs/verification.md).
            let most = match (ranks, line) {
                (2, "particle_momentum") => 1e-3,
                _ => 1e-10,
            };
            assert!(error < most, "{line}: {error}");
            let moved = summary["ledger"][line]["throughput"].as_f64().unwrap();
            assert!(moved > 0.0, "{line}");
        }
    }
    assert_eq!(one["particles"], two["particles"]);
    let mean = |of: &Value| {
        of["quantities"]["mean_temperature"]["value"]
            .as_f64()
            .unwrap()
    };
    assert!((mean(&one) - mean(&two)).abs() < 0.5);
}
