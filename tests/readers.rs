//! What users read results with: Debian's VTK 9.1 (as in ParaView 5.11) and h5py find in the files
//! of a run what `summary.json` and `series.csv` say, and the example in the docs runs.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use calcine::results::Summary;
use calcine::results::read::Series;
use serde_json::Value;
use tempfile::TempDir;

/// Process times of the snapshots of the run in s: each 0.8 s, and the end.
const SNAPSHOTS: [f64; 4] = [0.0, 0.8, 1.6, 2.0];

/// The results of a short run of the shipped heated bed; of one run for all tests.
fn results() -> &'static Path {
    static RUN: OnceLock<(TempDir, PathBuf)> = OnceLock::new();
    let (_, out) = RUN.get_or_init(|| {
        let scratch = tempfile::tempdir().unwrap();
        let out = scratch.path().join("results of a run");
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-bed.toml");
        let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
            .arg("run")
            .arg(case)
            .args(["--quiet", "--set", "time.end=2 s"])
            .args(["--set", "time.motion_window=2 ms"])
            .args(["--set", "time.acceleration=200"])
            .args(["--set", "output.every=0.8 s"])
            .args(["--set", "output.series_every=0.4 s"])
            .arg("--out")
            .arg(&out)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{text}");
        (scratch, out)
    });
    out
}

/// Debian's own Python, whatever else is on the PATH, with the packages that set-up installs.
fn python(script: &str, argument: &Path) -> String {
    let output = Command::new("/usr/bin/python3")
        .args(["-c", script])
        .arg(argument)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "python3-vtk9 and python3-h5py are needed (`cargo xtask setup`): {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

/// What VTK and h5py find in the results.
fn found() -> &'static Value {
    static FOUND: OnceLock<Value> = OnceLock::new();
    FOUND.get_or_init(|| {
        let text = python(include_str!("readers/read_back.py"), results());
        serde_json::from_str(&text).unwrap()
    })
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// A column of the series at the times of the snapshots.
fn at_snapshots(series: &Series, name: &str) -> Vec<f64> {
    let times = series.column("process_time");
    let row = |time| times.iter().position(|&other| other == time).unwrap();
    SNAPSHOTS
        .map(|time| series.column(name)[row(time)])
        .to_vec()
}

#[test]
fn paraview_shows_the_times_counts_and_temperatures_of_summary_and_series() {
    let (summary, series) = (
        Summary::read(results()).unwrap(),
        Series::read(results()).unwrap(),
    );
    assert!(summary.particles > 1000 && summary.cells > 1000);
    for kind in ["gas", "particles"] {
        let snapshots = found()[kind].as_array().unwrap();
        for name in ["collection_time", "time", "stored_time"] {
            let times: Vec<f64> = snapshots.iter().map(|shot| number(&shot[name])).collect();
            assert_eq!(times, SNAPSHOTS, "{kind}: {name}");
        }
        for extreme in ["min", "max"] {
            let values: Vec<f64> = snapshots
                .iter()
                .map(|shot| number(&shot[extreme]))
                .collect();
            let expected = at_snapshots(&series, &format!("{kind}.temperature_{extreme}"));
            assert_eq!(values, expected, "{kind}: {extreme}");
        }
        for shot in snapshots {
            let cells = match kind {
                "gas" => summary.cells,
                _ => summary.particles,
            };
            assert_eq!(shot["cells"].as_u64(), Some(cells as u64), "{kind}");
        }
    }
    let last = SNAPSHOTS.len() - 1;
    let means = at_snapshots(&series, "particles.temperature_mean");
    for (shot, mean) in found()["particles"].as_array().unwrap().iter().zip(&means) {
        assert_eq!(shot["points"].as_u64(), Some(summary.particles as u64));
        // Sums in another order: 2000 values at round-off.
        let difference = number(&shot["mean"]) - mean;
        assert!(difference.abs() < 1e-12 * mean, "{difference} K");
    }
    let quantity = summary.quantities["mean_temperature"].value.unwrap();
    assert!((quantity - means[last]).abs() < 1e-12 * quantity);
    assert!(means[last] > means[0] + 0.01, "the bed heats up: {means:?}");
}

#[test]
fn vtk_and_h5py_read_the_same_fields_to_the_bit() {
    for kind in ["gas", "particles"] {
        for shot in found()[kind].as_array().unwrap() {
            assert_eq!(shot["fields"], shot["stored_fields"], "{kind}");
            assert_eq!(
                shot["differing"].as_array().map(Vec::len),
                Some(0),
                "{shot}"
            );
        }
    }
    let fields = &found()["gas"][0]["fields"];
    let wanted = ["pressure", "temperature", "velocity", "void_fraction"];
    assert_eq!(*fields, serde_json::json!(wanted));
}

#[test]
fn vtk_computes_the_volumes_of_cells_that_the_solver_works_with() {
    for shot in found()["gas"].as_array().unwrap() {
        // VTK cuts a cell into tetrahedra; faces of this mesh are plane.
        let error = number(&shot["volume_error"]);
        assert!(error < 1e-10, "{error}");
    }
    // Polygons of the area of circles of 50 mm, 100 mm long.
    let tube = std::f64::consts::PI * 0.025f64.powi(2) * 0.1;
    let share = number(&found()["volume"]) / tube;
    assert!((share - 1.0).abs() < 1e-12, "{share}");
}

#[test]
fn h5py_reads_the_series_to_the_bit_and_every_dataset_says_its_unit() {
    let series = Series::read(results()).unwrap();
    let summary = Summary::read(results()).unwrap();
    assert_eq!(found()["case"], summary.case.name);
    assert_eq!(found()["hash"], summary.case.hash);
    let stored = found()["series"].as_object().unwrap();
    assert_eq!(stored.len(), series.names.len());
    for (place, name) in series.names.iter().enumerate() {
        let column = &stored[name];
        assert_eq!(column["unit"], series.units[place], "{name}");
        let values: Vec<u64> = column["values"]
            .as_array()
            .unwrap()
            .iter()
            .map(|text| from_hexadecimal(text.as_str().unwrap()).to_bits())
            .collect();
        let written: Vec<u64> = series.columns[place].iter().map(|x| x.to_bits()).collect();
        assert_eq!(values, written, "{name}");
    }
    let datasets = found()["datasets"].as_array().unwrap();
    assert!(datasets.len() > 60, "{}", datasets.len());
    let known = [
        "1", "s", "m", "m^3", "m/s", "K", "Pa", "W", "kg", "kg/m^3", "J", "N s",
    ];
    for dataset in datasets {
        let unit = dataset["unit"].as_str().unwrap_or_default();
        assert!(known.contains(&unit), "{dataset}");
        assert!(
            !dataset["description"]
                .as_str()
                .unwrap_or_default()
                .is_empty()
        );
    }
}

/// A number as Python's `float.hex` writes it: `-0x1.8p+1`, `0x0.0p+0`, `nan`, `inf`.
fn from_hexadecimal(text: &str) -> f64 {
    let (sign, size) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text),
    };
    let Some(digits) = size.strip_prefix("0x") else {
        return sign * size.parse::<f64>().unwrap();
    };
    let (mantissa, exponent) = digits.split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let bits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    let exponent = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    // Two steps, for a subnormal number's exponent is below that of any normal one.
    sign * bits as f64 * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
}

