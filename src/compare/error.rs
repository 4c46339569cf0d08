//! What keeps runs from being compared.

use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

use crate::results::ResultsError;

/// Runs that cannot be compared.
#[derive(Debug, Error, Diagnostic)]
pub enum CompareError {
    /// Results that cannot be read or written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Results(#[from] ResultsError),
    /// One run alone.
    #[error("{count} run cannot be compared, at least 2 are needed")]
    #[diagnostic(help("name two pairings or more, for example `--pairings all`"))]
    TooFew {
        /// Number of runs.
        count: usize,
    },
    /// A run of another case.
    #[error("{} holds a run of another case than this: {differences}", path.display())]
    #[diagnostic(help("run that pairing again with this case file and the same `--set` values"))]
    OtherCase {
        /// Its result directory.
        path: PathBuf,
        /// Which keys and files differ.
        differences: String,
    },
    /// Snapshots with different fields or numbers of cells or particles.
    #[error("the field `{field}` has {found} values in `{run}` and {expected} in `{reference}`")]
    #[diagnostic(help("both runs must use the mesh and the particles of the case"))]
    Shape {
        /// Name of the field.
        field: String,
        /// The run that differs.
        run: String,
        /// Its number of values.
        found: usize,
        /// The run it is compared with.
        reference: String,
        /// That run's number of values.
        expected: usize,
    },
}
