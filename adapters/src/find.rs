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
    #[error(
        "the program was found neither in {folder}, nor beside the command `calcine` of PATH, nor in the variable {variable}; {REMEDY}"
    )]
    Nowhere {
        /// The folder of the running executable.
        folder: PathBuf,
        /// The variable.
        variable: String,
    },
}

/// Where programs of Calcine are, from the folder of the running one: beside it, one folder up, for tests, in `libexec/calcine` of an
/// installation, and in `openfoam/bin` of the target folder.
const PLACES: [&str; 5] = [
    ".",
    "..",
    "../libexec/calcine",
    "../openfoam/bin",
    "../../openfoam/bin",
];

/// The folder of the command `calcine` of PATH, for programs that are not Calcine's, such as Python.
fn folder_of_command() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let mut commands = std::env::split_paths(&path).map(|folder| folder.join("calcine"));
    let command = commands.find(|command| command.is_file())?;
    Some(command.canonicalize().ok()?.parent()?.to_owned())
}

/// Looks for a program of Calcine: the variable's path, or in the places about the running executable, or about the command `calcine`.
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
    let about = |folder: &Path| {
        let mut programs = PLACES.iter().map(|place| folder.join(place).join(name));
        programs.find(|path| path.is_file())
    };
    let found = about(folder).or_else(|| about(&folder_of_command()?));
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
