//! Particles that leave the gas mesh where no wall closes it: they end the run by name and place, or are taken out and booked,
//! with the native particles and with LIGGGHTS alike.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::Output;

use calcine::exit;
use calcine::results::Summary;

use crate::support::program::{self, shipped};
use crate::support::{results_equal, stopped};

/// Beads that fall 31 mm towards a bottom without a wall; the lowest begin at 10 mm.
const SET: [&str; 3] = [
    "walls[0].patches=[\"side\", \"top\"]",
    "time.end=0.08 s",
    "output.series_every=0.02 s",
];

fn run(out: &Path, arguments: &[&str], more: &[&str]) -> Output {
    let set = [&SET[..], more].concat();
    program::command(&shipped("settled-bed"), out, arguments, &set)
        .output()
        .unwrap()
}

#[test]
fn a_particle_that_leaves_ends_the_run_with_its_place_and_what_to_do() {
    for particles in ["native", "liggghts"] {
        let out = tempfile::tempdir().unwrap();
        let ended = run(out.path(), &["--particles", particles], &[]);
        let told = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(
            ended.status.code(),
            Some(i32::from(exit::DIVERGED)),
            "{told}"
        );
        for part in ["particle ", "motion.lost", "calcine check"] {
            assert!(told.contains(part), "{particles}: {part}: {told}");
        }
    }
}

#[test]
fn particles_that_leave_are_taken_out_booked_and_warned_of() {
    let mut gone = Vec::new();
    for particles in ["native", "liggghts"] {
        let out = tempfile::tempdir().unwrap();
        let take_out = ["motion.lost=\"take-out\""];
        let ended = run(out.path(), &["--particles", particles], &take_out);
        let told = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert!(ended.status.success(), "{particles}: {told}");
        let summary = Summary::read(out.path()).unwrap();
        let lost = summary.passed.lost;
        assert!(lost.rows > 50 && summary.particles > 50, "{lost:?}");
        let bead = std::f64::consts::PI / 6.0 * 8e-9 * 2500.0;
        let mass = lost.rows as f64 * bead;
        assert!((lost.mass_kg - mass).abs() < 1e-12 * mass, "{lost:?}");
        for name in [
            "mass",
            "energy",
            "momentum",
            "particle_mass",
            "particle_momentum",
        ] {
            let error = summary.ledger.lines[name].relative_error;
            assert!(error < 1e-10, "{particles}, {name}: {error}");
        }
        let warning = &summary.warnings["lost_particles"];
        assert_eq!(warning.count, lost.rows, "{warning:?}");
        let sentence = warning.sentence();
        assert!(
            sentence.contains(" of particle ") && sentence.contains(" m at "),
            "{sentence}"
        );
        let page = std::fs::read_to_string(out.path().join("report.html")).unwrap();
        assert!(page.contains("Particles that came and went") && page.contains("lost"));
        gone.push(lost.rows);
    }
    // Few meet on the way, and those that do round differently.
    let [native, liggghts] = gone[..] else {
        unreachable!()
    };
    assert!(native.abs_diff(liggghts) <= 1, "{gone:?}");
}

#[test]
fn what_leaves_through_an_outlet_within_a_window_is_discharged() {
    // 1 mm thick; beads fall 6 mm in a window.
    let outlet = "outlets=[{ name = \"hole\", region = { box = { from = \"-1 -1 0 mm\", to = \"17 17 1 mm\" } } }]";
    for particles in ["native", "liggghts"] {
        let out = tempfile::tempdir().unwrap();
        let more = [outlet, "time.motion_window=10 ms"];
        let ended = run(out.path(), &["--particles", particles], &more);
        let told = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert!(ended.status.success(), "{particles}: {told}");
        let summary = Summary::read(out.path()).unwrap();
        let passed = &summary.passed;
        assert!(passed.discharged.rows > 50 && passed.lost.rows == 0);
        for name in ["mass", "energy", "momentum", "particle_mass"] {
            let error = summary.ledger.lines[name].relative_error;
            assert!(error < 1e-10, "{particles}, {name}: {error}");
        }
    }
    // One with a rate of its own takes no more than that.
    let out = tempfile::tempdir().unwrap();
    let slow = outlet.replace(" region", " mass_rate = \"1e-9 kg/s\", region");
    let ended = run(out.path(), &[], &[&slow, "time.motion_window=10 ms"]);
    assert_eq!(ended.status.code(), Some(i32::from(exit::DIVERGED)));
}

#[test]
fn a_run_that_lost_particles_is_stopped_and_resumed_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        SET[0],
        SET[1],
        "motion.lost=\"take-out\"",
        "time.motion_window=0.2 ms",
        "output.series_every=0.2 ms",
    ];
    let out = ["whole", "stopped"].map(|name| folder.path().join(name));
    let command = |out: &Path| program::command(&shipped("settled-bed"), out, &[], &set);
    stopped::finish(command(&out[0]));
    // The first beads leave after 45 ms.
    stopped::stop_and_resume(|| command(&out[1]), &out[1], 270);
    let [whole, resumed] = out.each_ref().map(|out| Summary::read(out).unwrap());
    assert_eq!(whole.passed.lost, resumed.passed.lost);
    assert!(whole.passed.lost.rows > 50);
    let differing = results_equal::differences(&out[0], &out[1]);
    assert!(differing.is_empty(), "{differing:?}");
}
