//! In place of `results.h5` where HDF5 is left out.

use std::path::Path;

use super::files::TimeTable;
use super::measure::Column;
use crate::case::plant::PlantCase;
use crate::results::ResultsError;

/// Writes nothing.
pub(super) fn write(
    _folder: &Path,
    _case: &PlantCase,
    _columns: &[Column],
    _series: &TimeTable,
) -> Result<(), ResultsError> {
    Ok(())
}
