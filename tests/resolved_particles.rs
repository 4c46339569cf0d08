//! Particles resolved along their radius, through the program: balances, pairings, shells, interrupts.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::{killed, program};

/// A shipped case that is run, its ledger closed.
fn closed(case: &str, out: &Path, words: &[&str], set: &[&str]) -> Summary {
    program::run(&program::shipped(case), out, words, set);
    let summary = Summary::read(out).unwrap();
    for name in ["mass", "energy", "energy_exchange", "particle_mass"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-12, "{name}: {error}");
    }
    for (element, line) in &summary.ledger.elements {
        let error = line.relative_error;
        assert!(error < 1e-12, "{element}: {error}");
    }
    summary
}

/// The lime of the stone at the end.
fn lime(out: &Path, words: &[&str], set: &[&str]) -> f64 {
    closed("calcining-stone", out, words, set);
    let series = Series::read(out).unwrap();
    *series.column("quantities.lime").last().unwrap()
}

#[test]
fn a_stone_burns_alike_in_every_pairing_and_its_ledger_closes() {
    let folder = tempfile::tempdir().unwrap();
    let native = lime(&folder.path().join("native"), &[], &[]);
    assert!((0.8..0.95).contains(&native), "{native}");
    for (gas, particles) in [
        ("native", "liggghts"),
        ("openfoam", "native"),
        ("openfoam", "liggghts"),
    ] {
        let out = folder.path().join(format!("{gas}-{particles}"));
        let words = ["--gas", gas, "--particles", particles];
        let other = lime(&out, &words, &[]);
        // Both gases are solved to 1e-8.
        assert!((other - native).abs() < 1e-6, "{gas} {particles}: {other}");
    }
}

#[test]
fn lime_converges_with_the_number_of_shells_and_auto_becomes_all_shells() {
    let folder = tempfile::tempdir().unwrap();
    let at = |shells: u32| {
        let key = format!("materials.limestone.radial.shells={shells}");
        lime(&folder.path().join(key.clone()), &[], &[&key])
    };
    let [coarse, middle, fine] = [15, 30, 60].map(at);
    println!("{coarse} {middle} {fine}");
    let ratio = (fine - middle) / (middle - coarse);
    // A sharp front: at least first order.
    assert!((0.0..0.8).contains(&ratio), "{coarse} {middle} {fine}");
    let auto = lime(
        &folder.path().join("auto"),
        &[],
        &["materials.limestone.inside=auto"],
    );
    // The stone has its shells from a difference of 5 K on, in its first window, which is computed with them.
    assert!((auto / middle - 1.0).abs() < 1e-9, "{auto} {middle}");
}

#[test]
fn a_run_killed_while_a_stone_burns_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case: PathBuf = program::shipped("calcining-stone");
    let settings = [
        "time.process_step=1 s",
        "output.series_every=1 s",
        "time.checkpoint.every=50 s",
    ];
    killed::resumes_to_the_same_bits(folder.path(), &[200, 700], |out| {
        program::command(&case, out, &[], &settings)
    });
}

/// A porous ball with carbon in air that has a hundredth of oxygen: far leaner than the share of the pressure by which `auto` turns.
const LEAN: &str = r#"format = 1
title = "Carbon in a porous ball burns in lean oxygen"
[time]
end = "400 s"
process_step = "20 s"
[mesh]
box = { size = "20 20 20 mm", cells = [1, 1, 1] }
[materials.ball]
density = "1500 kg/m^3"
composition = { mass = { C = 0.2, Al2O3 = 0.8 } }
conductivity = "1 W/m/K"
inside = "auto"
[materials.ball.radial]
shells = 20
grading = 4
true_densities = { C = "2200 kg/m^3", Al2O3 = "3970 kg/m^3" }
pore_diameter = "1 um"
tortuosity = 3
permeability = { law = "constant", value = "1e-16 m^2" }
[gas]
mixture = "lean air"
species = ["O2", "CO2", "N2"]
schmidt = 0.7
controls = { convection = "upwind" }
initial = { temperature = "1100 K", pressure = "1 atm", velocity = "0 0 1 m/s", composition = { mole = { O2 = 0.01, N2 = 0.99 } } }
[gas.patch.bottom]
inlet = { superficial_velocity = "1 m/s", temperature = "1100 K", composition = { mole = { O2 = 0.01, N2 = 0.99 } } }
[gas.patch.top]
outlet = { pressure = "1 atm" }
[gas.patch.side]
symmetry = {}
[[particles]]
name = "ball"
material = "ball"
diameter = "10 mm"
motion = "frozen"
place = { grid = { first = "10 10 10 mm", spacing = "1 1 1 mm", counts = [1, 1, 1] } }
temperature = "1100 K"
[[reactions]]
name = "burn"
equation = "C + O2 => CO2"
law = "first-order"
rate = { factor = 1000, orders = { O2 = 1 } }
[laws]
drag = { law = "none" }
heat_transfer = { law = "ranz-marshall" }
mass_transfer = { law = "ranz-marshall" }
conduction = { law = "none" }
radiation = { law = "none" }
[coupling]
mapping = "centroid"
[output]
every = "400 s"
[[quantities]]
name = "mass"
measure = { particles = "mass", statistic = "mean" }
[[quantities]]
name = "shells"
measure = { particles = "shell_count", statistic = "mean" }
[[quantities]]
name = "centre"
measure = { particles = "centre_temperature", statistic = "mean" }
"#;

