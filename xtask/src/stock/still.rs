//! Gas through beads that are held still, by DPMFoam and by Calcine: the pressure drop that each states, and that by the law of
//! Ergun, Wen and Yu over its own void fractions and velocities. Where these agree the laws are the same.

use std::fs;
use std::path::Path;

use super::beads::{Places, fluidised_places, written};
use super::programs::{CalcineRun, OpenFoamRun, Source};
use crate::openfoam::{internal_field, last_time};
use crate::snapshots::{self, appended};
use crate::steps::{Stop, TaskResult, step};
use crate::table::Table;
use crate::workspace::Workspace;

/// Step and end in s: the flow is steady then.
const STEP: f64 = 2e-4;
const END: f64 = 10e-3;
/// Diameter of the beads in m, density in kg/m³ and viscosity in Pa s of the gas, height of the box in m.
const DIAMETER: f64 = 2.5e-3;
const DENSITY: f64 = 1.2;
const VISCOSITY: f64 = 1.2e-5;
const HEIGHT: f64 = 0.45;

/// What holds the tutorial's beads still: a million times their mass, no weight, no contacts.
const HELD: [(&str, &str, &str); 3] = [
    (
        "constant/kinematicCloudProperties",
        "rho0            2526",
        "rho0            2.526e9",
    ),
    (
        "constant/kinematicCloudProperties",
        "collisionModel pairCollision;",
        "collisionModel none;",
    ),
    ("constant/g", "-9.81", "0"),
];
/// The same, with the velocity of a bead's cell in place of one between cells.
const HELD_BY_CELL: [(&str, &str, &str); 4] = [
    HELD[0],
    HELD[1],
    HELD[2],
    (
        "constant/kinematicCloudProperties",
        "U.air           cellPoint",
        "U.air           cell",
    ),
];
/// The tutorial's cells.
const CELLS: [u32; 3] = [2, 30, 90];
/// Those of `fixed-bed.toml`, and its spheres: first place and spacing in m, counts.
const LATTICE_CELLS: [u32; 3] = [3, 30, 90];
const LATTICE: ([f64; 3], f64, [u32; 3]) = ([1.25e-3, 1.25e-3, 101.25e-3], 2.5e-3, [6, 60, 68]);

const NO_DIFFUSION: &str = "coupling.smoother.diffusion_length=0 m";
const NO_LIMIT: &str = "coupling.smoother.max_solid_fraction=0.99";

/// A gas of Calcine with what its smoother is told.
const RUNS: [(&str, &str, &[&str]); 4] = [
    ("native", "native", &[]),
    ("native, no diffusion", "native", &[NO_DIFFUSION]),
    (
        "native, neither diffusion nor limit",
        "native",
        &[NO_DIFFUSION, NO_LIMIT],
    ),
    (
        "calcineGasFoam, neither diffusion nor limit",
        "openfoam",
        &[NO_DIFFUSION, NO_LIMIT],
    ),
];

pub fn table(workspace: &Workspace) -> TaskResult<Table> {
    let mut table = Table::new([
        "beads held still",
        "cells",
        "pressure drop, Pa",
        "law over its own fields, Pa",
    ]);
    let mut add = |bed: &str, name: &str, cells: [u32; 3], run: &dyn Fn() -> TaskResult<Drop>| {
        let drop = step(&format!("{name}, {bed}"), run)?;
        table.add([
            format!("{bed}: {name}"),
            format!("{}", cells.iter().product::<u32>()),
            format!("{:.1}", drop.stated),
            format!("{:.1}", drop.by_law),
        ]);
        Ok::<(), Stop>(())
    };
    let lattice = written(workspace, &lattice())?;
    for (name, changes) in dpm_foams() {
        let run = || dpm_foam(workspace, &lattice, LATTICE_CELLS, changes);
        add("lattice", name, LATTICE_CELLS, &run)?;
    }
    add("lattice", "native", LATTICE_CELLS, &|| {
        calcine(workspace, ("fixed-bed.toml", "native"), Vec::new())
    })?;
    let fluidised = fluidised_places(workspace)?;
    for (name, changes) in dpm_foams() {
        let run = || dpm_foam(workspace, &fluidised, CELLS, changes);
        add("fluidised", name, CELLS, &run)?;
    }
    for (name, gas, words) in RUNS {
        let mut settings: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
        settings
            .extend(["particles[0].motion=frozen", "gas.gravity=0 0 0 m/s^2"].map(str::to_owned));
        settings.push(fluidised.setting());
        let run = || calcine(workspace, ("beads.toml", gas), settings.clone());
        add("fluidised", name, CELLS, &run)?;
    }
    Ok(table)
}

type Changes = &'static [(&'static str, &'static str, &'static str)];

