//! What commands read and where they write.

use std::path::Path;

use super::failure::Failure;
use crate::assembly::PreparedCase;
use crate::case::model::Case;
use crate::exit;
use crate::progress::preparing;
pub(super) use crate::simulation::results_folder;
use crate::valid::ValidCase;

/// Reads a case with `--set` applied; all its errors at once.
pub(super) fn read_case(path: &Path, set: &[String]) -> Result<Case, Failure> {
    crate::case::read(path, set).map_err(|errors| Failure::new(exit::CASE, errors.render()))
}

/// Reads a case that is to be run, and refuses one that cannot be.
pub(super) fn read_and_prepare(
    path: &Path,
    set: &[String],
) -> Result<(Case, PreparedCase), Failure> {
    let valid = preparing(|| ValidCase::open(path, set))?;
    Ok((valid.case, valid.prepared))
}
