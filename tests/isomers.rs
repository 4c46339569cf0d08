//! A gas that becomes its isomer, or falls apart, at a constant rate, in cells without a flow through them and in cells that it leaves
//! hardly at all, by both gases (CHM-2): a closed cell, one with an outlet alone, and a chain in which next to nothing is left of it. A
//! cell that starts with cold gas, below the rate at which its reactor ignites.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use calcine::results::read;

use crate::support::program;

/// Gases of constant heat capacity: B and C are isomers of A, C of a lower enthalpy, D half of it, X inert.
const SPECIES: &str = "
units: {length: m, quantity: mol, activation-energy: J/mol, energy: J, time: s}
phases:
- name: gas
  thermo: ideal-gas
  elements: [N]
  species: [A, B, C, D, X]
  state: {T: 300.0, P: 1 atm}
species:
- name: A
  composition: {N: 2}
  thermo: {model: NASA7, temperature-ranges: [200.0, 1000.0, 6000.0], data: [[3.5,0,0,0,0,0,4],[3.5,0,0,0,0,0,4]]}
  transport: {model: gas, geometry: linear, diameter: 3.6, well-depth: 97.5}
- name: B
  composition: {N: 2}
  thermo: {model: NASA7, temperature-ranges: [200.0, 1000.0, 6000.0], data: [[3.5,0,0,0,0,0,5],[3.5,0,0,0,0,0,5]]}
  transport: {model: gas, geometry: linear, diameter: 3.6, well-depth: 97.5}
- name: C
  composition: {N: 2}
  thermo: {model: NASA7, temperature-ranges: [200.0, 1000.0, 6000.0], data: [[3.5,0,0,0,0,-3.0e4,4],[3.5,0,0,0,0,-3.0e4,4]]}
  transport: {model: gas, geometry: linear, diameter: 3.6, well-depth: 97.5}
- name: X
  composition: {N: 2}
  thermo: {model: NASA7, temperature-ranges: [200.0, 1000.0, 6000.0], data: [[3.5,0,0,0,0,0,4],[3.5,0,0,0,0,0,4]]}
  transport: {model: gas, geometry: linear, diameter: 3.6, well-depth: 97.5}
- name: D
  composition: {N: 1}
  thermo: {model: NASA7, temperature-ranges: [200.0, 1000.0, 6000.0], data: [[1.75,0,0,0,0,0,2],[1.75,0,0,0,0,0,2]]}
  transport: {model: gas, geometry: linear, diameter: 3.6, well-depth: 97.5}
";

