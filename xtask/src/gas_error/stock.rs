//! Runs of OpenFOAM's own solvers.

use std::fs;
use std::path::Path;

use super::case::{ErrorCase, ErrorQuantity, Resolution};
use super::field::{self, MeanField};
use crate::measure::{Cost, measured};
use crate::openfoam::{self, copy, last_time, write};
use crate::steps::{TaskResult, quietly};

/// How a solver steps in time.
#[derive(Clone, Copy, Debug)]
pub struct Time {
    /// OpenFOAM's name of the scheme.
    pub scheme: &'static str,
    /// Outer corrections of a step, where the solver has them.
    pub outer: u32,
}

/// As tutorials have it.
pub const USUAL: Time = Time {
    scheme: "Euler",
    outer: 1,
};
/// Of second order, with what is needed so that all equations of a step hold.
pub const ACCURATE: Time = Time {
    scheme: "backward",
    outer: 2,
};

/// Runs a case of `from` in `folder` on so many ranks; its cost, and its fields where it
/// came to its end.
pub fn run(
    case: &ErrorCase,
    from: &Path,
    folder: &Path,
    (resolution, time, ranks): (Resolution, Time, usize),
) -> TaskResult<(Cost, Option<Vec<MeanField>>)> {
    let _ = fs::remove_dir_all(folder);
    copy(from, folder)?;
    let [nx, ny] = case.cells(resolution);
    let (step, end) = (resolution.step, case.end);
    let (Time { scheme, outer }, half) = (time, ny / 2);
    let text = format!(
        "nx {nx};\nny {ny};\nhalf {half};\ndeltaT {step:?};\nendTime {end:?};\nddt {scheme};\nouter {outer};\n"
    );
    write(&folder.join("parameters"), &text)?;
    if let Some(start) = &case.start {
        start.write_openfoam(&folder.join("0"), [nx, ny], ("empty", true))?;
    }
    let log = folder.join("log.preparation");
    let tool = |words: &[&str]| openfoam::tool(folder, words);
    quietly(&mut tool(&["blockMesh"]), &log)?;
    if folder.join("system/topoSetDict").exists() {
        quietly(&mut tool(&["topoSet"]), &log)?;
    }
    let solver = case.stock;
    let number = ranks.to_string();
    let words = if ranks == 1 {
        vec![solver]
    } else {
        write(
            &folder.join("system/decomposeParDict"),
            &decomposition(ranks),
        )?;
        quietly(&mut tool(&["decomposePar"]), &log)?;
        vec![
            "mpirun",
            "--allow-run-as-root",
            "-n",
            &number,
            solver,
            "-parallel",
        ]
    };
    let (cost, success) = measured(&tool(&words), &folder.join("log"))?;
    if !success {
        return Ok((cost, None));
    }
    if ranks > 1 {
        quietly(&mut tool(&["reconstructPar", "-latestTime"]), &log)?;
    }
    let last = last_time(folder)?;
    let read = |quantity: &ErrorQuantity| {
        field::of_openfoam(&last.join(quantity.openfoam), case.cells(resolution))
    };
    let fields: TaskResult<Vec<MeanField>> = case.quantities.iter().map(read).collect();
    Ok((cost, Some(fields?)))
}

fn decomposition(ranks: usize) -> String {
    format!(
        "FoamFile {{ version 2.0; format ascii; class dictionary; object decomposeParDict; }}\n\
         numberOfSubdomains {ranks};\nmethod simple;\nsimpleCoeffs {{ n ({ranks} 1 1); delta 0.001; }}\n"
    )
}
