//! SIGTERM, or Ctrl-C, and `--resume`: natively the same bits as without, whether checkpoints are scheduled or not.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::read::Series;
use rustix::process::Signal;

use crate::support::program::{self, shipped};
use crate::support::stopped::Stopped;
use crate::support::{results_equal, stopped};

/// Runs a case without interruption and without checkpoints, then stops it after each number of rows of its series, the first
/// in its first windows, with and
/// without scheduled checkpoints, and compares every value.
fn goes_on_alike(case: &Path, set: &[&str], every: &str, rows: [usize; 3]) {
    let directory = tempfile::tempdir().unwrap();
    let command = |out: &Path, set: &[&str]| program::command(case, out, &[], set);
    let whole = directory.path().join("whole");
    stopped::finish(command(&whole, set));
    let schedule = format!("time.checkpoint.every={every}");
    let scheduled = [set, &[schedule.as_str()]].concat();
    for (set, at) in [(set, rows[0]), (set, rows[1]), (&scheduled[..], rows[2])] {
        let out = directory.path().join(format!("stopped-{at}"));
        stopped::stop_and_resume(|| command(&out, set), &out, at);
        let differing = results_equal::values_that_differ(&whole, &out);
        assert!(differing.is_empty(), "after {at} rows: {differing:?}");
    }
}

#[test]
fn a_bed_that_settles_goes_on_alike() {
    let set = [
        "time.end=0.2 s",
        "output.every=0.04 s",
        "particles[0].place.region.from=2 mm",
        "particles[0].place.region.to=40 mm",
    ];
    goes_on_alike(&shipped("settled-bed"), &set, "30 ms", [1, 75, 50]);
}

/// A terminal that closes leaves a checkpoint; not to a run that was started to live on, as by `nohup`.
#[test]
fn a_run_whose_terminal_closes_leaves_a_checkpoint_unless_it_ignores_that() {
    let directory = tempfile::tempdir().unwrap();
    for (name, ended) in [
        ("closed", Stopped::Checkpointed),
        ("ignored", Stopped::AtItsEnd),
    ] {
        let out = directory.path().join(name);
        let set = ["time.end=0.2 s", "output.every=0.04 s"];
        let run = program::command(&shipped("settled-bed"), &out, &[], &set);
        let run = match ended {
            Stopped::AtItsEnd => {
                let mut shell = Command::new("sh");
                shell.args(["-c", "trap '' HUP; exec \"$@\"", "sh"]);
                shell.arg(run.get_program()).args(run.get_args());
                shell
            }
            _ => run,
        };
        let found = stopped::stop_by(Signal::HUP, run, |_| stopped::rows(&out) >= 3);
        assert_eq!(found, ended, "{name}");
    }
}

/// Particles that react and do not settle with their gas: the run stops at its last commit between two attempts, and begins
/// the window again.
#[test]
fn a_reacting_bed_whose_windows_are_cut_goes_on_alike() {
    let directory = tempfile::tempdir().unwrap();
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/stiff-ore.toml");
    let command = |out: &Path| program::command(&case, out, &[], &["time.end=20 s"]);
    let whole = directory.path().join("whole");
    stopped::finish(command(&whole));
    for cuts in [2, 6] {
        let out = directory.path().join(format!("stopped-{cuts}"));
        let cut = |_| {
            let log = std::fs::read_to_string(out.join("log/calcine.log")).unwrap_or_default();
            log.matches("the window is cut").count() >= cuts
        };
        assert_eq!(
            stopped::stop(command(&out), cut),
            stopped::Stopped::Checkpointed
        );
        let mut resumed = command(&out);
        resumed.arg("--resume");
        stopped::finish(resumed);
        let differing = results_equal::values_that_differ(&whole, &out);
        assert!(differing.is_empty(), "after {cuts} cuts: {differing:?}");
    }
}

#[test]
fn a_fluidised_bed_goes_on_alike() {
    let set = [
        "time.end=0.3 s",
        "output.every=0.1 s",
        "output.series_every=2 ms",
        "particles[0].place.height=30 mm",
    ];
    goes_on_alike(&shipped("fluidised-bed"), &set, "50 ms", [1, 75, 50]);
}

