//! Trials of the tuning of a plant: each is written as it comes, and known where the tuning goes on.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use sha2::{Digest, Sha256};

use crate::case::plant::{PlantCase, PlantTuningSpec};
use crate::hex::hex;
use crate::results::{ResultsError, files};

/// Name of the table of trials.
const TRIALS: &str = "trials.csv";

/// What a trial gave: what the plant does, or why it could not be followed.
pub(super) type Trial = Result<Vec<f64>, String>;

/// All trials of a tuning. A plant is deterministic, so that one that is known is not computed again, and a tuning that goes on takes
/// the same way to the same bits.
pub(super) struct TrialLog {
    path: PathBuf,
    kept: Mutex<Kept>,
}

struct Kept {
    file: File,
    /// By the bits of the places.
    known: BTreeMap<Vec<u64>, Trial>,
    /// The first row that could not be written.
    wrong: Option<ResultsError>,
}

/// How many trials there were, how many of these failed, and what one of them said.
pub(super) struct TrialCount {
    pub tried: usize,
    pub failed: usize,
    pub failure: Option<String>,
}

/// The hash of a case with its measurements: SHA-256 in hex.
pub(crate) fn hash_of(case: &PlantCase, spec: &PlantTuningSpec) -> String {
    let mut digest = Sha256::new();
    digest.update(case.hash.as_bytes());
    // Of the measurements, which are files of their own: every number to its bits.
    digest.update(format!("{spec:?}").as_bytes());
    hex(digest.finalize())
}

/// The hash of the case whose trials a folder holds.
pub(crate) fn trials_of(folder: &Path) -> Option<String> {
    let text = fs::read_to_string(folder.join(TRIALS)).ok()?;
    let mut head = text.lines().next()?.splitn(3, ',');
    (head.next() == Some("trials of")).then(|| head.next().map(str::to_owned))?
}

fn bits(places: &[f64]) -> Vec<u64> {
    places.iter().map(|place| place.to_bits()).collect()
}

fn list(values: &[f64]) -> String {
    let words: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
    words.join(" ")
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace()
        .map(|one| one.parse().ok())
        .collect()
}

fn parse(row: &str) -> Option<(Vec<u64>, Trial)> {
    let mut fields = row.splitn(3, ',');
    let places = bits(&numbers(fields.next()?)?);
    let (outcome, rest) = (fields.next()?, fields.next()?);
    match outcome {
        "followed" => Some((places, Ok(numbers(rest)?))),
        "failed" => Some((places, Err(rest.to_owned()))),
        _ => None,
    }
}

impl TrialLog {
    /// The log of a folder, with what it holds where the tuning goes on: up to the first row that is not whole.
    pub fn open(
        folder: &Path,
        hash: &str,
        keys: &[&str],
        go_on: bool,
    ) -> Result<Self, ResultsError> {
        files::directory(folder)?;
        let path = folder.join(TRIALS);
        let head = format!(
            "trials of,{hash},places from 0 to 1 between the bounds of {}\n",
            keys.join(" ")
        );
        let mut known = BTreeMap::new();
        let mut length = 0;
        if go_on {
            let text = fs::read_to_string(&path).map_err(ResultsError::file("read", &path))?;
            for (number, row) in text.split_inclusive('\n').enumerate() {
                let whole = row.strip_suffix('\n');
                match (number, whole, whole.and_then(parse)) {
                    (0, Some(_), _) => {}
                    (1.., _, Some((places, trial))) => {
                        known.insert(places, trial);
                    }
                    _ => break,
                }
                length += row.len();
            }
        }
        let mut options = OpenOptions::new();
        let options = options.create(true).write(true).truncate(!go_on);
        let mut file = options
            .open(&path)
            .map_err(ResultsError::file("open", &path))?;
        file.set_len(length as u64)
            .map_err(ResultsError::file("cut", &path))?;
        let file = match length {
            0 => file.write_all(head.as_bytes()).map(|()| file),
            _ => OpenOptions::new().append(true).open(&path),
        };
        let file = file.map_err(ResultsError::file("write", &path))?;
        Ok(Self {
            path,
            kept: Mutex::new(Kept {
                file,
                known,
                wrong: None,
            }),
        })
    }

    /// The trial at some places: the one that is known, else a new one.
    pub fn trial(&self, places: &[f64], new: impl FnOnce() -> Trial) -> Trial {
        let of = bits(places);
        let lock = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let before = lock().known.get(&of).cloned();
        if let Some(known) = before {
            return known;
        }
        let found = new().map_err(|told| told.replace('\n', " "));
        let row = match &found {
            Ok(values) => format!("{},followed,{}\n", list(places), list(values)),
            Err(told) => format!("{},failed,{told}\n", list(places)),
        };
        let mut kept = lock();
        if let Err(cause) = kept.file.write_all(row.as_bytes()) {
            let error = ResultsError::file("write", &self.path)(cause);
            kept.wrong.get_or_insert(error);
        }
        kept.known.insert(of, found.clone());
        found
    }

    /// All trials, or the first that could not be written.
    pub fn count(self) -> Result<TrialCount, ResultsError> {
        let kept = self
            .kept
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(wrong) = kept.wrong {
            return Err(wrong);
        }
        let mut failed = kept.known.values().filter_map(|trial| trial.as_ref().err());
        Ok(TrialCount {
            tried: kept.known.len(),
            failed: failed.clone().count(),
            failure: failed.next().cloned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_tried_is_known_to_the_bit_after_an_end_within_a_row() {
        let folder = tempfile::tempdir().unwrap();
        let log = TrialLog::open(folder.path(), "abc", &["a", "b"], false).unwrap();
        let values = vec![0.1 + 0.2, f64::INFINITY, -1e-310];
        let told = Err("mill \"m\" at 3 s: too fine; lower it".to_owned());
        assert_eq!(
            log.trial(&[1.0 / 3.0, 0.0], || Ok(values.clone())),
            Ok(values.clone())
        );
        assert_eq!(log.trial(&[0.5, 1.0], || told.clone()), told);
        drop(log);
        let path = folder.path().join(TRIALS);
        let whole = fs::read_to_string(&path).unwrap();
        fs::write(&path, whole.clone() + "2e-1 3e-1,followed,1e0 2").unwrap();
        assert_eq!(trials_of(folder.path()).as_deref(), Some("abc"));
        let log = TrialLog::open(folder.path(), "abc", &["a", "b"], true).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        let known = |places: &[f64]| log.trial(places, || panic!("it is known"));
        assert_eq!(known(&[1.0 / 3.0, 0.0]), Ok(values));
        assert_eq!(known(&[0.5, 1.0]), told);
        assert_eq!(log.trial(&[0.2, 0.3], || Ok(vec![7.0])), Ok(vec![7.0]));
        let count = log.count().unwrap();
        assert_eq!((count.tried, count.failed), (3, 1));
        assert_eq!(count.failure, told.err());
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text.lines().count(), 4);
    }
}