#[test]
fn a_ball_in_lean_oxygen_takes_its_shells_where_the_oxygen_runs_out_inside() {
    let folder = tempfile::tempdir().unwrap();
    let burnt = |inside: &str| {
        let text = LEAN.replace("\"auto\"", &format!("\"{inside}\""));
        let out = program::run_text(folder.path(), inside, &text, &[]);
        let mass = Summary::read(&out).unwrap().quantities["mass"].value;
        std::f64::consts::PI / 6.0 * 1e-6 * 1500.0 - mass.unwrap()
    };
    let [all, auto] = ["radial", "auto"].map(burnt);
    println!("{all} {auto}");
    assert!(
        all > 1e-6 && (auto / all - 1.0).abs() < 1e-3,
        "{auto} for {all}"
    );
}

#[test]
fn runs_with_and_without_shells_are_compared_by_what_both_have() {
    let folder = tempfile::tempdir().unwrap();
    let text = LEAN.replace(
        "every = \"400 s\"",
        "every = \"200 s\"\nparticles = [\"temperature\", \"inside\"]",
    );
    // So slow that oxygen is nearly the same throughout.
    let text = text.replace("factor = 1000", "factor = 1e-5");
    let thin = [
        &text[..text.find("inside").unwrap()],
        &text[text.find("[gas]").unwrap()..],
    ]
    .concat();
    let thin = thin
        .replace("first-order", "power-law")
        .replace("{ O2 = 1 }", "{ C = 1, O2 = 1 }");
    // The second one does not turn, the third one is thin.
    let late = "shells = 20\nturn_temperature = \"500 K\"";
    let texts = [
        text.replace("\"auto\"", "\"radial\""),
        text.replace("shells = 20", late),
        thin,
    ];
    let runs: Vec<(String, PathBuf)> = ["all", "one", "thin"]
        .into_iter()
        .zip(&texts)
        .map(|(name, text)| {
            let out = program::run_text(folder.path(), name, text, &[]);
            (name.to_owned(), out)
        })
        .collect();
    let quantity = |run: usize, name: &str| {
        let summary = Summary::read(&runs[run].1).unwrap();
        summary.quantities[name].value.unwrap()
    };
    assert_eq!(
        [0, 1, 2].map(|run| quantity(run, "shells")),
        [20.0, 1.0, 1.0]
    );
    for run in 0..3 {
        let centre = quantity(run, "centre");
        assert!((1100.0..1300.0).contains(&centre), "{run}: {centre}");
    }
    // As runs of one case are, in which particles turn in one pairing and not in another.
    let case = calcine::case::parse(Path::new("lean.toml"), &texts[0], &[]).unwrap();
    for (_, out) in &runs {
        let path = out.join("summary.json");
        let own = Summary::read(out).unwrap().case.hash;
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace(&own, &case.hash)).unwrap();
    }
    let fields = |runs: &[(String, PathBuf)]| {
        let fields = calcine::compare::compare(&case, runs).unwrap().fields;
        let largest = |one: &calcine::compare::FieldDifference| one.worst().unwrap().maximum;
        let all = fields.iter().map(|one| (one.name.clone(), largest(one)));
        all.collect::<std::collections::BTreeMap<String, f64>>()
    };
    let both = fields(&runs[..2]);
    assert_eq!(both["particles.shell_count"], 19.0);
    assert!(both["particles.mean_temperature"] < 20.0, "{both:?}");
    assert!(
        !both.contains_key("particles.shell_temperature"),
        "{both:?}"
    );
    let all = fields(&runs);
    assert!(all.contains_key("particles.temperature"), "{all:?}");
    assert!(!all.contains_key("particles.mean_temperature"), "{all:?}");
}

