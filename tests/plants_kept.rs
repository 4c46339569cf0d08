//! What plants keep and show: checkpoints that are whole or told to be damaged, series as they were, attributes of particles,
//! and runs that stop between two rows.

use std::fs;
use std::path::Path;
use std::time::Duration;

use calcine::plant::PlantSummary;

use crate::plants::{root, run, said};
use crate::support::program;
use crate::support::stopped::{Stopped, stop};

const SETTINGS: [&str; 3] = [
    "time.end=400 s",
    "sizes.uniform.classes=100",
    "time.checkpoint={ every = \"20 s\" }",
];

/// Stops the shipped plant when it has left two checkpoints.
fn stopped(out: &Path) {
    let case = root().join("cases/granulation-plant.toml");
    let command = program::command(&case, out, &[], &SETTINGS);
    let due = |_| out.join("checkpoint.before").is_dir();
    assert_eq!(stop(command, due), Stopped::Checkpointed);
}

fn resumed(out: &Path) -> (Option<i32>, String) {
    let case = root().join("cases/granulation-plant.toml");
    let output = run(&case, out, &SETTINGS, &["--resume"]);
    (output.status.code(), said(&output))
}

#[test]
fn a_damaged_checkpoint_leads_back_to_the_one_before_and_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("cases/granulation-plant.toml");
    let whole = folder.path().join("whole");
    run(&case, &whole, &SETTINGS, &[]);
    for (name, harm) in [("cut", 0), ("changed", 1), ("gone", 2)] {
        let out = folder.path().join(name);
        stopped(&out);
        let file = out.join("checkpoint/plant.json");
        let text = fs::read_to_string(&file).unwrap();
        match harm {
            0 => fs::write(&file, &text[..text.len() / 2]).unwrap(),
            1 => fs::write(&file, text.replacen('7', "8", 1)).unwrap(),
            _ => fs::remove_file(&file).unwrap(),
        }
        let (code, told) = resumed(&out);
        assert!([Some(0), Some(5)].contains(&code), "{name}: {told}");
        assert!(
            told.contains("plant.json") && told.contains("checkpoint.damaged"),
            "{told}"
        );
        for file in ["series.csv", "distributions.csv", "streams.csv"] {
            let read = |folder: &Path| fs::read(folder.join(file)).unwrap();
            assert!(read(&out) == read(&whole), "{name}: {file}");
        }
    }
}

#[test]
fn a_series_that_was_changed_or_is_gone_is_refused_and_nothing_is_cut() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    stopped(&out);
    let before = fs::read(out.join("distributions.csv")).unwrap();
    let series = out.join("series.csv");
    let text = fs::read_to_string(&series).unwrap();
    let digit = text.rfind('5').unwrap();
    let changed = text[..digit].to_owned() + "6" + &text[digit + 1..];
    for content in [Some(&changed[..]), Some(&text[..text.len() / 2]), None] {
        match content {
            Some(content) => fs::write(&series, content).unwrap(),
            None => fs::remove_file(&series).unwrap(),
        }
        let (code, told) = resumed(&out);
        assert_eq!(code, Some(2), "{told}");
        assert!(
            told.contains("series.csv is not as the run left it"),
            "{told}"
        );
        fs::write(&series, &text).unwrap();
    }
    assert_eq!(fs::read(out.join("distributions.csv")).unwrap(), before);
    let (code, told) = resumed(&out);
    assert!([Some(0), Some(5)].contains(&code), "{told}");
    // Complete, and not said to be so when a table is gone.
    fs::remove_file(out.join("streams.csv")).unwrap();
    let (code, told) = resumed(&out);
    assert_eq!(code, Some(1), "{told}");
    assert!(
        told.contains("the run is complete, but") && told.contains("streams.csv"),
        "{told}"
    );
}

/// Classes of an attribute in the series, the distributions and as quantities: their sum is all.
#[test]
fn attributes_are_in_the_results() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("tests/inputs/plants/good/every-unit.toml");
    let out = folder.path().join("out");
    let quantity = "quantities=[{ name = \"second colour\", measure = { stream = \"nuclei\", field = \"class\", of = \"colour 2\" } }]";
    let output = run(&case, &out, &[quantity], &[]);
    assert!(output.status.success(), "{}", said(&output));
    let summary = PlantSummary::read(&out).unwrap();
    let flow = summary.quantities["second colour"].value.unwrap();
    assert!((flow - 0.02).abs() < 1e-12, "{flow}");
    let text = fs::read_to_string(out.join("series.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let last = lines.next_back().unwrap();
    let value = |name: &str| {
        let place = head.iter().position(|own| *own == name);
        let place = place.unwrap_or_else(|| panic!("{name} is not among {head:?}"));
        last[place].parse::<f64>().unwrap()
    };
    let parts = value("streams.nuclei.solid_flow_of_colour_1")
        + value("streams.nuclei.solid_flow_of_colour_2");
    assert!((parts / value("streams.nuclei.solid_flow") - 1.0).abs() < 1e-14);
    assert!(
        value("streams.nuclei.mean_diameter_of_colour_1")
            < value("streams.nuclei.mean_diameter_of_colour_2")
    );
    let text = fs::read_to_string(out.join("distributions.csv")).unwrap();
    let sum = |place: &str| -> f64 {
        let row = text
            .lines()
            .rfind(|line| line.split(',').nth(1) == Some(place))
            .unwrap();
        row.split(',')
            .skip(2)
            .map(|word| word.parse::<f64>().unwrap())
            .sum()
    };
    let parts = sum("streams.nuclei.colour_1") + sum("streams.nuclei.colour_2");
    assert!((parts / sum("streams.nuclei") - 1.0).abs() < 1e-14);
}

/// Windows of tear streams take many steps to the first row: the run stops all the same, at its last row.
#[test]
fn a_run_stops_between_two_rows() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("cases/granulation-plant.toml");
    let out = folder.path().join("out");
    let set = [
        "method.recycles=\"waveform\"",
        "time.end=2 h",
        "output.every=1 h",
    ];
    let command = program::command(&case, &out, &[], &set);
    let status = out.join("status.json");
    let due = |elapsed| status.exists() && elapsed > Duration::from_millis(300);
    assert_eq!(stop(command, due), Stopped::Checkpointed);
    assert!(out.join("checkpoint/plant.json").is_file());
}
