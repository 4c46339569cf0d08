//! Measures of what passes patches and outlets, and of conversion, against what the snapshots say.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::{Series, arrays, collection};

use crate::support::program;

const GASES: [&str; 2] = ["native", "openfoam"];

fn value(out: &Path, name: &str) -> f64 {
    Summary::read(out).unwrap().quantities[name].value.unwrap()
}

/// Fails where a value is off by more than a share of the other.
fn close(what: &str, found: f64, expected: f64, share: f64) {
    let off = (found - expected).abs() / expected.abs();
    assert!(
        off < share,
        "{what}: {found} for {expected}, off by {off:e}"
    );
}

fn field(out: &Path, file: &str, name: &str) -> Vec<f64> {
    let files = collection(out, file).unwrap();
    arrays(&files.last().unwrap().1).unwrap()[name]
        .values
        .clone()
}

/// A fluid of constant properties between a floor that gives heat and a lid of a temperature that slides along x, periodic along x.
const SHEARED: &str = r#"
format = 1
title = "A lid slides over a heated fluid"
[time]
end = "50 ms"
motion_window = "10 ms"
[mesh]
box = { size = "10 10 10 mm", cells = [2, 2, 8], patches = ["left", "right", "front", "back", "floor", "lid"] }
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[gas]
mixture = "oil"
constant = { density = "900 kg/m^3", heat_capacity = "2 kJ/kg/K", viscosity = "0.1 Pa s", conductivity = "0.15 W/m/K" }
initial = { temperature = "300 K", pressure = "1 atm" }
gravity = "0 0 -9.81 m/s^2"
controls = { convection = "upwind", outer_tolerance = 1e-12, outer_iterations = 100 }
[gas.patch.left]
periodic = { with = "right" }
[gas.patch.right]
periodic = { with = "left" }
[gas.patch.front]
symmetry = {}
[gas.patch.back]
symmetry = {}
[gas.patch.floor]
wall = { velocity = "no-slip", heat = { flux = "100 W/m^2" } }
[gas.patch.lid]
wall = { velocity = { moving = "10 0 0 mm/s" }, heat = { temperature = "320 K" } }
[[particles]]
name = "bead"
material = "glass"
diameter = "0.1 mm"
motion = "frozen"
place = { grid = { first = "2 2 5.6 mm", spacing = "2 2 2 mm", counts = [1, 1, 1] } }
temperature = "300 K"
[laws]
drag = { law = "none" }
heat_transfer = { law = "none" }
conduction = { law = "none" }
radiation = { law = "none" }
[coupling]
mapping = "overlap"
smoother = { max_solid_fraction = 0.64 }
[output]
every = "10 ms"
gas = ["temperature", "velocity", "pressure"]
[[quantities]]
name = "floor_heat"
measure = { flow = "heat", patch = "floor" }
[[quantities]]
name = "lid_heat"
measure = { flow = "heat", patch = "lid" }
[[quantities]]
name = "lid_friction"
measure = { force = "viscous", patch = "lid", along = "1 0 0" }
[[quantities]]
name = "floor_friction"
measure = { force = "viscous", patch = "floor", along = "2 0 0" }
[[quantities]]
name = "floor_pressure"
measure = { force = "pressure", patch = "floor", along = "0 0 -1" }
[[quantities]]
name = "lid_pressure"
measure = { force = "pressure", patch = "lid", along = "0 0 1" }
[[quantities]]
name = "lid_total"
measure = { force = "total", patch = "lid", along = "1 0 1" }
"#;

