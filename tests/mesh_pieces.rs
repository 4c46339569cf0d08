//! Meshes of several pieces that no face joins, in cases of the gas alone: what is refused, and that pieces with outlets of their own
//! run as each would by itself; means by mass flow of the two streams.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::path::Path;
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::{arrays, collection};
use calcine_coupler::mesh::Mesh;

use crate::support::blocks::{Block, even};
use crate::support::program;

/// Two streams along x that meet in a gap between two pieces of a block of 70 x 10 x 15 mm.
const STREAMS: &str = r#"
format = 1
title = "Two streams through pieces that no face joins"
[time]
end = "30 ms"
motion_window = "5 ms"
[mesh]
polymesh = "polyMesh"
[gas]
mixture = "fluid"
constant = { density = "1.2 kg/m^3", heat_capacity = "1 kJ/kg/K", viscosity = "1.8e-5 Pa s", conductivity = "0.026 W/m/K" }
initial = { temperature = "300 K", pressure = "1 atm" }
controls = { outer_tolerance = 1e-12, outer_iterations = 100, linear_tolerance = 1e-14 }
[gas.patch.west]
inlet = { superficial_velocity = "1 m/s", temperature = "400 K" }
[gas.patch.east]
inlet = { superficial_velocity = "0.4 m/s", temperature = "320 K" }
[gas.patch.gap]
outlet = { pressure = "1 atm" }
[gas.patch.side]
wall = { velocity = "slip", heat = "adiabatic" }
[output]
every = "30 ms"
gas = ["temperature", "velocity", "pressure"]
[[quantities]]
name = "mixing_cup"
measure = { gas = "temperature", patch = "gap", statistic = "mass-flow-mean" }
agree = "1e-6 K"
[[quantities]]
name = "by_area"
measure = { gas = "temperature", patch = "gap", statistic = "mean" }
[[quantities]]
name = "inflow"
measure = { gas = "temperature", patch = "west", statistic = "mass-flow-mean" }
"#;

/// Writes the two pieces, of 3 x 2 x 3 cells each, beside the case.
fn pieces(folder: &Path) -> Mesh {
    let gap = |at: [f64; 3]| (at[0] - 0.5).abs() < 0.05;
    let block = Block {
        levels: [even(7), even(2), even(3)],
        patches: ["west", "east", "side", "side", "side", "side"],
        hole: Some(("gap", &gap)),
        shape: &|at| [0.07 * at[0], 0.01 * at[1], 0.015 * at[2]],
    };
    block.write(folder)
}

fn value(out: &Path, name: &str) -> f64 {
    Summary::read(out).unwrap().quantities[name].value.unwrap()
}

fn field(out: &Path, name: &str) -> Vec<f64> {
    let files = collection(out, "gas.pvd").unwrap();
    let last = arrays(&files.last().unwrap().1).unwrap();
    last[name].values.clone()
}

#[test]
fn pieces_with_outlets_run_as_each_by_itself_and_mixing_cup_means_are_those_of_the_snapshot() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = pieces(folder.path());
    for gas in ["native", "openfoam"] {
        let out = program::run_text(folder.path(), gas, STREAMS, &["--gas", gas]);
        let (kelvin, speed, pressure) = (
            field(&out, "temperature"),
            field(&out, "velocity"),
            field(&out, "pressure"),
        );
        let (mut flow, mut carried, mut area) = (0.0, 0.0, 0.0);
        for (cell, at) in mesh.cell_centre().iter().enumerate() {
            // Walls do not hold the gas back, nothing expands: uniform flow towards the gap.
            let along = if at.x < 0.035 { 1.0 } else { -0.4 };
            let off = (speed[3 * cell] - along).abs() + (pressure[cell] - 101_325.0).abs();
            assert!(off < 1e-7, "{gas}, cell {cell}: {} m/s", speed[3 * cell]);
            if (at.x - 0.035).abs() < 0.011 {
                flow += speed[3 * cell].abs();
                carried += speed[3 * cell].abs() * kelvin[cell];
                area += kelvin[cell] / 12.0;
            }
        }
        let (found, by_area) = (value(&out, "mixing_cup"), value(&out, "by_area"));
        let off = found * flow / carried - 1.0;
        assert!(off.abs() < 1e-10, "{gas}: {found} K, off by {off:e}");
        assert!((by_area / area - 1.0).abs() < 1e-12, "{gas}: {by_area}");
        assert!((found - by_area).abs() > 5.0, "{gas}: {found}, {by_area}");
        // What is conducted into the inflow counts along.
        let inflow = value(&out, "inflow");
        assert!((inflow - 400.0).abs() < 0.5, "{gas}: {inflow}");
    }
}

