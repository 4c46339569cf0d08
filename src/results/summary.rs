//! `summary.json`: what was run and what came out, under stable names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calcine_coupler::ledger::{CarriedInventory, Ledger};
use serde::{Deserialize, Serialize};

use super::files::{self, COMPARISON, number};
use super::flows::FlowSummary;
use super::inertial_number::InertialNumberStatistics;
use super::steps::StepSummary;
use super::warnings::Warnings;
use super::{ResultsError, SUMMARY};
use crate::case::units::{short, shown};

/// How a quantity, or the run, stands against what the case expects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The run goes on, or was killed.
    Running,
    /// The run stopped early, at a checkpoint or with an error.
    Stopped,
    /// Inside its band.
    Pass,
    /// Outside its band.
    Fail,
    /// Nothing is expected.
    None,
}

impl Verdict {
    /// The word in the file.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Running => "running",
            Verdict::Stopped => "stopped",
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
            Verdict::None => "none",
        }
    }

    /// The state of the run in `status.json`: `running`, `stopped` or `complete`.
    pub(super) fn state(self) -> &'static str {
        match self {
            Verdict::Running | Verdict::Stopped => self.word(),
            Verdict::Pass | Verdict::Fail | Verdict::None => "complete",
        }
    }
}

/// The file; wall times are in s, other units are in the names or beside the values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of these names.
    pub format: u32,
    /// Version of Calcine.
    pub calcine: String,
    /// The case.
    pub case: CaseName,
    /// The run whose results this one continued from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Provenance>,
    /// The verdict over all quantities.
    pub verdict: Verdict,
    /// The kinds of solver, `native`, `openfoam`, `liggghts`.
    pub backend: Backends,
    /// The two solvers with version and ranks.
    pub solver: SolverSummaries,
    /// How the coordinator talks to the solvers.
    pub transport: String,
    /// Over which clock the gas stores.
    pub storage: String,
    /// The acceleration schedule: process time in s from which a factor holds, and the factor.
    pub acceleration: Vec<(f64, f64)>,
    /// Motion time reached, in s.
    pub motion_time_s: f64,
    /// Process time reached, in s.
    pub process_time_s: f64,
    /// Process time at which the case ends, in s.
    pub process_end_s: f64,
    /// Windows committed.
    pub windows: u64,
    /// Particles in the bed.
    pub particles: usize,
    /// Cells of the gas mesh.
    pub cells: usize,
    /// Particles that came and went.
    #[serde(default)]
    pub passed: PassedParticles,
    /// What passed into and out of gas and particles.
    #[serde(default)]
    pub flows: FlowSummary,
    /// The ledger.
    pub ledger: LedgerSummary,
    /// Wall times by stage in s, over all processes of the run.
    pub wall_time_s: WallTimes,
    /// Processor time of the two solvers in s, over all processes of the run.
    #[serde(default)]
    pub processor_time_s: ProcessorTimes,
    /// Wall time of the phases of a gas that tells them in s, by name.
    #[serde(default)]
    pub gas_phases_s: BTreeMap<String, f64>,
    /// Quantities of interest by name.
    pub quantities: BTreeMap<String, QuantityResult>,
    /// Convergence of the gas, over the run.
    pub convergence: ConvergenceSummary,
    /// Windows and the errors of their steps.
    #[serde(default)]
    pub steps: StepSummary,
    /// What the smoother moved.
    #[serde(default)]
    pub smoother: SmootherSummary,
    /// What `calcine check` warns of in the case, in its words.
    #[serde(default)]
    pub case_warnings: Vec<String>,
    /// What was outside the ranges of laws, or did not converge, by kinds.
    #[serde(default)]
    pub warnings: Warnings,
    /// SHA-256 of `results.h5` as a run that was stopped left it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub results_sum: Option<String>,
    /// Why the run ended with an error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<RunFailure>,
    /// How far a bed that moves accelerated is from quasi-static.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pace: Option<InertialNumberStatistics>,
}

/// The error with which a run ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunFailure {
    /// The exit code.
    pub code: u8,
    /// The error and what caused it.
    pub message: String,
}

/// The case of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseName {
    /// Its name.
    pub name: String,
    /// Its title.
    pub title: String,
    /// SHA-256 of its effective text and of the files that it reads.
    pub hash: String,
    /// SHA-256 of what is in each of these files, by the key that names it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, String>,
}

