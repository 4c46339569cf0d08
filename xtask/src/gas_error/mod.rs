//! `cargo xtask bench gas-error`: error against processor time of the native gas, calcineGasFoam and OpenFOAM's own
//! solvers, in one run and against one reference.

mod case;
mod cases;
mod cavity;
mod coupled;
mod field;
mod five_species;
mod front;
mod heated_cavity;
mod hot_duct;
mod report;
mod start;
mod stock;
mod taylor_green;

use std::env;
use std::fs;
use std::path::PathBuf;
use std::thread;

use case::{CoupledGas, ErrorCase, Reference, Resolution};
use coupled::Done;
use field::MeanField;
use report::ErrorRow;

use crate::measure::Cost;
use crate::packages::{self, Needs};
use crate::runs::LOOSE;
use crate::steps::{Stop, TaskResult, loud_step, say, step};
use crate::tasks::{self, BuildScope};
use crate::workspace::{CargoProfile, Workspace};

/// What is asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ErrorChoice {
    /// Names of cases; all of them if there are none.
    pub names: Vec<String>,
    /// Measures the programs that were built last.
    pub built: bool,
}

impl ErrorChoice {
    /// From the words behind `gas-error`; nothing where one is neither a case nor an option.
    pub fn read<'w>(words: impl Iterator<Item = Option<&'w str>>) -> Option<Self> {
        let mut choice = Self::default();
        for word in words {
            match word? {
                "--no-build" => choice.built = true,
                name if cases::ALL.iter().any(|case| case.name == name) => {
                    choice.names.push(name.to_owned());
                }
                _ => return None,
            }
        }
        Some(choice)
    }
}

/// Gases of Calcine: as cases have them unless they say otherwise, and with tolerances near those of OpenFOAM's
/// tutorials.
const GASES: [(&str, CoupledGas); 6] = [
    (
        "native",
        CoupledGas {
            gas: "native",
            set: &[],
            longer: 1,
        },
    ),
    (
        "native, two stages",
        CoupledGas {
            gas: "native",
            set: &["gas.controls.time_scheme=sdirk2"],
            longer: LONGER,
        },
    ),
    (
        "native, loose",
        CoupledGas {
            gas: "native",
            set: &LOOSE,
            longer: 1,
        },
    ),
    (
        "native, loose, two stages",
        CoupledGas {
            gas: "native",
            set: TWO_STAGES,
            longer: LONGER,
        },
    ),
    (
        "calcineGasFoam",
        CoupledGas {
            gas: "openfoam",
            set: &[],
            longer: 1,
        },
    ),
    (
        "calcineGasFoam, loose",
        CoupledGas {
            gas: "openfoam",
            set: &LOOSE,
            longer: 1,
        },
    ),
];
/// The same in windows of second order, which may be longer.
const TWO_STAGES: &[&str] = &[LOOSE[0], LOOSE[1], "gas.controls.time_scheme=sdirk2"];
const LONGER: u32 = 5;

/// Builds, measures, prints the tables and writes them below the target folder.
pub fn run(workspace: &Workspace, choice: &ErrorChoice) -> TaskResult<()> {
    let needs = Needs {
        openfoam: true,
        ..Needs::NATIVE
    };
    packages::install(needs, &workspace.logs)?;
    if !choice.built {
        let _lock = workspace.lock()?;
        tasks::build_parts(workspace, needs, BuildScope::Runs)?;
    }
    let chosen = |case: &&ErrorCase| {
        choice.names.is_empty() || choice.names.iter().any(|name| name == case.name)
    };
    let mut text = report::head();
    for case in cases::ALL.into_iter().filter(chosen) {
        let bench = Bench::new(workspace, case);
        text += &loud_step(case.name, || bench.run())?;
    }
    let path = workspace.target.join("xtask/gas-error.md");
    fs::write(&path, &text).map_err(|cause| Stop::io(&path, &cause))?;
    print(&text)?;
    say(&format!("written to {}", path.display()));
    Ok(())
}

fn print(text: &str) -> TaskResult<()> {
    use std::io::Write;
    let written = writeln!(std::io::stdout(), "\n{text}");
    written.map_err(|cause| Stop(format!("the tables cannot be printed: {cause}")))
}

/// The runs of one case.
struct Bench<'a> {
    case: &'a ErrorCase,
    /// Its files.
    from: PathBuf,
    /// Where it runs.
    folder: PathBuf,
    program: PathBuf,
}

impl<'a> Bench<'a> {
    fn new(workspace: &Workspace, case: &'a ErrorCase) -> Self {
        let release = workspace.target.join(CargoProfile::Release.folder());
        Self {
            case,
            from: workspace.root.join("of-cases/gas-error").join(case.name),
            folder: workspace.target.join("xtask/gas-error").join(case.name),
            program: release.join("calcine"),
        }
    }