/// What is left of A in each cell of 10 mm at the end.
struct Decay {
    /// `A => B` or `A => 2 D`.
    equation: &'static str,
    /// Its rate constant in 1/s.
    rate: String,
    /// The gas at the start.
    initial: &'static str,
    /// Keys of `[time]`.
    time: String,
    /// Cells one above the other.
    cells: usize,
    /// Conditions of bottom and top.
    ends: [&'static str; 2],
    /// Keys of `[gas]` about diffusion and convection.
    transport: &'static str,
}

const STILL: &str = "schmidt = 1e6\ncontrols = { convection = \"upwind\" }";

const WALL: &str = "wall = { velocity = \"slip\", heat = \"adiabatic\" }";
const OUTLET: &str = "outlet = { pressure = \"1 atm\" }";
const FULL: &str = "temperature = \"500 K\", composition = { mass = { A = 1 } }";
const INLET: &str = "inlet = { superficial_velocity = \"0.1 m/s\", temperature = \"500 K\", composition = { mass = { A = 1 } } }";

impl Decay {
    /// A field of the cells at the end.
    fn found(&self, field: &str, gas: &str, directory: &Path) -> Vec<f64> {
        let Self {
            equation,
            rate,
            initial,
            time,
            cells,
            ends: [bottom, top],
            transport,
        } = self;
        let length = 10 * cells;
        let text = format!(
            r#"
format = 1
title = "Isomers"
[time]
{time}
[mesh]
box = {{ size = "10 10 {length} mm", cells = [1, 1, {cells}] }}
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "isomers"
species = ["A", "B", "C", "D", "X"]
{transport}
initial = {{ pressure = "1 atm", {initial} }}
[gas.species_data]
thermo = "isomers.yaml"
[gas.chemistry]
reactions = [{{ name = "decay", equation = "{equation}", rate = {{ {rate} }} }}]
[gas.patch.bottom]
{bottom}
[gas.patch.top]
{top}
[gas.patch.side]
symmetry = {{}}
[[particles]]
name = "speck"
material = "glass"
diameter = "1 um"
motion = "frozen"
place = {{ grid = {{ first = "5 5 3 mm", spacing = "1 1 1 mm", counts = [1, 1, 1] }} }}
temperature = "500 K"
[laws]
drag = {{ law = "none" }}
heat_transfer = {{ law = "none" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "overlap"
smoother = {{ max_solid_fraction = 0.64 }}
[output]
every = "1e6 s"
gas = ["temperature", "mass_fractions"]
"#
        );
        fs::write(directory.join("isomers.yaml"), SPECIES).unwrap();
        let number = fs::read_dir(directory).unwrap().count();
        let name = format!("{gas}-{number}");
        let out = program::run_text(directory, &name, &text, &["--gas", gas]);
        let files = read::collection(&out, "gas.pvd").unwrap();
        let arrays = read::arrays(&files.last().unwrap().1).unwrap();
        arrays[field].values.clone()
    }

    /// Asserts what is left in the first cells, within a share of it.
    fn assert(&self, expected: &[f64], within: f64) {
        let directory = tempfile::tempdir().unwrap();
        for gas in ["native", "openfoam"] {
            let left = self.found("A", gas, directory.path());
            for (cell, (found, expected)) in left.iter().zip(expected).enumerate() {
                assert!(
                    (found / expected - 1.0).abs() < within,
                    "{gas}, {}, cell {cell}: {found:e}, expected {expected:e}",
                    self.time
                );
            }
        }
    }
}

#[test]
fn a_closed_cell_is_a_closed_reactor_in_windows_of_any_length() {
    for window in ["0.1 ms", "1 ms", "10 ms", "50 ms"] {
        let decay = Decay {
            equation: "A => B",
            rate: "factor = 10".into(),
            initial: FULL,
            time: format!("motion_window = \"{window}\"\nend = \"100 ms\""),
            cells: 1,
            ends: [WALL, WALL],
            transport: STILL,
        };
        decay.assert(&[(-1.0_f64).exp()], 1e-5);
    }
}

#[test]
fn a_cell_that_gas_only_leaves_keeps_its_share() {
    for window in ["1 ms", "100 ms"] {
        let decay = Decay {
            equation: "A => 2 D",
            rate: "factor = 1".into(),
            initial: FULL,
            time: format!("motion_window = \"{window}\"\nend = \"1 s\""),
            cells: 1,
            ends: [WALL, OUTLET],
            transport: STILL,
        };
        decay.assert(&[(-1.0_f64).exp()], 1e-5);
    }
}

#[test]
fn gas_that_decays_at_once_leaves_next_to_nothing_in_any_window() {
    for (rate, step, end) in [(1e5, 1000.0, 1e4), (1e6, 10.6, 53.0), (1e12, 10.0, 50.0)] {
        let decay = Decay {
            equation: "A => B",
            rate: format!("factor = {rate:e}"),
            initial: FULL,
            time: format!("process_step = \"{step} s\"\nend = \"{end} s\""),
            cells: 4,
            ends: [INLET, OUTLET],
            transport: STILL,
        };
        // 0.1 s pass a cell.
        let cell = 1.0 / (1.0 + 0.1 * rate);
        decay.assert(&[cell], 1e-2);
    }
}

/// Gas of 600 K with a seventh of A that becomes C, into a cell of cold, dense gas whose reactor ignites at half as fast a reaction again: it
/// warms up and stays unburnt, in windows of a hundredth to ten thousand residence times. A cell that kept the mass of its
/// cold gas would ignite.
#[test]
fn a_cell_of_cold_gas_does_not_ignite_where_its_reactor_does_not() {
    // ΔT of all of A is 0.15 · 30000 K/3.5; 0.1 s pass the cell at 600 K; 100 kJ/mol.
    let (inlet, rise, residence, energy) = (600.0, 0.15 * 3.0e4 / 3.5, 0.1, 1e5 / 8.314_462_6);
    // The rate constant's factor at which a part of A reacts in the steady state: X/(1 − X) = k τ T_in/T.
    let factor = |part: f64| {
        let temperature = inlet + rise * part;
        part / (1.0 - part) * temperature / inlet / residence * (energy / temperature).exp()
    };
    // Up to its first maximum the factor rises with the part.
    let step = 1e-5;
    let mut limit = step;
    while factor(limit + step) > factor(limit) {
        limit += step;
    }
    let chosen = factor(limit) / 1.5;
    let (mut low, mut high) = (0.0, limit);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if factor(middle) < chosen {
            low = middle;
        } else {
            high = middle;
        }
    }
    let expected = inlet + rise * low;
    for [step, end] in [["1 ms", "3 s"], ["10 s", "40 s"], ["1000 s", "4000 s"]] {
        let cell = Decay {
            equation: "A => C",
            rate: format!("factor = {chosen:e}, activation_energy = \"100 kJ/mol\""),
            initial: "temperature = \"300 K\", composition = { mass = { X = 1 } }",
            time: match step {
                "1 ms" => format!("motion_window = \"{step}\"\nend = \"{end}\""),
                _ => format!("process_step = \"{step}\"\nend = \"{end}\""),
            },
            cells: 1,
            ends: [
                "inlet = { superficial_velocity = \"0.1 m/s\", temperature = \"600 K\", composition = { mass = { A = 0.15, X = 0.85 } } }",
                OUTLET,
            ],
            transport: STILL,
        };
        let directory = tempfile::tempdir().unwrap();
        for gas in ["native", "openfoam"] {
            let found = cell.found("temperature", gas, directory.path());
            assert!(
                (found[0] - expected).abs() < 0.05,
                "{gas}, {step}: {}, expected {expected}",
                found[0]
            );
        }
    }
}

/// Uniform gas that heats itself in a closed box of cells between which it diffuses: no worse than implicit Euler in any window.
#[test]
fn a_closed_box_of_cells_reacts_as_fast_as_one_cell() {
    for windows in [1, 8] {
        let box_of_cells = Decay {
            equation: "A => C",
            rate: "factor = 0.05".into(),
            initial: "temperature = \"300 K\", composition = { mass = { A = 0.05, X = 0.95 } }",
            time: format!(
                "process_step = \"{} s\"\nend = \"20 s\"",
                20.0 / f64::from(windows)
            ),
            cells: 5,
            ends: [WALL, WALL],
            transport: "schmidt = 0.7",
        };
        let (exact, implicit) = (
            (-1.0_f64).exp(),
            (1.0 + 1.0 / f64::from(windows)).powi(-windows),
        );
        let directory = tempfile::tempdir().unwrap();
        for gas in ["native", "openfoam"] {
            for left in box_of_cells.found("A", gas, directory.path()) {
                let left = left / 0.05;
                assert!(
                    left > exact - 1e-4 && left < implicit + 1e-4,
                    "{gas}, {windows} windows: {left}, exact {exact}, implicit Euler {implicit}"
                );
            }
        }
    }
}

/// Gas that decays in a steady flow, with van Leer's limiter for all species, one of which is uniform: every window leaves it as it was.
#[test]
fn a_steady_decay_stays_with_second_order_convection() {
    let chain = |end: &str| Decay {
        equation: "A => B",
        rate: "factor = 0.5".into(),
        initial: "velocity = \"0 0 0.1 m/s\", temperature = \"500 K\", composition = { mass = { A = 0.5, X = 0.5 } }",
        time: format!("motion_window = \"0.1 s\"\nend = \"{end}\""),
        cells: 25,
        ends: [
            "inlet = { superficial_velocity = \"0.1 m/s\", temperature = \"500 K\", composition = { mass = { A = 0.5, X = 0.5 } } }",
            OUTLET,
        ],
        transport: "schmidt = 1e6\ncontrols = { convection = \"van-leer\" }",
    };
    let directory = tempfile::tempdir().unwrap();
    let [native, openfoam] = ["native", "openfoam"].map(|gas| {
        let [one, other] =
            ["10 s", "11.3 s"].map(|end| chain(end).found("A", gas, directory.path()));
        for (one, other) in one.iter().zip(&other) {
            assert!((one - other).abs() < 1e-6, "{gas}: {one}, then {other}");
        }
        one
    });
    for (one, other) in native.iter().zip(&openfoam) {
        assert!((one - other).abs() < 1e-4, "{one}, {other}");
    }
    // 0.25 m at 0.1 m/s.
    let left = native.last().unwrap() / 0.5;
    assert!((left / (-1.25_f64).exp() - 1.0).abs() < 0.02, "{left}");
}

/// Gas of an element that is not there comes into a cell: it is mixed in, with its enthalpy of formation, and nothing reacts.
#[test]
fn gas_of_a_new_element_is_mixed_in() {
    let text = r#"
format = 1
title = "Carbon dioxide into nitrogen"
[time]
process_step = "0.1 s"
end = "0.3 s"
[mesh]
box = { size = "10 10 30 mm", cells = [1, 1, 3] }
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "flue gas"
species = ["CO", "CO2", "O2", "N2"]
schmidt = 0.7
initial = { temperature = "900 K", pressure = "1 bar", composition = { mole = { N2 = 1 } } }
[gas.chemistry]
reactions = [{ name = "burn", equation = "CO + 0.5 O2 => CO2", rate = { factor = 500, activation_energy = "100 kJ/mol", orders = { CO = 1, O2 = 0.5 } } }]
[gas.patch.bottom]
inlet = { superficial_velocity = "0.1 m/s", temperature = "900 K", composition = { mole = { CO2 = 0.5, N2 = 0.5 } } }
[gas.patch.top]
outlet = { pressure = "1 bar" }
[gas.patch.side]
symmetry = {}
[[particles]]
name = "speck"
material = "glass"
diameter = "1 um"
motion = "frozen"
place = { grid = { first = "5 5 3 mm", spacing = "1 1 1 mm", counts = [1, 1, 1] } }
temperature = "900 K"
[laws]
drag = { law = "none" }
heat_transfer = { law = "none" }
conduction = { law = "none" }
radiation = { law = "none" }
[coupling]
mapping = "overlap"
[output]
every = "1 s"
gas = ["temperature", "mass_fractions"]
"#;
    let inert = text
        .replace("[gas.chemistry]\n", "")
        .lines()
        .filter(|line| !line.starts_with("reactions"))
        .collect::<Vec<_>>()
        .join("\n");
    let directory = tempfile::tempdir().unwrap();
    for gas in ["native", "openfoam"] {
        let found = |name: &str, text: &str| {
            let out = program::run_text(
                directory.path(),
                &format!("{gas}-{name}"),
                text,
                &["--gas", gas, "--set", "gas.controls.outer_tolerance=1e-8"],
            );
            let files = read::collection(&out, "gas.pvd").unwrap();
            read::arrays(&files.last().unwrap().1).unwrap()
        };
        let (reacting, inert) = (found("reacting", text), found("inert", &inert));
        for (field, within) in [("temperature", 1e-3), ("CO2", 1e-6)] {
            let pairs = reacting[field].values.iter().zip(&inert[field].values);
            for (one, other) in pairs {
                assert!(
                    (one - other).abs() < within,
                    "{gas}, {field}: {one}, {other}"
                );
            }
        }
        assert!(reacting["CO2"].values[0] > 0.3);
    }
}