#[test]
fn heat_and_forces_on_walls_are_those_of_the_fields_of_the_snapshot() {
    let folder = tempfile::tempdir().unwrap();
    for gas in GASES {
        let out = program::run_text(folder.path(), gas, SHEARED, &["--gas", gas]);
        let found = |name: &str| value(&out, name);
        let list = |name: &str| field(&out, "gas.pvd", name);
        let (kelvin, speed, pressure) = (list("temperature"), list("velocity"), list("pressure"));
        // Cells run along x, y, z; faces of 25 mm², half a cell 0.625 mm.
        let (face, half) = (25e-6, 0.625e-3);
        let layer = |k: usize| 4 * k..4 * (k + 1);
        close("floor heat", found("floor_heat"), 100.0 * 1e-4, 1e-10);
        let conducted = layer(7).map(|cell| 0.15 * face / half * (320.0 - kelvin[cell]));
        close("lid heat", found("lid_heat"), conducted.sum(), 1e-10);
        let drag = |k: usize, wall: f64| {
            let of = layer(k).map(|cell| 0.1 * face / half * (speed[3 * cell] - wall));
            of.sum::<f64>()
        };
        close("lid", found("lid_friction"), drag(7, 0.01), 1e-10);
        close("floor", found("floor_friction"), drag(0, 0.0), 1e-10);
        // Pressures at the walls by those of the two layers beside, which gravity makes linear.
        let at_wall = |near: usize, next: usize| {
            let pairs = layer(near).zip(layer(next));
            let faces = pairs.map(|(a, b)| 1.5 * pressure[a] - 0.5 * pressure[b] - 101_325.0);
            face * faces.sum::<f64>()
        };
        let size = pressure[0].abs() * 1e-4;
        for (name, expected) in [
            ("floor_pressure", at_wall(0, 1)),
            ("lid_pressure", at_wall(7, 6)),
        ] {
            let off = (found(name) - expected).abs() / size;
            assert!(off < 1e-10, "{gas} {name}: {} for {expected}", found(name));
        }
        // The weight of the fluid, as no wall beside carries any of it.
        let weight = found("floor_pressure") - found("lid_pressure");
        let off = (weight - 900.0 * 9.81 * 1e-6).abs() / size;
        assert!(off < 1e-10, "{gas}: {weight} N");
        let total = (found("lid_friction") + found("lid_pressure")) / 2f64.sqrt();
        assert!((found("lid_total") - total).abs() < 1e-12 * size);
    }
}

/// Heat that flows with a fluid of constant properties through a column of one cell across.
const THROUGH: &str = r#"
[[quantities]]
name = "mass_in"
measure = { flow = "mass", patch = "bottom" }
[[quantities]]
name = "heat_in"
measure = { flow = "heat", patch = "bottom" }
[[quantities]]
name = "mass_out"
measure = { flow = "mass", patch = "top" }
[[quantities]]
name = "heat_out"
measure = { flow = "heat", patch = "top" }
[[quantities]]
name = "side"
measure = { flow = "heat", patch = "side" }
"#;

#[test]
fn heat_and_mass_through_open_patches_are_those_of_the_inlet_and_of_the_last_cell() {
    let folder = tempfile::tempdir().unwrap();
    let case = fs::read_to_string(program::shipped("heated-column")).unwrap();
    let case = case.split("[[quantities]]").next().unwrap().to_owned() + THROUGH;
    let fluid = "mixture = \"fluid\"\nconstant = { density = \"1.2 kg/m^3\", heat_capacity = \"1 kJ/kg/K\", viscosity = \"1.8e-5 Pa s\", conductivity = \"0.026 W/m/K\" }";
    let case = case.replace("mixture = \"air\"", fluid);
    let file = folder.path().join("column.toml");
    fs::write(&file, case).unwrap();
    for gas in GASES {
        let out = folder.path().join(gas);
        // What passes the outlet is what continuity makes of the inlet, to these tolerances.
        let set = [
            "time.end=2 s",
            "output.every=1 s",
            "gas.controls.outer_tolerance=1e-12",
            "gas.controls.outer_iterations=100",
            "gas.controls.linear_tolerance=1e-14",
        ];
        program::run(&file, &out, &["--gas", gas], &set);
        let found = |name: &str| value(&out, name);
        let last = *field(&out, "gas.pvd", "temperature").last().unwrap();
        let inlet = 1.2 * 0.5 * 1e-4;
        close("mass in", found("mass_in"), inlet, 1e-10);
        close("mass out", found("mass_out"), -inlet, 1e-10);
        close(
            "heat in",
            found("heat_in"),
            inlet * 1000.0 * (400.0 - 298.15),
            1e-10,
        );
        close(
            "heat out",
            found("heat_out"),
            -inlet * 1000.0 * (last - 298.15),
            1e-10,
        );
        assert_eq!(found("side"), 0.0);
    }
}