#[test]
fn hexadecimal_numbers_of_python_are_read_to_the_bit() {
    for (text, value) in [
        ("0x1.999999999999ap-4", 0.1),
        ("-0x1.8000000000000p+1", -3.0),
        ("0x0.0000000000001p-1022", f64::from_bits(1)),
        ("-0x0.0p+0", -0.0),
        ("inf", f64::INFINITY),
    ] {
        assert_eq!(from_hexadecimal(text).to_bits(), value.to_bits(), "{text}");
    }
}

#[test]
fn the_example_of_the_docs_prints_the_series_in_ten_lines() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/results.md");
    let docs = fs::read_to_string(docs).unwrap();
    let (_, after) = docs.split_once("```python\n").unwrap();
    let (script, _) = after.split_once("```").unwrap();
    assert_eq!(script.lines().count(), 10, "{script}");
    let text = python(script, &results().join("results.h5"));
    let series = Series::read(results()).unwrap();
    let columns = [
        "process_time",
        "quantities.pressure_drop",
        "particles.temperature_mean",
    ];
    let columns = columns.map(|name| series.column(name));
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    assert!(
        head.contains("[s]") && head.contains("[Pa]") && head.contains("[K]"),
        "{head}"
    );
    let rows: Vec<&str> = lines.collect();
    assert_eq!(rows.len(), columns[0].len(), "{text}");
    for (row, line) in rows.iter().enumerate() {
        let shown: Vec<f64> = line
            .split_whitespace()
            .map(|word| word.parse().unwrap())
            .collect();
        for (shown, column) in shown.iter().zip(columns) {
            // Three decimals are shown; before the first window there is no pressure drop.
            let same = shown.is_nan() && column[row].is_nan();
            assert!(same || (shown - column[row]).abs() < 5.1e-4, "{line}");
        }
        assert_eq!(shown.len(), columns.len(), "{line}");
    }
}
