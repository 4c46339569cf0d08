//! Agreement of the native particles and LIGGGHTS' on a bed that moves, with feed and discharge, and of
//! LIGGGHTS on one, two and three ranks, between which particles wander, with either gas.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout
)]

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::program::{self, shipped};

#[test]
fn a_moving_bed_is_heated_alike_by_native_particles_and_by_liggghts() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("comparison");
    let pairings = "native+native,native+liggghts";
    let comparison = program::compare(&shipped("moving-bed"), &out, pairings, &["time.end=40 s"]);
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

/// The summary of the moving bed with options and settings.
fn run(directory: &Path, name: &str, options: &[&str], set: &[&str]) -> Value {
    let out = directory.join(name);
    let words = [&["--particles", "liggghts"], options].concat();
    program::run(&shipped("moving-bed"), &out, &words, set);
    let text = fs::read_to_string(out.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Every line of the ledger moved something and closes; OpenFOAM's momentum to what its outer loop leaves.
fn assert_closed(name: &str, summary: &Value) {
    for line in [
        "mass",
        "energy",
        "momentum",
        "particle_mass",
        "particle_momentum",
    ] {
        let error = summary["ledger"][line]["relative_error"].as_f64().unwrap();
        println!("{name}, {line}: {error:.1e}");
        let most = match line {
            "particle_momentum" | "particle_mass" => 1e-13,
            _ => 1e-10,
        };
        assert!(error < most, "{name}, {line}: {error}");
        let moved = summary["ledger"][line]["throughput"].as_f64().unwrap();
        assert!(moved > 0.0, "{name}, {line}");
    }
}

fn value(summary: &Value, quantity: &str) -> f64 {
    summary["quantities"][quantity]["value"].as_f64().unwrap()
}

/// Mass in kg that came in and went out.
fn traded(summary: &Value) -> f64 {
    summary["ledger"]["particle_mass"]["throughput"]
        .as_f64()
        .unwrap()
}

#[test]
fn a_moving_bed_is_heated_alike_on_one_two_and_three_ranks_of_liggghts() {
    let directory = tempfile::tempdir().unwrap();
    let [one, two, three] = ["1", "2", "3"].map(|ranks| {
        let options = ["--ranks-particles", ranks];
        run(directory.path(), ranks, &options, &["time.end=20 s"])
    });
    for (ranks, summary) in [("1", &one), ("2", &two), ("3", &three)] {
        assert_closed(ranks, summary);
        // What the case feeds and takes out does not depend on where it comes in and goes out.
        assert_eq!(one["particles"], summary["particles"], "{ranks} ranks");
        let apart = traded(&one) - traded(summary);
        assert!(
            apart.abs() < 1e-12 * traded(&one),
            "{ranks} ranks: {apart} kg"
        );
        let apart = value(&one, "mean_temperature") - value(summary, "mean_temperature");
        assert!(apart.abs() < 0.5, "{ranks} ranks: {apart} K");
    }
}

#[test]
fn three_ranks_of_openfoam_and_three_of_liggghts_do_what_one_of_each_does() {
    let directory = tempfile::tempdir().unwrap();
    let set = [
        "time.end=5 s",
        "feeds[0].mass_rate=4 g/s",
        "outlets[0].mass_rate=4 g/s",
    ];
    let [one, three] = ["1", "3"].map(|ranks| {
        let options = [
            "--gas",
            "openfoam",
            "--ranks-gas",
            ranks,
            "--ranks-particles",
            ranks,
        ];
        run(directory.path(), ranks, &options, &set)
    });
    for (ranks, summary) in [(1, &one), (3, &three)] {
        assert_closed(&format!("{ranks} + {ranks}"), summary);
        for solver in ["gas", "particles"] {
            assert_eq!(summary["solver"][solver]["ranks"], ranks);
        }
    }
    assert_eq!(one["particles"], three["particles"]);
    assert!((traded(&one) - traded(&three)).abs() < 1e-12 * traded(&one));
    for name in ["mean_temperature", "top_gas"] {
        let apart = value(&one, name) - value(&three, name);
        println!("{name}: {apart:.1e} K");
        assert!(apart.abs() < 0.05, "{name}: {apart} K");
    }
}