/// Two balls in hot surroundings that touch and see each other, of a material with or without shells; the gas carries nothing to speak of.
const RADIANT: &str = r#"format = 1
title = "Balls in hot surroundings"
[time]
end = "100 s"
process_step = "100 s"
checkpoint = { every = "20 s" }
[mesh]
box = { size = "40 20 20 mm", cells = [2, 1, 1] }
[materials.ball]
density = "2500 kg/m^3"
heat_capacity = "900 J/kg/K"
conductivity = "INSIDE W/m/K"
emissivity = 0.9
young = "10 MPa"
poisson = 0.3
inside = "radial"
[materials.ball.radial]
shells = 12
temperature_error = "0.2 K"
[[contacts]]
between = ["ball", "ball"]
restitution = 0.5
friction = 0.3
[gas]
mixture = "air"
initial = { temperature = "300 K", pressure = "1 atm" }
[gas.patch.bottom]
wall = { velocity = "no-slip", heat = "adiabatic" }
[gas.patch.top]
wall = { velocity = "no-slip", heat = "adiabatic" }
[gas.patch.side]
wall = { velocity = "no-slip", heat = "adiabatic" }
[[particles]]
name = "balls"
material = "ball"
diameter = "10 mm"
motion = "frozen"
place = { grid = { first = "10 10 10 mm", spacing = "9.95 1 1 mm", counts = [2, 1, 1] } }
temperature = "300 K"
[laws]
drag = { law = "none" }
heat_transfer = { law = "none" }
conduction = { law = "batchelor-obrien" }
radiation = { law = "view-factors", surroundings = "1400 K" }
[coupling]
mapping = "centroid"
[output]
every = "100 s"
series_every = "1 s"
[[quantities]]
name = "kelvin"
measure = { particles = "temperature", statistic = "mean" }
"#;

/// Surface temperature at the end, of balls of a conductivity in W/m/K; the ledger closes.
fn radiant(folder: &Path, name: &str, conductivity: &str, set: &[String], words: &[&str]) -> f64 {
    let file = folder.join(format!("{name}.toml"));
    std::fs::write(&file, RADIANT.replace("INSIDE", conductivity)).unwrap();
    let out = folder.join(name);
    program::run(&file, &out, words, set);
    let summary = Summary::read(&out).unwrap();
    for name in ["energy", "energy_exchange"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-10, "{name}: {error}");
    }
    summary.quantities["kelvin"].value.unwrap()
}

fn steps(end: u32, step: u32) -> [String; 2] {
    [
        format!("time.end={end} s"),
        format!("time.process_step={step} s"),
    ]
}

#[test]
fn shells_that_radiate_and_touch_heat_alike_in_short_and_long_windows() {
    let folder = tempfile::tempdir().unwrap();
    // Largest errors in K of windows of 5, 10 and 20 s in the first 20 s, in which surfaces rise by 800 K, and of 10 and 100 s in 100 s.
    for (conductivity, begins, ends) in [
        ("1", [1.0, 3.0, 6.0], [1.0, 10.0]),
        ("50", [2.0, 6.0, 20.0], [1.0, 30.0]),
    ] {
        let at = |end: u32, step: u32| {
            let name = format!("{conductivity}-{end}-{step}");
            radiant(folder.path(), &name, conductivity, &steps(end, step), &[])
        };
        for (end, windows, most) in [
            (20, &[5, 10, 20][..], &begins[..]),
            (100, &[10, 100], &ends),
        ] {
            let fine = at(end, 1);
            for (step, most) in windows.iter().zip(most) {
                let found = at(end, *step);
                println!("{conductivity}, {end} s by {step} s: {found} {fine}");
                assert!((found - fine).abs() < *most, "{found} {fine}");
            }
        }
    }
}

