//! How the programs are run: Calcine, OpenFOAM's solvers with their pressure at the bottom, and LIGGGHTS.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::comparison::Run;
use crate::measure::{Cost, measured};
use crate::openfoam::{copy, tool, write};
use crate::runs;
use crate::steps::{Stop, TaskResult, quietly};
use crate::workspace::{CargoProfile, Workspace};

/// Where Debian's package openfoam-examples has the tutorials.
const TUTORIALS: &str = "/usr/share/doc/openfoam-examples/examples";
/// Density of the gas in kg/m³: OpenFOAM's pressures are divided by it.
const GAS_DENSITY: f64 = 1.2;

/// A folder below `of-cases/goldschmidt`, or a file in it.
pub fn files(workspace: &Workspace, name: &str) -> PathBuf {
    workspace.root.join("of-cases/goldschmidt").join(name)
}

/// An empty folder for a program's files.
pub fn fresh(workspace: &Workspace, name: &str) -> TaskResult<PathBuf> {
    let folder = workspace.target.join("xtask/stock").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(|cause| Stop::io(&folder, &cause))?;
    Ok(folder)
}

fn ended((cost, success): (Cost, bool), log: &Path) -> TaskResult<Cost> {
    match success {
        true => Ok(cost),
        false => Err(Stop(format!("it failed; see {}", log.display()))),
    }
}

/// A run of Calcine.
pub struct CalcineRun<'a> {
    /// File below `of-cases/goldschmidt`.
    pub case: &'a str,
    /// Solvers as the command line has them: of gas and particles.
    pub pairing: [&'a str; 2],
    pub settings: Vec<String>,
    /// Time between samples in s; only the end without it.
    pub every: Option<f64>,
    /// The quantity that is compared.
    pub quantity: &'a str,
}

impl CalcineRun<'_> {
    /// Runs it to a time in s on one core.
    pub fn to(&self, workspace: &Workspace, end: f64) -> TaskResult<Run> {
        Ok(self.run(workspace, end)?.0)
    }

    /// The same with the folder of its results; the next run takes its place.
    pub fn run(&self, workspace: &Workspace, end: f64) -> TaskResult<(Run, PathBuf)> {
        let (cost, results) = self.start(workspace, end)?;
        let series = results.join("series.csv");
        let text = fs::read_to_string(&series).map_err(|cause| Stop::io(&series, &cause))?;
        let samples = column(&text, self.quantity)
            .ok_or_else(|| Stop(format!("{}: no {}", series.display(), self.quantity)))?;
        Ok((Run { cost, samples }, results))
    }

    fn start(&self, workspace: &Workspace, end: f64) -> TaskResult<(Cost, PathBuf)> {
        let folder = fresh(workspace, "calcine")?;
        let mut settings = self.settings.clone();
        settings.push(format!("time.end={} us", micro(end)));
        settings.push(format!("output.every={} us", micro(end)));
        let every = self.every.unwrap_or(end);
        settings.push(format!("output.series_every={} us", micro(every)));
        let release = workspace.target.join(CargoProfile::Release.folder());
        let mut command = Command::new(release.join("calcine"));
        let [gas, particles] = self.pairing;
        let results = folder.join("out");
        command
            .arg("run")
            .arg(files(workspace, self.case))
            .args(["--quiet", "--threads", "1"])
            .args(["--gas", gas, "--particles", particles])
            .args(runs::set(&settings))
            .arg("--out")
            .arg(&results);
        let log = folder.join("log");
        let cost = ended(measured(&command, &log)?, &log)?;
        Ok((cost, results))
    }
}

/// Whole microseconds of a time in s.
fn micro(time: f64) -> u64 {
    (1e6 * time).round() as u64
}

