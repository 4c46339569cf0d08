//! How far pairings of solvers may differ beside quantities of interest.

use super::quantity::ToleranceBand;

/// `[agreement]`: what `compare` judges beside quantities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AgreementSpec {
    /// Share of the windows of a run that may end at a limit of iterations.
    pub unconverged: f64,
    /// Bands of fields.
    pub fields: Vec<FieldBand>,
}

/// The band of a field of cells or particles.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldBand {
    /// Name as `compare` has it, `gas.temperature`.
    pub field: String,
    /// Of the largest difference; a share is one of the field's span.
    pub largest: Option<ToleranceBand>,
    /// Of the root of the mean square.
    pub root_mean_square: Option<ToleranceBand>,
}
