//! Discharge of a hopper against Beverloo's equation: W = C ρ_b √g (D − k d)^2.5 with C = 0.58 and k = 1.4 for
//! spheres (Beverloo, Leniger, van de Velde, Chem. Eng. Sci. 15 (1961) 260, doi 10.1016/0009-2509(61)85030-6). ρ_b is that of
//! the bed of each run.

use std::f64::consts::PI;

use crate::hopper_bed::{PARTICLE, bulk, is_published, scale, scatter};
use crate::{line, run as calcine, shipped};

/// Diameters of the hole in m.
const HOLES: [f64; 5] = [20e-3, 22e-3, 25e-3, 28e-3, 32e-3];

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let mut roots = Vec::new();
    let mut constants = Vec::new();
    println!("  | hole/bead | rate g/s | bulk density kg/m³ | C with k = 1.4 |");
    for hole in HOLES {
        let set = [
            format!("walls[1].cone.from_radius={:e} m", 0.5 * hole),
            "time.end=0.7 s".into(),
        ];
        let (out, series) = calcine(&shipped("hopper"), folder.path(), &format!("{hole}"), &set);
        let times = series.column("process_time");
        let gone = series.column("ledger.particle_mass_throughput");
        // After the start the flow is steady as long as more than the hole's width is left above it.
        let total = 0.55 * PI * 0.032f64.powi(2) * 0.088 * 2500.0;
        let points: Vec<(f64, f64)> = times
            .iter()
            .zip(gone)
            .filter(|(time, gone)| **time > 0.15 && **gone < 0.45 * total)
            .map(|(time, gone)| (*time, *gone))
            .collect();
        let (rate, _) = line(&points);
        let bulk = bulk(&out);
        let constant = rate / scale(bulk, hole);
        println!(
            "  | {:>9.2} | {:>8.1} | {bulk:>18.0} | {constant:>14.3} |",
            hole / PARTICLE,
            1e3 * rate
        );
        let passed = points.last().unwrap().1 - points[0].1;
        constants.push((constant, scatter(passed)));
        roots.push((hole, (rate / bulk).powf(0.4)));
    }
    // (W/ρ_b)^0.4 over D is straight, and zero at k d.
    let (slope, zero) = line(&roots);
    let empty = -zero / slope / PARTICLE;
    let constant = slope.powf(2.5) / 9.81f64.sqrt();
    let off = roots
        .iter()
        .map(|(hole, root)| (slope * hole + zero - root).abs() / root)
        .fold(0.0, f64::max);
    // A root of 0.4 has 0.4 of the scatter of the rate, largest for the smallest hole.
    let counted = constants.iter().map(|one| 0.4 * one.1).fold(0.0, f64::max);
    println!("  (W/ρ_b)^0.4 is straight within {off:.1e}: k = {empty:.2}, C = {constant:.3}");
    assert!(off < (1.5 * counted).min(0.02), "{off} {counted}");
    // A line through five points between 5 and 8 diameters that are off by 1 % each finds its zero within 0.3 diameters.
    assert!((1.1..1.7).contains(&empty), "{empty}");
    assert!(
        constants.iter().all(|one| is_published(*one)),
        "{constants:?}"
    );
}
