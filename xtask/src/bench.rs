//! `cargo xtask bench`: the benchmarks of every package, then one table of what they measured,
//! taken from Criterion's own files, and what whole runs cost.

use std::ffi::OsString;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::time::SystemTime;

use crate::json::Json;
use crate::packages::{self, Needs};
use crate::runs;
use crate::steps::{Stop, TaskResult, loud_step, say, visibly};
use crate::table::{Table, short};
use crate::tasks;
use crate::workspace::Workspace;

/// Packages that may have benchmarks, by their folders.
const FOLDERS: [&str; 9] = [
    ".",
    "flowsheet",
    "coupler",
    "coupler/physics",
    "coupler/interior",
    "native-solver",
    "adapters",
    "adapters/wire",
    "adapters/mpi",
];

/// What to measure.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Only the table of what was measured last.
    pub table_only: bool,
    /// Without OpenFOAM, LIGGGHTS and MPI.
    pub native: bool,
    /// Only whole runs.
    pub runs_only: bool,
    /// Words for `cargo bench`, for example the beginning of a benchmark's name.
    pub words: Vec<OsString>,
}

/// Runs the benchmarks and prints the table.
pub fn run(workspace: &Workspace, choice: &Choice) -> TaskResult<()> {
    let begun = SystemTime::now();
    if choice.table_only {
        return print(&table(&measurements(&workspace.target, None)));
    }
    let needs = if choice.native {
        Needs::NATIVE
    } else {
        Needs {
            tests: false,
            python: false,
            ..Needs::ALL
        }
    };
    packages::install(needs, &workspace.logs)?;
    let everything = choice.words.is_empty();
    if everything {
        tasks::build_parts(workspace, needs, tasks::BuildScope::Runs)?;
    }
    let folders = if choice.runs_only { &[][..] } else { &FOLDERS };
    for &folder in folders {
        let absent = !workspace.root.join(folder).join("benches").is_dir();
        if absent || folder == "adapters/mpi" && choice.native {
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
    // Before the table, so that it is not parted by what runs say.
    let tables = if everything {
        runs::tables(workspace, choice.native)
    } else {
        Ok(Vec::new())
    };
    if !choice.runs_only {
        print(&table(&measurements(&workspace.target, Some(begun))))?;
    }
    tables?.iter().try_for_each(print)
}

fn print(table: &Table) -> TaskResult<()> {
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
    /// What one iteration works through: cells, particles, bytes.
    elements: Option<f64>,
    /// True where these are bytes.
    bytes: bool,
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
            elements: about
                .number(&["throughput", "Elements"])
                .or_else(|| about.number(&["throughput", "Bytes"])),
            bytes: about.number(&["throughput", "Bytes"]).is_some(),
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
            counted(rate(one)),
            counted(format!("{}s", short(one.each()))),
            counted(format!("{:.2}", one.each() / first.each())),
        ]);
    }
    table
}

/// Elements per second.
fn rate(one: &Measurement) -> String {
    let rate = short(one.elements.unwrap_or(0.0) / one.time);
    if one.bytes {
        format!("{rate}B")
    } else {
        rate.trim_end().to_owned()
    }
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
}