/// Process times and values of a quantity from `series.csv`.
fn column(text: &str, quantity: &str) -> Option<Vec<(f64, f64)>> {
    let mut lines = text.lines();
    let head = format!("quantities.{quantity} [");
    let place = lines
        .next()?
        .split(',')
        .position(|name| name.starts_with(&head))?;
    let row = |line: &str| {
        let time = line.split(',').next()?.parse().ok()?;
        Some((time, line.split(',').nth(place)?.parse().ok()?))
    };
    lines.map(row).collect()
}

/// Where an OpenFOAM case comes from.
pub enum Source {
    /// A tutorial of Debian's package.
    Tutorial(&'static str),
    /// A folder below `of-cases/goldschmidt`.
    Own(&'static str),
}

/// A run of one of OpenFOAM's own solvers.
pub struct OpenFoamRun {
    pub solver: &'static str,
    pub source: Source,
    /// Step in s.
    pub step: f64,
    /// Cells of the one block, and those of the source.
    pub cells: Option<[[u32; 3]; 2]>,
    /// Words in files of the source with those that stand in their place.
    pub changes: &'static [(&'static str, &'static str, &'static str)],
    /// A file that takes the place of `constant/kinematicCloudPositions`.
    pub positions: Option<PathBuf>,
}

impl OpenFoamRun {
    /// Runs it to a time in s on one core; its figure is the mean pressure at the bottom in Pa above the top's.
    pub fn to(&self, workspace: &Workspace, end: f64) -> TaskResult<Run> {
        Ok(self.run(workspace, end)?.0)
    }

    /// The same with the folder of the case; the next run takes its place.
    pub fn run(&self, workspace: &Workspace, end: f64) -> TaskResult<(Run, PathBuf)> {
        let folder = fresh(workspace, "openfoam")?;
        let from = match self.source {
            Source::Tutorial(name) => Path::new(TUTORIALS).join(name),
            Source::Own(name) => files(workspace, name),
        };
        copy(&from, &folder)?;
        change(&folder.join("system/controlDict"), |text| {
            Some(text + &controls(self.step, end))
        })?;
        if let Some([cells, source]) = self.cells {
            change(&folder.join("system/blockMeshDict"), |text| {
                with_cells(&text, cells, source)
            })?;
        }
        for (file, old, new) in self.changes {
            change(&folder.join(file), |text| {
                text.contains(old).then(|| text.replace(old, new))
            })?;
        }
        if let Some(positions) = &self.positions {
            let own = folder.join("constant/kinematicCloudPositions");
            let _ = fs::remove_file(own.with_extension("gz"));
            fs::copy(positions, &own).map_err(|cause| Stop::io(positions, &cause))?;
        }
        let log = folder.join("log");
        quietly(
            &mut tool(&folder, &["blockMesh"]),
            &folder.join("log.blockMesh"),
        )?;
        let cost = ended(measured(&tool(&folder, &[self.solver]), &log)?, &log)?;
        let told = folder.join("postProcessing/drop/0/surfaceFieldValue.dat");
        let text = fs::read_to_string(&told).map_err(|cause| Stop::io(&told, &cause))?;
        let samples = pressures(&text)
            .ok_or_else(|| Stop(format!("{}: not times and pressures", told.display())))?;
        Ok((Run { cost, samples }, folder))
    }
}

fn change(path: &Path, how: impl Fn(String) -> Option<String>) -> TaskResult<()> {
    let text = fs::read_to_string(path).map_err(|cause| Stop::io(path, &cause))?;
    let changed = how(text).ok_or_else(|| {
        Stop(format!(
            "{}: not the tutorial that is expected",
            path.display()
        ))
    })?;
    write(path, &changed)
}

/// What goes behind a `controlDict`: of entries that are there twice OpenFOAM takes the last. Only the last step is written.
fn controls(step: f64, end: f64) -> String {
    format!(
        "\nendTime {end:?};\ndeltaT {step:?};\nwriteControl runTime;\nwriteInterval {end:?};\nwriteFormat ascii;\nrunTimeModifiable no;\n\
         functions\n{{\n    drop\n    {{\n        type surfaceFieldValue;\n        libs (fieldFunctionObjects);\n        \
         writeFields no;\n        log no;\n        regionType patch;\n        name bottom;\n        operation areaAverage;\n        \
         fields (p);\n        writeControl timeStep;\n        writeInterval 1;\n    }}\n}}\n"
    )
}

