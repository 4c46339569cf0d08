//! Beverloo's equation for a hopper, with the bulk density that the bed has while it runs out.

#![allow(clippy::unwrap_used, dead_code)]

use std::f64::consts::PI;
use std::path::Path;

use calcine::results::read;

/// Diameter of the particles in m, their density in kg/m³, radius of the silo in m.
pub const PARTICLE: f64 = 4e-3;
const DENSITY: f64 = 2500.0;
const SILO: f64 = 32e-3;
/// The slice above the hole's floor of 30 mm, in m, in which the bed is weighed, and the times in s: it flows, and its
/// surface is well above.
const SLICE: [f64; 2] = [40e-3, 60e-3];
const WHILE: [f64; 2] = [0.149, 0.201];

/// C of Beverloo's equation for spheres, W = C ρ_b √g (D − 1.4 d)^2.5, as measured by several (Nedderman, Tüzün, Savage
/// and Houlsby, Chem. Eng. Sci. 37 (1982) 1597, doi 10.1016/0009-2509(82)80029-8); 0.58 by Beverloo, Leniger and van de
/// Velde 1961, doi 10.1016/0009-2509(61)85030-6.
pub const PUBLISHED: std::ops::RangeInclusive<f64> = 0.55..=0.65;

/// Whether a C is within what is published and its own relative scatter.
pub fn is_published((constant, scatter): (f64, f64)) -> bool {
    let (low, high) = (PUBLISHED.start(), PUBLISHED.end());
    (low * (1.0 - scatter)..=high * (1.0 + scatter)).contains(&constant)
}

/// ρ_b √g (D − 1.4 d)^2.5 in kg/s of a hole of a diameter in m.
pub fn scale(bulk: f64, hole: f64) -> f64 {
    bulk * 9.81f64.sqrt() * (hole - 1.4 * PARTICLE).powf(2.5)
}

/// Standard deviation of the number of particles in a mass in kg, over that number, if each comes by itself.
pub fn scatter(mass: f64) -> f64 {
    (DENSITY * PI / 6.0 * PARTICLE.powi(3) / mass).sqrt()
}

/// Bulk density in kg/m³ of the bed above the hole while it flows, by the places of the particles of a run.
pub fn bulk(out: &Path) -> f64 {
    let radius = 0.5 * PARTICLE;
    let below = |x: f64| {
        let h = (x + radius).clamp(0.0, PARTICLE);
        PI * h * h * (3.0 * radius - h) / 3.0
    };
    let files = read::collection(out, "particles.pvd").unwrap();
    let found: Vec<f64> = files
        .iter()
        .filter(|(time, _)| (WHILE[0]..WHILE[1]).contains(time))
        .map(|(_, path)| {
            let arrays = read::arrays(path).unwrap();
            let places = arrays["points"].values.as_chunks::<3>().0;
            let inside = places
                .iter()
                .map(|at| below(SLICE[1] - at[2]) - below(SLICE[0] - at[2]));
            inside.sum::<f64>() / (PI * SILO * SILO * (SLICE[1] - SLICE[0]))
        })
        .collect();
    assert!(!found.is_empty(), "no snapshot between {WHILE:?} s");
    DENSITY * found.iter().sum::<f64>() / found.len() as f64
}
