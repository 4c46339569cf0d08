//! Long validations and verifications by name: `cargo xtask validate [NAME…]`, all unless named. Each prints what
//! it found and fails where that is off. `cargo test` runs none of them: short relatives of each are among the
//! other tests.

#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

mod agreement;
mod backward_step;
#[path = "../support/blocks.rs"]
mod blocks;
#[cfg(feature = "hdf5")]
mod checkpoint_faults;
#[cfg(feature = "hdf5")]
#[path = "../support/checkpoint_harm.rs"]
mod checkpoint_harm;
mod counter_current;
#[cfg(feature = "hdf5")]
mod drum_restarts;
mod elastic_box;
#[cfg(feature = "hdf5")]
mod external_restarts;
mod flame;
#[cfg(feature = "hdf5")]
#[path = "../support/fluidised.rs"]
mod fluidised;
#[cfg(feature = "hdf5")]
mod fluidised_bed;
mod heated_cavity;
mod hopper;
#[path = "../support/hopper.rs"]
mod hopper_bed;
mod kept;
mod load;
mod moving_bed;
mod paraview;
mod parcel_beds;
#[path = "../support/program.rs"]
mod program;
#[cfg(feature = "hdf5")]
#[path = "../fuzz/random.rs"]
#[allow(dead_code)]
mod random;
mod report_pages;
mod repose;
#[cfg(feature = "hdf5")]
mod restarts;
#[cfg(feature = "hdf5")]
#[path = "../support/results_equal.rs"]
mod results_equal;
mod shaft_choices;
mod shaft_flames;
mod shaft_furnace;
mod skewed_cavity;
mod skewed_meshes;
#[cfg(feature = "hdf5")]
mod slurm;
#[cfg(feature = "hdf5")]
mod slurm_queue;
mod spouted_bed;
mod square_cylinder;
#[cfg(feature = "hdf5")]
#[path = "../support/stopped.rs"]
#[allow(dead_code)]
mod stopped;
mod tg_furnace;
mod voids;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use calcine::results::read::Series;

/// What `cargo xtask validate` says before the names.
const MARK: &str = "--validate";
/// Every validation by its name.
const ALL: &[(&str, fn())] = &[
    ("agreement", agreement::run),
    ("backward-step", backward_step::run),
    #[cfg(feature = "hdf5")]
    ("checkpoint-faults", checkpoint_faults::run),
    #[cfg(feature = "hdf5")]
    ("drum-restarts", drum_restarts::run),
    ("elastic-box", elastic_box::run),
    #[cfg(feature = "hdf5")]
    ("external-restarts", external_restarts::run),
    ("flame", flame::run),
    #[cfg(feature = "hdf5")]
    ("fluidised-bed", fluidised_bed::run),
    ("heated-cavity", heated_cavity::run),
    ("hopper", hopper::run),
    ("load", load::run),
    ("moving-bed", moving_bed::run),
    ("moving-resolved-bed", moving_bed::run_resolved),
    ("paraview", paraview::run),
    ("parcel-beds", parcel_beds::run),
    ("repose", repose::run),
    ("report-pages", report_pages::run),
    #[cfg(feature = "hdf5")]
    ("restarts", restarts::run),
    ("shaft-choices", shaft_choices::run),
    ("shaft-flames", shaft_flames::run),
    ("shaft-furnace", shaft_furnace::run),
    ("skewed-cavity", skewed_cavity::run),
    ("skewed-cavity-1000", skewed_cavity::run_faster),
    ("skewed-meshes", skewed_meshes::run),
    #[cfg(feature = "hdf5")]
    ("slurm", slurm::run),
    ("spouted-bed", spouted_bed::run),
    ("square-cylinder", square_cylinder::run),
    ("tg-furnace", tg_furnace::run),
    ("voids", voids::run),
];

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if !words.iter().any(|word| word == MARK) {
        return ExitCode::SUCCESS;
    }
    let names: Vec<&String> = words.iter().filter(|word| *word != MARK).collect();
    if let Some(unknown) = names
        .iter()
        .find(|name| ALL.iter().all(|one| one.0 != **name))
    {
        let known: Vec<&str> = ALL.iter().map(|one| one.0).collect();
        println!(
            "there is no validation {unknown}; there are {}",
            known.join(", ")
        );
        return ExitCode::from(2);
    }
    for (name, run) in ALL {
        if names.is_empty() || names.iter().any(|one| *one == name) {
            println!("{name}");
            let begun = Instant::now();
            run();
            println!("  {:.0} s", begun.elapsed().as_secs_f64());
        }
    }
    ExitCode::SUCCESS
}

/// Runs a case natively with settings, below a folder; gives its results' folder and its series.
fn run(case: &Path, folder: &Path, name: &str, set: &[String]) -> (PathBuf, Series) {
    run_with(case, folder, name, set, &[])
}

/// The same with options, such as those of the pairing.
fn run_with(
    case: &Path,
    folder: &Path,
    name: &str,
    set: &[String],
    options: &[&str],
) -> (PathBuf, Series) {
    let out = folder.join(name);
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command
        .arg("run")
        .arg(case)
        .arg("--quiet")
        .args(options)
        .arg("--out")
        .arg(&out);
    for setting in set {
        command.args(["--set", setting]);
    }
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {text}", case.display());
    let series = Series::read(&out).unwrap();
    (out, series)
}

/// A shipped case.
fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{name}.toml"))
}

/// Slope and value at zero of the straight line nearest to points.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let [x, y] = [
        points.iter().map(|point| point.0).sum::<f64>() / count,
        points.iter().map(|point| point.1).sum::<f64>() / count,
    ];
    let over: f64 = points
        .iter()
        .map(|point| (point.0 - x) * (point.1 - y))
        .sum();
    let under: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    (over / under, y - over / under * x)
}
