//! What a comparison finds.

use serde::Serialize;

use super::fields::FieldDifference;
use super::quantities::QuantityDifference;
use crate::results::read::Series;

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
    /// Share of its windows that ended at a limit of iterations.
    pub unconverged_share: f64,
    /// True where that is no more than the case allows (`agreement.unconverged`).
    pub converged: bool,
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
    /// True where every band holds, and every run is complete and has converged.
    pub agrees: bool,
    #[serde(skip)]
    pub(super) series: Vec<Series>,
}
