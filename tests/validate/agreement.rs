//! Every shipped case that reacts or moves, natively and with OpenFOAM and LIGGGHTS, within its own `agree` bands
//! at all times. One table of all; it fails at the end, so that one case out of its band does not hide the next.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::shipped;

const PAIRINGS: &str = "native+native,openfoam+liggghts";

/// A case, and its settings where the whole would take hours.
struct Compared {
    name: &'static str,
    set: &'static [&'static str],
}

const fn whole(name: &'static str) -> Compared {
    Compared { name, set: &[] }
}

/// Shortened: the furnace as far as two of the means over 240 s that its pressure drop is compared by, of 3400 s; it goes on to
/// 600 s in `shaft-flames`.
const CASES: [Compared; 18] = [
    whole("lime-burning"),
    whole("calcining-stone"),
    whole("ore-pellet"),
    whole("char-particle"),
    whole("catalyst-pellet"),
    whole("tg-furnace"),
    whole("tg-heap"),
    whole("ore-reduction"),
    whole("dri-self-heating"),
    whole("purged-bed"),
    whole("settling-sphere"),
    whole("settled-bed"),
    whole("rotating-drum"),
    whole("hopper"),
    whole("chute"),
    whole("moving-bed"),
    whole("fluidised-bed"),
    Compared {
        name: "shaft-furnace",
        set: &["time.end=480 s"],
    },
];

pub fn run() {
    every_such_case_is_listed();
    let folder = tempfile::tempdir().unwrap();
    println!(
        "  | case | quantity | largest difference at any time | of its band | band | verdict | wall time |"
    );
    let mut failed = Vec::new();
    for case in &CASES {
        let out = folder.path().join(case.name);
        match compared(case, &out) {
            Ok(comparison) => failed.extend(rows(case.name, &comparison)),
            Err(told) => {
                println!("  | {} | did not run: {told} |", case.name);
                failed.push(case.name.to_owned());
            }
        }
    }
    assert!(failed.is_empty(), "out of band: {}", failed.join(", "));
}

/// Runs both pairings; `compare.json`, whether within the bands or not.
fn compared(case: &Compared, out: &Path) -> Result<Value, String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command
        .arg("compare")
        .arg(shipped(case.name))
        .arg("--quiet");
    command.args(["--pairings", PAIRINGS]).arg("--out").arg(out);
    for setting in case.set {
        command.args(["--set", setting]);
    }
    let output = command.output().unwrap();
    let text = fs::read_to_string(out.join("compare.json"));
    text.ok()
        .and_then(|text| serde_json::from_str(&text).ok())
        .ok_or_else(|| String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Prints the quantities and those fields that have bands; names what is outside.
fn rows(case: &str, comparison: &Value) -> Vec<String> {
    let runs = comparison["runs"].as_array().unwrap();
    let walls: Vec<String> = runs
        .iter()
        .map(|run| format!("{:.0} s", run["wall_time_s"].as_f64().unwrap()))
        .collect();
    let mut failed = Vec::new();
    let mut banded = 0;
    for run in runs.iter().filter(|run| run["complete"] != true) {
        failed.push(format!("{case} ({} stopped early)", run["name"]));
    }
    for quantity in comparison["quantities"].as_array().unwrap() {
        let text = |key: &str| quantity[key].as_str().unwrap_or("–").to_owned();
        let (name, verdict) = (text("name"), text("verdict"));
        let share = quantity["multiple"].as_f64();
        banded += usize::from(share.is_some());
        println!(
            "  | {case} | {name} | {:.2e} {} | {} | {} | {verdict} | {} |",
            quantity["largest"]["difference"]
                .as_f64()
                .unwrap_or(f64::NAN),
            text("unit"),
            share.map_or("–".to_owned(), |share| format!("{share:.2e}")),
            text("band"),
            walls.join(", ")
        );
        if verdict == "outside" {
            failed.push(format!("{case}: {name}"));
        }
    }
    if banded == 0 {
        failed.push(format!("{case} states no band"));
    }
    failed
}

/// A shipped case that reacts or moves is in the table, or this fails.
fn every_such_case_is_listed() {
    for entry in fs::read_dir(shipped("x").parent().unwrap()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = fs::read_to_string(&path).unwrap();
        let due = ["[[reactions]]", "motion = \"free\"", "\nspecies ="]
            .iter()
            .any(|word| text.contains(word));
        let listed = CASES.iter().any(|case| case.name == name);
        assert!(listed || !due, "{name} reacts or moves and is not compared");
    }
}
