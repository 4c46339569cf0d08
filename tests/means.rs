//! Time means of fields, against what the snapshots of all windows come to.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use calcine::results::read::{Arrays, arrays, collection};

use crate::support::{program, results_equal, stopped};

const MEANS: &str = "means = { from = \"1 s\", to = \"3.25 s\", gas = [\"velocity\", \"temperature\", \"pressure\", \"void_fraction\"], particles = [\"velocity\", \"temperature\"] }\n";

/// The moving bed with means over the windows of 0.5 s from 1 s, half of the last one.
fn case(folder: &Path) -> std::path::PathBuf {
    let case = fs::read_to_string(program::shipped("moving-bed")).unwrap();
    let case = case.split("[[quantities]]").next().unwrap();
    let case = case.replace("[output]\n", &format!("[output]\n{MEANS}"));
    let file = folder.join("bed.toml");
    fs::write(&file, case).unwrap();
    file
}

const SET: [&str; 4] = [
    "time.end=4 s",
    "output.every=0.5 s",
    "output.gas=[\"velocity\", \"temperature\", \"pressure\", \"void_fraction\"]",
    "output.particles=[\"velocity\", \"temperature\", \"mass\"]",
];

/// Weights in s of the snapshots: of what of the window before each lies between 1 s and 3.25 s.
fn weighted(out: &Path, file: &str) -> Vec<(f64, Arrays)> {
    let files = collection(out, file).unwrap();
    let overlap = |end: f64| (end.min(3.25) - (end - 0.5).max(1.0)).max(0.0);
    let all = files
        .iter()
        .map(|(time, path)| (overlap(*time), arrays(path).unwrap()));
    all.filter(|(weight, _)| *weight > 1e-9).collect()
}

/// Mean and root mean square of the fluctuation of pairs of weight and value.
fn statistics(pairs: &[(f64, f64)]) -> [f64; 2] {
    let total: f64 = pairs.iter().map(|pair| pair.0).sum();
    let mean = pairs
        .iter()
        .map(|(weight, value)| weight * value)
        .sum::<f64>()
        / total;
    let square = pairs
        .iter()
        .map(|(weight, value)| weight * (value - mean).powi(2));
    [mean, (square.sum::<f64>() / total).sqrt()]
}

fn close(what: &str, found: f64, expected: f64, size: f64) {
    if expected.is_nan() && found.is_nan() {
        return;
    }
    let off = (found - expected).abs() / size;
    assert!(off < 1e-10, "{what}: {found} for {expected}");
}

