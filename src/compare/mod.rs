//! Comparison of runs of one case with different solvers: quantity by quantity and field by field,
//! against the bands (`agree`) that the case states.

mod common;
pub mod deviation;
mod fields;
mod page;
mod quantities;
mod table;

use std::path::{Path, PathBuf};

use miette::Diagnostic;
use serde::Serialize;
use thiserror::Error;

use crate::case::model::Case;
use crate::results::read::Series;
use crate::results::{ResultsError, Summary, files};

pub use self::fields::{FieldDifference, Norms};
pub use self::quantities::{Extreme, QuantityDifference};

/// Name of the comparison as data.
pub const COMPARISON: &str = "compare.json";
/// Name of the comparison as a page.
pub const PAGE: &str = "compare.html";

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
    #[error("{} holds a run of a case with the hash {stored}, this case has {hash}", path.display())]
    #[diagnostic(help("run that pairing again with this case file and the same `--set` values"))]
    OtherCase {
        /// Its result directory.
        path: PathBuf,
        /// The hash in its summary.
        stored: String,
        /// The hash of the case.
        hash: String,
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

/// How a difference stands against its band.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Agreement {
    /// Within the band.
    Inside,
    /// Out of the band.
    Outside,
    /// The case states no band.
    None,
}

impl Agreement {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Agreement::Inside => "inside",
            Agreement::Outside => "outside",
            Agreement::None => "–",
        }
    }

    /// How a multiple of the allowed distance stands; NaN is outside.
    fn of(multiple: Option<f64>) -> Self {
        match multiple {
            None => Agreement::None,
            Some(multiple) if multiple <= 1.0 => Agreement::Inside,
            Some(_) => Agreement::Outside,
        }
    }
}

/// One run among those compared.
#[derive(Clone, Debug, Serialize)]
pub struct ComparedRun {
    /// Name of the pairing.
    pub name: String,
    /// Process time reached in s.
    pub process_time_s: f64,
    /// Wall time in s.
    pub wall_time_s: f64,
    /// True where it reached the end of the case.
    pub complete: bool,
    /// Largest relative error of the ledger's mass and energy lines.
    pub ledger_error: f64,
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name of the case.
    pub case: String,
    /// SHA-256 of the case.
    pub hash: String,
    /// Title of the case.
    pub title: String,
    /// The runs, in the order given.
    pub runs: Vec<ComparedRun>,
    /// Differences of the quantities of interest.
    pub quantities: Vec<QuantityDifference>,
    /// Differences of the fields.
    pub fields: Vec<FieldDifference>,
    /// True where every band holds and every run is complete.
    pub agrees: bool,
    #[serde(skip)]
    series: Vec<Series>,
}

/// A run as read.
struct Source {
    name: String,
    directory: PathBuf,
    summary: Summary,
    series: Series,
}

/// Compares result directories of the same case; each comes with the name of its pairing.
pub fn compare(case: &Case, runs: &[(String, PathBuf)]) -> Result<Comparison, CompareError> {
    if runs.len() < 2 {
        return Err(CompareError::TooFew { count: runs.len() });
    }
    let sources = runs
        .iter()
        .map(|(name, directory)| open(case, name, directory))
        .collect::<Result<Vec<_>, _>>()?;
    let quantities = quantities::differences(case, &sources);
    let fields = fields::differences(case, &sources)?;
    let listed: Vec<ComparedRun> = sources.iter().map(|source| run(case, source)).collect();
    let bands = quantities.iter().map(|quantity| quantity.verdict);
    let bands = bands.chain(fields.iter().map(|field| field.verdict));
    let agrees = listed.iter().all(|run| run.complete)
        && bands
            .into_iter()
            .all(|verdict| verdict != Agreement::Outside);
    Ok(Comparison {
        case: case.name.clone(),
        hash: case.hash.clone(),
        title: case.title.clone(),
        runs: listed,
        quantities,
        fields,
        agrees,
        series: sources.into_iter().map(|source| source.series).collect(),
    })
}

impl Comparison {
    /// The tables for a terminal.
    pub fn table(&self) -> String {
        table::render(self)
    }

    /// Writes `compare.json` and `compare.html` into a directory; returns the page's path.
    pub fn write(&self, directory: &Path) -> Result<PathBuf, CompareError> {
        files::directory(directory)?;
        files::replace_json(&directory.join(COMPARISON), self)?;
        let path = directory.join(PAGE);
        files::replace(&path, page::render(self).as_bytes())?;
        Ok(path)
    }
}

fn open(case: &Case, name: &str, directory: &Path) -> Result<Source, CompareError> {
    let summary = Summary::read(directory)?;
    if summary.case.hash != case.hash {
        return Err(CompareError::OtherCase {
            path: directory.to_owned(),
            stored: summary.case.hash,
            hash: case.hash.clone(),
        });
    }
    Ok(Source {
        name: name.into(),
        directory: directory.to_owned(),
        series: Series::read(directory)?,
        summary,
    })
}

fn run(case: &Case, source: &Source) -> ComparedRun {
    let lines = ["mass", "energy"].map(|name| {
        let line = source.summary.ledger.lines.get(name);
        line.map_or(f64::NAN, |line| line.relative_error)
    });
    ComparedRun {
        name: source.name.clone(),
        process_time_s: source.summary.process_time_s,
        wall_time_s: source.summary.wall_time_s.total,
        complete: source.summary.process_time_s >= case.time.end.seconds(),
        ledger_error: lines.into_iter().fold(0.0, f64::max),
    }
}
