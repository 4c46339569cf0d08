//! Whole runs that the benchmarks measure, from their summaries: what a window costs by phase, what the
//! coordinator takes of it beside both production solvers, and the native gas beside calcineGasFoam.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::thread;

use crate::json::Json;
use crate::steps::{Stop, TaskResult, quietly, step};
use crate::table::{Table, short};
use crate::workspace::{CargoProfile, Workspace};

/// Cells across and along the heated bed (10 k, 100 k, 1 M in all), and windows.
const SIZES: [[u32; 3]; 3] = [[18, 42, 5], [38, 92, 2], [84, 190, 1]];

/// Words for tolerances near those of OpenFOAM's tutorials.
pub const LOOSE: [&str; 2] = [
    "gas.controls.outer_tolerance=1e-4",
    "gas.controls.linear_tolerance=1e-8",
];

/// Phases in the order of a window, as `wall_time_s` in summary.json names them. The first two
/// happen once in a run of a frozen bed, and in each window where particles move.
pub const PHASES: [&str; 7] = [
    "mapping",
    "smoother",
    "exchange",
    "gas",
    "interior",
    "particles",
    "output",
];

/// What the coordinator does between the solvers: the first three.
const BETWEEN: usize = 3;

/// All tables of runs.
pub fn tables(workspace: &Workspace, native: bool) -> TaskResult<Vec<Table>> {
    let mut tables = vec![phases(workspace)?, fine_and_fluidised(workspace, &[])?];
    if !native {
        let pairing = ["--gas", "openfoam", "--particles", "liggghts"];
        tables.push(fine_and_fluidised(workspace, &pairing)?);
        tables.push(between(workspace)?);
        tables.push(gases(workspace)?);
    }
    Ok(tables)
}

/// The sizes that are measured.
fn sizes() -> &'static [[u32; 3]] {
    let large = env::var_os("CALCINE_BENCH_LARGE").is_some();
    &SIZES[..SIZES.len() - usize::from(!large)]
}

/// The summary of a run of a case, its file below the workspace's folder, its results below the target folder.
pub fn summary(
    workspace: &Workspace,
    (case, name): (&str, &str),
    words: &[String],
) -> TaskResult<Json> {
    let log = crate::steps::new_log(&workspace.logs, "bench-runs")?;
    let out = workspace.target.join("xtask/bench").join(name);
    let _ = fs::remove_dir_all(&out);
    let program = workspace.target.join(CargoProfile::Release.folder());
    let mut command = Command::new(program.join("calcine"));
    command
        .arg("run")
        .arg(workspace.root.join(case))
        .arg("--quiet")
        .args(words)
        .arg("--out")
        .arg(&out);
    step(&format!("run {name}"), || quietly(&mut command, &log))?;
    let path = out.join("summary.json");
    let text = fs::read_to_string(&path).map_err(|cause| Stop::io(&path, &cause))?;
    // Of a million cells the results are large.
    let _ = fs::remove_dir_all(&out);
    Json::read(&text).ok_or_else(|| no_summary(&path))
}

fn no_summary(path: &Path) -> Stop {
    Stop(format!("{}: not a summary", path.display()))
}

/// Words that make a run of the heated bed on a mesh of some size.
fn heated_bed([across, along, windows]: [u32; 3]) -> Vec<String> {
    let settings = [
        format!("mesh.cylinder.cells=[{across}, {along}]"),
        "time.acceleration=200".into(),
        "time.motion_window=2 ms".into(),
        // 0.4 s of process time each.
        format!("time.end={} ms", 400 * windows),
    ];
    set(&settings)
}

/// Words of the command line that change keys of a case.
pub fn set(settings: &[String]) -> Vec<String> {
    let words = settings.iter();
    words
        .flat_map(|setting| ["--set".to_owned(), setting.clone()])
        .collect()
}

/// The native heated bed: the cost of a window by phase.
fn phases(workspace: &Workspace) -> TaskResult<Table> {
    let mut table = Table::new([
        "cost per window by phase",
        "cells",
        "particles",
        "wall time",
        "per cell",
        "share",
    ]);
    for size in sizes() {
        let name = format!("heated-bed-{}-{}", size[0], size[1]);
        let run = summary(
            workspace,
            ("cases/heated-bed.toml", &name),
            &heated_bed(*size),
        )?;
        add_phases(&mut table, &run, true)?;
    }
    Ok(table)
}

fn add_phases(table: &mut Table, run: &Json, frozen: bool) -> TaskResult<()> {
    let rows = phase_rows(run, frozen);
    let rows = rows.ok_or_else(|| Stop::new("a summary lacks its wall times"))?;
    rows.into_iter().for_each(|row| table.add(row));
    Ok(())
}

