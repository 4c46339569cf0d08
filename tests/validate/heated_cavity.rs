//! The cavity between a warm and a cold side that lean by 45 degrees, at a Rayleigh number of 1e6 (Demirdzic, Lilek and Peric 1992, doi
//! 10.1002/fld.1650150306), in both gases.
//!
//! The published cavities have Prandtl numbers of 0.1 and 10, which no ideal gas has; this one is that of air, 0.69. The reference was computed for
//! it: stream function, vorticity and temperature (Boussinesq) on 128 × 128 and 256 × 256 points by Newton's method with second-order
//! differences, extrapolated. Of the upright cavity at a Prandtl number of 0.71 the same has a Nusselt number of 8.818 and a least stream function of
//! 16.79; Le Quere 1991 (doi 10.1016/0045-7930(91)90025-D) has 8.825 and 16.81.

use std::fs;
use std::path::Path;

use calcine::results::read;

use crate::blocks::{Block, even, rhombus};
use crate::run_with;
use crate::skewed_cavity::{Lines, least};

/// Side in m.
const SIDE: f64 = 0.1;
const DEGREES: f64 = 45.0;
const RAYLEIGH: f64 = 1e6;
/// Of the gas of the case at 300 K: kinematic viscosity in m²/s, Prandtl number.
const VISCOSITY: f64 = 18.46e-6 * 8.314_462_618 * 300.0 / (28.96e-3 * 1e5);
const PRANDTL: f64 = 1007.0 / 1458.44;
/// Cells along a side, from which results are extrapolated.
const CELLS: [usize; 2] = [40, 80];
const BAND: f64 = 0.01;
/// Nusselt number, largest u from floor to ceiling and v at half of the height and least stream function, by the diffusivity over the side.
const KNOWN: [f64; 4] = [7.3093, 64.025, 122.336, -14.4882];
/// Share of the largest change of any of these over the second half of a run that counts as steady.
const STEADY: f64 = 1e-4;

/// Both gases.
pub fn run() {
    let mut missed = Vec::new();
    for gas in ["native", "openfoam"] {
        let [coarse, fine] = CELLS.map(|cells| {
            let found = by(gas, cells);
            tell(gas, &format!("{cells} x {cells}"), &found);
            found
        });
        let squared = (CELLS[1] as f64 / CELLS[0] as f64).powi(2);
        let extrapolated = [0, 1, 2, 3].map(|k| (squared * fine[k] - coarse[k]) / (squared - 1.0));
        let off = tell(gas, "extrapolated", &extrapolated);
        if off.iter().any(|off| off.abs() > BAND) {
            missed.push(gas);
        }
    }
    assert!(missed.is_empty(), "off by more than 1 %: {missed:?}");
}

/// Prints what was found; by what share it is off the reference.
fn tell(gas: &str, mesh: &str, found: &[f64; 4]) -> [f64; 4] {
    let off = [0, 1, 2, 3].map(|k| found[k] / KNOWN[k] - 1.0);
    let percent = off.map(|off| format!("{:.2}", 100.0 * off)).join(", ");
    println!(
        "  {gas}, {mesh}: Nusselt number {:.4}, u {:.3}, v {:.3}, stream function {:.4}; off by {percent} %",
        found[0], found[1], found[2], found[3]
    );
    off
}

/// What a gas has of the cavity.
fn by(gas: &str, cells: usize) -> [f64; 4] {
    let folder = tempfile::tempdir().unwrap();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/heated-cavity.toml");
    let case = folder.path().join("case.toml");
    fs::copy(source, &case).unwrap();
    let depth = SIDE / cells as f64;
    let shape = rhombus(SIDE, DEGREES, depth);
    let block = Block {
        levels: [even(cells), even(cells), even(1)],
        patches: ["warm", "cold", "walls", "walls", "side", "side"],
        hole: None,
        shape: &shape,
    };
    block.write(folder.path());
    let (sine, cosine) = DEGREES.to_radians().sin_cos();
    let place = [
        0.5 * SIDE * (1.0 + cosine) + 1e-4,
        0.5 * SIDE * sine,
        0.5 * depth,
    ];
    let gravity = RAYLEIGH * VISCOSITY * VISCOSITY / PRANDTL * 300.0 / SIDE.powi(3);
    let set = [
        format!("time.motion_window={} s", 3.0 / cells as f64),
        format!("gas.gravity=0 {} 0 m/s^2", -gravity),
        format!(
            "particles[0].place.grid.first={} {} {} m",
            place[0], place[1], place[2]
        ),
    ];
    let (out, _) = run_with(&case, folder.path(), "out", &set, &["--gas", gas]);
    let files = read::collection(&out, "gas.pvd").unwrap();
    let values = |file: &Path| {
        let arrays = read::arrays(file).unwrap();
        let velocity = arrays["velocity"].values.as_chunks::<3>().0.to_vec();
        of(&velocity, &arrays["temperature"].values, cells)
    };
    let [before, end] = [&files[files.len() - 2], &files[files.len() - 1]];
    let [before, end] = [before, end].map(|file| values(&file.1));
    for (before, end) in before.iter().zip(end) {
        assert!((before / end - 1.0).abs() < STEADY, "{before} to {end}");
    }
    end
}

/// From velocities and temperatures, row after row from the floor.
fn of(velocity: &[[f64; 3]], temperature: &[f64], cells: usize) -> [f64; 4] {
    let (sine, cosine) = DEGREES.to_radians().sin_cos();
    let unit = VISCOSITY / PRANDTL / SIDE;
    let lines = Lines::of(velocity, cells, DEGREES, 0.0);
    // Through the plane between the two sides: what the gas carries, and what it conducts along the plane's normal.
    let middle = cells / 2;
    let [own, other] = [middle - 1, middle].map(|i| move |j: usize| i + cells * j);
    let mean = |j: usize| 0.5 * (temperature[own(j)] + temperature[other(j)]);
    let heat = |j: usize| {
        let (low, high) = (j.saturating_sub(1), (j + 1).min(cells - 1));
        let flow = [0, 1].map(|axis| 0.5 * (velocity[own(j)][axis] + velocity[other(j)][axis]));
        let carried = (flow[0] * sine - flow[1] * cosine) / unit * (mean(j) - 300.0);
        let across = (temperature[other(j)] - temperature[own(j)]) * cells as f64;
        let along = (mean(high) - mean(low)) * cells as f64 / (high - low) as f64;
        carried - (across - cosine * along) / sine
    };
    let nusselt = (0..cells).map(heat).sum::<f64>() / cells as f64;
    [
        nusselt,
        least(&lines.up, -1.0) / unit,
        least(&lines.across, -1.0) / unit,
        lines.stream / unit,
    ]
}