/// Another run, as it stood when this one continued from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Its results folder, absolute.
    pub path: PathBuf,
    /// Name of its case.
    pub case: String,
    /// SHA-256 of its case's effective text.
    pub hash: String,
    /// Process time that it had reached, in s.
    pub process_time_s: f64,
    /// Windows that it had committed.
    pub windows: u64,
    /// What that run had itself continued from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Box<Provenance>>,
}

/// One entry for the gas, one for the particles.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Backends {
    /// Kind of the gas solver.
    pub gas: String,
    /// Kind of the particle solver.
    pub particles: String,
}

/// The solvers as they name themselves.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolverSummaries {
    /// The gas solver.
    pub gas: SolverSummary,
    /// The particle solver.
    pub particles: SolverSummary,
}

/// One solver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolverSummary {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Ranks it ran on.
    pub ranks: usize,
}

/// Particles that came and went over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PassedParticles {
    /// By feeds.
    pub fed: PassedInventory,
    /// By outlets.
    pub discharged: PassedInventory,
    /// What was left of those that were used up, burnt for example, as they were taken out.
    pub used_up: PassedInventory,
    /// What left the gas mesh and was taken out.
    pub lost: PassedInventory,
}

impl PassedParticles {
    /// As the ledger has them.
    pub fn of(ledger: &Ledger) -> Self {
        let of = |inventory: &CarriedInventory| PassedInventory {
            rows: inventory.particles,
            mass_kg: inventory.mass,
            energy_j: inventory.enthalpy,
        };
        let [fed, discharged] = &ledger.fed_and_discharged;
        Self {
            fed: of(fed),
            discharged: of(discharged),
            used_up: of(&ledger.used_up),
            lost: of(&ledger.lost),
        }
    }
}

/// What particles carried.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PassedInventory {
    /// Number of rows; each stands for as many particles as its weight says.
    pub rows: u64,
    /// Their mass in kg.
    pub mass_kg: f64,
    /// Their energy in J, as their models count it.
    pub energy_j: f64,
}

/// The ledger's lines by their stable names; elements get a table of their own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LedgerSummary {
    /// `mass`, `energy`, `energy_exchange`, `momentum`, `gas_momentum`.
    #[serde(flatten)]
    pub lines: BTreeMap<String, LedgerLineSummary>,
    /// One line per element.
    pub elements: BTreeMap<String, LedgerLineSummary>,
}

/// One line of the ledger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LedgerLineSummary {
    /// Error over throughput (docs/theory.md, CON-2).
    #[serde(deserialize_with = "number")]
    pub relative_error: f64,
    /// Signed sum of what did not close, in `unit`.
    #[serde(deserialize_with = "number")]
    pub drift: f64,
    /// Sum over windows of the magnitude of what did not close, in `unit`.
    #[serde(deserialize_with = "number")]
    pub error: f64,
    /// Sum over windows of what moved, in `unit`.
    #[serde(deserialize_with = "number")]
    pub throughput: f64,
    /// Unit of the three amounts.
    pub unit: String,
}

/// Wall times in s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallTimes {
    /// Everything.
    pub total: f64,
    /// Waiting for the gas.
    pub gas: f64,
    /// Waiting for the particles.
    pub particles: f64,
    /// Inside particles.
    pub interior: f64,
    /// Mapping particles onto cells.
    pub mapping: f64,
    /// The smoother.
    pub smoother: f64,
    /// Laws between the phases.
    pub exchange: f64,
    /// Results and checkpoints.
    pub output: f64,
}

impl WallTimes {
    /// The stages by name, without the total.
    pub fn stages(&self) -> [(&'static str, f64); 7] {
        [
            ("gas", self.gas),
            ("particles", self.particles),
            ("interior", self.interior),
            ("mapping", self.mapping),
            ("smoother", self.smoother),
            ("exchange", self.exchange),
            ("output", self.output),
        ]
    }
}

/// Processor times in s: of this process while it waits for a solver, and of the solver's own processes on this
/// machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProcessorTimes {
    /// The gas.
    pub gas: f64,
    /// The particles.
    pub particles: f64,
}

