//! Runs of OpenFOAM's own solvers.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::case::{ErrorCase, ErrorQuantity, Resolution};
use super::field::{self, MeanField};
use super::measure::{Cost, measured};
use crate::steps::{Stop, TaskResult, quietly};

/// Where Debian's OpenFOAM finds its own dictionaries.
const PROJECT: (&str, &str) = ("WM_PROJECT_DIR", "/usr/share/openfoam");

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
    let tool = |words: &[&str]| {
        let mut command = Command::new(words[0]);
        command
            .args(&words[1..])
            .current_dir(folder)
            .env(PROJECT.0, PROJECT.1);
        command
    };
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

/// The folder of the latest time.
fn last_time(folder: &Path) -> TaskResult<PathBuf> {
    let entries = fs::read_dir(folder).map_err(|cause| Stop::io(folder, &cause))?;
    let times = entries.flatten().filter_map(|entry| {
        let time: f64 = entry.file_name().to_str()?.parse().ok()?;
        Some((time, entry.path()))
    });
    let last = times.max_by(|one, other| one.0.total_cmp(&other.0));
    let last = last.filter(|(time, _)| *time > 0.0);
    last.map(|(_, path)| path)
        .ok_or_else(|| Stop(format!("{}: no results", folder.display())))
}

fn write(path: &Path, text: &str) -> TaskResult<()> {
    fs::write(path, text).map_err(|cause| Stop::io(path, &cause))
}

/// Copies a folder with all that is in it.
pub fn copy(from: &Path, to: &Path) -> TaskResult<()> {
    fs::create_dir_all(to).map_err(|cause| Stop::io(to, &cause))?;
    for entry in fs::read_dir(from)
        .map_err(|cause| Stop::io(from, &cause))?
        .flatten()
    {
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &to)?;
        } else {
            fs::copy(&path, &to).map_err(|cause| Stop::io(&path, &cause))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_time_is_found_by_its_number() {
        let folder = std::env::temp_dir().join(format!("xtask times {}", std::process::id()));
        for name in ["0", "9.5", "10", "constant"] {
            fs::create_dir_all(folder.join(name)).unwrap();
        }
        let last = last_time(&folder).unwrap();
        for name in ["9.5", "10"] {
            fs::remove_dir(folder.join(name)).unwrap();
        }
        let none = last_time(&folder);
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(last, folder.join("10"));
        assert!(none.is_err());
    }
}