fn dpm_foams() -> [(&'static str, Changes); 2] {
    [
        ("DPMFoam", &HELD),
        ("DPMFoam, velocity of the cell", &HELD_BY_CELL),
    ]
}

/// A pressure drop in Pa as a program states it, and by the law over its fields.
struct Drop {
    stated: f64,
    by_law: f64,
}

fn dpm_foam(
    workspace: &Workspace,
    places: &Places,
    cells: [u32; 3],
    changes: Changes,
) -> TaskResult<Drop> {
    let stock = OpenFoamRun {
        solver: "DPMFoam",
        source: Source::Tutorial("lagrangian/DPMFoam/Goldschmidt"),
        step: STEP,
        cells: Some([cells, CELLS]),
        changes,
        positions: Some(places.positions.clone()),
    };
    let (run, folder) = stock.run(workspace, END)?;
    let last = last_time(&folder)?;
    let count = cells.iter().product::<u32>() as usize;
    let read = |name: &str| {
        let path = last.join(name);
        let text = fs::read_to_string(&path).map_err(|cause| Stop::io(&path, &cause))?;
        internal_field(&text, count).ok_or_else(|| no_field(&path, name))
    };
    drop_of(&run.samples, (&read("alpha.air")?, &read("U.air")?), &last)
}

fn calcine(
    workspace: &Workspace,
    (case, gas): (&str, &str),
    settings: Vec<String>,
) -> TaskResult<Drop> {
    let run = CalcineRun {
        case,
        pairing: [gas, "native"],
        settings,
        every: None,
        quantity: "pressure_drop",
    };
    let (run, results) = run.run(workspace, END)?;
    let snapshot = snapshots::last(&results.join("gas"), "vtu")?;
    let bytes = fs::read(&snapshot).map_err(|cause| Stop::io(&snapshot, &cause))?;
    let read = |name: &str| appended(&bytes, name).ok_or_else(|| no_field(&snapshot, name));
    drop_of(
        &run.samples,
        (&read("void_fraction")?, &read("velocity")?),
        &snapshot,
    )
}

fn no_field(path: &Path, name: &str) -> Stop {
    Stop(format!("{}: no field `{name}`", path.display()))
}

fn drop_of(
    samples: &[(f64, f64)],
    (void, velocity): (&[f64], &[f64]),
    from: &Path,
) -> TaskResult<Drop> {
    let stated = samples.last().map(|(_, drop)| *drop);
    let by_law = by_law(void, velocity);
    let pair = stated.zip(by_law);
    let (stated, by_law) = pair.ok_or_else(|| no_field(from, "void fraction and velocity"))?;
    Ok(Drop { stated, by_law })
}

/// Pressure drop in Pa by the drag in cells of one size, from their void fractions and interlaced interstitial velocities in m/s.
fn by_law(void: &[f64], velocity: &[f64]) -> Option<f64> {
    let velocities = velocity.as_chunks::<3>().0;
    if void.is_empty() || velocities.len() != void.len() {
        return None;
    }
    let each = void.iter().zip(velocities);
    let gradients = each.map(|(&void, velocity)| gradient(void, velocity));
    Some(gradients.sum::<f64>() / void.len() as f64 * HEIGHT)
}

/// Pressure gradient in Pa/m along z: Ergun's equation below a void fraction of 0.8, Wen and Yu's above, as `ErgunWenYuDrag` has them.
fn gradient(void: f64, velocity: &[f64; 3]) -> f64 {
    let speed = velocity.iter().map(|one| one * one).sum::<f64>().sqrt();
    let solid = 1.0 - void;
    let reynolds = DENSITY * speed * DIAMETER / VISCOSITY;
    let viscous = solid * VISCOSITY / (void * DIAMETER * DIAMETER);
    let coefficient = if void < 0.8 {
        viscous * (150.0 * solid / void + 1.75 * reynolds)
    } else {
        let superficial = void * reynolds;
        let drag = match superficial > 1000.0 {
            true => 0.44 * superficial,
            false => 24.0 * (1.0 + 0.15 * superficial.powf(0.687)),
        };
        0.75 * viscous * drag * void.powf(-2.65)
    };
    coefficient * velocity[2]
}

/// Places of the spheres of `fixed-bed.toml` in m, interlaced.
fn lattice() -> Vec<f64> {
    let (first, spacing, [nx, ny, nz]) = LATTICE;
    let mut points = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                for (first, number) in first.into_iter().zip([i, j, k]) {
                    points.push(first + spacing * f64::from(number));
                }
            }
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_over_an_even_bed_is_ergun_s_equation() {
        // 34 of 90 layers of touching spheres, 1.875 m/s: 150 μ (1 − ε)² u/(ε³ d²) + 1.75 (1 − ε) ρ u²/(ε³ d), 0.17 m.
        let void = 1.0 - std::f64::consts::PI / 6.0;
        let fractions: Vec<f64> = (0..90).map(|k| if k < 34 { void } else { 1.0 }).collect();
        let velocity = fractions.iter().flat_map(|void| [0.0, 0.0, 1.875 / void]);
        let velocity: Vec<f64> = velocity.collect();
        let drop = by_law(&fractions, &velocity).unwrap();
        assert!((drop - 2663.9114).abs() < 1e-3, "{drop}");
        assert_eq!(by_law(&fractions, &velocity[3..]), None);
    }

    #[test]
    fn wen_and_yu_s_drag_of_a_lone_sphere_is_that_of_schiller_and_naumann() {
        // Force on a sphere over its volume at ε → 1: 18 μ u/d² (1 + 0.15 Re^0.687), Re = 125 at 0.5 m/s.
        let solid = 1e-9;
        let found = gradient(1.0 - solid, &[0.0, 0.0, 0.5]) / solid;
        let stokes = 18.0 * 1.2e-5 * 0.5 / 2.5e-3f64.powi(2);
        let wanted = stokes * (1.0 + 0.15 * 125f64.powf(0.687));
        assert!((found / wanted - 1.0).abs() < 1e-6, "{found} {wanted}");
    }

    #[test]
    fn the_lattice_is_that_of_the_fixed_bed() {
        let points = lattice();
        assert_eq!(points.len(), 3 * 24_480);
        let last = &points[points.len() - 3..];
        for (place, wanted) in last.iter().zip([13.75e-3, 148.75e-3, 268.75e-3]) {
            assert!((place - wanted).abs() < 1e-12, "{last:?}");
        }
    }
}
