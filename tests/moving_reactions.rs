//! Particles that react while they move: fed, burnt, shrunk, drawn off, at an acceleration factor above one; the
//! ledger closes in every line, whoever moves them.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::Series;

use crate::support::program;

const CASE: &str = "tests/inputs/good/moving-reactions.toml";

fn run(out: &Path, settings: &[&str], options: &[&str]) -> Summary {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(CASE);
    program::run(&path, out, options, settings);
    Summary::read(out).unwrap()
}

/// Mass in kg of a stone as it is fed, of 2700 kg/m³, and its diameter in m.
const FRESH: f64 = 2700.0 * PI / 6.0 * WIDE * WIDE * WIDE;
const WIDE: f64 = 8e-3;

fn value(summary: &Summary, name: &str) -> f64 {
    summary.quantities[name].value.unwrap()
}

/// What stones have lost in the mean, in kg, and by how much they have shrunk, in m.
fn lost_mass(summary: &Summary) -> f64 {
    FRESH - value(summary, "mean_mass")
}

fn shrunk(summary: &Summary) -> f64 {
    WIDE - value(summary, "mean_diameter")
}

/// Asserts that two runs have reacted alike: within a share of what has reacted.
fn alike(one: &Summary, other: &Summary, most: f64) {
    let lime = |summary: &Summary| value(summary, "lime");
    for (name, of) in [
        ("lime", &lime as &dyn Fn(&Summary) -> f64),
        ("lost mass", &lost_mass),
        ("shrunk", &shrunk),
    ] {
        let (a, b) = (of(one), of(other));
        println!("{name}: {a:.5e} {b:.5e}");
        assert!((a / b - 1.0).abs() < most, "{name}: {a} {b}");
    }
}

/// Elements and energy close, and so does the momentum of particles whose mass changes.
fn closes(summary: &Summary) {
    for (name, line) in &summary.ledger.lines {
        println!(
            "{name}: {:.1e} of {:.3e}",
            line.relative_error, line.throughput
        );
    }
    for name in [
        "mass",
        "energy",
        "energy_exchange",
        "particle_mass",
        "particle_momentum",
    ] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-11, "{name}: {error}");
    }
    assert!(summary.ledger.elements.contains_key("Ca"));
    for (element, line) in &summary.ledger.elements {
        println!("{element}: {:.1e}", line.relative_error);
        assert!(
            line.relative_error < 1e-11,
            "{element}: {}",
            line.relative_error
        );
        assert!(line.throughput > 0.0, "{element}");
    }
}

#[test]
fn stones_that_move_react_and_shrink_close_the_ledger_with_feed_and_discharge() {
    let folder = tempfile::tempdir().unwrap();
    let summary = run(folder.path(), &[], &[]);
    closes(&summary);
    let (lime, mass) = (value(&summary, "lime"), value(&summary, "mean_mass"));
    let (mean, least) = (
        value(&summary, "mean_diameter"),
        value(&summary, "least_diameter"),
    );
    println!("lime {lime:.4}, {mass:.4e} kg, diameters {mean:.5} and {least:.5} m");
    assert!(lime > 0.05, "{lime}");
    assert!(
        lost_mass(&summary) > 0.03 * FRESH,
        "they lose carbon dioxide: {mass} of {FRESH} kg"
    );
    // Lime of 1900 kg/m³ takes 56.077/100.086 · 2700/1900 = 0.796 of the room.
    let smallest = 8e-3 * (0.03f64 + 0.97 * 0.7962).cbrt();
    assert!(
        least < 7.9e-3 && least > smallest - 1e-6,
        "{least} {smallest}"
    );
    assert!(mean < 8e-3 && mean > least);
    let series = Series::read(folder.path()).unwrap();
    assert!(series.column("quantities.lime").len() > 15);
}

/// The same stones with shells, of 10 % pores and by a rate in their volume.
const SHELLS: [&str; 6] = [
    "time.end=24 s",
    "materials.limestone.density=2440 kg/m^3",
    "materials.limestone.size={ law = \"densities\", densities = { CaCO3 = \"2440 kg/m^3\", CaO = \"1700 kg/m^3\", Al2O3 = \"2440 kg/m^3\" }, \
     least_diameter = \"4 mm\" }",
    "materials.limestone.conductivity=0.6 W/m/K",
    "materials.limestone.radial={ shells = 10, grading = 2, true_densities = { CaCO3 = \"2711 kg/m^3\", CaO = \"3340 kg/m^3\", Al2O3 = \
     \"3970 kg/m^3\" }, pore_diameter = \"1 um\", tortuosity = 2, permeability = { law = \"constant\", value = \"1e-13 m^2\" } }",
    "reactions=[{ name = \"calcination\", equation = \"CaCO3 <=> CaO + CO2\", law = \"first-order\", rate = { factor = 1.235e15, \
     activation_energy = \"325.1 kJ/mol\" } }]",
];

#[test]
fn stones_with_shells_that_move_and_shrink_close_the_ledger_in_every_pairing_and_on_two_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let set = [&SHELLS[..], &["materials.limestone.inside=radial"]].concat();
    let own = run(&folder.path().join("own"), &set, &[]);
    closes(&own);
    assert!(value(&own, "lime") > 0.04 && value(&own, "least_diameter") < 7.95e-3);
    let pairings: [(&str, &[&str]); 3] = [
        (
            "two-ranks",
            &["--particles", "liggghts", "--ranks-particles", "2"],
        ),
        ("openfoam", &["--gas", "openfoam"]),
        ("both", &["--gas", "openfoam", "--particles", "liggghts"]),
    ];
    for (name, options) in pairings {
        println!("{name}");
        let other = run(&folder.path().join(name), &set, options);
        closes(&other);
        for (quantity, most) in [("lime", 1e-4), ("mean_mass", 1e-5), ("mean_diameter", 1e-5)] {
            let [one, other] = [&own, &other].map(|summary| value(summary, quantity));
            println!("{quantity}: {one:.6e} {other:.6e}");
            assert!(
                (other / one - 1.0).abs() < most,
                "{quantity}: {one} {other}"
            );
        }
    }
}

#[test]
fn the_acceleration_factor_does_not_show_in_what_has_reacted() {
    let folder = tempfile::tempdir().unwrap();
    let at = |factor: &str| {
        let set = [
            format!("time.acceleration={factor}"),
            "time.end=80 s".to_owned(),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        run(&folder.path().join(factor), &set, &[])
    };
    let [fast, slow] = ["200", "50"].map(at);
    alike(&fast, &slow, 5e-3);
    let [fast, slow] = [fast, slow].map(|run| value(&run, "top_gas"));
    println!("gas at the top: {fast:.2} {slow:.2} K");
    assert!((fast - slow).abs() < 2.0, "{fast} {slow} K");
}

#[test]
fn liggghts_has_sizes_and_masses_as_they_become() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["time.end=80 s"];
    let own = run(&folder.path().join("own"), &set, &[]);
    let other = run(
        &folder.path().join("liggghts"),
        &set,
        &["--particles", "liggghts"],
    );
    closes(&other);
    // Stones touch otherwise than natively, and so turn and sink a little otherwise.
    alike(&own, &other, 5e-3);
}
