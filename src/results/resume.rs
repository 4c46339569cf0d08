//! What the recorder leaves in a checkpoint, and how it goes on from one.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use calcine_coupler::coordinator::sum_of_file;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::files::{DRAFT, gas_file, particle_file, probe_file};
use super::flows::FlowSummary;
use super::inertial_number::InertialNumberStatistics;
use super::marked::FileMark;
use super::moment::SnapshotMoment;
use super::passages::OutflowTrail;
use super::quantities::Captured;
use super::read::{Series, collection};
use super::steps::StepSummary;
use super::summary::{ConvergenceSummary, ProcessorTimes, Provenance, Summary, Verdict, WallTimes};
use super::warnings::Warnings;
use super::{CaseIdentity, same_case};
use super::{ResultsError, SERIES, STORE, SUMMARY, files};
use crate::case::model::Case;

/// Name of the counters in a checkpoint directory.
const COUNTERS: &str = "recorder.json";

/// Raised with every change of what is counted.
const FORMAT: u32 = 2;

/// The first bytes of an HDF5 file.
const HDF5_SIGNATURE: &[u8; 8] = b"\x89HDF\r\n\x1a\n";

/// Where the recorder stands: with the files of the results folder, cut back to it, all that it needs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Counters {
    /// Layout of the checkpoint.
    #[serde(default)]
    pub format: u32,
    /// How far `series.csv` was.
    #[serde(default)]
    pub series: FileMark,
    /// Hash of the case.
    pub case_hash: String,
    /// The run that this one continued from.
    #[serde(default)]
    pub from: Option<Provenance>,
    /// Process time of the next row at the earliest, in ps.
    pub next_row: i64,
    /// Process time of the next snapshot at the earliest, in ps.
    pub next_snapshot: i64,
    /// Process time of the last row in ps.
    pub last_row: Option<i64>,
    /// Process time of the last snapshot in ps.
    pub last_snapshot: Option<i64>,
    /// Rows written.
    pub rows: usize,
    /// The snapshots written.
    #[serde(default)]
    pub snapshots: Vec<SnapshotMoment>,
    /// SHA-256 of the file of the gas of each, of that of the particles, and of that of the probes where there are such.
    #[serde(default)]
    pub sums: Vec<Vec<String>>,
    /// Ids of the particles that have a column of their own.
    pub tracked: Vec<u64>,
    /// Quantities whose time has come.
    pub captured: Captured,
    /// Convergence so far.
    pub convergence: ConvergenceSummary,
    /// Windows and errors of their steps so far.
    #[serde(default)]
    pub steps: StepSummary,
    /// Largest share of the solid volume that the smoother moved so far.
    #[serde(default)]
    pub largest_moved_share: f64,
    /// What was outside the ranges of laws, or did not converge, so far.
    #[serde(default)]
    pub warnings: Warnings,
    /// Inertial number so far.
    #[serde(default)]
    pub pace: InertialNumberStatistics,
    /// What passed so far.
    #[serde(default)]
    pub flows: FlowSummary,
    /// What left through outlets before.
    #[serde(default)]
    pub outflow: OutflowTrail,
    /// Wall times so far.
    pub wall: WallTimes,
    /// Processor times so far.
    #[serde(default)]
    pub processor: ProcessorTimes,
    /// Wall times of the gas' phases so far.
    #[serde(default)]
    pub gas_phases: BTreeMap<String, f64>,
}

/// The files of a snapshot, that of the probes whether there are any or not.
fn all_snapshot_files(results: &Path, number: usize) -> [PathBuf; 3] {
    [gas_file(number), particle_file(number), probe_file(number)].map(|name| results.join(name))
}

/// The files that a snapshot has.
fn snapshot_files(results: &Path, number: usize) -> Vec<PathBuf> {
    let [gas, particles, probes] = all_snapshot_files(results, number);
    let mut files = vec![gas, particles];
    files.extend(Some(probes).filter(|path| path.is_file()));
    files
}

