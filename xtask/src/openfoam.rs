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

/// The internal field in the text of a file in ASCII, its components one after the other; of one component where it is uniform.
pub fn internal_field(text: &str, cells: usize) -> Option<Vec<f64>> {
    let (_, after) = text.split_once("internalField")?;
    let numbers = |text: &str| -> Option<Vec<f64>> {
        let words = text.split(|c: char| c.is_whitespace() || "()".contains(c));
        let words = words.filter(|word| !word.is_empty());
        words.map(|word| word.parse().ok()).collect()
    };
    if let Some(uniform) = after.trim_start().strip_prefix("uniform") {
        let one = numbers(uniform.split_once(';')?.0)?;
        return Some(one.repeat(cells));
    }
    let (_, list) = after.split_once('(')?;
    numbers(list.split_once(';')?.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_of_openfoam_are_read_uniform_or_not() {
        let list = "FoamFile { object U; }\ndimensions [0 1 -1 0 0 0 0];\n\
            internalField   nonuniform List<vector> \n2\n(\n(1 2e-1 0)\n(-3 0 0)\n)\n;\n\nboundaryField\n{ lid { } }";
        assert_eq!(
            internal_field(list, 2),
            Some(vec![1.0, 0.2, 0.0, -3.0, 0.0, 0.0])
        );
        let uniform = "internalField   uniform 300;\nboundaryField { }";
        assert_eq!(internal_field(uniform, 2), Some(vec![300.0, 300.0]));
        assert_eq!(internal_field("boundaryField { }", 2), None);
    }

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
