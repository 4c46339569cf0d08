//! The folder of a checkpoint that a solver takes up.

use std::path::{Path, PathBuf};

use calcine_coupler::error::{FailureKind, PartError};

/// The error of a checkpoint that a solver cannot take up.
pub(crate) fn unusable(
    name: &str,
    folder: &Path,
    cause: impl std::error::Error + Send + Sync + 'static,
) -> PartError {
    let message = format!("the checkpoint {} cannot be used", folder.display());
    PartError::new(name, FailureKind::Io, message).caused_by(cause)
}

/// The absolute path of a folder of a checkpoint, or of a file in it.
pub(crate) fn absolute(name: &str, path: &Path) -> Result<PathBuf, PartError> {
    std::path::absolute(path).map_err(|cause| unusable(name, path, cause))
}
