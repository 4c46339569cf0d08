//! Heat between particles and to walls, through the program: exact relaxation, series of resistances, radiation
//! in a cubic array against rays traced apart from Calcine, beds against correlations, native particles
//! against LIGGGHTS.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::{Path, PathBuf};

use calcine::results::Summary;
use calcine::results::read::Series;
use calcine_coupler::physics::bed_conductivity::{
    BedConductivity, PackedBed, YagiKunii, ZehnerBauerSchluender,
};

use crate::support::lattice;
use crate::support::program;

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

const STACK: &str = "cases/iron-stack.toml";

/// Runs a case with keys set; the quantity `heat` and the series.
fn run(name: &str, set: &[String]) -> (f64, Series, Summary) {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out");
    program::run(&case(name), &out, &[], set);
    let summary = Summary::read(&out).unwrap();
    let heat = summary.quantities.get("heat").and_then(|one| one.value);
    (
        heat.unwrap_or(f64::NAN),
        Series::read(&out).unwrap(),
        summary,
    )
}

/// Temperatures in K of all particles at the end.
fn last(series: &Series) -> Vec<f64> {
    let particles = series.particles();
    particles
        .iter()
        .map(|(_, values)| values[values.len() - 1])
        .collect()
}

fn set(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

#[test]
fn two_particles_in_contact_relax_as_the_exponential_says() {
    let (_, series, _) = run(
        "tests/inputs/good/two-in-contact.toml",
        &set(&[
            "laws.conduction={ law = \"batchelor-obrien\" }",
            "laws.radiation={ law = \"none\" }",
            "walls=[]",
        ]),
    );
    // r_c = √(2.5e-3 · 1e-6) = 5e-5 m, G = 2 · 50 r_c = 5e-3 W/K; m c = 7870 π/6 1e-6 · 3 R/M.
    let heat_capacity =
        7870.0 * std::f64::consts::PI / 6.0 * 1e-6 * 3.0 * 8.314_462_618 / 0.055_845;
    let rate = 2.0 * 5e-3 / heat_capacity;
    let (times, particles) = (series.column("process_time"), series.particles());
    let mut worst = 0.0_f64;
    for (k, time) in times.iter().enumerate() {
        let left = (particles[1].1[k] - particles[0].1[k]) / 100.0;
        worst = worst.max((left / (-rate * time).exp() - 1.0).abs());
    }
    println!("largest relative deviation over 300 s: {worst:.1e}");
    assert!(times.len() > 200 && worst < 1e-3, "{worst}");
}

#[test]
fn a_stack_conducts_as_its_resistances_in_series() {
    let (heat, ..) = run(
        STACK,
        &set(&[
            "laws.radiation={ law = \"none\" }",
            "laws.conduction.gap={ law = \"none\" }",
            "materials.iron.conductivity=50 W/m/K",
            "time.end=600 h",
        ]),
    );
    // Contact radii by Hertz: a³ = 3 F R*/(4 E*), E* = E/(2(1 − ν²)).
    let young = 210e9 / (2.0 * (1.0 - 0.29 * 0.29));
    let conductance = |radius: f64| 2.0 * 50.0 * (0.75 * 0.27 * radius / young).cbrt();
    let resistance = 10.0 / conductance(2.75e-3) + 2.0 / conductance(5.5e-3);
    assert!((heat / (50.0 / resistance) - 1.0).abs() < 1e-8, "{heat}");
}

#[test]
fn black_spheres_in_a_cubic_array_radiate_as_rays_through_the_endless_lattice_say() {
    let (heat, series, summary) = run(
        STACK,
        &set(&[
            "laws.conduction={ law = \"none\" }",
            "laws.radiation.rays=20000",
            "laws.radiation.range=40",
            "materials.iron.emissivity=1",
            "walls[0].temperature=1100 K",
            "walls[1].temperature=300 K",
        ]),
    );
    let (exact, kelvin) = lattice::stack(11, 5.5e-3, [1100.0, 300.0]);
    let worst = last(&series)
        .iter()
        .zip(&kelvin)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    let energy = summary.ledger.lines["energy"].relative_error;
    println!(
        "heat {heat:.4} W, lattice {exact:.4} W; temperatures within {worst:.2} K; ledger {energy:.1e}"
    );
    assert!(
        (heat / exact - 1.0).abs() < 0.01 && worst < 3.0,
        "{heat} {exact} {worst}"
    );
    assert!(energy < 1e-12, "{energy}");
}

/// Conductivity in W/m/K of air, as the runs have it.
fn air(kelvin: f64) -> f64 {
    let case = calcine::case::read(&case(STACK), &[]).unwrap();
    case.gas.properties.conductivity(kelvin, &[])
}

/// Effective conductivity of the stack in W/m/K at a mean temperature in K, between spheres 2 and 10.
fn of_stack(kelvin: f64) -> f64 {
    let (heat, series, _) = run(
        STACK,
        &[
            format!("walls[0].temperature={} K", kelvin + 25.0),
            format!("walls[1].temperature={} K", kelvin - 25.0),
            format!("gas.initial.temperature={kelvin} K"),
            format!("particles[0].temperature={kelvin} K"),
        ],
    );
    let end = last(&series);
    heat * 8.0 * 11e-3 / (121e-6 * (end[1] - end[9]))
}

#[test]
fn the_stack_of_iron_lies_about_the_correlations_from_400_to_1100_kelvin() {
    for (kelvin, solid) in [(400.0, 71.67), (750.0, 46.75), (1100.0, 33.0)] {
        let bed = PackedBed {
            void_fraction: 1.0 - std::f64::consts::FRAC_PI_6,
            diameter: 11e-3,
            solid_conductivity: solid,
            gas_conductivity: air(kelvin),
            emissivity: 0.8,
            temperature: kelvin,
        };
        let made = of_stack(kelvin);
        let zbs = ZehnerBauerSchluender { flattening: 0.0013 }.conductivity(&bed);
        let yagi = YagiKunii.conductivity(&bed);
        println!(
            "{kelvin} K: {made:.4}, Zehner-Bauer-Schlünder {zbs:.4}, Yagi-Kunii {yagi:.4} W/m/K"
        );
        assert!((0.6..1.7).contains(&(made / zbs)), "{kelvin}: {made} {zbs}");
        assert!(
            (0.6..1.7).contains(&(made / yagi)),
            "{kelvin}: {made} {yagi}"
        );
    }
}

/// Effective conductivity in W/m/K and void fraction of the middle of the random bed.
fn of_bed(kelvin: f64) -> (f64, f64) {
    const NAME: &str = "cases/bed-conductivity.toml";
    let words = vec![
        format!("walls[0].temperature={} K", kelvin + 50.0),
        format!("walls[1].temperature={} K", kelvin - 50.0),
        format!("gas.initial.temperature={kelvin} K"),
        format!("particles[0].temperature={kelvin} K"),
    ];
    let (heat, series, _) = run(NAME, &words);
    let bed = calcine::case::particles(&calcine::case::read(&case(NAME), &[]).unwrap()).unwrap();
    let end = last(&series);
    let heights: Vec<f64> = bed.setup.position.iter().map(|centre| centre.z).collect();
    assert_eq!(heights.len(), end.len());
    // Least squares over the middle.
    let middle = heights
        .iter()
        .zip(&end)
        .filter(|(z, _)| (0.018..0.066).contains(*z));
    let (mut n, mut z, mut t, mut zz, mut zt) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (height, kelvin) in middle {
        (n, z, t) = (n + 1.0, z + height, t + kelvin);
        (zz, zt) = (zz + height * height, zt + height * kelvin);
    }
    let slope = (n * zt - z * t) / (n * zz - z * z);
    let radius = 3e-3;
    let slab = |height: &f64| {
        // Volume of a sphere below a plane at x above its centre.
        let below = |x: f64| {
            let h = (x + radius).clamp(0.0, 2.0 * radius);
            std::f64::consts::PI * h * h * (3.0 * radius - h) / 3.0
        };
        below(0.066 - height) - below(0.018 - height)
    };
    let solid = heights.iter().map(slab).sum::<f64>() / (0.048 * 0.048 * 0.048);
    (heat / (0.048 * 0.048 * -slope), 1.0 - solid)
}

#[test]
fn a_random_bed_conducts_as_zehner_bauer_and_schluender_say_from_300_to_1500_kelvin() {
    for kelvin in [300.0, 900.0, 1500.0] {
        let (made, void_fraction) = of_bed(kelvin);
        let bed = PackedBed {
            void_fraction,
            diameter: 6e-3,
            solid_conductivity: 20.0,
            gas_conductivity: air(kelvin),
            emissivity: 0.9,
            temperature: kelvin,
        };
        let zbs = ZehnerBauerSchluender::default().conductivity(&bed);
        println!(
            "{kelvin} K: void fraction {void_fraction:.3}, {made:.4}, Zehner-Bauer-Schlünder {zbs:.4} W/m/K"
        );
        // The correlation is good for 30 %; the bed has no contact areas, which tells where it is cold.
        assert!(
            (0.65..1.3).contains(&(made / zbs)),
            "{kelvin}: {made} {zbs}"
        );
    }
}

#[test]
fn liggghts_particles_exchange_the_same_heat() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out");
    program::compare(
        &case(STACK),
        &out,
        "native+native,native+liggghts",
        &[""; 0],
    );
}
