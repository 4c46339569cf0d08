//! The checkpoint of a plant: all that decides how its run goes on, and how far its files were written.

use std::path::{Path, PathBuf};

use calcine_flowsheet::PlantStep;
use serde::{Deserialize, Serialize};

use crate::results::{ResultsError, files};

/// Folder and name of the file.
const FOLDER: &str = "checkpoint";
const FILE: &str = "plant.json";

/// What is kept. Numbers are finite, so that JSON gives them back to the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PlantCheckpoint {
    /// SHA-256 of the case's values.
    pub case_hash: String,
    /// Rows of the series, the one of this moment included.
    pub rows: u64,
    /// Length of `series.csv` in bytes.
    pub series: u64,
    /// Length of `distributions.csv` in bytes.
    pub distributions: u64,
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
    /// Bytes of the series.
    pub series: u64,
    /// Bytes of the distributions.
    pub distributions: u64,
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
            series: written.series,
            distributions: written.distributions,
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

    /// Replaces the checkpoint of a results folder at once.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ResultsError> {
        files::directory(&folder.join(FOLDER))?;
        let path = folder.join(FOLDER).join(FILE);
        files::replace_json(&path, self)?;
        Ok(path)
    }

    /// The checkpoint of a results folder; `None` where it has none.
    pub fn read(folder: &Path) -> Result<Option<Self>, ResultsError> {
        let path = folder.join(FOLDER).join(FILE);
        if !path.is_file() {
            return Ok(None);
        }
        let read = serde_json::from_str(&files::read(&path)?);
        read.map(Some)
            .map_err(|error| ResultsError::content(&path, error.to_string()))
    }
}
