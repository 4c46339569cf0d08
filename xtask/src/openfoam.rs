//! Cases of OpenFOAM's own programs: copied, prepared, run where Debian's OpenFOAM finds its dictionaries.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::steps::{Stop, TaskResult};

/// Where Debian's OpenFOAM finds its own dictionaries.
const PROJECT: (&str, &str) = ("WM_PROJECT_DIR", "/usr/share/openfoam");

/// A program of OpenFOAM with its words, started in the folder of a case.
pub fn tool(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).current_dir(folder);
    command.env(PROJECT.0, PROJECT.1);
    command
}

/// Copies a folder with all that is in it.
pub fn copy(from: &Path, to: &Path) -> TaskResult<()> {
    fs::create_dir_all(to).map_err(|cause| Stop::io(to, &cause))?;
    for entry in fs::read_dir(from)
        .map_err(|cause| Stop::io(from, &cause))?
        .flatten()
    {
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &to)?;
        } else {
            fs::copy(&path, &to).map_err(|cause| Stop::io(&path, &cause))?;
        }
    }
    Ok(())
}

/// Writes a file of a case.
pub fn write(path: &Path, text: &str) -> TaskResult<()> {
    fs::write(path, text).map_err(|cause| Stop::io(path, &cause))
}

/// The folder of the latest time.
pub fn last_time(folder: &Path) -> TaskResult<PathBuf> {
    let entries = fs::read_dir(folder).map_err(|cause| Stop::io(folder, &cause))?;
    let times = entries.flatten().filter_map(|entry| {
        let time: f64 = entry.file_name().to_str()?.parse().ok()?;
        Some((time, entry.path()))
    });
    let last = times.max_by(|one, other| one.0.total_cmp(&other.0));
    let last = last.filter(|(time, _)| *time > 0.0);
    last.map(|(_, path)| path)
        .ok_or_else(|| Stop(format!("{}: no results", folder.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_time_is_found_by_its_number() {
        let folder = std::env::temp_dir().join(format!("xtask times {}", std::process::id()));
        for name in ["0", "9.5", "10", "constant"] {
            fs::create_dir_all(folder.join(name)).unwrap();
        }
        let last = last_time(&folder).unwrap();
        for name in ["9.5", "10"] {
            fs::remove_dir(folder.join(name)).unwrap();
        }
        let none = last_time(&folder);
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(last, folder.join("10"));
        assert!(none.is_err());
    }
}