    /// Measures all solvers; the tables as text.
    fn run(&self) -> TaskResult<String> {
        let _ = fs::remove_dir_all(&self.folder);
        fs::create_dir_all(&self.folder).map_err(|cause| Stop::io(&self.folder, &cause))?;
        let large = env::var_os("CALCINE_BENCH_LARGE").is_some();
        let reference = self.reference(large)?;
        let runs = if large {
            self.case.large
        } else {
            self.case.runs
        };
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let mut settings: Vec<(Resolution, usize)> = runs.iter().map(|&run| (run, 1)).collect();
        // On two cores the last of the runs alone.
        settings.extend(runs.last().filter(|_| cores > 1).map(|&run| (run, 2)));
        let mut rows = Vec::new();
        for (resolution, cores) in settings {
            rows.push(self.stock(&reference, resolution, cores)?);
            for (name, gas) in GASES {
                if self
                    .case
                    .finest(&gas, large)
                    .is_none_or(|finest| resolution.factor > finest)
                {
                    continue;
                }
                let resolution = Resolution {
                    step: f64::from(gas.longer) * resolution.step,
                    ..resolution
                };
                rows.push(self.coupled(&reference, (name, gas), resolution, cores)?);
            }
        }
        Ok(report::tables(self.case, &reference, &rows))
    }

    /// A row of OpenFOAM's own solver.
    fn stock(
        &self,
        reference: &[MeanField],
        resolution: Resolution,
        cores: usize,
    ) -> TaskResult<ErrorRow> {
        let (cost, fields) = self.stock_run((resolution, stock::USUAL, cores))?;
        let solver = self.case.stock.to_owned();
        let done = Done {
            cost,
            gas: None,
            iterations: None,
            fields,
        };
        self.row(reference, (solver, resolution, cores), done)
    }

    /// A row of a gas of Calcine.
    fn coupled(
        &self,
        reference: &[MeanField],
        (name, gas): (&str, CoupledGas),
        resolution: Resolution,
        cores: usize,
    ) -> TaskResult<ErrorRow> {
        let what = self.what(name, resolution, cores);
        let file = self.from.join("case.toml");
        let folder = self.folder.join(what.replace([' ', ','], "-"));
        let place = (self.program.as_path(), file.as_path());
        let settings = (gas, resolution, cores);
        let done = step(&what, || coupled::run(self.case, place, &folder, settings))?;
        let _ = fs::remove_dir_all(&folder);
        self.row(reference, (name.to_owned(), resolution, cores), done)
    }

    fn stock_run(
        &self,
        settings: (Resolution, stock::Time, usize),
    ) -> TaskResult<(Cost, Option<Vec<MeanField>>)> {
        let (resolution, time, ranks) = settings;
        let what = self.what(
            &format!("{} {}", self.case.stock, time.scheme),
            resolution,
            ranks,
        );
        let folder = self.folder.join(what.replace(' ', "-"));
        let from = self.from.join("stock");
        let done = step(&what, || stock::run(self.case, &from, &folder, settings))?;
        let _ = fs::remove_dir_all(&folder);
        Ok(done)
    }

    fn what(&self, solver: &str, resolution: Resolution, cores: usize) -> String {
        let [nx, ny] = self.case.cells(resolution);
        format!("{solver} {nx}x{ny} {:?} s on {cores}", resolution.step)
    }

    /// The fields that all others are compared with, on the cells of the coarsest mesh.
    fn reference(&self, large: bool) -> TaskResult<Vec<MeanField>> {
        match self.case.reference {
            Reference::Extrapolated(usual) => {
                let times = if large { 2 } else { 1 };
                let finest = Resolution {
                    factor: times * usual.factor,
                    step: usual.step / times as f64,
                };
                let coarser = Resolution {
                    factor: finest.factor / 2,
                    step: 2.0 * finest.step,
                };
                let get = |resolution| {
                    let (_, fields) = self.stock_run((resolution, stock::ACCURATE, 1))?;
                    let fields = fields.ok_or_else(|| Stop::new("the reference diverged"))?;
                    self.restricted(&fields)
                };
                let (finest, coarser) = (get(finest)?, get(coarser)?);
                let pairs = finest.iter().zip(&coarser);
                // Errors of second order in cell and step fall to a quarter.
                let third = 1.0 / 3.0;
                let each = pairs.map(|(finest, coarser)| {
                    MeanField::sum(&[(1.0 + third, finest), (-third, coarser)])
                });
                Ok(each.collect())
            }
            Reference::Exact(values, edge) => {
                let field = MeanField::means(self.case.coarsest, edge, values);
                Ok(vec![field.ok_or_else(|| {
                    Stop::new("the exact solution is not a field")
                })?])
            }
        }
    }

    fn restricted(&self, fields: &[MeanField]) -> TaskResult<Vec<MeanField>> {
        let each = fields
            .iter()
            .map(|field| field.restricted(self.case.coarsest));
        let all: Option<Vec<MeanField>> = each.collect();
        all.ok_or_else(|| Stop::new("cells do not fill those of the coarsest mesh"))
    }

    /// What a run gave, its fields on the coarsest mesh and their errors.
    fn row(
        &self,
        reference: &[MeanField],
        (solver, resolution, cores): (String, Resolution, usize),
        done: Done,
    ) -> TaskResult<ErrorRow> {
        let fields = done
            .fields
            .map(|fields| self.restricted(&fields))
            .transpose()?;
        let errors = fields.as_deref().map_or_else(
            || vec![f64::NAN; self.case.quantities.len()],
            |fields| self.case.errors(fields, reference),
        );
        let (cost, gas) = (done.cost, done.gas);
        let iterations = done.iterations;
        Ok(ErrorRow {
            solver,
            resolution,
            cores,
            cost,
            gas,
            iterations,
            fields,
            errors,
        })
    }
}
