//! Direct-reduced iron in an open container: what heats, what cools, and what it takes from the air
//! (docs/theory.md, DRI-1, DRI-2, DRI-V1, DRI-V2).

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine::results::Summary;
use calcine::results::read::{self, Series};

use crate::support::program;

/// Mass of oxygen in a unit mass of FeO.
const OXYGEN: f64 = 15.999 / 71.844;

fn run(out: &Path, settings: &[&str]) -> Summary {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/dri-self-heating.toml");
    program::run(&case, out, &[], settings);
    let summary = Summary::read(out).unwrap();
    let lines = summary.ledger.lines.iter().chain(&summary.ledger.elements);
    for (name, line) in lines {
        let kept = name != "gas_momentum" && name != "storage_clock";
        assert!(
            !kept || line.relative_error < 1e-11,
            "{name}: {}",
            line.relative_error
        );
    }
    summary
}

fn column(out: &Path, name: &str) -> Vec<f64> {
    let series = Series::read(out).unwrap();
    series.column(&format!("quantities.{name}")).to_vec()
}

/// A pellet at the end: its centre in m, temperature in K, mass fraction of oxide.
struct Pellet {
    centre: [f64; 3],
    kelvin: f64,
    oxide: f64,
}

fn pellets(out: &Path) -> Vec<Pellet> {
    let files = read::collection(out, "particles.pvd").unwrap();
    let arrays = read::arrays(&files.last().unwrap().1).unwrap();
    let centres = arrays["points"].values.as_chunks::<3>().0;
    let (kelvin, oxide) = (&arrays["temperature"].values, &arrays["FeO"].values);
    let rows = centres.iter().zip(kelvin).zip(oxide);
    rows.map(|((centre, kelvin), oxide)| Pellet {
        centre: *centre,
        kelvin: *kelvin,
        oxide: *oxide,
    })
    .collect()
}

/// Mean over the pellets that are meant.
fn mean(pellets: &[Pellet], meant: impl Fn(&[f64; 3]) -> bool, of: impl Fn(&Pellet) -> f64) -> f64 {
    let chosen: Vec<f64> = pellets
        .iter()
        .filter(|one| meant(&one.centre))
        .map(of)
        .collect();
    assert!(!chosen.is_empty());
    chosen.iter().sum::<f64>() / chosen.len() as f64
}

#[test]
fn the_inside_heats_wall_and_top_cool_and_oxide_follows_heat_and_oxygen() {
    let folder = tempfile::tempdir().unwrap();
    let (air, lean) = (folder.path().join("air"), folder.path().join("lean"));
    let end = ["time.end=3000 s", "output.every=3000 s"];
    run(&air, &end);

    let all = pellets(&air);
    let inside = |x: &[f64; 3]| x[0] < 0.1 && x[1] < 0.1 && (0.1..0.2).contains(&x[2]);
    let wall = |x: &[f64; 3]| x[0] > 0.29 || x[1] > 0.29;
    let top = |x: &[f64; 3]| x[0] < 0.1 && x[1] < 0.1 && x[2] > 0.255;
    let below = |x: &[f64; 3]| x[0] < 0.1 && x[1] < 0.1 && (0.2..0.255).contains(&x[2]);
    let kelvin = |one: &Pellet| one.kelvin;
    let [middle, beside, above, under] = [
        mean(&all, inside, kelvin),
        mean(&all, wall, kelvin),
        mean(&all, top, kelvin),
        mean(&all, below, kelvin),
    ];
    println!(
        "inside {middle:.2} K, beside walls {beside:.2} K, top {above:.2} K over {under:.2} K"
    );
    assert!(middle > 333.0 + 3.0, "{middle}");
    assert!(beside < 333.0 - 15.0, "{beside}");
    // The gas above takes heat from the top layer, which comes from the layers below.
    assert!(
        above < under - 1.0 && above < middle - 1.0,
        "{above} {under}"
    );

    // Where it is hot the oxide grows as its rate, exp(-E/RT) by 59.7 kJ/mol and the pores beside it, has it.
    let gain = |one: &Pellet| one.oxide - 0.07;
    let [hot, cold] = [mean(&all, inside, gain), mean(&all, wall, gain)];
    println!("oxide gained inside {hot:.3e}, beside walls {cold:.3e}");
    assert!(hot > 1.5 * cold && cold > 0.0, "{hot} {cold}");

    // The container gains the oxygen that its iron takes.
    let (mass, oxide) = (column(&air, "pellet_mass"), column(&air, "oxide"));
    let last = mass.len() - 1;
    let gained = mass[last] - mass[0];
    let bound = (mass[last] * oxide[last] - mass[0] * oxide[0]) * OXYGEN;
    // All pellets are alike in size, so that means of products are near the product of means.
    assert!(
        gained > 0.0 && (gained / bound - 1.0).abs() < 1e-4,
        "{gained} {bound}"
    );

    // A quarter of the oxygen: a quarter of the oxide, but for what less heat slows it further.
    let lean_air = "{ mole = { O2 = 0.0525, N2 = 0.9475 } }";
    let initial = format!("gas.initial.composition={lean_air}");
    let around = format!("gas.patch.top.opening.composition={lean_air}");
    run(&lean, &[&end[..], &[&initial, &around]].concat());
    let less = column(&lean, "oxide");
    let share = (less[less.len() - 1] - 0.07) / (oxide[last] - 0.07);
    println!("a quarter of the oxygen makes {share:.4} of the oxide");
    assert!((0.21..0.25).contains(&share), "{share}");
    let hottest = |out: &Path| column(out, "highest_temperature")[last];
    assert!(hottest(&lean) < hottest(&air) - 3.0);
}
