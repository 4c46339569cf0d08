//! Curves of thermogravimetry from text files of any instrument.
//!
//! A file is read in three steps: [`sheet`] finds the columns of numbers in the text, [`columns`] what they are and their
//! units, [`curve`] makes runs of them and refuses what no sample does. What is recognised can be stated; what is ambiguous is
//! refused with what to state.

mod columns;
mod curve;
mod curve_column;
mod sheet;
mod start;

use std::fmt;
use std::path::{Path, PathBuf};

pub use columns::ColumnChoice;
pub use curve::{CurveFile, CurveRules, MeasuredRun, parse_curves, read_curves};
pub use curve_column::CurveColumn;
pub use sheet::{Delimiter, SheetForm};
pub use start::MassAtStart;

/// What is wrong with a file of curves: the fact, where it stands, what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveFileError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1; `None` of the file as a whole.
    pub line: Option<usize>,
    /// What is wrong.
    pub fact: String,
    /// What to do.
    pub help: String,
}

impl CurveFileError {
    fn new(
        path: &Path,
        line: Option<usize>,
        fact: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            path: path.to_owned(),
            line,
            fact: fact.into(),
            help: help.into(),
        }
    }
}

impl fmt::Display for CurveFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = self.path.display();
        match self.line {
            Some(line) => write!(f, "line {line} of {path}: {}", self.fact),
            None => write!(f, "{path}: {}", self.fact),
        }
    }
}

impl std::error::Error for CurveFileError {}
