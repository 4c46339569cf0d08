//! How quantities of interest are measured.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;

use calcine::case::model::{GasPlace, Measure, ParticlePlace, Probe, Statistic};
use calcine_coupler::physics::Vec3;

use crate::support::fake;

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
    add(
        "all",
        "K",
        particles(ParticlePlace::Population(0), Statistic::Max),
    );
    add(
        "none",
        "K",
        particles(ParticlePlace::Population(9), Statistic::Max),
    );
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
