//! `cargo xtask bench parcels`: what parcels cost, by the phases of a window of a drying, reacting drum of 5000 to 450 000.

use std::env;

use crate::packages::{self, Needs};
use crate::runs::{self, summary};
use crate::steps::{Stop, TaskResult, say};
use crate::table::{Table, short};
use crate::tasks::{self, BuildScope};
use crate::workspace::Workspace;

/// The drums: how many times as wide as the shipped one, and layers of cells along its axis. The last two on request.
const DRUMS: [[u32; 2]; 4] = [[2, 12], [4, 30], [6, 41], [8, 67]];
/// Windows of a drum that are measured.
const WINDOWS: u32 = 10;

/// Builds unless told not to, measures, and prints the tables.
pub fn run(workspace: &Workspace, built: bool) -> TaskResult<()> {
    let needs = Needs::NATIVE;
    packages::install(needs, &workspace.logs)?;
    if !built {
        let _lock = workspace.lock()?;
        tasks::build_parts(workspace, needs, BuildScope::Runs)?;
    }
    say(&format!("\n{}", drums(workspace)?));
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
}
