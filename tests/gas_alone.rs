//! Cases without particles: the gas alone, natively and with OpenFOAM, resumed, compared, swept, in a report.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::Path;
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::{program, stopped};

/// A quick version of the shipped pipe: coarse, and ten windows.
const QUICK: [&str; 6] = [
    "mesh.cylinder.cells=[5, 8]",
    "time.end=0.2 s",
    "output.every=0.1 s",
    "output.series_every=20 ms",
    "quantities.axis_speed.expect.within=10 m/s",
    "quantities.outlet_temperature.expect.within=10 K",
];

/// Exit code and all that is printed.
fn calcine(words: &[&str], set: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.args(words);
    for one in set {
        command.args(["--set", one]);
    }
    let output = command.output().unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(text).unwrap())
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_case_without_particles_is_checked_and_runs_with_each_solver_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("pipe");
    let (code, said) = calcine(&["check", text(&case)], &[]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("the gas is computed alone"), "{said}");
    assert!(!said.contains("warning"), "{said}");
    // LIGGGHTS has nothing to move, and is not started.
    for words in [
        &["--gas", "native"][..],
        &["--gas", "openfoam"],
        &["--gas", "openfoam", "--particles", "liggghts"],
    ] {
        let out = folder.path().join(words.join(""));
        let all = [&["run", "--quiet", text(&case), "--out", text(&out)], words].concat();
        let (code, said) = calcine(&all, &QUICK);
        assert_eq!(code, Some(0), "{words:?}: {said}");
        assert!(
            said.contains("no particles: the gas was computed alone"),
            "{said}"
        );
        assert!(!out.join("solvers/liggghts").exists());
        let summary = Summary::read(&out).unwrap();
        for line in ["mass", "energy"] {
            assert!(
                summary.ledger.lines[line].relative_error < 1e-10,
                "{words:?}"
            );
        }
        let warmed = summary.quantities["outlet_temperature"].value.unwrap();
        assert!((300.02..302.0).contains(&warmed), "{words:?}: {warmed}");
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains("outlet_temperature") && !page.contains("NaN"));
    }
}

#[test]
fn a_gas_alone_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("pipe");
    for gas in ["native", "openfoam"] {
        let [whole, parts] =
            ["whole", "parts"].map(|name| folder.path().join(format!("{gas}-{name}")));
        let long = [&QUICK[..], &["time.end=4 s"]].concat();
        program::run(&case, &whole, &["--gas", gas], &long);
        let words = ["--gas", gas];
        stopped::stop_and_resume(
            || program::command(&case, &parts, &words, &long),
            &parts,
            20,
        );
        let [one, other] = [&whole, &parts].map(|out| Series::read(out).unwrap());
        for name in [
            "quantities.pressure_drop",
            "quantities.outlet_temperature",
            "quantities.wall_heat",
        ] {
            let [one, other] = [&one, &other].map(|series| series.column(name).to_vec());
            // What flowed through patches is not known before the first window of a process.
            assert_eq!(one.len(), other.len());
            for (row, (one, other)) in one.iter().zip(&other).enumerate() {
                let same = one.to_bits() == other.to_bits() || one.is_nan() || other.is_nan();
                assert!(same, "{gas}, {name}, row {row}: {one} {other}");
            }
        }
    }
}

#[test]
fn a_gas_alone_is_compared_once_a_gas_and_swept() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("pipe");
    let compared = program::compare(&case, &folder.path().join("compared"), "all", &QUICK);
    assert_eq!(compared["runs"].as_array().unwrap().len(), 2, "{compared}");
    assert_eq!(compared["agrees"], true, "{compared}");

    let out = folder.path().join("swept");
    let speeds = "gas.patch.bottom.inlet.superficial_velocity=0.2 m/s,0.4 m/s";
    let words = ["sweep", text(&case), "--out", text(&out)];
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.args(words).args(["--set", speeds]);
    for one in QUICK {
        command.args(["--set", one]);
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 3, "{table}");
}

/// Hagen and Poiseuille's speed on the axis, 0.3 m/s, near the outlet of a pipe without heat; one cell lies on the axis.
#[test]
fn the_speed_on_the_axis_of_the_pipe_converges_to_twice_the_mean() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("pipe");
    let off = |cells: u32| {
        let out = folder.path().join(format!("{cells}"));
        let mesh = format!("mesh.cylinder.cells=[{cells}, 30]");
        let set = [
            &mesh,
            "time.end=3 s",
            "output.every=3 s",
            "output.series_every=3 s",
            "quantities.outlet_temperature.expect.value=300 K",
            "gas.patch.side={ wall = { velocity = \"no-slip\", heat = \"adiabatic\" } }",
        ];
        program::run(&case, &out, &[], &set);
        let summary = Summary::read(&out).unwrap();
        let value = |name: &str| summary.quantities[name].value.unwrap();
        assert!((value("outlet_temperature") - 300.0).abs() < 1e-6);
        (value("axis_speed") - 0.3).abs()
    };
    let [coarse, middle, fine] = [9, 13, 19].map(off);
    println!("{coarse:e}, {middle:e}, {fine:e} m/s");
    let order = |coarse: f64, fine: f64, ratio: f64| (coarse / fine).ln() / ratio.ln();
    assert!(order(coarse, middle, 13.0 / 9.0) > 1.6);
    assert!(order(middle, fine, 19.0 / 13.0) > 1.6);
    assert!(fine < 2e-3, "{fine}");
}