#[test]
fn a_rotating_drum_goes_on_alike() {
    let set = [
        "time.end=0.5 s",
        "output.every=0.1 s",
        "output.series_every=5 ms",
    ];
    goes_on_alike(&shipped("rotating-drum"), &set, "70 ms", [1, 75, 50]);
}

#[test]
fn a_bed_with_feed_and_outlet_goes_on_alike() {
    let set = [
        "time.end=30 s",
        "output.every=5 s",
        "output.series_every=0.5 s",
        "feeds[0].mass_rate=4 g/s",
        "outlets[0].mass_rate=4 g/s",
    ];
    goes_on_alike(&shipped("moving-bed"), &set, "7 s", [1, 40, 25]);
}

#[test]
fn a_bed_that_reacts_goes_on_alike() {
    let set = [
        "time.end=20 min",
        "output.every=4 min",
        "output.series_every=20 s",
        "mesh.box.size=24 24 132 mm",
        "mesh.box.cells=[2, 2, 11]",
        "particles[0].place.grid.counts=[2, 2, 8]",
    ];
    goes_on_alike(&shipped("ore-reduction"), &set, "3 min", [1, 40, 25]);
}

/// Views hold for 3 s, while particles come and go.
#[test]
fn a_moving_bed_that_radiates_goes_on_alike() {
    let set = [
        "time.end=30 s",
        "output.every=10 s",
        "output.series_every=0.5 s",
    ];
    let case = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/moving-heat.toml");
    goes_on_alike(&case, &set, "5 s", [10, 43, 25]);
}

/// The largest difference of columns of two series that have these words in their names, relative to the larger value.
fn apart(one: &Path, other: &Path, words: &[&str]) -> f64 {
    let [one, other] = [one, other].map(|out| Series::read(out).unwrap());
    let mut largest = 0.0f64;
    for name in one
        .names
        .iter()
        .filter(|name| words.iter().any(|word| name.contains(word)))
    {
        let pairs = one.column(name).iter().zip(other.column(name));
        for (a, b) in pairs.filter(|(a, b)| a != b) {
            largest = largest.max((a - b).abs() / a.abs().max(b.abs()));
        }
    }
    largest
}

/// calcineGasFoam reads anew what it wrote, and has the bits that it had.
#[test]
fn a_frozen_bed_in_an_openfoam_gas_goes_on_alike() {
    let directory = tempfile::tempdir().unwrap();
    let set = [
        "time.end=10 s",
        "output.every=5 s",
        "output.series_every=0.1 s",
    ];
    let case = shipped("heated-column");
    let command = |out: &Path| program::command(&case, out, &["--gas", "openfoam"], &set);
    let whole = directory.path().join("whole");
    stopped::finish(command(&whole));
    for at in [1, 12, 47] {
        let out = directory.path().join(format!("stopped-{at}"));
        stopped::stop_and_resume(|| command(&out), &out, at);
        let differing = results_equal::values_that_differ(&whole, &out);
        assert!(differing.is_empty(), "after {at} rows: {differing:?}");
    }
}

/// An unscheduled checkpoint has LIGGGHTS read anew what it wrote: a frozen bed may then differ by round-off from the run
/// without a stop, which the solver of the pressure amplifies (docs/how-to/continue-a-run.md).
#[test]
fn a_frozen_bed_with_external_solvers_goes_on_within_round_off() {
    let directory = tempfile::tempdir().unwrap();
    let set = [
        "time.end=10 s",
        "output.every=5 s",
        "output.series_every=0.1 s",
    ];
    let words = ["--gas", "openfoam", "--particles", "liggghts"];
    let case = shipped("heated-column");
    let command = |out: &Path| program::command(&case, out, &words, &set);
    let (whole, out) = (directory.path().join("whole"), directory.path().join("out"));
    stopped::finish(command(&whole));
    stopped::stop_and_resume(|| command(&out), &out, 12);
    let temperatures = apart(&whole, &out, &["temperature"]);
    assert!(temperatures <= 1e-7, "{temperatures}");
    let pressure = apart(&whole, &out, &["pressure_drop"]);
    assert!(pressure <= 1e-7, "{pressure}");
}