/// Streams of two compositions and temperatures, of stated mass flows.
#[test]
fn means_by_mass_flow_of_mixtures_are_those_of_the_streams_that_came_in() {
    let folder = tempfile::tempdir().unwrap();
    pieces(folder.path());
    let (begin, end) = (
        STREAMS.find("[gas]").unwrap(),
        STREAMS.find("[gas.patch.gap]").unwrap(),
    );
    let gas = r#"[gas]
mixture = "flue"
species = ["N2", "CO2"]
schmidt = 0.7
initial = { temperature = "300 K", pressure = "1 atm", composition = { mass = { N2 = 1 } } }
controls = { outer_tolerance = 1e-11, outer_iterations = 100 }
[gas.patch.west]
inlet = { mass_flow = "0.2 g/s", temperature = "600 K", composition = { mass = { N2 = 0.7, CO2 = 0.3 } } }
[gas.patch.east]
inlet = { mass_flow = "0.05 g/s", temperature = "350 K", composition = { mass = { N2 = 0.9, CO2 = 0.1 } } }
"#;
    let case = format!("{}{gas}{}", &STREAMS[..begin], &STREAMS[end..]).replace("30 ms", "1 s")
        + r#"
[[quantities]]
name = "carbon_dioxide"
measure = { gas = "mass_fraction", of = "CO2", patch = "gap", statistic = "mass-flow-mean" }
[[quantities]]
name = "heat"
measure = { flow = "heat", patch = "gap" }
"#;
    for gas in ["native", "openfoam"] {
        let out = program::run_text(folder.path(), gas, &case, &["--gas", gas]);
        // Steady: what comes in goes out.
        let share = (0.2 * 0.3 + 0.05 * 0.1) / 0.25;
        let found = value(&out, "carbon_dioxide");
        assert!(
            (found / share - 1.0).abs() < 1e-8,
            "{gas}: {found} for {share}"
        );
        let kelvin = value(&out, "mixing_cup");
        assert!((540.0..570.0).contains(&kelvin), "{gas}: {kelvin}");
    }
}

/// Exit code and all that is printed, in one line.
fn calcine(folder: &Path, words: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    let output = command.current_dir(folder).args(words).output().unwrap();
    let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    let words = text.split_whitespace().filter(|word| *word != "│");
    (output.status.code(), words.collect::<Vec<_>>().join(" "))
}

#[test]
fn a_piece_without_an_outlet_is_refused_by_its_place_and_its_patches() {
    let folder = tempfile::tempdir().unwrap();
    pieces(folder.path());
    let outlet = "outlet = { pressure = \"1 atm\" }";
    let wall = "wall = { velocity = \"slip\", heat = \"adiabatic\" }";
    let west = "inlet = { superficial_velocity = \"1 m/s\", temperature = \"400 K\" }";
    let east = "inlet = { superficial_velocity = \"0.4 m/s\", temperature = \"320 K\" }";
    let unmeasured = STREAMS.split("[[quantities]]").next().unwrap();
    let shut = unmeasured.replace(outlet, wall);
    for (name, case, words) in [
        // The western piece lets its gas out, the eastern one only in.
        (
            "one",
            shut.replace(west, outlet),
            "1 has no `outlet` or `opening`: 18 cells about (0.0450, 0.0025, 0.0025) m with the patches side, gap, east",
        ),
        // Both are closed, and have one level of pressure between them.
        (
            "both",
            shut.replace(west, wall).replace(east, wall),
            "2 have no `outlet` or `opening`: 18 cells about (0.0050, 0.0025, 0.0025) m",
        ),
    ] {
        let file = format!("{name}.toml");
        fs::write(folder.path().join(&file), case).unwrap();
        for arguments in [
            &["check", &file][..],
            &["run", &file, "--out", "out"],
            &["run", &file, "--gas", "openfoam", "--out", "out"],
        ] {
            let (code, said) = calcine(folder.path(), arguments);
            assert_eq!(code, Some(2), "{arguments:?}: {said}");
            for part in ["the mesh has 2 pieces", words, "give each piece an outlet"] {
                assert!(said.contains(part), "{arguments:?}: {said}");
            }
        }
    }
}