/// Flushes the files of the snapshots that came since the last checkpoint to the disk, and takes their sums.
pub(super) fn seal(results: &Path, counters: &mut Counters) -> Result<(), ResultsError> {
    for number in counters.sums.len()..counters.snapshots.len() {
        let sum =
            |path: PathBuf| sum_of_file(&path, true).map_err(ResultsError::file("flush", &path));
        let paths = snapshot_files(results, number);
        let sums = paths.into_iter().map(sum).collect::<Result<_, _>>()?;
        counters.sums.push(sums);
    }
    Ok(())
}

/// Refuses snapshots whose files are not what was written; of several the first is named.
fn check_snapshots(results: &Path, sums: &[Vec<String>]) -> Result<(), ResultsError> {
    let check = |(number, sums): (usize, &Vec<String>)| {
        for (path, expected) in all_snapshot_files(results, number).iter().zip(sums) {
            let found = sum_of_file(path, false).map_err(ResultsError::file("read", path))?;
            if found != *expected {
                let fact = "it has another content than was written";
                return Err(ResultsError::behind(path, fact));
            }
        }
        Ok(())
    };
    let found: Vec<Result<(), ResultsError>> = sums.par_iter().enumerate().map(check).collect();
    found.into_iter().collect()
}

/// SHA-256 of a file of results that was closed; `None` where it cannot be read.
pub(super) fn sum_of_store(results: &Path) -> Option<String> {
    let path = results.join(STORE);
    if cfg!(feature = "hdf5") {
        sum_of_file(&path, false).ok()
    } else {
        None
    }
}

/// True where `results.h5` is as a run that was stopped left it. One that was killed may have left it in the middle.
fn is_as_left(results: &Path) -> bool {
    let Ok(summary) = Summary::read(results) else {
        return false;
    };
    if summary.verdict == Verdict::Running {
        return false;
    }
    let whole = summary.results_sum.is_none() || summary.results_sum == sum_of_store(results);
    if !whole {
        tracing::warn!("{STORE} has another content than the run left in it");
    }
    whole
}

/// Flushes a result directory's files to the disk and writes the counters into a checkpoint directory. What this takes does not depend on
/// how much the results are.
pub(super) fn save(
    results: &Path,
    checkpoint: &Path,
    counters: Counters,
) -> Result<(), ResultsError> {
    files::directory(checkpoint)?;
    let flush = |path: &Path| {
        let file = File::open(path).and_then(|file| file.sync_all());
        file.map_err(ResultsError::file("flush", path))
    };
    if cfg!(feature = "hdf5") {
        flush(&results.join(STORE))?;
    }
    let counters = Counters {
        format: FORMAT,
        ..counters
    };
    files::replace_json(&checkpoint.join(COUNTERS), &counters)
}

/// What a run resumes with.
pub(super) struct Restored {
    /// Where the recorder stood.
    pub counters: Counters,
    /// False where `results.h5` may be in the middle of a change.
    pub store_is_closed: bool,
}

/// Brings a result directory back to where a checkpoint stands: cuts the series and removes later snapshots. Nothing is changed where what
/// the checkpoint counts on is not there.
pub(super) fn restore(
    checkpoint: &Path,
    results: &Path,
    case: &Case,
) -> Result<Restored, ResultsError> {
    let path = checkpoint.join(COUNTERS);
    let counters: Counters = serde_json::from_str(&files::read(&path)?)
        .map_err(|error| ResultsError::content(&path, error.to_string()))?;
    if counters.format != FORMAT {
        let fact = format!(
            "it is of layout {}, which another release of Calcine wrote; this one reads layout {FORMAT}",
            counters.format
        );
        return Err(ResultsError::content(&path, fact));
    }
    same_case(results, &counters.case_hash, CaseIdentity::of(case))?;
    let count = counters.snapshots.len();
    for number in 0..count {
        // Without sums a snapshot has no probes that are counted on.
        let written = counters.sums.get(number).map_or(2, Vec::len);
        let files = all_snapshot_files(results, number);
        for file in files.into_iter().take(written) {
            if !file.is_file() {
                let fact = "it is missing, but the checkpoint counts on it";
                return Err(ResultsError::behind(&file, fact));
            }
        }
    }
    counters.series.check(&results.join(SERIES))?;
    check_snapshots(results, &counters.sums)?;
    let is_closed = is_as_left(results);
    counters.series.cut(&results.join(SERIES))?;
    for folder in files::SNAPSHOTS {
        let folder = results.join(folder);
        if folder.is_dir() {
            remove_later(&folder, count)?;
        }
    }
    remove(&results.join(DRAFT))?;
    Ok(Restored {
        counters,
        store_is_closed: is_closed || cfg!(not(feature = "hdf5")),
    })
}

