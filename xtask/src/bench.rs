//! `cargo xtask bench`: the benchmarks of every package, then one table of what they measured,
//! taken from Criterion's own files, and what a window of the heated bed costs by phase.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

use crate::json::Json;
use crate::packages::{self, Needs};
use crate::steps::{Outcome, Stop, loud_step, quietly, say, step, visibly};
use crate::table::{Table, short};
use crate::workspace::{Profile, Workspace};

/// Packages that may have benchmarks, by their folders.
const FOLDERS: [&str; 7] = [
    ".",
    "coupler",
    "coupler/physics",
    "coupler/interior",
    "native-solver",
    "adapters",
    "adapters/wire",
];

/// Cells across and along the heated bed of the phases' runs (10 k, 100 k, 1 M in all), and windows.
const SIZES: [[u32; 3]; 3] = [[18, 42, 5], [38, 92, 2], [84, 190, 1]];

/// Phases in the order of a window, as `wall_time_s` in summary.json names them. The first two
/// happen once in a run of a frozen bed, and in each window where particles move.
const PHASES: [&str; 7] = [
    "mapping",
    "smoother",
    "exchange",
    "gas",
    "interior",
    "particles",
    "output",
];

/// What to measure.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Only the table of what was measured last.
    pub table_only: bool,
    /// Words for `cargo bench`, for example the beginning of a benchmark's name.
    pub words: Vec<OsString>,
}

/// Runs the benchmarks and prints the table.
pub fn run(workspace: &Workspace, choice: &Choice) -> Outcome<()> {
    let begun = SystemTime::now();
    if choice.table_only {
        return print(&table(&measurements(&workspace.target, None)));
    }
    packages::install(Needs::NATIVE, &workspace.logs)?;
    let everything = choice.words.is_empty();
    if everything {
        let mut build = workspace.cargo("build");
        build.args(["--release", "-p", "calcine"]);
        loud_step("build Calcine", || visibly(&mut build))?;
    }
    for folder in FOLDERS {
        if !workspace.root.join(folder).join("benches").is_dir() {
            continue;
        }
        let manifest = workspace.root.join(folder).join("Cargo.toml");
        let mut command = workspace.cargo("bench");
        command
            .args(["--bench", "*", "--manifest-path"])
            .arg(manifest)
            .args(&choice.words);
        loud_step(&format!("benchmarks in {folder}"), || visibly(&mut command))?;
    }
    let phases = everything.then(|| phases(workspace));
    print(&table(&measurements(&workspace.target, Some(begun))))?;
    match phases {
        Some(phases) => print(&phases?),
        None => Ok(()),
    }
}

fn print(table: &Table) -> Outcome<()> {
    if table.is_empty() {
        say("nothing was measured");
    }
    let written = write!(io::stdout(), "\n{table}");
    written.map_err(|cause| Stop(format!("the table cannot be printed: {cause}")))
}

/// One benchmark as Criterion left it.
#[derive(Clone, Debug, PartialEq)]
struct Measurement {
    group: String,
    function: String,
    /// Size, as the benchmark names it.
    value: String,
    /// Median time of one iteration in s.
    time: f64,
    /// Standard error of it in s.
    error: f64,
    /// What one iteration works through: cells, particles.
    elements: Option<f64>,
}

impl Measurement {
    /// From the two files of a benchmark's folder `new`.
    fn read(benchmark: &str, estimates: &str) -> Option<Self> {
        let (about, found) = (Json::read(benchmark)?, Json::read(estimates)?);
        let text = |key| about.text(&[key]).unwrap_or_default().to_owned();
        // Criterion writes nanoseconds.
        let median = |key| Some(1e-9 * found.number(&["median", key])?);
        Some(Self {
            group: text("group_id"),
            function: text("function_id"),
            value: text("value_str"),
            time: median("point_estimate")?,
            error: median("standard_error")?,
            elements: about.number(&["throughput", "Elements"]),
        })
    }