/// A `blockMeshDict` with another number of cells in place of those that it has.
fn with_cells(text: &str, cells: [u32; 3], source: [u32; 3]) -> Option<String> {
    let words = |[nx, ny, nz]: [u32; 3]| format!("({nx} {ny} {nz}) simpleGrading");
    let old = words(source);
    text.contains(&old)
        .then(|| text.replace(&old, &words(cells)))
}

/// Times and pressures in Pa from what the function object wrote.
fn pressures(text: &str) -> Option<Vec<(f64, f64)>> {
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    let row = |line: &str| {
        let mut words = line.split_whitespace().map(str::parse::<f64>);
        let time = words.next()?.ok()?;
        Some((time, GAS_DENSITY * words.next()?.ok()?))
    };
    rows.map(row).collect()
}

/// LIGGGHTS with a script of `of-cases/goldschmidt/liggghts` in steps of so many s; its figure is the last column of its last row.
pub fn liggghts(workspace: &Workspace, script: &str, step: f64, end: f64) -> TaskResult<Run> {
    let folder = fresh(workspace, "liggghts")?;
    let steps = (end / step).round().to_string();
    let script = files(workspace, "liggghts").join(script);
    let mut command = Command::new("liggghts");
    command
        .current_dir(&folder)
        .arg("-in")
        .arg(&script)
        .args([
            "-var",
            "steps",
            &steps,
            "-var",
            "step",
            &format!("{step:?}"),
        ])
        .args(["-log", "none"]);
    let log = folder.join("log");
    let cost = ended(measured(&command, &log)?, &log)?;
    let text = fs::read_to_string(&log).map_err(|cause| Stop::io(&log, &cause))?;
    let figure =
        row_of(&text, &steps).ok_or_else(|| Stop(format!("{}: no last row", log.display())))?;
    Ok(Run {
        cost,
        samples: vec![(end, figure)],
    })
}

/// The last column of the row of a step.
fn row_of(text: &str, step: &str) -> Option<f64> {
    let mut rows = text
        .lines()
        .filter(|line| line.split_whitespace().next() == Some(step));
    rows.next()?.split_whitespace().last()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read_as_each_program_writes_them() {
        let series = "process_time [s],motion_time [s],quantities.pressure_drop [Pa]\n0.0,0.0,1.5\n0.1,0.1,2.5\n";
        assert_eq!(
            column(series, "pressure_drop"),
            Some(vec![(0.0, 1.5), (0.1, 2.5)])
        );
        assert_eq!(column(series, "drop"), None);
        let told =
            "# Region type : patch bottom\n# Time \tareaAverage(p)\n2e-05         \t1.000000e+02\n";
        assert_eq!(pressures(told), Some(vec![(2e-5, 120.0)]));
        let log = "    Step    Atoms         height \n       0    24750 0.1485 \n    2000    24750 0.139120462 \nLoop time of 3.6\n";
        assert_eq!(row_of(log, "2000"), Some(0.139120462));
        assert_eq!(row_of(log, "4000"), None);
    }

    #[test]
    fn a_tutorial_with_other_cells_is_refused() {
        let text = "    hex (0 1 2 3 4 5 6 7) (1 15 45) simpleGrading (1 1 1)\n";
        let finer = with_cells(text, [2, 30, 90], [1, 15, 45]).unwrap();
        assert!(finer.contains("(2 30 90) simpleGrading (1 1 1)"), "{finer}");
        assert_eq!(with_cells(text, [2, 30, 90], [3, 15, 45]), None);
    }
}