/// True where the run in this directory ended before its end, so that it may begin again; false where it came to its
/// end. The start of another case is an error.
pub fn may_start_again(results: &Path, case: &Case) -> Result<bool, ResultsError> {
    let path = results.join(SUMMARY);
    if !path.exists() {
        return Ok(true);
    }
    let summary = Summary::read(results)?;
    same_case(results, &summary.case.hash, CaseIdentity::of(case))?;
    // One that was interrupted left a checkpoint, which is gone: what it computed is not thrown away.
    Ok(match summary.verdict {
        Verdict::Running => true,
        Verdict::Stopped => summary.failure.is_some(),
        _ => false,
    })
}

/// Refuses a folder of a run that came to its end whose results are not as the run left them: its series, `results.h5`,
/// the snapshots.
pub fn as_finished(results: &Path, summary: &Summary) -> Result<(), ResultsError> {
    let spoilt = |path: PathBuf, fact: &str| ResultsError::Spoilt {
        path,
        fact: fact.into(),
    };
    let (series, store) = (results.join(SERIES), results.join(STORE));
    for path in [&series, &store] {
        let due = path == &series || cfg!(feature = "hdf5");
        if due && !path.is_file() {
            return Err(spoilt(path.clone(), "is missing"));
        }
    }
    let end = summary.process_time_s;
    let rows = Series::read(results)?;
    let last = rows.column("process_time").last();
    if last.is_none_or(|last| (last - end).abs() > 1e-9 * end.abs()) {
        return Err(spoilt(series, "does not reach to its end"));
    }
    if cfg!(feature = "hdf5") {
        let mut start = [0; HDF5_SIGNATURE.len()];
        let read = File::open(&store).and_then(|mut file| file.read_exact(&mut start));
        if read.is_err() || start != *HDF5_SIGNATURE {
            return Err(spoilt(store, "is not an HDF5 file"));
        }
    }
    for name in [files::GAS, files::PARTICLES] {
        for (_, file) in collection(results, name)? {
            if !file.is_file() {
                return Err(spoilt(file, "is missing"));
            }
        }
    }
    Ok(())
}

/// Makes room for a run that begins again.
pub fn clear_start(results: &Path) -> Result<(), ResultsError> {
    remove(&results.join(SUMMARY))
}

/// Removes a file where there is one.
pub(super) fn remove(path: &Path) -> Result<(), ResultsError> {
    match fs::remove_file(path) {
        Err(cause) if cause.kind() != ErrorKind::NotFound => {
            Err(ResultsError::file("remove", path)(cause))
        }
        _ => Ok(()),
    }
}

/// Removes the snapshots of a folder from a number on, and drafts.
fn remove_later(folder: &Path, count: usize) -> Result<(), ResultsError> {
    let entries = fs::read_dir(folder).map_err(ResultsError::file("list", folder))?;
    for entry in entries {
        let path = entry.map_err(ResultsError::file("list", folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let number = name
            .split(['_', '.'])
            .nth(1)
            .and_then(|digits| digits.parse::<usize>().ok());
        if number.is_some_and(|number| number >= count) || name.ends_with(".new") {
            fs::remove_file(&path).map_err(ResultsError::file("remove", &path))?;
        }
    }
    Ok(())
}
