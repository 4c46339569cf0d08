//! Runs of Calcine: with its native gas and with calcineGasFoam.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::case::{CoupledGas, ErrorCase, ErrorQuantity, Resolution};
use super::field::{self, MeanField};
use super::start;
use crate::json::Json;
use crate::measure::{Cost, measured};
use crate::snapshots;
use crate::steps::{TaskResult, quietly};

/// What a run gave.
pub struct Done {
    pub cost: Cost,
    /// Processor time of the gas' phases in s, by the summary.
    pub gas: Option<f64>,
    /// Outer and linear iterations of a window.
    pub iterations: Option<[f64; 2]>,
    /// Its fields, where it came to its end.
    pub fields: Option<Vec<MeanField>>,
}

/// Runs a case file into `folder` on so many threads or ranks.
pub fn run(
    case: &ErrorCase,
    (program, file): (&Path, &Path),
    folder: &Path,
    (gas, resolution, cores): (CoupledGas, Resolution, usize),
) -> TaskResult<Done> {
    let _ = fs::remove_dir_all(folder);
    let counts = case.cells(resolution);
    let [nx, ny] = counts;
    let cores = cores.to_string();
    let native = gas.gas == "native";
    let mut command = Command::new(program);
    command
        .arg("run")
        .arg(file)
        .args(["--quiet", "--out"])
        .arg(folder);
    command.args([
        "--gas",
        gas.gas,
        "--threads",
        if native { &cores } else { "1" },
    ]);
    if !native {
        command.args(["--ranks-gas", &cores]);
    }
    let cells = format!("mesh.box.cells=[{nx}, {ny}, 1]");
    let window = format!("time.motion_window={:?} s", resolution.step);
    for setting in [cells.as_str(), &window].iter().chain(gas.set) {
        command.args(["--set", setting]);
    }
    let log = folder.with_extension("log");
    if let Some(start) = &case.start {
        let from = start::beside(folder);
        let _ = fs::remove_dir_all(&from);
        if native {
            // One window from rest makes a checkpoint of this mesh.
            let mut rest = Command::new(program);
            rest.args(command.get_args().map(|word| {
                if word == folder.as_os_str() {
                    from.as_os_str()
                } else {
                    word
                }
            }));
            rest.args(["--set", &window.replace("motion_window", "end")]);
            quietly(&mut rest, &log)?;
            start.write_native(&from, counts)?;
            command.arg("--from").arg(&from);
        } else {
            start.write_openfoam(&from, counts, ("slip", false))?;
            command.args([
                "--set",
                &format!("openfoam.start={:?}", from.display().to_string()),
            ]);
        }
    }
    let (cost, success) = measured(&command, &log)?;
    let text = fs::read_to_string(folder.join("summary.json")).unwrap_or_default();
    let summary = Json::read(&text);
    let number = |path: &[&str]| summary.as_ref().and_then(|read| read.number(path));
    let time = number(&["processor_time_s", "gas"]);
    let a_window = |name: &str| {
        let windows = number(&["windows"])?;
        Some(number(&["convergence", name])? / windows)
    };
    let iterations = a_window("outer_iterations")
        .zip(a_window("linear_iterations"))
        .map(<[f64; 2]>::from);
    if !success {
        return Ok(Done {
            cost,
            gas: time,
            iterations,
            fields: None,
        });
    }
    let last = snapshots::last(&folder.join("gas"), "vtu")?;
    let read = |quantity: &ErrorQuantity| {
        field::of_calcine(&last, quantity.calcine, case.cells(resolution))
    };
    let fields: TaskResult<Vec<MeanField>> = case.quantities.iter().map(read).collect();
    Ok(Done {
        cost,
        gas: time,
        iterations,
        fields: Some(fields?),
    })
}
