//! What commands read and where they write.

use std::path::Path;

use super::failure::Failure;
use crate::assembly::PreparedCase;
use crate::case::model::Case;
use crate::exit;
use crate::progress::preparing;
pub(super) use crate::simulation::results_folder;
use crate::valid::ValidCase;

/// True of a folder that holds anything.
pub(super) fn holds_files(folder: &Path) -> bool {
    std::fs::read_dir(folder).is_ok_and(|mut files| files.next().is_some())
}

/// Refuses to write over a file that does not begin as what is to be written does.
pub(super) fn own_or_new(path: &Path, begins: char, option: &str) -> Result<(), Failure> {
    let Ok(text) = std::fs::read(path) else {
        return Ok(());
    };
    let first = text.iter().find(|byte| !byte.is_ascii_whitespace());
    if first.is_none_or(|first| char::from(*first) == begins) {
        return Ok(());
    }
    let message = format!(
        "{} is there, and holds something else than {option} writes: name another file with `{option}`, or remove it",
        path.display()
    );
    Err(Failure::new(exit::CASE, message))
}

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
