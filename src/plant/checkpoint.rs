//! The checkpoint of a plant: all that decides how its run goes on, and how far its files were written.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use calcine_coupler::coordinator::CheckpointPaths;
use calcine_flowsheet::PlantStep;
use serde::{Deserialize, Serialize};

use super::error::PlantRunError;
use crate::case::units::shown;
use crate::results::marked::FileMark;
use crate::results::{ResultsError, files};

/// Name of the file.
const FILE: &str = "plant.json";

/// Where the checkpoints of a plant are: the last one and that before it, each with the sums of its files.
pub(super) fn paths(folder: &Path) -> CheckpointPaths {
    CheckpointPaths::of(folder, FILE)
}

/// What is kept. Numbers are finite, so that JSON gives them back to the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PlantCheckpoint {
    /// SHA-256 of the case's values.
    pub case_hash: String,
    /// Rows of the series, the one of this moment included.
    pub rows: u64,
    /// How far `series.csv` was.
    pub series: FileMark,
    /// How far `distributions.csv` was.
    pub distributions: FileMark,
    /// Time in s of the next distributions.
    pub next_distributions: f64,
    /// Wall time so far in s.
    pub wall: f64,
    /// Folder that the run began from.
    pub from: Option<String>,
    time: f64,
    unknowns: Vec<f64>,
    totals: Vec<f64>,
    streams: Vec<f64>,
    step: f64,
    window: f64,
    closures: Vec<f64>,
    held: Vec<Vec<f64>>,
    /// Windows of each bed.
    #[serde(default)]
    beds: Vec<u64>,
}

/// How far the files of a run are written.
pub(super) struct Written {
    /// Rows of the series.
    pub rows: u64,
    /// The series.
    pub series: FileMark,
    /// The distributions.
    pub distributions: FileMark,
    /// Time in s of the next distributions.
    pub next_distributions: f64,
    /// Wall time so far in s.
    pub wall: f64,
    /// Windows of each bed.
    pub beds: Vec<u64>,
}

impl PlantCheckpoint {
    /// A checkpoint of a run.
    pub fn new(case_hash: &str, written: &Written, from: Option<String>, step: PlantStep) -> Self {
        Self {
            case_hash: case_hash.to_owned(),
            rows: written.rows,
            series: written.series.clone(),
            distributions: written.distributions.clone(),
            next_distributions: written.next_distributions,
            wall: written.wall,
            from,
            time: step.time,
            unknowns: step.unknowns,
            totals: step.totals,
            streams: step.streams,
            step: step.step,
            window: step.window,
            closures: step.closures,
            held: step.held,
            beds: written.beds.clone(),
        }
    }

    /// Windows of each bed.
    pub fn beds(&self) -> &[u64] {
        &self.beds
    }

    /// What the run goes on from.
    pub fn step(self) -> PlantStep {
        PlantStep {
            time: self.time,
            unknowns: self.unknowns,
            totals: self.totals,
            streams: self.streams,
            step: self.step,
            window: self.window,
            closures: self.closures,
            held: self.held,
        }
    }

    /// The unknowns.
    pub fn unknowns(&self) -> &[f64] {
        &self.unknowns
    }

    /// Leaves it as the last checkpoint of a results folder, the one before beside it.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, PlantRunError> {
        let paths = paths(folder);
        let fresh = paths.fresh();
        match fs::remove_dir_all(&fresh) {
            Err(cause) if cause.kind() != ErrorKind::NotFound => {
                return Err(ResultsError::file("remove", &fresh)(cause).into());
            }
            _ => {}
        }
        let written = || -> Result<(), PlantRunError> {
            files::directory(&fresh)?;
            files::replace_json(&fresh.join(FILE), self)?;
            Ok(paths.publish()?)
        };
        written().inspect_err(|_| {
            // What could not be written fills the disk no longer; the last one stays.
            let _ = fs::remove_dir_all(&fresh);
        })?;
        Ok(paths.committed().join(FILE))
    }

    /// The newest whole checkpoint of a results folder, and what is wrong with a newer one; `None` where it has none.
    pub fn read(folder: &Path) -> Result<Option<(Self, Option<String>)>, PlantRunError> {
        let Some(whole) = paths(folder).newest_whole()? else {
            return Ok(None);
        };
        let path = whole.path.join(FILE);
        let read = serde_json::from_str(&files::read(&path)?);
        let read = read.map_err(|error| ResultsError::content(&path, error.to_string()))?;
        Ok(Some((read, whole.damage)))
    }

    /// The same of a run that goes on: the newest whole checkpoint becomes the last one. What is to be told of that.
    pub fn recover(folder: &Path) -> Result<Option<(Self, Option<String>)>, PlantRunError> {
        let paths = paths(folder);
        let damage = paths.recover()?;
        let Some((found, _)) = Self::read(folder)? else {
            return Ok(None);
        };
        let told = damage.map(|damage| {
            format!(
                "{damage}; the run goes on from the checkpoint before it, of {} s, and the damaged one is kept as {}",
                shown(found.time),
                paths.damaged().display()
            )
        });
        Ok(Some((found, told)))
    }
}
