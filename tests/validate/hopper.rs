//! Discharge of a hopper against Beverloo's equation: W = C ρ_b √g (D − k d)^2.5 with C = 0.58 and k = 1.4 for
//! spheres (Beverloo, Leniger, van de Velde, Chem. Eng. Sci. 15 (1961) 260, doi 10.1016/0009-2509(61)85030-6).

use std::f64::consts::PI;

use crate::{line, run as calcine, shipped};

/// Diameter of the beads in m.
const BEAD: f64 = 4e-3;
/// Diameters of the hole in m.
const HOLES: [f64; 5] = [20e-3, 22e-3, 25e-3, 28e-3, 32e-3];

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let mut roots = Vec::new();
    let mut rates = Vec::new();
    println!("  | hole/bead | rate g/s | C with k = 1.4 |");
    for hole in HOLES {
        let set = [
            format!("walls[1].cone.from_radius={:e} m", 0.5 * hole),
            "time.end=0.7 s".into(),
        ];
        let (_, series) = calcine(&shipped("hopper"), folder.path(), &format!("{hole}"), &set);
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
        let constant = rate / (bulk() * 9.81f64.sqrt() * (hole - 1.4 * BEAD).powf(2.5));
        println!(
            "  | {:>9.2} | {:>8.1} | {constant:>14.3} |",
            hole / BEAD,
            1e3 * rate
        );
        rates.push(constant);
        roots.push((hole, rate.powf(0.4)));
    }
    // W^0.4 over D is straight, and zero at k d.
    let (slope, zero) = line(&roots);
    let empty = -zero / slope / BEAD;
    let constant = slope.powf(2.5) / (bulk() * 9.81f64.sqrt());
    let off = roots
        .iter()
        .map(|(hole, root)| (slope * hole + zero - root).abs() / root)
        .fold(0.0, f64::max);
    println!("  W^0.4 is straight within {off:.1e}: k = {empty:.2}, C = {constant:.3}");
    assert!(off < 0.02, "{off}");
    assert!((1.0..2.0).contains(&empty), "{empty}");
    assert!(rates.iter().all(|c| (0.5..0.66).contains(c)), "{rates:?}");
}

/// Bulk density in kg/m³ of the bed above the hole: beads of friction 0.5 at a solid fraction of 0.58.
fn bulk() -> f64 {
    0.58 * 2500.0
}
