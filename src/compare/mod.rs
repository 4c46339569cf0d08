//! Comparison of runs of one case with different solvers: quantity by quantity and field by field,
//! against the bands (`agree`) that the case states.

mod agreement;
mod common;
mod comparison;
pub mod deviation;
mod error;
mod fields;
mod page;
mod quantities;
mod source;
mod spread;
mod table;

use std::path::{Path, PathBuf};

use crate::case::model::Case;
pub use crate::results::files::COMPARISON;
use crate::results::read::Series;
use crate::results::{CaseIdentity, Summary, differences, files};
use source::Source;

pub use self::agreement::Agreement;
pub use self::comparison::{ComparedRun, Comparison};
pub use self::error::CompareError;
pub use self::fields::{FieldDifference, Norms};
pub use self::quantities::{Extreme, QuantityDifference};

/// Name of the comparison as a page.
pub const PAGE: &str = "compare.html";

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
    let agrees = listed.iter().all(|run| run.complete && run.converged)
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
    /// True where the case states a band of some difference.
    pub(super) fn has_bands(&self) -> bool {
        let quantities = self.quantities.iter().map(|one| one.verdict);
        let mut all = quantities.chain(self.fields.iter().map(|field| field.verdict));
        all.any(|verdict| verdict != Agreement::None)
    }

    /// True where some difference is outside its band.
    pub(super) fn has_outside(&self) -> bool {
        let quantities = self.quantities.iter().map(|one| one.verdict);
        let mut all = quantities.chain(self.fields.iter().map(|field| field.verdict));
        all.any(|verdict| verdict == Agreement::Outside)
    }

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
            differences: differences(directory, &summary.case.hash, CaseIdentity::of(case)),
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
    let sums = &source.summary.convergence;
    let unconverged = sums.unconverged_windows.max(sums.unsettled_windows);
    let unconverged_share = unconverged as f64 / source.summary.windows.max(1) as f64;
    ComparedRun {
        unconverged_share,
        converged: unconverged_share <= case.agreement.unconverged,
        name: source.name.clone(),
        process_time_s: source.summary.process_time_s,
        wall_time_s: source.summary.wall_time_s.total,
        complete: source.summary.process_time_s >= case.time.end.seconds(),
        ledger_error: lines.into_iter().fold(0.0, f64::max),
    }
}