/// Rows of one run, from its summary; of a bed that is held as one of moving particles would pay for each
/// window.
fn phase_rows(summary: &Json, frozen: bool) -> Option<Vec<[String; 6]>> {
    let number = |key: &str| summary.number(&[key]);
    let (cells, windows) = (number("cells")?, number("windows")?);
    let wall = |phase: &str| summary.number(&["wall_time_s", phase]);
    let mut times = Vec::new();
    for phase in PHASES {
        let once = frozen && PHASES[..2].contains(&phase);
        times.push((phase, wall(phase)? / if once { 1.0 } else { windows }));
    }
    let sum: f64 = times.iter().map(|(_, time)| time).sum();
    let between: f64 = times[..BETWEEN].iter().map(|(_, time)| time).sum();
    times.push(("mapping, smoother, exchange", between));
    times.push(("all phases", sum));
    let row = |(phase, time): (&str, f64)| {
        [
            phase.to_owned(),
            format!("{cells}"),
            format!("{}", number("particles").unwrap_or(0.0)),
            format!("{}s", short(time)),
            format!("{}s", short(time / cells)),
            format!("{:.1} %", 100.0 * time / sum),
        ]
    };
    Some(times.into_iter().map(row).collect())
}

/// Beds in which mapping or exchange weigh most. Natively: 2000 particles held in 78 k cells much smaller than they are,
/// without splitting of time, and a flat fluidised bed in windows of 20 µs; with any pairing: that bed in windows of 0.2 ms.
fn fine_and_fluidised(workspace: &Workspace, pairing: &[&str]) -> TaskResult<Table> {
    let title = match pairing.is_empty() {
        true => "fine cells, and fluidised, natively",
        false => "fluidised bed with OpenFOAM and LIGGGHTS",
    };
    let mut table = Table::new([
        title,
        "cells",
        "particles",
        "wall time per window",
        "per cell",
        "share",
    ]);
    if pairing.is_empty() {
        let settings = [
            "mesh.cylinder.cells=[32, 76]",
            "time.acceleration=1",
            "time.motion_window=2 ms",
            "time.end=40 ms",
        ];
        let words = set(&settings.map(str::to_owned));
        let case = ("cases/heated-bed.toml", "heated-bed-fine");
        add_phases(&mut table, &summary(workspace, case, &words)?, true)?;
    }
    let case = "coupler/benches/cases/flat-bed.toml";
    let mut runs = vec![("flat-bed", Vec::new())];
    if pairing.is_empty() {
        let short = ["time.motion_window=20 us", "time.end=4 ms"];
        runs.push(("flat-bed-short", short.map(str::to_owned).to_vec()));
    }
    for (name, settings) in runs {
        let name = format!("{name}{}", pairing.concat());
        let mut words = set(&settings);
        words.extend(pairing.iter().map(|&word| word.to_owned()));
        add_phases(
            &mut table,
            &summary(workspace, (case, &name), &words)?,
            false,
        )?;
    }
    Ok(table)
}

/// 100 k cells of OpenFOAM and 50 k moving beads of LIGGGHTS: the shipped moving bed with beads of 1.7 mm in
/// cells of 1.5 mm, so that the smoother and the short diffusion work too.
fn between(workspace: &Workspace) -> TaskResult<Table> {
    let mut table = Table::new([
        "moving bed with OpenFOAM and LIGGGHTS",
        "cells",
        "particles",
        "wall time per window",
        "per cell",
        "share",
    ]);
    let settings = [
        "mesh.box.cells=[27, 27, 137]",
        "particles[0].diameter=1.7 mm",
        // Four windows of 2 ms at AF 50.
        "time.motion_window=2 ms",
        "time.end=400 ms",
        "output.every=400 ms",
        // On a machine with other work too.
        "coupling.deadline=20 min",
        "gas.controls.outer_tolerance=1e-6",
    ];
    let mut words = set(&settings.map(str::to_owned));
    words.extend(["--gas", "openfoam", "--particles", "liggghts"].map(str::to_owned));
    let run = summary(
        workspace,
        ("cases/moving-bed.toml", "moving-bed-100k-50k"),
        &words,
    )?;
    add_phases(&mut table, &run, false)?;
    Ok(table)
}

/// What one run of a gas tells.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gas {
    cells: f64,
    /// Attempts at windows: each is a time step of the gas.
    steps: f64,
    /// Outer iterations of all steps that were committed.
    outer: f64,
    windows: f64,
    /// Processor time in s of the gas' phases.
    processor: f64,
    /// Wall time in s of them.
    wall: f64,
}

