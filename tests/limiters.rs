//! Limited convection of scalars on irregular cells: what flows in bounds what is there, in both gases.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine::results::Summary;

use crate::support::blocks::{Block, even};
use crate::support::program;

const CELLS: [usize; 3] = [6, 6, 12];
/// In m.
const SIZE: [f64; 3] = [0.06, 0.06, 0.12];

/// A number in [−1, 1] of a point and an axis.
fn drawn(at: [f64; 3], axis: usize) -> f64 {
    let index = |k: usize| (at[k] * CELLS[k] as f64).round() as u64;
    let mut state = (index(0) * 31 + index(1)) * 31 + index(2) * 3 + axis as u64 + 1;
    for _ in 0..3 {
        state = state.wrapping_mul(6_364_136_223_846_793_005);
        state ^= state >> 29;
    }
    (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Hexahedra whose points within the duct are displaced by up to 40 % of their edges.
fn displaced(at: [f64; 3]) -> [f64; 3] {
    let inside = |level: f64| level > 1e-9 && level < 1.0 - 1e-9;
    [0, 1, 2].map(|axis| {
        let edge = SIZE[axis] / CELLS[axis] as f64;
        let way = if at.into_iter().all(inside) {
            0.4 * edge * drawn(at, axis)
        } else {
            0.0
        };
        at[axis] * SIZE[axis] + way
    })
}

/// Gas of 400 K drives one of 300 K out of a duct with walls of 320 K.
const CASE: &str = r#"format = 1
title = "Hot gas in irregular cells"
[time]
end = "0.1 s"
motion_window = "1 ms"
[mesh]
polymesh = "polyMesh"
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas.patch.top]
outlet = { pressure = "1 atm" }
[gas.patch.side]
wall = { velocity = "no-slip", heat = { temperature = "320 K" } }
[[particles]]
name = "speck"
material = "glass"
diameter = "1 um"
motion = "frozen"
place = { grid = { first = "31 31 61 mm", spacing = "1 1 1 mm", counts = [1, 1, 1] } }
temperature = "300 K"
[laws]
drag = { law = "none" }
heat_transfer = { law = "none" }
conduction = { law = "none" }
radiation = { law = "none" }
[coupling]
mapping = "overlap"
smoother = { max_solid_fraction = 0.64, diffusion_length = "0 mm" }
[output]
every = "0.1 s"
[[quantities]]
name = "hottest"
measure = { gas = "temperature", statistic = "max" }
[[quantities]]
name = "coldest"
measure = { gas = "temperature", statistic = "min" }
"#;

const AIR: &str = r#"
[gas]
mixture = "air"
initial = { temperature = "300 K", pressure = "1 atm" }
[gas.patch.bottom]
inlet = { superficial_velocity = "1 m/s", temperature = "400 K" }
"#;

const MIXTURE: &str = r#"
[gas]
mixture = "carbon dioxide and nitrogen"
species = ["CO2", "N2"]
schmidt = 0.7
initial = { temperature = "300 K", pressure = "1 atm", composition = { mass = { N2 = 1 } } }
[gas.patch.bottom]
inlet = { superficial_velocity = "1 m/s", temperature = "400 K", composition = { mass = { CO2 = 0.5, N2 = 0.5 } } }
[[quantities]]
name = "most"
measure = { gas = "mass_fraction", of = "CO2", statistic = "max" }
[[quantities]]
name = "least"
measure = { gas = "mass_fraction", of = "CO2", statistic = "min" }
"#;

/// Quantities at the end with a gas and a scheme.
fn ends(folder: &Path, gas: &str, scheme: &str, mixture: &str) -> impl Fn(&str) -> f64 {
    let block = Block {
        levels: [even(CELLS[0]), even(CELLS[1]), even(CELLS[2])],
        patches: ["side", "side", "side", "side", "bottom", "top"],
        hole: None,
        shape: &displaced,
    };
    block.write(folder);
    let controls = format!("[gas.controls]\nconvection = {scheme}\n");
    let out = program::run_text(
        folder,
        gas,
        &(CASE.to_owned() + mixture + &controls),
        &["--gas", gas],
    );
    let summary = Summary::read(&out).unwrap();
    move |name| summary.quantities[name].value.unwrap()
}

#[test]
fn no_gas_is_hotter_than_what_flows_in_on_irregular_cells() {
    for scheme in ["\"van-leer\"", "{ limited_linear = 1 }"] {
        let [native, openfoam] = ["native", "openfoam"].map(|gas| {
            let folder = tempfile::tempdir().unwrap();
            let end = ends(folder.path(), gas, scheme, AIR);
            ["hottest", "coldest"].map(end)
        });
        println!("{scheme}: {native:?}, {openfoam:?}");
        // By van Leer's limiter without bounds 411 K.
        assert!(
            native[0] < 401.0 && native[1] > 300.0,
            "{scheme}: {native:?}"
        );
        for (one, other) in native.into_iter().zip(openfoam) {
            assert!(
                (one - other).abs() < 0.05,
                "{scheme}: {native:?}, {openfoam:?}"
            );
        }
    }
}

#[test]
fn no_gas_has_more_of_a_species_than_what_flows_in_on_irregular_cells() {
    let [native, openfoam] = ["native", "openfoam"].map(|gas| {
        let folder = tempfile::tempdir().unwrap();
        let end = ends(folder.path(), gas, "\"van-leer\"", MIXTURE);
        ["hottest", "coldest", "most", "least"].map(end)
    });
    println!("{native:?}, {openfoam:?}");
    let bounded = native[0] < 401.0 && native[1] > 300.0 && native[2] < 0.503 && native[3] > -1e-3;
    assert!(bounded, "{native:?}");
    for (k, band) in [0.05, 0.05, 1e-4, 1e-4].into_iter().enumerate() {
        let off = (native[k] - openfoam[k]).abs();
        assert!(off < band, "{native:?}, {openfoam:?}");
    }
}
