//! The tutorial DPMFoam/Goldschmidt: 24 750 beads whose contacts are resolved, in a flat bed of 5400 cells; from its own start, where
//! they stand on a lattice and begin to fall, and from the places that they come to when they are fluidised.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use super::comparison::{Contestant, StockComparison};
use super::programs::{CalcineRun, OpenFoamRun, Source, fresh};
use crate::openfoam::write;
use crate::runs::LOOSE;
use crate::snapshots::{self, appended};
use crate::steps::{Stop, TaskResult, step};
use crate::table::Table;
use crate::workspace::Workspace;

/// The tutorial's step in s.
const TUTORIAL_STEP: f64 = 2e-5;
/// Calcine's window in s as its users have it.
const USUAL_WINDOW: f64 = 2e-4;
/// Ends of the shorter and of the longer run in s.
const ENDS: [f64; 2] = [2e-3, 10e-3];
/// When the beads are fluidised, in s.
const FLUIDISED: f64 = 0.3;
/// Half the tutorial's box across, in m: OpenFOAM's origin is at the middle of its bottom.
const MIDDLE: [f64; 3] = [7.5e-3, 75e-3, 0.0];

/// Solvers of gas and particles, and whether the tolerances are OpenFOAM's.
type Pairing = ([&'static str; 2], bool);
const NATIVE: Pairing = (["native", "native"], false);
const NATIVE_LOOSE: Pairing = (["native", "native"], true);
const BOTH_PRODUCTION: Pairing = (["openfoam", "liggghts"], true);
const AT_TUTORIAL_STEP: [Pairing; 3] = [NATIVE, NATIVE_LOOSE, BOTH_PRODUCTION];
const AT_USUAL_WINDOW: [Pairing; 5] = [
    NATIVE,
    NATIVE_LOOSE,
    (["native", "liggghts"], true),
    (["openfoam", "native"], true),
    BOTH_PRODUCTION,
];

/// Where beads are at the start, as either program reads it.
pub struct Places {
    /// For Calcine.
    pub table: PathBuf,
    /// For OpenFOAM.
    pub positions: PathBuf,
}

impl Places {
    /// What has Calcine's beads begin there.
    pub fn setting(&self) -> String {
        format!("particles[0].place={{ file = '{}' }}", self.table.display())
    }
}

/// From the tutorial's own start.
pub fn table(workspace: &Workspace) -> TaskResult<Table> {
    compared(workspace, "24 750 beads in 5400 cells", None)
}

/// From the places of fluidised beads, at rest.
pub fn fluidised(workspace: &Workspace) -> TaskResult<Table> {
    let places = fluidised_places(workspace)?;
    compared(
        workspace,
        "24 750 fluidised beads in 5400 cells",
        Some(&places),
    )
}

fn compared(
    workspace: &Workspace,
    title: &'static str,
    places: Option<&Places>,
) -> TaskResult<Table> {
    let stock = OpenFoamRun {
        solver: "DPMFoam",
        source: Source::Tutorial("lagrangian/DPMFoam/Goldschmidt"),
        step: TUTORIAL_STEP,
        cells: None,
        changes: &[],
        positions: places.map(|places| places.positions.clone()),
    };
    let mut contestants = vec![Contestant::new("DPMFoam", "20 µs", move |end| {
        stock.to(workspace, end)
    })];
    let steps = [
        (&AT_TUTORIAL_STEP[..], TUTORIAL_STEP, "20 µs"),
        (&AT_USUAL_WINDOW[..], USUAL_WINDOW, "0.2 ms"),
    ];
    for (pairings, window, shown) in steps {
        for &(pairing, loose) in pairings {
            let [gas, particles] = pairing;
            let tolerances = if loose { ", loose" } else { "" };
            let name = format!("{gas} gas, {particles} particles{tolerances}");
            contestants.push(Contestant::new(name, shown, move |end| {
                let mut settings = vec![format!("time.motion_window={:.0} us", 1e6 * window)];
                settings.extend(LOOSE.iter().filter(|_| loose).map(|&word| word.to_owned()));
                settings.extend(places.map(Places::setting));
                let run = CalcineRun {
                    case: "beads.toml",
                    pairing,
                    settings,
                    every: Some(window),
                    quantity: "pressure_drop",
                };
                run.to(workspace, end)
            }));
        }
    }
    let comparison = StockComparison {
        title,
        figure: "pressure drop, Pa",
        ends: ENDS,
    };
    comparison.table(&contestants)
}

/// Runs the bed natively until it is fluidised and writes where the beads are then.
pub fn fluidised_places(workspace: &Workspace) -> TaskResult<Places> {
    step("fluidise the beads natively", || {
        let run = CalcineRun {
            case: "beads.toml",
            pairing: NATIVE.0,
            settings: LOOSE.map(str::to_owned).to_vec(),
            every: None,
            quantity: "pressure_drop",
        };
        let (_, results) = run.run(workspace, FLUIDISED)?;
        let snapshot = snapshots::last(&results.join("particles"), "vtp")?;
        let bytes = fs::read(&snapshot).map_err(|cause| Stop::io(&snapshot, &cause))?;
        let points = appended(&bytes, "points")
            .ok_or_else(|| Stop(format!("{}: no points", snapshot.display())))?;
        written(workspace, &points)
    })
}

/// Writes places in m for both programs.
pub fn written(workspace: &Workspace, points: &[f64]) -> TaskResult<Places> {
    let folder = fresh(workspace, "places")?;
    let places = Places {
        table: folder.join("beads.csv"),
        positions: folder.join("kinematicCloudPositions"),
    };
    let (table, positions) = texts(points);
    write(&places.table, &table)?;
    write(&places.positions, &positions)?;
    Ok(places)
}

/// Places in m as a table for Calcine and as OpenFOAM's list about its own origin.
fn texts(points: &[f64]) -> (String, String) {
    let mut table = "x,y,z\n".to_owned();
    let mut positions = "FoamFile { version 2.0; format ascii; class vectorField; object kinematicCloudPositions; }\n(\n".to_owned();
    for [x, y, z] in points.as_chunks::<3>().0 {
        let [u, v, w] = [x - MIDDLE[0], y - MIDDLE[1], z - MIDDLE[2]];
        let _ = writeln!(table, "{x:.9},{y:.9},{z:.9}");
        let _ = writeln!(positions, "({u:.9} {v:.9} {w:.9})");
    }
    (table, positions + ")\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_written_about_either_origin() {
        let (table, positions) = texts(&[7.5e-3, 80e-3, 1e-3]);
        assert_eq!(table, "x,y,z\n0.007500000,0.080000000,0.001000000\n");
        assert!(
            positions.contains("\n(\n(0.000000000 0.005000000 0.001000000)\n)\n"),
            "{positions}"
        );
    }
}