impl Gas {
    fn of(summary: &Json) -> Option<Self> {
        Some(Self {
            cells: summary.number(&["cells"])?,
            steps: summary.number(&["convergence", "attempts"])?,
            outer: summary.number(&["convergence", "outer_iterations"])?,
            windows: summary.number(&["windows"])?,
            processor: summary.number(&["processor_time_s", "gas"])?,
            wall: summary.number(&["wall_time_s", "gas"])?,
        })
    }

    /// Cell-steps per second of processor time.
    fn per_processor(&self) -> f64 {
        self.cells * self.steps / self.processor
    }

    /// Cell-steps per second of wall time.
    fn per_second(&self) -> f64 {
        self.cells * self.steps / self.wall
    }
}

/// The heated bed with both gases, on one core and two.
fn gases(workspace: &Workspace) -> TaskResult<Table> {
    let mut table = Table::new([
        "gas of the heated bed",
        "cells",
        "cores",
        "outer iterations per window",
        "cell-steps per CPU-second",
        "per second",
        "over OpenFOAM's, per CPU-second",
        "per second ",
    ]);
    let cores = thread::available_parallelism().map_or(1, usize::from);
    for size in sizes() {
        for cores in 1..=cores.min(2) {
            let run = |gas: &str, words: &[String]| {
                let name = format!("{gas}-{}-{}-{cores}", size[0], size[1]);
                let mut all = heated_bed(*size);
                all.extend_from_slice(words);
                let read = summary(workspace, ("cases/heated-bed.toml", &name), &all)?;
                Gas::of(&read).ok_or_else(|| Stop::new("a summary lacks the gas' times"))
            };
            let number = cores.to_string();
            let words = |words: &[&str]| words.iter().map(|&word| word.into()).collect::<Vec<_>>();
            let ranks = ["--gas", "openfoam", "--ranks-gas", &number];
            let foam = run(
                "openfoam",
                &words(&[&ranks[..], &["--threads", "1"]].concat()),
            )?;
            let native = run("native", &words(&["--threads", &number]))?;
            for (name, gas) in [("calcineGasFoam", &foam), ("native", &native)] {
                table.add(row(name, cores, gas, &foam));
            }
        }
    }
    Ok(table)
}

fn row(name: &str, cores: usize, gas: &Gas, other: &Gas) -> [String; 8] {
    let rate = |rate: f64| short(rate).trim_end().to_owned();
    [
        name.to_owned(),
        format!("{}", gas.cells),
        cores.to_string(),
        format!("{:.1}", gas.outer / gas.windows),
        rate(gas.per_processor()),
        rate(gas.per_second()),
        format!("{:.2}", gas.per_processor() / other.per_processor()),
        format!("{:.2}", gas.per_second() / other.per_second()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUMMARY: &str = r#"{"cells": 1000, "particles": 70, "windows": 4, "wall_time_s": {"total": 9,
        "gas": 3.0, "particles": 0, "interior": 0, "mapping": 0.5, "smoother": 0, "exchange": 1.0,
        "output": 0}, "processor_time_s": {"gas": 6.0},
        "convergence": {"attempts": 8, "outer_iterations": 40}}"#;

    #[test]
    fn phases_are_shares_of_a_window() {
        let summary = Json::read(SUMMARY).unwrap();
        let rows = phase_rows(&summary, true).unwrap();
        let mapping = ["mapping", "1000", "70", "500 ms", "500 µs", "33.3 %"];
        assert_eq!(rows[0], mapping);
        assert_eq!(rows[3], ["gas", "1000", "70", "750 ms", "750 µs", "50.0 %"]);
        let between = [
            "mapping, smoother, exchange",
            "1000",
            "70",
            "750 ms",
            "750 µs",
            "50.0 %",
        ];
        assert_eq!(rows[7], between);
        assert_eq!(
            rows[8],
            ["all phases", "1000", "70", "1.50 s", "1.50 ms", "100.0 %"]
        );
        let moving = phase_rows(&summary, false).unwrap();
        assert_eq!(moving[0][3], "125 ms");
        assert_eq!(phase_rows(&Json::read("{}").unwrap(), true), None);
    }

    #[test]
    fn a_gas_is_rated_by_processor_and_by_wall_time_beside_another() {
        let gas = Gas::of(&Json::read(SUMMARY).unwrap()).unwrap();
        let slower = Gas {
            processor: 12.0,
            ..gas
        };
        let wanted = [
            "native", "1000", "2", "10.0", "1.33 k", "2.67 k", "2.00", "1.00",
        ];
        assert_eq!(row("native", 2, &gas, &slower), wanted);
    }
}