    /// Time per element, or of all where none are counted, in s.
    fn each(&self) -> f64 {
        self.time / self.elements.unwrap_or(1.0)
    }

    /// What orders the table: group and function, then size.
    fn key(&self) -> (&str, &str, f64) {
        let size = self.value.parse().ok().or(self.elements).unwrap_or(0.0);
        (&self.group, &self.function, size)
    }
}

/// All measurements in `TARGET/criterion`, those since `since` if it is given.
fn measurements(target: &Path, since: Option<SystemTime>) -> Vec<Measurement> {
    let mut found = Vec::new();
    let mut folders = vec![target.join("criterion")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if !path.is_dir() {
                continue;
            }
            if entry.file_name() == "new" {
                found.extend(measurement(&path, since));
            } else {
                folders.push(path);
            }
        }
    }
    found.sort_by(|a, b| {
        a.key()
            .partial_cmp(&b.key())
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    found
}

fn measurement(folder: &Path, since: Option<SystemTime>) -> Option<Measurement> {
    let estimates = folder.join("estimates.json");
    let written = fs::metadata(&estimates).and_then(|data| data.modified());
    if since.is_some_and(|since| written.is_ok_and(|written| written < since)) {
        return None;
    }
    let benchmark = fs::read_to_string(folder.join("benchmark.json")).ok()?;
    Measurement::read(&benchmark, &fs::read_to_string(estimates).ok()?)
}

/// One row each; the last column says how the time per element grows from the smallest size.
fn table(measurements: &[Measurement]) -> Table {
    let mut table = Table::new([
        "benchmark",
        "size",
        "time",
        "±",
        "per second",
        "each",
        "growth",
    ]);
    let mut smallest: Option<&Measurement> = None;
    for one in measurements {
        let same =
            |other: &&Measurement| (&other.group, &other.function) == (&one.group, &one.function);
        let first = smallest.filter(same).unwrap_or(one);
        smallest = Some(first);
        let counted = |text: String| one.elements.map_or_else(String::new, |_| text);
        let name = [&one.group, &one.function].map(String::as_str).join(": ");
        table.add([
            name.trim_end_matches(": ").to_owned(),
            one.value.clone(),
            format!("{}s", short(one.time)),
            format!("{:.0} %", 100.0 * one.error / one.time),
            counted(
                short(one.elements.unwrap_or(0.0) / one.time)
                    .trim_end()
                    .to_owned(),
            ),
            counted(format!("{}s", short(one.each()))),
            counted(format!("{:.2}", one.each() / first.each())),
        ]);
    }
    table
}

/// Runs of the shipped heated bed on meshes of growing size: the cost of a window by phase.
fn phases(workspace: &Workspace) -> Outcome<Table> {
    let log = crate::steps::new_log(&workspace.logs, "bench-phases")?;
    let mut table = Table::new([
        "cost per window by phase",
        "cells",
        "particles",
        "wall time",
        "per cell",
        "share",
    ]);
    let large = env::var_os("CALCINE_BENCH_LARGE").is_some();
    for size in &SIZES[..SIZES.len() - usize::from(!large)] {
        let [across, along, _] = size;
        let out = workspace
            .target
            .join(format!("xtask/heated-bed-{across}-{along}"));
        let _ = fs::remove_dir_all(&out);
        let mut command = heated_bed(workspace, &out, *size);
        step(
            &format!("heated bed, {across} cells across, {along} along"),
            || quietly(&mut command, &log),
        )?;
        let path = out.join("summary.json");
        let text = fs::read_to_string(&path).map_err(|cause| Stop::io(&path, &cause))?;
        let rows = phase_rows(&text);
        let rows = rows.ok_or_else(|| Stop(format!("{}: not a summary", path.display())))?;
        rows.into_iter().for_each(|row| table.add(row));
    }
    Ok(table)
}

fn heated_bed(workspace: &Workspace, out: &Path, [across, along, windows]: [u32; 3]) -> Command {
    let program = workspace
        .target
        .join(Profile::Release.folder())
        .join("calcine");
    let case: PathBuf = workspace.root.join("cases/heated-bed.toml");
    let mut command = Command::new(program);
    command
        .arg("run")
        .arg(case)
        .args(["--quiet", "--out"])
        .arg(out);
    let settings = [
        format!("mesh.cylinder.cells=[{across}, {along}]"),
        "time.acceleration=200".into(),
        "time.motion_window=2 ms".into(),
        // 0.4 s of process time each.
        format!("time.end={} ms", 400 * windows),
    ];
    for setting in settings {
        command.args(["--set", &setting]);
    }
    command
}

/// Rows of one run, from its summary, as a bed of moving particles would pay for each window.
fn phase_rows(summary: &str) -> Option<Vec<[String; 6]>> {
    let summary = Json::read(summary)?;
    let number = |key: &str| summary.number(&[key]);
    let (cells, windows) = (number("cells")?, number("windows")?);
    let wall = |phase: &str| summary.number(&["wall_time_s", phase]);
    let mut times = Vec::new();
    for phase in PHASES {
        let once = PHASES[..2].contains(&phase);
        times.push((phase, wall(phase)? / if once { 1.0 } else { windows }));
    }
    let sum: f64 = times.iter().map(|(_, time)| time).sum();
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

#[cfg(test)]
mod tests {
    use super::*;

    /// As Criterion 0.8 writes it, shortened.
    fn criterion(value: u32, elements: u32, nanoseconds: f64) -> Option<Measurement> {
        let benchmark = format!(
            r#"{{"group_id":"W cells","function_id":"S W0","value_str":"{value}","throughput":{{"Elements":{elements}}}}}"#
        );
        let estimates = format!(
            r#"{{"mean":{{"point_estimate":1.0}},"median":{{"confidence_interval":{{}},"point_estimate":{nanoseconds},"standard_error":2000.0}}}}"#
        );
        Measurement::read(&benchmark, &estimates)
    }

    #[test]
    fn the_table_says_rate_time_per_element_and_growth() {
        let rows = [
            criterion(10_000, 10_648, 106_480.0).unwrap(),
            criterion(100_000, 97_336, 1_946_720.0).unwrap(),
        ];
        assert!(rows[0].key() < rows[1].key());
        let text = table(&rows).to_string();
        let lines: Vec<Vec<&str>> = text
            .lines()
            .map(|line| line.split('|').map(str::trim).collect())
            .collect();
        let wanted = [
            "",
            "W cells: S W0",
            "10000",
            "106 µs",
            "2 %",
            "100 M",
            "10.0 ns",
            "1.00",
            "",
        ];
        assert_eq!(lines[2], wanted);
        let wanted = [
            "",
            "W cells: S W0",
            "100000",
            "1.95 ms",
            "0 %",
            "50.0 M",
            "20.0 ns",
            "2.00",
            "",
        ];
        assert_eq!(lines[3], wanted);
    }

    #[test]
    fn phases_are_shares_of_a_window() {
        let summary = r#"{"cells": 1000, "particles": 70, "windows": 4, "wall_time_s": {"total": 9,
            "gas": 3.0, "particles": 0, "interior": 0, "mapping": 0.5, "smoother": 0,
            "exchange": 1.0, "output": 0}}"#;
        let rows = phase_rows(summary).unwrap();
        let mapping = ["mapping", "1000", "70", "500 ms", "500 µs", "33.3 %"];
        assert_eq!(rows[0], mapping);
        assert_eq!(rows[3], ["gas", "1000", "70", "750 ms", "750 µs", "50.0 %"]);
        assert_eq!(
            rows[7],
            ["all phases", "1000", "70", "1.50 s", "1.50 ms", "100.0 %"]
        );
        assert_eq!(phase_rows("{}"), None);
    }
}
