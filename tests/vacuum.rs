//! Particles without a gas.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::program;

fn case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/vacuum.toml")
}

/// No buoyancy and no drag: g t and h − g t²/2, which velocity Verlet computes exactly; with native particles and LIGGGHTS.
#[test]
fn a_bead_falls_in_a_vacuum_as_galileo_says() {
    let folder = tempfile::tempdir().unwrap();
    for particles in ["native", "liggghts"] {
        let out = folder.path().join(particles);
        program::run(&case(), &out, &["--particles", particles], &[""; 0]);
        let series = Series::read(&out).unwrap();
        let last = |name: &str| *series.column(name).last().unwrap();
        let (speed, height) = (last("quantities.speed"), last("quantities.height"));
        assert!(
            (speed / (9.81 * 0.2) - 1.0).abs() < 1e-9,
            "{particles}: {speed}"
        );
        let fallen = 0.5 * 9.81 * 0.2 * 0.2;
        assert!(
            ((0.25 - height) / fallen - 1.0).abs() < 1e-9,
            "{particles}: {height}"
        );
        let summary = Summary::read(&out).unwrap();
        assert!(
            summary.warnings.is_empty() && summary.case_warnings.is_empty(),
            "{summary:?}"
        );
    }
}

/// A whole gas solver is not started for a vacuum.
#[test]
fn openfoam_has_nothing_to_do_in_a_vacuum() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    program::run(&case(), &out, &["--gas", "openfoam"], &["time.end=10 ms"]);
    assert!(!out.join("log/openfoam.log").exists());
}
