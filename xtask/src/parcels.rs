//! `cargo xtask bench parcels`: what parcels cost, by the phases of a window of a drying, reacting drum of 5000 to 450 000, and beside OpenFOAM's own
//! MPPICFoam on the flat bed of its tutorial at equal steps.

use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::gas_error::{Cost, copy, measured};
use crate::packages::{self, Needs};
use crate::runs::{self, summary};
use crate::steps::{Stop, TaskResult, quietly, say, step};
use crate::table::{Table, short};
use crate::tasks::{self, BuildScope};
use crate::workspace::{CargoProfile, Workspace};

/// The drums: how many times as wide as the shipped one, and layers of cells along its axis. The last two on request.
const DRUMS: [[u32; 2]; 4] = [[2, 12], [4, 30], [6, 41], [8, 67]];
/// Windows of a drum that are measured.
const WINDOWS: u32 = 10;
/// Cells of the flat bed: of the tutorial MPPICFoam/Goldschmidt, and of DPMFoam/Goldschmidt.
const FLAT: [[u32; 3]; 2] = [[1, 15, 45], [2, 30, 90]];
/// Steps of the flat bed: those of the longer run less those of the shorter are measured.
const STEPS: [u32; 2] = [50, 250];
/// Length of a step in s.
const STEP: f64 = 2e-4;
/// Where Debian's OpenFOAM finds its own dictionaries.
const PROJECT: (&str, &str) = ("WM_PROJECT_DIR", "/usr/share/openfoam");

/// Who computes the flat bed: MPPICFoam, or Calcine with these words.
const FLAT_BEDS: [(&str, Option<&[&str]>); 4] = [
    ("MPPICFoam, explicit stress", None),
    ("native", Some(&[])),
    (
        "native, loose",
        Some(&[
            "gas.controls.outer_tolerance=1e-4",
            "gas.controls.linear_tolerance=1e-8",
        ]),
    ),
    (
        "native, loose, explicit stress",
        Some(&[
            "gas.controls.outer_tolerance=1e-4",
            "gas.controls.linear_tolerance=1e-8",
            "motion.parcels.packing=explicit",
        ]),
    ),
];

/// Builds unless told not to, measures, and prints the tables.
pub fn run(workspace: &Workspace, built: bool) -> TaskResult<()> {
    let needs = Needs {
        openfoam: true,
        ..Needs::NATIVE
    };
    packages::install(needs, &workspace.logs)?;
    if !built {
        let _lock = workspace.lock()?;
        tasks::build_parts(workspace, needs, BuildScope::Runs)?;
    }
    let drums = drums(workspace)?;
    let flat = flat_beds(workspace)?;
    say(&format!("\n{drums}\n{flat}"));
    Ok(())
}

/// The drums by phase, on all threads.
fn drums(workspace: &Workspace) -> TaskResult<Table> {
    let mut table = Table::new([
        "drum of wet parcels, cost per window by phase",
        "cells",
        "parcels",
        "wall time",
        "per parcel",
        "share",
    ]);
    let large = env::var_os("CALCINE_BENCH_LARGE").is_some();
    for [wide, layers] in &DRUMS[..if large { 4 } else { 2 }] {
        let settings = drum(*wide, *layers);
        let words = runs::set(&settings);
        let name = format!("wet-drum-{wide}-{layers}");
        let run = summary(workspace, ("cases/wet-drum.toml", &name), &words)?;
        let rows = drum_rows(&run).ok_or_else(|| Stop::new("a summary lacks its wall times"))?;
        rows.into_iter().for_each(|row| table.add(row));
    }
    Ok(table)
}

/// The shipped drum, so many times as wide, with cells and parcels of the same size.
fn drum(wide: u32, layers: u32) -> Vec<String> {
    let cells = 10 * wide;
    // Layers of 8.33 mm, as three of 25 mm; parcels 4.2 mm apart across and 4 mm along.
    let length = f64::from(layers) * 25.0 / 3.0;
    let first = -42 * i64::from(wide);
    let (rows, columns) = (5 * wide, 10 * wide + 1);
    let along = ((length - 5.0) / 4.0).floor() as u32 + 1;
    vec![
        format!(
            r#"mesh.cylinder={{ diameter = "{} mm", length = "{length} mm", cells = [{cells}, {layers}] }}"#,
            100 * wide
        ),
        format!(
            r#"particles[0].place.grid={{ first = "{first} {} 2.5 mm", spacing = "4.2 4.2 4 mm", counts = [{rows}, {columns}, {along}] }}"#,
            -21 * i64::from(wide)
        ),
        format!("time.end={} ms", 2 * WINDOWS),
        format!("output.every={} ms", 2 * WINDOWS),
        format!("output.series_every={} ms", 2 * WINDOWS),
    ]
}

/// Rows of a drum from its summary, by parcel, and of all phases without the gas.
fn drum_rows(summary: &crate::json::Json) -> Option<Vec<[String; 6]>> {
    let number = |key: &str| summary.number(&[key]);
    let (cells, parcels, windows) = (number("cells")?, number("particles")?, number("windows")?);
    let mut times = Vec::new();
    for phase in runs::PHASES {
        times.push((phase, summary.number(&["wall_time_s", phase])? / windows));
    }
    let sum = |leave: &[&str]| {
        let own = times.iter().filter(|(phase, _)| !leave.contains(phase));
        own.map(|(_, time)| time).sum::<f64>()
    };
    let (all, without) = (sum(&["output"]), sum(&["output", "gas"]));
    times.retain(|(phase, _)| *phase != "output");
    times.push(("all but the gas", without));
    times.push(("all", all));
    let row = |(phase, time): (&str, f64)| {
        [
            phase.to_owned(),
            format!("{cells}"),
            format!("{parcels}"),
            format!("{}s", short(time)),
            format!("{}s", short(time / parcels)),
            format!("{:.1} %", 100.0 * time / all),
        ]
    };
    Some(times.into_iter().map(row).collect())
}