/// A bed of ore, one cell across, with what it takes of the gas and how far it is.
const REDUCED: &str = r#"
[[quantities]]
name = "mass_in"
measure = { flow = "mass", patch = "bottom" }
[[quantities]]
name = "co_in"
measure = { flow = "species", of = "CO", patch = "bottom" }
[[quantities]]
name = "mass_out"
measure = { flow = "mass", patch = "top" }
[[quantities]]
name = "co2_out"
measure = { flow = "species", of = "CO2", patch = "top" }
[[quantities]]
name = "reduced"
measure = { particles = "conversion", of = "Fe2O3", statistic = "mean", population = "pellets" }
[[quantities]]
name = "low"
measure = { particles = "conversion", of = "Fe2O3", statistic = "max", zone = { box = { from = "0 0 0 mm", to = "60 60 60 mm" } } }
[[quantities]]
name = "first"
measure = { particle = "conversion", of = "Fe2O3", number = 1 }
"#;

#[test]
fn flows_of_species_and_conversions_are_those_of_gas_and_solids_of_the_snapshots() {
    let folder = tempfile::tempdir().unwrap();
    let case = fs::read_to_string(program::shipped("ore-reduction")).unwrap();
    let case = case.split("[[quantities]]").next().unwrap().to_owned() + REDUCED;
    let file = folder.path().join("ore.toml");
    fs::write(&file, case).unwrap();
    for gas in GASES {
        let out = folder.path().join(gas);
        let set = [
            "time.end=200 s",
            "mesh.box.cells=[1, 1, 11]",
            "gas.patch.bottom.inlet.composition={ mass = { CO = 0.5, H2 = 0.1, N2 = 0.4 } }",
            "output.every=100 s",
            "output.gas=[\"mass_fractions\"]",
            "output.particles=[\"solids\", \"mass\"]",
        ];
        program::run(&file, &out, &["--gas", gas], &set);
        let found = |name: &str| value(&out, name);
        close("CO in", found("co_in"), 0.5 * found("mass_in"), 1e-10);
        let last = *field(&out, "gas.pvd", "CO2").last().unwrap();
        close("CO2 out", found("co2_out"), last * found("mass_out"), 1e-10);
        let files = collection(&out, "particles.pvd").unwrap();
        let held: Vec<Vec<f64>> = [files.first(), files.last()]
            .map(|file| {
                let arrays = arrays(&file.unwrap().1).unwrap();
                let pairs = arrays["Fe2O3"].values.iter().zip(&arrays["mass"].values);
                pairs
                    .map(|(share, mass)| share * mass)
                    .collect::<Vec<f64>>()
            })
            .into();
        let sum = |list: &[f64]| list.iter().sum::<f64>();
        let reduced = 1.0 - sum(&held[1]) / sum(&held[0]);
        assert!(reduced > 1e-3, "{reduced}");
        close("reduced", found("reduced"), reduced, 1e-10);
        // Nothing has reacted at the start, to the last bit.
        let series = Series::read(&out).unwrap();
        assert_eq!(series.column("quantities.reduced")[0], 0.0);
        close(
            "first",
            found("first"),
            1.0 - held[1][0] / held[0][0],
            1e-10,
        );
        let places = field(&out, "particles.pvd", "points");
        let low = (0..held[0].len()).filter(|row| places[3 * row + 2] <= 0.06);
        let low = low.map(|row| 1.0 - held[1][row] / held[0][row]);
        close("low", found("low"), low.fold(0.0, f64::max), 1e-10);
    }
}

/// What leaves below, and what of a feed leaves soon after it came.
const SPILLED: &str = r#"
[[outlets]]
name = "spill"
region = { box = { from = "0 0 171 mm", to = "40 40 200 mm" } }
mass_rate = "6 g/s"
[[quantities]]
name = "below"
measure = { discharge = "mass_flow", outlet = "discharge", over = "5 s" }
[[quantities]]
name = "part"
measure = { discharge = "mass_flow", outlet = "discharge", over = "0.7 s" }
[[quantities]]
name = "within"
measure = { discharge = "count", outlet = "discharge", over = "0.1 s" }
[[quantities]]
name = "all"
measure = { discharge = "mass" }
[[quantities]]
name = "spilled"
measure = { discharge = "count", outlet = "spill" }
[[quantities]]
name = "flow"
measure = { discharge = "mass_flow" }
[[quantities]]
name = "stay"
measure = { discharge = "residence_time", outlet = "spill", over = "4 s" }
"#;

