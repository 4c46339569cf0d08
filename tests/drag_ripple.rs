//! How much the force of the fluid on one particle ripples while it crosses cells: a sphere half as wide
//! as the cells, sinking through ten of them, by each mapping, with the diffusion F and without. The force on a
//! particle is constant over a window, so that its change of velocity tells it exactly.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine::results::read::Series;

use crate::support::program::run_text;
use crate::support::schiller_naumann::Sphere;

const DIAMETER: f64 = 2e-3;
const CELL: f64 = 4e-3;
const WINDOW: f64 = 1e-3;
/// The bead, in water.
const BEAD: Sphere = Sphere {
    diameter: DIAMETER,
    density: 2500.0,
    fluid: 998.0,
    viscosity: 1e-3,
};

/// A bead of glass in water at rest, over a column of cells twice as wide as it.
fn case(mapping: &str, diffusion: &str) -> String {
    format!(
        r#"
format = 1
title = "A bead of glass crosses cells of twice its diameter"
[time]
end = "0.33 s"
motion_window = "1 ms"
[mesh]
box = {{ size = "20 20 120 mm", cells = [5, 5, 30] }}
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
young = "0.5 MPa"
poisson = 0.22
[[contacts]]
between = ["glass", "glass"]
restitution = 0.8
friction = 0.1
[motion]
kind = "real-time"
contact = {{ law = "hertz-mindlin" }}
rolling = {{ law = "none" }}
cohesion = {{ law = "none" }}
[gas]
mixture = "water"
constant = {{ density = "998 kg/m^3", heat_capacity = "4.18 kJ/kg/K", viscosity = "1e-3 Pa s", conductivity = "0.6 W/m/K" }}
initial = {{ temperature = "300 K", pressure = "1 atm" }}
gravity = "0 0 -9.81 m/s^2"
[gas.patch.bottom]
wall = {{ velocity = "slip", heat = "adiabatic" }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
[[particles]]
name = "bead"
material = "glass"
diameter = "{DIAMETER} m"
motion = "free"
place = {{ grid = {{ first = "10 10 110 mm", spacing = "1 1 1 mm", counts = [1, 1, 1] }} }}
temperature = "300 K"
[laws]
drag = {{ law = "wen-yu" }}
heat_transfer = {{ law = "none" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "{mapping}"
smoother = {{ max_solid_fraction = 0.64, diffusion_length = "{diffusion}" }}
[output]
every = "0.33 s"
series_every = "1 ms"
[[quantities]]
name = "speed"
measure = {{ particle = "speed", number = 1 }}
[[quantities]]
name = "height"
measure = {{ particle = "height", number = 1 }}
"#
    )
}

/// What comes out over ten cells: the force of the fluid over the buoyant weight, and the speed.
struct Ripple {
    /// Root mean square of the force about its mean, as a share of the mean.
    force: f64,
    /// Half of the largest less the smallest, as a share of the mean.
    peak: f64,
    /// The same of the speed.
    speed: f64,
    /// Mean speed in m/s.
    mean: f64,
}

fn ripple(directory: &Path, mapping: &str, diffusion: &str) -> Ripple {
    let name = format!("{mapping}-{}", diffusion.replace(' ', "-"));
    let out = run_text(directory, &name, &case(mapping, diffusion), &[]);
    let series = Series::read(&out).unwrap();
    let (speeds, heights) = (
        series.column("quantities.speed"),
        series.column("quantities.height"),
    );
    // Ten cells, the last of which ends four above the floor.
    let (low, high) = (4.0 * CELL, 14.0 * CELL);
    let within: Vec<usize> = (1..speeds.len())
        .filter(|&row| (low..high).contains(&heights[row]))
        .collect();
    assert!(within.len() > 50, "{} windows", within.len());
    let mass = BEAD.volume() * BEAD.density;
    let force = |&row: &usize| mass * (9.81 - (speeds[row] - speeds[row - 1]) / WINDOW);
    let forces: Vec<f64> = within.iter().map(force).collect();
    let crossed: Vec<f64> = within.iter().map(|&row| speeds[row]).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let half = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        0.5 * (high - low) / mean(values)
    };
    let average = mean(&forces);
    let square = forces.iter().map(|f| (f - average).powi(2)).sum::<f64>();
    let found = Ripple {
        force: (square / forces.len() as f64).sqrt() / average,
        peak: half(&forces),
        speed: half(&crossed),
        mean: mean(&crossed),
    };
    println!(
        "{mapping:9} F {diffusion:5}: force {:.2} % rms, {:.2} % half peak to peak; speed {:.3} % of {:.4} m/s",
        100.0 * found.force,
        100.0 * found.peak,
        100.0 * found.speed,
        found.mean
    );
    found
}

#[test]
fn the_force_on_a_bead_that_crosses_ten_cells_ripples_least_by_overlap() {
    let directory = tempfile::tempdir().unwrap();
    let [centroid, divided, overlap] = ["centroid", "divided", "overlap"].map(|mapping| {
        ["0 mm", "1 mm", "2 mm"].map(|length| ripple(directory.path(), mapping, length))
    });
    // Without F, with that of the default (half a diameter), with one diameter.
    for (way, most) in [
        (&overlap, [0.06, 0.04, 0.02]),
        (&divided, [0.1, 0.06, 0.02]),
    ] {
        for (found, most) in way.iter().zip(most) {
            assert!(found.force < most, "{} {most}", found.force);
            assert!(found.speed < 0.01, "{}", found.speed);
        }
    }
    // All of a particle changing cells at once is felt as an impact.
    assert!(centroid[0].force > 0.2, "{}", centroid[0].force);
    assert!(centroid[0].peak > 10.0 * overlap[0].peak);
    // The bead drags the water of its own cells along; F spreads that, and comes nearer to the law's 0.27 m/s.
    assert!(overlap[0].mean < overlap[1].mean && overlap[1].mean < overlap[2].mean);
    assert!((overlap[2].mean / BEAD.terminal() - 1.0).abs() < 0.02);
}
