//! How quantities of interest are measured.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;

use calcine::case::model::{GasPlace, Measure, ParticlePlace, Probe, Statistic};
use calcine::results::{Summary, read};
use calcine_coupler::physics::Vec3;

use crate::support::{fake, program};

/// Each measure against a value that reaches the series by another way.
#[test]
fn quantities_of_the_gas_of_patches_of_probes_and_of_populations_are_what_they_say() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let mut case = fake::case();
    case.probes.push(Probe {
        name: "third".into(),
        // The centre of the third sphere.
        points: vec![Vec3::new(0.005, 0.005, 0.035)],
        gas: true,
        particles: true,
    });
    let template = case.quantities[1].clone();
    let mut add = |name: &str, unit, measure| {
        let mut quantity = template.clone();
        (quantity.name, quantity.unit, quantity.measure) = (name.into(), unit, measure);
        case.quantities.push(quantity);
    };
    let gas = |field: &str, over, statistic| Measure::Gas {
        field: field.into(),
        over,
        statistic,
    };
    let particles = |over, statistic| Measure::Particles {
        field: "temperature".into(),
        over,
        statistic,
    };
    let populations = |of: &[u32]| ParticlePlace::Among {
        populations: Some(of.to_vec()),
        zone: None,
    };
    let patch = |name: &str| GasPlace::Patch(name.into());
    add(
        "hottest",
        "K",
        gas("temperature", GasPlace::Everywhere, Statistic::Max),
    );
    add(
        "low",
        "Pa",
        gas("pressure", patch("bottom"), Statistic::Mean),
    );
    add("high", "Pa", gas("pressure", patch("top"), Statistic::Mean));
    add(
        "third",
        "K",
        particles(ParticlePlace::Probe("third".into()), Statistic::Mean),
    );
    add("all", "K", particles(populations(&[0]), Statistic::Max));
    add("none", "K", particles(populations(&[9]), Statistic::Max));
    add(
        "gas",
        "K",
        gas(
            "temperature",
            GasPlace::Probe("third".into()),
            Statistic::Min,
        ),
    );
    fake::run(&case, &out, 0.0);
    let series = calcine::results::read::Series::read(&out).unwrap();
    let column = |name: &str| series.column(name)[1..].to_vec();
    assert_eq!(column("quantities.hottest"), column("gas.temperature_max"));
    assert_eq!(column("quantities.third"), column("particle_temperature.3"));
    assert_eq!(
        column("quantities.all"),
        column("particles.temperature_max")
    );
    assert!(column("quantities.none").iter().all(|value| value.is_nan()));
    let drop = column("quantities.pressure_drop");
    let ends = column("quantities.low")
        .into_iter()
        .zip(column("quantities.high"));
    assert!(ends.zip(drop).all(|((low, high), drop)| low - high == drop));
    // At the end: the last row of the probe's table, column 6, is the temperature of the gas.
    let table = fs::read_to_string(out.join("probes/probes_0004.csv")).unwrap();
    let row = table
        .lines()
        .find(|line| line.starts_with("third,"))
        .unwrap();
    let at_point: f64 = row.split(',').nth(5).unwrap().parse().unwrap();
    assert_eq!(column("quantities.gas").last(), Some(&at_point));
}

/// The drum of glass beads, its first 40 ms, with a measure of each kind.
const MEASURED: &str = r#"
[[quantities]]
name = "count"
measure = { particles = "count", population = "beads" }
[[quantities]]
name = "count_low"
measure = { particles = "count", material = "glass", zone = { box = { from = "-51 0 -51 mm", to = "51 25 -28 mm" } } }
[[quantities]]
name = "mass_round"
measure = { particles = "mass", statistic = "sum", zone = { cylinder = { from = "0 0 0 mm", to = "0 25 0 mm", radius = "28 mm" } } }
[[quantities]]
name = "x"
measure = { particles = "x", population = "beads between", statistic = "mean" }
[[quantities]]
name = "y"
measure = { particles = "y", statistic = "deviation" }
[[quantities]]
name = "z"
measure = { particles = "z", statistic = "min" }
[[quantities]]
name = "energy"
measure = { particles = "kinetic_energy", statistic = "sum" }
[[quantities]]
name = "spin"
measure = { particles = "angular_speed", statistic = "mean" }
[[quantities]]
name = "spread"
measure = { particles = "angular_speed", statistic = "deviation" }
"#;

/// Against sums over the particles of the snapshot.
#[test]
fn counts_sums_and_deviations_of_particles_are_those_of_the_snapshot() {
    let folder = tempfile::tempdir().unwrap();
    let case = fs::read_to_string(program::shipped("rotating-drum")).unwrap();
    let case = case.split("[[quantities]]").next().unwrap().to_owned() + MEASURED;
    let file = folder.path().join("drum.toml");
    fs::write(&file, case).unwrap();
    let out = folder.path().join("out");
    let set = [
        "time.end=40 ms",
        "output.every=40 ms",
        "output.series_every=40 ms",
    ];
    let set = [&set[..], &["output.particles=[\"velocity\", \"mass\"]"]].concat();
    program::run(&file, &out, &[], &set);
    let summary = Summary::read(&out).unwrap();
    let found = |name: &str| summary.quantities[name].value.unwrap();
    let files = read::collection(&out, "particles.pvd").unwrap();
    let arrays = read::arrays(&files.last().unwrap().1).unwrap();
    let list = |name: &str| &arrays[name].values[..];
    let (place, speed) = (list("points"), list("velocity"));
    let (mass, radius, kind) = (list("mass"), 2.5e-3, list("population"));
    let rows = 0..mass.len();
    let at = |row: usize, axis: usize| place[3 * row + axis];
    let close = |name: &str, value: f64| {
        let off = (found(name) - value).abs() / value.abs();
        assert!(off < 1e-10, "{name}: {} for {value}", found(name));
    };
    close(
        "count",
        kind.iter().filter(|kind| **kind == 0.0).count() as f64,
    );
    let low = rows.clone().filter(|row| at(*row, 2) <= -0.028).count();
    assert!(low > 10);
    close("count_low", low as f64);
    let round = rows
        .clone()
        .filter(|row| at(*row, 0).hypot(at(*row, 2)) <= 0.028);
    close("mass_round", round.map(|row| mass[row]).sum());
    let between: Vec<f64> = rows
        .clone()
        .filter(|row| kind[*row] == 1.0)
        .map(|row| at(row, 0))
        .collect();
    close("x", between.iter().sum::<f64>() / between.len() as f64);
    let mean = rows.clone().map(|row| at(row, 1)).sum::<f64>() / mass.len() as f64;
    let square = rows
        .clone()
        .map(|row| (at(row, 1) - mean).powi(2))
        .sum::<f64>()
        / mass.len() as f64;
    close("y", square.sqrt());
    close(
        "z",
        rows.clone()
            .map(|row| at(row, 2))
            .fold(f64::INFINITY, f64::min),
    );
    // Beads are alike, so that the energy of spin is that of the mean square.
    let square = found("spin").powi(2) + found("spread").powi(2);
    assert!(square > 0.0);
    let spin = 0.5 * 0.4 * radius * radius * square * mass.iter().sum::<f64>();
    let flight = rows.map(|row| {
        0.5 * mass[row]
            * (0..3)
                .map(|axis| speed[3 * row + axis].powi(2))
                .sum::<f64>()
    });
    close("energy", flight.sum::<f64>() + spin);
}
