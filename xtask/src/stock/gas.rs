//! Gas through a bed that does not move: pimpleFoam with a porous zone by Ergun's equation, and Calcine with the spheres.

use super::comparison::{Contestant, StockComparison};
use super::programs::{CalcineRun, OpenFoamRun, Source};
use crate::runs::LOOSE;
use crate::steps::TaskResult;
use crate::table::Table;
use crate::workspace::Workspace;

const STEP: f64 = 1e-3;

/// Name, solver of the gas, and whether the tolerances are OpenFOAM's.
const RUNS: [(&str, &str, bool); 3] = [
    ("native", "native", false),
    ("native, loose", "native", true),
    ("calcineGasFoam, loose", "openfoam", true),
];

pub fn table(workspace: &Workspace) -> TaskResult<Table> {
    let stock = OpenFoamRun {
        solver: "pimpleFoam",
        source: Source::Own("fixed-bed"),
        step: STEP,
        cells: None,
        changes: &[],
        positions: None,
    };
    let mut contestants = vec![Contestant::new("pimpleFoam", "1 ms", move |end| {
        stock.to(workspace, end)
    })];
    for (name, gas, loose) in RUNS {
        contestants.push(Contestant::new(name, "1 ms", move |end| {
            let loose = LOOSE.iter().filter(|_| loose);
            let run = CalcineRun {
                case: "fixed-bed.toml",
                pairing: [gas, "native"],
                settings: loose.map(|&word| word.to_owned()).collect(),
                every: Some(STEP),
                quantity: "pressure_drop",
            };
            run.to(workspace, end)
        }));
    }
    let comparison = StockComparison {
        title: "fixed bed of 24 480 spheres in 8100 cells",
        figure: "pressure drop, Pa",
        ends: [2e-3, 22e-3],
    };
    comparison.table(&contestants)
}