/// A quantity at the end of the run, or at the process time at which a value is expected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct QuantityResult {
    /// Its value in `unit`; `null` where it is not known yet.
    pub value: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// Process time of the value in s.
    pub at_s: Option<f64>,
    /// Smallest and largest value that pass, in `unit`; `null` where nothing is expected.
    pub band: Option<(f64, f64)>,
    /// Process time in s for which the band is stated; without it that is the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected_at_s: Option<f64>,
    /// `pass`, `fail`, `none`, or `running` before the value is known.
    pub verdict: Verdict,
}

impl QuantityResult {
    /// The band in words, with the time for which it is stated.
    pub fn expectation(&self) -> Option<String> {
        let (low, high) = self.band?;
        let time = self.expected_at_s;
        let time = time.map_or("the end".into(), |time| format!("{} s", shown(time)));
        let unit = &self.unit;
        Some(format!(
            "{} to {} {unit} at {time}",
            short(low),
            short(high)
        ))
    }

    /// Why the quantity fails, in words; `ended`: process time in s at which the run ended. `None` where it does not
    /// fail.
    pub fn reason(&self, ended: f64) -> Option<String> {
        let expected = match self.verdict {
            Verdict::Fail => self.expectation()?,
            _ => return None,
        };
        let late = self.expected_at_s.is_some_and(|time| time > ended);
        Some(match self.value {
            Some(_) => format!("expected {expected}"),
            None if late => format!(
                "expected {expected}, but the run ended at {} s: raise `time.end`, or lower `expect.at`",
                shown(ended)
            ),
            None => format!("expected {expected}, where it has no value"),
        })
    }
}

/// How the gas converged, over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ConvergenceSummary {
    /// Windows whose outer loop ended at its limit.
    pub unconverged_windows: u64,
    /// Outer iterations of all windows.
    pub outer_iterations: u64,
    /// Iterations of the linear solvers in all windows.
    pub linear_iterations: u64,
    /// Windows whose attempts ended with more of the exchange misplaced than tolerated.
    #[serde(default)]
    pub unsettled_windows: u64,
    /// Largest share of the exchange that a window left in the wrong cells of a particle.
    #[serde(default)]
    pub largest_misplaced: f64,
    /// Attempts of all windows.
    #[serde(default)]
    pub attempts: u64,
    /// How often windows were cut (`coupling.exchange.cuts`).
    #[serde(default)]
    pub cuts: u64,
    /// Largest scaled residual at the end of a window.
    #[serde(deserialize_with = "number")]
    pub largest_residual: f64,
    /// Largest volume residual of a window (docs/theory.md, CON-2).
    #[serde(deserialize_with = "number")]
    pub largest_volume_residual: f64,
}

/// What the smoother did to the bed (docs/theory.md, VFS-1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SmootherSummary {
    /// Share of the solid volume that it moved out of cells above `coupling.smoother.max_solid_fraction` in the last window.
    pub moved_share: f64,
    /// The largest such share of a window, or of the start.
    pub largest_moved_share: f64,
}

/// The kind of case whose results a folder holds; "bed" where it holds none, or states none.
pub fn kind(directory: &Path) -> String {
    let text = std::fs::read_to_string(directory.join(SUMMARY)).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    summary["kind"].as_str().unwrap_or("bed").to_owned()
}

/// Refuses a folder that holds no run.
pub fn must_hold_run(directory: &Path) -> Result<(), ResultsError> {
    if directory.join(SUMMARY).exists() {
        return Ok(());
    }
    Err(ResultsError::NoResults {
        path: directory.to_owned(),
        fact: match directory {
            one if one.is_file() => "it is a file; name the results folder of a run",
            one if !one.is_dir() => "there is no such folder",
            one if one.join(COMPARISON).exists() => {
                "it is that of a comparison, whose page is compare.html; its runs are in the folders below it"
            }
            _ => "it holds no summary.json",
        },
    })
}

impl Summary {
    /// Reads the summary of a result directory.
    pub fn read(directory: &Path) -> Result<Self, ResultsError> {
        must_hold_run(directory)?;
        let path = directory.join(SUMMARY);
        serde_json::from_str(&files::read(&path)?)
            .map_err(|error| ResultsError::content(&path, error.to_string()))
    }

    /// Replaces the summary of a result directory.
    pub(super) fn replace(&self, directory: &Path) -> Result<(), ResultsError> {
        files::replace_json(&directory.join(SUMMARY), self)
    }
}
