//! The tutorial MPPICFoam/Goldschmidt: 24 750 parcels in a flat bed, on its own cells and on those of DPMFoam's.

use super::comparison::{Contestant, StockComparison};
use super::programs::{CalcineRun, OpenFoamRun, Source};
use crate::runs::LOOSE;
use crate::steps::TaskResult;
use crate::table::Table;
use crate::workspace::Workspace;

/// The tutorial's step in s, and Calcine's window.
const STEP: f64 = 2e-4;
/// Cells of the tutorial, and of DPMFoam/Goldschmidt.
const CELLS: [[u32; 3]; 2] = [[1, 15, 45], [2, 30, 90]];
const EXPLICIT: &[&str] = &["motion.parcels.packing=explicit"];
/// What the implicit stress of OpenFOAM's cloud needs.
const FLOOR: &[&str] = &["motion.parcels.floor=0.01"];

/// Name, solvers of gas and parcels, whether the tolerances are OpenFOAM's, and further words.
type Parcels = (
    &'static str,
    [&'static str; 2],
    bool,
    &'static [&'static str],
);
const RUNS: [Parcels; 4] = [
    ("native", ["native", "native"], false, &[]),
    ("native, loose", ["native", "native"], true, &[]),
    (
        "native, loose, explicit stress",
        ["native", "native"],
        true,
        EXPLICIT,
    ),
    (
        "calcineGasFoam with OpenFOAM's parcels, loose",
        ["openfoam", "openfoam"],
        true,
        FLOOR,
    ),
];

/// On the tutorial's cells.
pub fn coarse(workspace: &Workspace) -> TaskResult<Table> {
    table(workspace, "24 750 parcels in 675 cells", CELLS[0])
}

/// On the cells of DPMFoam's tutorial.
pub fn fine(workspace: &Workspace) -> TaskResult<Table> {
    table(workspace, "24 750 parcels in 5400 cells", CELLS[1])
}

fn table(workspace: &Workspace, title: &'static str, cells: [u32; 3]) -> TaskResult<Table> {
    let stock = OpenFoamRun {
        solver: "MPPICFoam",
        source: Source::Tutorial("lagrangian/MPPICFoam/Goldschmidt"),
        step: STEP,
        cells: Some([cells, CELLS[0]]),
        // Which Calcine has too.
        changes: &[(
            "constant/kinematicCloudProperties",
            "PlessisMasliyahDrag",
            "ErgunWenYuDrag",
        )],
        positions: None,
    };
    let mut contestants = vec![Contestant::new("MPPICFoam", "0.2 ms", move |end| {
        stock.to(workspace, end)
    })];
    for (name, pairing, loose, words) in RUNS {
        contestants.push(Contestant::new(name, "0.2 ms", move |end| {
            let mut settings = vec![format!("mesh.box.cells={cells:?}")];
            let loose = LOOSE.iter().filter(|_| loose);
            settings.extend(loose.chain(words).map(|&word| word.to_owned()));
            let run = CalcineRun {
                case: "parcels.toml",
                pairing,
                settings,
                every: Some(STEP),
                quantity: "pressure_drop",
            };
            run.to(workspace, end)
        }));
    }
    let comparison = StockComparison {
        title,
        figure: "pressure drop, Pa",
        ends: [10e-3, 50e-3],
    };
    comparison.table(&contestants)
}
