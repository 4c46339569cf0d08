//! Errors of writing and reading results.

use std::path::{Path, PathBuf};

use calcine_coupler::observer::ObserverError;
use miette::Diagnostic;
use thiserror::Error;

/// What else can be done about the run in a folder: one that is complete does not go on.
fn going_on(state: &str) -> &'static str {
    match state {
        "complete" => "",
        _ => ", continue that run by `--resume`",
    }
}

/// Results that cannot be written or read.
#[derive(Debug, Error, Diagnostic)]
pub enum ResultsError {
    /// The directory belongs to another run.
    #[error(
        "{} holds the results of another run of `{case}` ({state}, process time {time} s)",
        path.display()
    )]
    #[diagnostic(help(
        "write elsewhere with `--out DIR`{}, or remove the directory",
        going_on(state)
    ))]
    Occupied {
        /// The directory.
        path: PathBuf,
        /// Name of the case whose results it holds.
        case: String,
        /// Whether that run is complete.
        state: &'static str,
        /// How far that run came, in s of process time.
        time: f64,
    },
    /// A checkpoint or the start of a run of another case.
    #[error("the run in {} is of another case than this: {differences}", path.display())]
    #[diagnostic(help(
        "resume with the case, the files that it names and the `--set` values that the run began with ({} holds the case as it was \
         run), or continue from it with the changes by `--from {}` and another `--out`",
        kept.display(),
        path.display()
    ))]
    OtherCase {
        /// The results folder.
        path: PathBuf,
        /// The case as it was run, in that folder.
        kept: PathBuf,
        /// Which keys and files differ.
        differences: String,
    },
    /// A directory in which no run was begun.
    #[error("{} is not the results folder of a run: {fact}", path.display())]
    #[diagnostic(help("name the folder that a run wrote: that of its `--out`, or results/NAME"))]
    NoResults {
        /// The directory.
        path: PathBuf,
        /// What is missing.
        fact: &'static str,
    },
    /// A file that could not be read or written.
    #[error("cannot {action} {}: {}", path.display(), told_by_hdf5(&source.to_string()))]
    #[diagnostic(help("check the space on the disk and the permissions of the directory"))]
    File {
        /// What was tried: `read`, `write`, `copy` …
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// A file whose content is not what Calcine writes.
    #[error("{} is not as Calcine writes it: {fact}", path.display())]
    #[diagnostic(help("the file was changed or cut short; resume from the last checkpoint"))]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        fact: String,
    },
    /// A file that is not as it was when the checkpoint was written.
    #[error("{} is not as the run left it at its checkpoint: {fact}", path.display())]
    #[diagnostic(help(
        "put the file back as it was, or begin a run of its own from the checkpoint with `--from` and another `--out`; \
         nothing that the checkpoint counts on was changed"
    ))]
    Behind {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        fact: String,
    },
    /// A file that a run left at its end is no longer there, or another.
    #[error("the run is complete, but {} {fact}", path.display())]
    #[diagnostic(help(
        "put the file back as it was, or run the case again into a folder of its own; nothing was changed"
    ))]
    Spoilt {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        fact: String,
    },
    /// A probe with no point in the gas mesh.
    #[error("no point of the probe `{probe}` lies inside the gas mesh")]
    #[diagnostic(help("move the points of the probe into the mesh"))]
    ProbeOutside {
        /// Name of the probe.
        probe: String,
    },
    /// Lists of a moment that contradict each other.
    #[error("{list} has {found} values where {expected} are needed")]
    Length {
        /// Which list.
        list: String,
        /// Its length.
        found: usize,
        /// The length needed.
        expected: usize,
    },
    /// A patch that the mesh lacks.
    #[error("the quantity `{quantity}` names the patch `{patch}`, which the mesh lacks")]
    #[diagnostic(help("use one of the mesh's patches in `measure.patches`: {patches}"))]
    NoPatch {
        /// Name of the quantity.
        quantity: String,
        /// The patch.
        patch: String,
        /// The patches that there are.
        patches: String,
    },
    /// HDF5 failed.
    #[cfg(feature = "hdf5")]
    #[error("cannot {action} {}: {}", path.display(), told_by_hdf5(&source.to_string()))]
    #[diagnostic(help("check the space on the disk and the permissions of the directory"))]
    Store {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The cause.
        source: hdf5::Error,
    },
}

/// What HDF5 says, without addresses and times: the operating system's own words where it has them.
#[cfg(feature = "hdf5")]
fn told_by_hdf5(text: &str) -> &str {
    let system = text.split_once("error message = '");
    let system = system.and_then(|(_, rest)| Some(rest.split_once('\'')?.0));
    let own = text.split(": time =").next().unwrap_or(text);
    system.unwrap_or(own).trim()
}

impl ResultsError {
    /// A failed file operation.
    pub(crate) fn file(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File {
            action,
            path,
            source,
        }
    }

    /// A file that lacks what a checkpoint counts on.
    pub(crate) fn behind(path: &Path, fact: impl Into<String>) -> Self {
        Self::Behind {
            path: path.to_owned(),
            fact: fact.into(),
        }
    }

    /// A file with unexpected content.
    pub(crate) fn content(path: &Path, fact: impl Into<String>) -> Self {
        Self::Content {
            path: path.to_owned(),
            fact: fact.into(),
        }
    }
}

impl From<ResultsError> for ObserverError {
    fn from(error: ResultsError) -> Self {
        ObserverError {
            doing: "writing results".into(),
            cause: Box::new(error),
        }
    }
}

#[cfg(all(test, feature = "hdf5"))]
mod tests {
    use super::*;

    #[test]
    fn of_an_error_of_hdf5_the_systems_words_are_told() {
        let full = "H5Dwrite(): can't write data: file write failed: time = Fri Nov 27 05:05:39 2026\n, filename = 'a', errno = 28, error message = 'No space left on device', buf = 0x56";
        assert_eq!(told_by_hdf5(full), "No space left on device");
        let other = "H5Fopen(): unable to open file: bad superblock";
        assert_eq!(told_by_hdf5(other), other);
    }
}
