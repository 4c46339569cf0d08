//! What commands read and where they write.

use std::path::Path;

use super::failure::Failure;
use crate::assembly::PreparedCase;
use crate::case::model::Case;
use crate::exit;
pub(super) use crate::simulation::results_folder;

/// Reads a case with `--set` applied; all its errors at once.
pub(super) fn read_case(path: &Path, set: &[String]) -> Result<Case, Failure> {
    crate::case::read(path, set).map_err(|errors| Failure::new(exit::CASE, errors.render()))
}

/// Reads a case and makes mesh and particles.
pub(super) fn read_and_prepare(
    path: &Path,
    set: &[String],
) -> Result<(Case, PreparedCase), Failure> {
    let mut case = read_case(path, set)?;
    let prepared = PreparedCase::new(&case)?;
    crate::case::settle(&mut case, &prepared.mesh);
    Ok((case, prepared))
}
