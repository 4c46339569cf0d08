//! The turning drum of wet parcels that dry and char: ledger with both gases, resuming, threads.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine::results::Summary;

use crate::support::{killed, program, results_equal, stopped};

/// Wood that gives off volatiles from the start: drying and charring at once, in the little time of a test.
const AT_ONCE: [&str; 4] = [
    "time.end=0.2 s",
    "reactions.volatiles.rate.factor=2.58e22",
    "particles.chips.temperature=360 K",
    "time.checkpoint.every=20 ms",
];

fn closes(out: &Path) -> Summary {
    let summary = Summary::read(out).unwrap();
    for name in [
        "mass",
        "energy",
        "energy_exchange",
        "momentum",
        "particle_mass",
        "particle_momentum",
    ] {
        let error = summary.ledger.lines[name].relative_error;
        println!("{name} {error:.1e}");
        assert!(error < 1e-10, "{name}: {error}");
    }
    for (element, line) in &summary.ledger.elements {
        println!("{element} {:.1e}", line.relative_error);
        assert!(line.relative_error < 1e-10, "{element}: {line:?}");
    }
    assert_eq!(summary.convergence.unsettled_windows, 0);
    summary
}

#[test]
fn a_turning_drum_of_wet_parcels_dries_chars_and_closes_its_ledger_with_both_gases() {
    let folder = tempfile::tempdir().unwrap();
    let runs = [("native", "native"), ("openfoam", "native")].map(|(gas, particles)| {
        let out = folder.path().join(gas);
        let words = ["--gas", gas, "--particles", particles];
        program::run(&program::shipped("wet-drum"), &out, &words, &AT_ONCE);
        let summary = closes(&out);
        let names = ["moisture", "char", "mean_temperature", "outlet_h2o"];
        names.map(|name| summary.quantities[name].value.unwrap())
    });
    println!("{runs:?}");
    let [native, openfoam] = runs;
    assert!(native[0] < 0.0999 && native[1] > 1e-5, "{native:?}");
    for (name, (one, other)) in ["moisture", "char", "temperature", "outlet_h2o"]
        .iter()
        .zip(native.iter().zip(openfoam))
    {
        assert!((one / other - 1.0).abs() < 0.02, "{name}: {runs:?}");
    }
}

#[test]
fn a_turning_drum_of_wet_parcels_that_is_killed_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("wet-drum");
    let settings = [&AT_ONCE[..], &["output.series_every=10 ms"]].concat();
    killed::resumes_to_the_same_bits(folder.path(), &[4, 7, 11, 16], |out| {
        program::command(&case, out, &[], &settings)
    });
}

#[test]
fn a_turning_drum_of_wet_parcels_has_the_same_bits_on_one_thread_and_on_two() {
    let folder = tempfile::tempdir().unwrap();
    let runs = ["1", "2"].map(|threads| {
        let out = folder.path().join(threads);
        let words = ["--threads", threads];
        program::run(&program::shipped("wet-drum"), &out, &words, &AT_ONCE);
        out
    });
    let differing = results_equal::differences(&runs[0], &runs[1]);
    assert!(differing.is_empty(), "{differing:?}");
}

/// `cargo xtask validate drum-restarts` interrupts it 50 times.
#[test]
fn a_turning_drum_that_is_interrupted_again_and_again_on_one_and_two_threads_has_the_bits_of_one_that_is_not()
 {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("wet-drum");
    for (gas, end, growths) in [
        ("native", "0.1 s", &[1, 4, 2, 7, 1, 3, 5][..]),
        ("openfoam", "40 ms", &[3, 5][..]),
    ] {
        let settings = [
            AT_ONCE[1],
            AT_ONCE[2],
            "output.series_every=2 ms",
            "output.every=20 ms",
            &format!("time.end={end}"),
        ];
        let command = |out: &Path, threads: &str| {
            let words = ["--gas", gas, "--threads", threads];
            program::command(&case, out, &words, &settings)
        };
        let [whole, out] = ["whole", "stopped"].map(|name| folder.path().join(gas).join(name));
        std::fs::create_dir(folder.path().join(gas)).unwrap();
        stopped::finish(command(&whole, "1"));
        let threads = |stretch: usize| ["2", "1"][stretch % 2];
        let left =
            stopped::interrupt_often(|stretch| command(&out, threads(stretch)), &out, growths);
        assert_eq!(left, growths.len(), "{gas}");
        let differing = results_equal::values_that_differ(&whole, &out);
        assert!(differing.is_empty(), "{gas}: {differing:?}");
    }
}
