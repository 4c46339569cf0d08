//! Particles resolved along their radius, through the program: balances, pairings, shells, interrupts.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::{killed, program};

/// The lime of the stone at the end, and its ledger closed.
fn lime(out: &Path, words: &[&str], set: &[&str]) -> f64 {
    program::run(&program::shipped("calcining-stone"), out, words, set);
    let summary = Summary::read(out).unwrap();
    for name in ["mass", "energy", "energy_exchange", "particle_mass"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-12, "{name}: {error}");
    }
    for (element, line) in &summary.ledger.elements {
        let error = line.relative_error;
        assert!(error < 1e-12, "{element}: {error}");
    }
    let series = Series::read(out).unwrap();
    *series.column("quantities.lime").last().unwrap()
}

#[test]
fn a_stone_burns_alike_in_every_pairing_and_its_ledger_closes() {
    let folder = tempfile::tempdir().unwrap();
    let native = lime(&folder.path().join("native"), &[], &[]);
    assert!((0.8..0.95).contains(&native), "{native}");
    for (gas, particles) in [
        ("native", "liggghts"),
        ("openfoam", "native"),
        ("openfoam", "liggghts"),
    ] {
        let out = folder.path().join(format!("{gas}-{particles}"));
        let words = ["--gas", gas, "--particles", particles];
        let other = lime(&out, &words, &[]);
        // Both gases are solved to 1e-8.
        assert!((other - native).abs() < 1e-6, "{gas} {particles}: {other}");
    }
}

#[test]
fn lime_converges_with_the_number_of_shells_and_auto_becomes_all_shells() {
    let folder = tempfile::tempdir().unwrap();
    let at = |shells: u32| {
        let key = format!("materials.limestone.radial.shells={shells}");
        lime(&folder.path().join(key.clone()), &[], &[&key])
    };
    let [coarse, middle, fine] = [15, 30, 60].map(at);
    println!("{coarse} {middle} {fine}");
    let ratio = (fine - middle) / (middle - coarse);
    // A sharp front: at least first order.
    assert!((0.0..0.8).contains(&ratio), "{coarse} {middle} {fine}");
    let auto = lime(
        &folder.path().join("auto"),
        &[],
        &["materials.limestone.inside=auto"],
    );
    // The stone has its shells from a difference of 5 K on, in its first window, which is computed with them.
    assert!((auto / middle - 1.0).abs() < 1e-9, "{auto} {middle}");
}

#[test]
fn a_run_killed_while_a_stone_burns_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case: PathBuf = program::shipped("calcining-stone");
    let settings = [
        "time.process_step=1 s",
        "output.series_every=1 s",
        "time.checkpoint.every=50 s",
    ];
    killed::resumes_to_the_same_bits(folder.path(), &[200, 700], |out| {
        program::command(&case, out, &[], &settings)
    });
}
