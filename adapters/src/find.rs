//! Where Calcine's programs are.

use std::path::{Path, PathBuf};

use calcine_coupler::error::{FailureKind, PartError};
use thiserror::Error;

/// What installs and builds a program of Calcine that is not there.
pub const REMEDY: &str = "in a clone of Calcine, `cargo xtask setup --all` installs and builds it; for an installed \
                          command, `cargo xtask install --prefix DIR` there (without `--native`) does";

/// Why a program of Calcine was not found.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NotFound {
    /// The variable that names it names no file.
    #[error(
        "{path}, which the variable {variable} names, is no file: name the program, or unset the variable"
    )]
    Misnamed {
        /// What the variable holds.
        path: PathBuf,
        /// The variable.
        variable: String,
    },
    /// It is in none of the places.
    #[error("the program was found neither in {folder} nor in the variable {variable}; {REMEDY}")]
    Nowhere {
        /// The folder of the running executable.
        folder: PathBuf,
        /// The variable.
        variable: String,
    },
}

/// Looks for a program of Calcine: the variable's path, or beside the running executable (also one folder
/// up, for tests; in `openfoam/bin` of the target folder; in `libexec/calcine` of an installation).
pub fn look_for(variable: &str, name: &str) -> Result<PathBuf, NotFound> {
    let variable_value = std::env::var_os(variable).map(PathBuf::from);
    let variable = variable.to_owned();
    if let Some(path) = variable_value {
        return match path.is_file() {
            true => Ok(path),
            false => Err(NotFound::Misnamed { path, variable }),
        };
    }
    let own = std::env::current_exe()
        .and_then(|path| path.canonicalize())
        .unwrap_or_default();
    let folder = own.parent().unwrap_or(Path::new("."));
    let places = [
        ".",
        "..",
        "../libexec/calcine",
        "../openfoam/bin",
        "../../openfoam/bin",
    ];
    let found = places
        .map(|place| folder.join(place).join(name))
        .into_iter()
        .find(|path| path.is_file());
    found.ok_or_else(|| NotFound::Nowhere {
        folder: folder.to_owned(),
        variable,
    })
}

/// A program of Calcine that a run needs.
pub fn find_program(variable: &str, name: &str) -> Result<PathBuf, PartError> {
    look_for(variable, name)
        .map_err(|why| PartError::new(name, FailureKind::NotStarted, why.to_string()))
}