#[test]
fn means_and_root_mean_squares_are_those_of_the_snapshots_of_all_windows() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    program::run(&case(folder.path()), &out, &[], &SET);
    let means = arrays(&out.join("means.vtu")).unwrap();
    // The report has a picture of each mean, and of what fluctuates.
    let page = fs::read_to_string(calcine::report::write(&out).unwrap()).unwrap();
    let (_, section) = page.split_once("<h2>Means over time</h2>").unwrap();
    let section = section.split("<h2>").next().unwrap();
    for label in [
        "temperature mean in K",
        "temperature rms in K",
        "particle temperature mean in K",
        "particle density mean in kg/m³",
    ] {
        assert!(section.contains(&format!("<figcaption>{label}")), "{label}");
    }
    assert!(!section.contains("NaN"));
    // A middle plane through 2 cells of 20 mm and 10 layers.
    assert_eq!(section.matches("<polygon").count() % 20, 0);
    let gas = weighted(&out, "gas.pvd");
    assert_eq!(gas.len(), 5);
    let cells = 40;
    for (name, items) in [
        ("velocity", 3),
        ("temperature", 1),
        ("pressure", 1),
        ("void_fraction", 1),
    ] {
        let [mean, rms] = ["mean", "rms"].map(|what| &means[&format!("{name}_{what}")].values);
        let size = gas[0].1[name]
            .values
            .iter()
            .fold(0.0, |size: f64, x| size.max(x.abs()));
        let mut moves = 0;
        for place in 0..cells * items {
            let pairs: Vec<_> = gas
                .iter()
                .map(|(w, of)| (*w, of[name].values[place]))
                .collect();
            let expected = statistics(&pairs);
            moves += usize::from(expected[1] > 1e-9 * size);
            close(name, mean[place], expected[0], size);
            // The square of a fluctuation is known to the round-off of the value, so that one of 1e-8 of it is.
            close(name, rms[place].powi(2), expected[1].powi(2), size * size);
            if expected[1] > 1e-5 * size {
                close(name, rms[place], expected[1], expected[1]);
            }
        }
        assert!(moves > cells / 2, "{name}: {moves}");
    }
    // Cells of 20 mm, which hold the particles by their centres.
    let mut of_cell: BTreeMap<usize, Vec<(f64, [f64; 4])>> = BTreeMap::new();
    for (weight, of) in weighted(&out, "particles.pvd") {
        let list = |name: &str| &of[name].values;
        let (place, mass, speed) = (list("points"), list("mass"), list("velocity"));
        for (row, kelvin) in list("temperature").iter().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|axis| (place[3 * row + axis] / 0.02) as usize);
            let [u, v, w] = [0, 1, 2].map(|axis| speed[3 * row + axis]);
            let cell = of_cell.entry(x + 2 * y + 4 * z).or_default();
            cell.push((weight * mass[row], [*kelvin, u, v, w]));
        }
    }
    for cell in 0..cells {
        let own = of_cell.get(&cell).cloned().unwrap_or_default();
        let density: f64 = own.iter().map(|one| one.0).sum::<f64>() / 2.25 / 8e-6;
        close(
            "density",
            means["particle_density_mean"].values[cell],
            density,
            2500.0,
        );
        for k in 0..4 {
            let pairs: Vec<_> = own.iter().map(|one| (one.0, one.1[k])).collect();
            let expected = statistics(&pairs);
            let at = |what: &str| match k {
                0 => means[&format!("particle_temperature_{what}")].values[cell],
                _ => means[&format!("particle_velocity_{what}")].values[3 * cell + k - 1],
            };
            let size = if k == 0 { 400.0 } else { 1.0 };
            close("particles", at("mean"), expected[0], size);
            close(
                "particles",
                at("rms").powi(2),
                expected[1].powi(2),
                size * size,
            );
        }
    }
}

#[test]
fn a_run_that_is_stopped_and_resumed_has_the_same_means_and_discharges() {
    let folder = tempfile::tempdir().unwrap();
    let file = case(folder.path());
    let text = fs::read_to_string(&file).unwrap() + DISCHARGES;
    fs::write(&file, text).unwrap();
    let more = [
        "feeds.charge.mass_rate=10 g/s",
        "outlets.discharge.mass_rate=10 g/s",
    ];
    let set = [&["time.end=30 s"][..], &SET[1..], &more[..]].concat();
    let whole = folder.path().join("whole");
    program::run(&file, &whole, &[], &set);
    let means = fs::read(whole.join("means.vtu")).unwrap();
    // In the middle of the interval, and after it.
    for rows in [4, 8] {
        let out = folder.path().join(format!("stopped-{rows}"));
        let command = || program::command(&file, &out, &[], &set);
        stopped::stop_and_resume(command, &out, rows);
        let differ = results_equal::differences(&whole, &out);
        assert!(differ.is_empty(), "{rows}: {differ:?}");
        assert!(fs::read(out.join("means.vtu")).unwrap() == means, "{rows}");
    }
}

const DISCHARGES: &str = r#"
[[outlets]]
name = "spill"
region = { box = { from = "0 0 171 mm", to = "40 40 200 mm" } }
mass_rate = "6 g/s"
[[quantities]]
name = "below"
measure = { discharge = "mass_flow", outlet = "discharge", over = "2 s" }
[[quantities]]
name = "stay"
measure = { discharge = "residence_time", outlet = "spill", over = "1 s" }
"#;