/// When a particle left, through the upper outlet or not, its mass, and for how long it had been there, if known.
struct Gone {
    time: f64,
    above: bool,
    mass: f64,
    stay: Option<f64>,
}

/// By which particles are there in one snapshot and not in the next.
fn gone(out: &Path) -> Vec<Gone> {
    let files = collection(out, "particles.pvd").unwrap();
    let mut came: BTreeMap<u64, f64> = BTreeMap::new();
    let mut found = Vec::new();
    let mut before: BTreeMap<u64, (f64, f64)> = BTreeMap::new();
    let mut start = 0.0;
    for (number, (time, path)) in files.iter().enumerate() {
        let arrays = arrays(path).unwrap();
        let list = |name: &str| &arrays[name].values;
        let (id, place, mass) = (list("id"), list("points"), list("mass"));
        let rows = id.iter().enumerate();
        let now: BTreeMap<u64, (f64, f64)> = rows
            .map(|(row, id)| (*id as u64, (place[3 * row + 2], mass[row])))
            .collect();
        for id in now
            .keys()
            .filter(|id| number > 0 && !before.contains_key(id))
        {
            came.insert(*id, start);
        }
        for (id, (height, mass)) in before.iter().filter(|(id, _)| !now.contains_key(id)) {
            found.push(Gone {
                time: *time,
                above: *height > 0.1,
                mass: *mass,
                stay: came.get(id).map(|came| start - came),
            });
        }
        (before, start) = (now, *time);
    }
    found
}

#[test]
fn what_outlets_take_is_what_is_missing_in_the_snapshots() {
    let folder = tempfile::tempdir().unwrap();
    let case = fs::read_to_string(program::shipped("moving-bed")).unwrap();
    let case = case.split("[[quantities]]").next().unwrap().to_owned() + SPILLED;
    let file = folder.path().join("bed.toml");
    fs::write(&file, case).unwrap();
    for particles in ["native", "liggghts"] {
        let out = folder.path().join(particles);
        let set = [
            "time.end=10 s",
            "feeds.charge.mass_rate=10 g/s",
            "outlets.discharge.mass_rate=10 g/s",
            "output.every=0.5 s",
            "output.series_every=0.5 s",
            "output.particles=[\"mass\"]",
        ];
        program::run(&file, &out, &["--particles", particles], &set);
        let found = |name: &str| value(&out, name);
        let gone = gone(&out);
        let mass = |which: &dyn Fn(&Gone) -> bool| {
            let of = gone.iter().filter(|one| which(one));
            of.map(|one| one.mass).sum::<f64>()
        };
        close(
            "below",
            found("below"),
            mass(&|one| !one.above && one.time > 5.01) / 5.0,
            1e-10,
        );
        // Windows of 0.5 s: of the oldest one counts the part that lies in the time.
        let last = |one: &Gone| !one.above && one.time > 9.6;
        let oldest = |one: &Gone| !one.above && (9.1..9.6).contains(&one.time);
        let part = (mass(&last) + 0.4 * mass(&oldest)) / 0.7;
        close("part", found("part"), part, 1e-10);
        let count = gone.iter().filter(|one| last(one)).count();
        close("within", found("within"), count as f64 / 5.0, 1e-10);
        close("all", found("all"), mass(&|_| true), 1e-10);
        close("flow", found("flow"), mass(&|_| true) / 10.0, 1e-10);
        let spilled = gone.iter().filter(|one| one.above).count();
        assert!(spilled > 5, "{spilled}");
        close("spilled", found("spilled"), spilled as f64, 1e-10);
        let late = gone.iter().filter(|one| one.above && one.time > 6.01);
        let known = late.filter_map(|one| Some((one.mass, one.mass * one.stay?)));
        let [mass, age] = known.fold([0.0; 2], |sum, (mass, age)| [sum[0] + mass, sum[1] + age]);
        assert!(age > 0.0);
        close("stay", found("stay"), age / mass, 1e-10);
        // The series has the same at its end, and nothing before anything left.
        let series = Series::read(&out).unwrap();
        let column = series.column("quantities.spilled");
        assert_eq!(column.first(), Some(&0.0));
        assert_eq!(column.last(), Some(&(spilled as f64)));
    }
}