/// The flat bed by MPPICFoam and by Calcine, each on one core.
fn flat_beds(workspace: &Workspace) -> TaskResult<Table> {
    let mut table = Table::new([
        "flat bed of 24 750 parcels, one core",
        "cells",
        "processor time per step",
        "over MPPICFoam's",
        "per parcel",
        "memory, MB",
    ]);
    for cells in FLAT {
        let mut stock = None;
        for (name, words) in FLAT_BEDS {
            let cost = |steps: u32| {
                let what = format!("{name}, {cells:?} cells, {steps} steps");
                step(&what, || match words {
                    None => mppic_foam(workspace, cells, steps),
                    Some(words) => calcine(workspace, cells, steps, words),
                })
            };
            let [short_run, long_run] = [cost(STEPS[0])?, cost(STEPS[1])?];
            let each = (long_run.processor - short_run.processor) / f64::from(STEPS[1] - STEPS[0]);
            let stock = *stock.get_or_insert(each);
            table.add([
                name.to_owned(),
                format!("{}", cells.iter().product::<u32>()),
                format!("{}s", short(each)),
                format!("{:.2}", each / stock),
                format!("{}s", short(each / 24_750.0)),
                format!("{:.0}", long_run.memory / 1e6),
            ]);
        }
    }
    Ok(table)
}

fn folder(workspace: &Workspace, name: &str) -> std::path::PathBuf {
    workspace.target.join("xtask/parcels").join(name)
}

fn files(workspace: &Workspace) -> std::path::PathBuf {
    workspace.root.join("of-cases/mppic-goldschmidt")
}

/// What so many steps of MPPICFoam cost.
fn mppic_foam(workspace: &Workspace, [nx, ny, nz]: [u32; 3], steps: u32) -> TaskResult<Cost> {
    let folder = folder(workspace, "stock");
    let _ = fs::remove_dir_all(&folder);
    copy(&files(workspace).join("stock"), &folder)?;
    let end = f64::from(steps) * STEP;
    let parameters = format!("nx {nx};\nny {ny};\nnz {nz};\ndeltaT {STEP:?};\nendTime {end:?};\n");
    write(&folder.join("parameters"), &parameters)?;
    write(
        &folder.join("constant/kinematicCloudPositions"),
        &positions(),
    )?;
    let tool = |name: &str| {
        let mut command = Command::new(name);
        command.current_dir(&folder).env(PROJECT.0, PROJECT.1);
        command
    };
    quietly(&mut tool("blockMesh"), &folder.join("log.blockMesh"))?;
    ended(
        measured(&tool("MPPICFoam"), &folder.join("log"))?,
        &folder.join("log"),
    )
}

/// The places of the tutorial's parcels, as Calcine's case has them.
fn positions() -> String {
    let mut text = "FoamFile { version 2.0; format ascii; class vectorField; object kinematicCloudPositions; }\n(\n".to_owned();
    for k in 0..99 {
        for j in 0..50 {
            for i in 0..5 {
                let place = [i, j, k].map(|n| 1e-3 * (1.5 + 3.0 * f64::from(n)));
                let [x, y, z] = place;
                let _ = writeln!(text, "({x:.4} {y:.4} {z:.4})");
            }
        }
    }
    text + ")\n"
}

/// What so many windows of Calcine cost.
fn calcine(workspace: &Workspace, cells: [u32; 3], steps: u32, words: &[&str]) -> TaskResult<Cost> {
    let folder = folder(workspace, "native");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(|cause| Stop::io(&folder, &cause))?;
    let release = workspace.target.join(CargoProfile::Release.folder());
    let mut settings: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
    settings.push(format!("mesh.box.cells={cells:?}"));
    settings.push(format!("time.end={} us", 200 * steps));
    let mut command = Command::new(release.join("calcine"));
    command
        .arg("run")
        .arg(files(workspace).join("case.toml"))
        .args(["--quiet", "--threads", "1"])
        .args(runs::set(&settings))
        .arg("--out")
        .arg(folder.join("out"));
    ended(
        measured(&command, &folder.join("log"))?,
        &folder.join("log"),
    )
}

fn ended((cost, success): (Cost, bool), log: &Path) -> TaskResult<Cost> {
    match success {
        true => Ok(cost),
        false => Err(Stop(format!("it failed; see {}", log.display()))),
    }
}

fn write(path: &Path, text: &str) -> TaskResult<()> {
    fs::write(path, text).map_err(|cause| Stop::io(path, &cause))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::Json;

    #[test]
    fn rows_of_a_drum_are_by_parcel_and_without_the_gas() {
        let text = r#"{"cells": 100, "particles": 200, "windows": 10, "wall_time_s": {"mapping": 1, "smoother": 1,
            "exchange": 2, "gas": 4, "interior": 1, "particles": 1, "output": 3}}"#;
        let rows = drum_rows(&Json::read(text).unwrap()).unwrap();
        let row = |name: &str| rows.iter().find(|row| row[0] == name).unwrap().clone();
        assert_eq!(row("all")[5], "100.0 %");
        assert_eq!(row("all but the gas")[5], "60.0 %");
        assert_eq!(row("all but the gas")[4].replace(' ', ""), "3.00ms");
        assert!(rows.iter().all(|row| row[0] != "output"));
    }

    #[test]
    fn the_tutorial_has_24_750_parcels() {
        assert_eq!(
            positions()
                .lines()
                .filter(|line| line.starts_with("(0."))
                .count(),
            24_750
        );
    }
}