#[test]
fn radiating_shells_have_the_same_bits_on_one_thread_and_after_they_resume() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str, words: &[&str]| radiant(folder.path(), name, "1", &steps(100, 10), words);
    let two = at("two", &["--threads", "2"]);
    let one = at("one", &["--threads", "1"]);
    assert_eq!(one.to_bits(), two.to_bits());
    let half = radiant(folder.path(), "half", "1", &steps(40, 10), &[]);
    assert!(half < one);
    let case = folder.path().join("whole.toml");
    std::fs::write(&case, RADIANT.replace("INSIDE", "1")).unwrap();
    killed::resumes_to_the_same_bits(folder.path(), &[50, 120], |out| {
        program::command(&case, out, &[], &steps(2000, 1))
    });
}

/// Mean mass fraction of hydrogen at the outlet of the shipped catalyst pellet.
fn hydrogen(out: &Path, words: &[&str], set: &[&str]) -> f64 {
    let summary = closed("catalyst-pellet", out, words, set);
    summary.quantities["outlet_h2"].value.unwrap()
}

#[test]
fn a_catalyst_turns_over_gas_and_stays_and_shells_by_its_thiele_number_resolve_its_layer() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str, set: &[&str]| hydrogen(&folder.path().join(name), &[], set);
    let none = at("none", &["reactions[0].rate.factor=1e-30"]);
    let [shipped, fine, coarse] = [
        at("shipped", &[]),
        at("fine", &["materials.catalyst.radial.shells=400"]),
        at("coarse", &["materials.catalyst.radial.grading=1"]),
    ]
    .map(|found| found - none);
    println!("{none} {shipped} {fine} {coarse}");
    assert!(fine > 1e-6, "{fine}");
    assert!((shipped / fine - 1.0).abs() < 2e-3, "{shipped} {fine}");
    assert!((coarse / fine - 1.0).abs() > 1e-2, "{coarse} {fine}");
    let words = ["--gas", "openfoam", "--particles", "liggghts"];
    let other = hydrogen(&folder.path().join("openfoam"), &words, &[]) - none;
    assert!((other / shipped - 1.0).abs() < 1e-4, "{other} {shipped}");
}

#[test]
fn a_catalyst_whose_pores_let_gas_pass_is_as_a_thin_one_and_one_without_it_does_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let case = std::fs::read_to_string(program::shipped("catalyst-pellet")).unwrap();
    let pores = case.find("[materials.catalyst.radial]").unwrap();
    let gas = case.find("[gas]").unwrap();
    let thin = (case[..pores].to_owned() + &case[gas..])
        .replace("inside = \"radial\"\n", "")
        .replace("\"mass\", \"inside\"", "\"mass\"");
    let bare = thin.replace("Al2O3 = 0.9, Fe3O4 = 0.1", "Al2O3 = 1");
    let open = case
        .replace("\"20 nm\"", "\"10 um\"")
        .replace("tortuosity = 4", "tortuosity = 1");
    let at = |name: &str, text: &str, factor: &str| {
        let file = folder.path().join(format!("{name}.toml"));
        std::fs::write(&file, text).unwrap();
        let out = folder.path().join(name);
        let factor = format!("reactions[0].rate.factor={factor}");
        program::run(&file, &out, &[], &[&factor]);
        let summary = Summary::read(&out).unwrap();
        assert!(summary.ledger.lines["energy"].relative_error < 1e-12);
        summary.quantities["outlet_h2"].value.unwrap()
    };
    let none = at("none", &thin, "1e-30");
    let [thin, open, bare] = [
        at("thin", &thin, "1.8e5"),
        at("open", &open, "1.8e5"),
        at("bare", &bare, "1.8e5"),
    ]
    .map(|found| found - none);
    println!("{thin} {open} {bare}");
    // Its Thiele number is 0.45, its effectiveness 0.987.
    assert!(
        thin > 1e-6 && (open / thin - 0.987).abs() < 0.02,
        "{open} {thin}"
    );
    assert!(bare.abs() < 1e-3 * thin, "{bare} {thin}");
}

#[test]
fn limestone_that_goes_one_way_burns_though_its_core_is_swept() {
    let folder = tempfile::tempdir().unwrap();
    let case = std::fs::read_to_string(program::shipped("calcining-stone")).unwrap();
    let file = folder.path().join("one-way.toml");
    std::fs::write(&file, case.replace("<=>", "=>")).unwrap();
    let out = folder.path().join("one-way");
    program::run(&file, &out, &[], &["time.end=10 min"]);
    let summary = Summary::read(&out).unwrap();
    let lime = summary.quantities["lime"].value.unwrap();
    assert!((0.3..0.8).contains(&lime), "{lime}");
}
