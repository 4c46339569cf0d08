//! Our C++ in OpenFOAM: `adapters/openfoam/build.sh`, started only if something it is made of
//! has changed.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::headers;
use crate::steps::{Stop, TaskResult, new_log, output, quietly, say, step};
use crate::workspace::{CargoProfile, Workspace};

/// The solvers that `build.sh` leaves in its output folder.
pub const SOLVERS: [&str; 2] = ["calcineGasFoam", "calcineParcelFoam"];

/// What the C++ is made of, and where it goes.
#[derive(Debug)]
pub struct OpenfoamAdapter {
    headers: PathBuf,
    stamp: String,
    /// The folder with the finished solver and library.
    pub folder: PathBuf,
}

impl OpenfoamAdapter {
    /// Prepares the headers and takes stock of the sources.
    pub fn new(workspace: &Workspace) -> TaskResult<Self> {
        let headers = headers::prepare(&workspace.openfoam, &workspace.logs)?;
        let folder = workspace.openfoam.join("bin");
        let stamp = stamp(&workspace.root, &headers)?;
        Ok(Self {
            headers,
            stamp,
            folder,
        })
    }

    /// True if the solver there was built from exactly these sources.
    pub fn is_current(&self) -> bool {
        let stamp = fs::read_to_string(self.stamp_file()).unwrap_or_default();
        stamp == self.stamp && self.missing().is_none()
    }

    /// A solver that is not there.
    fn missing(&self) -> Option<&'static str> {
        let mut solvers = SOLVERS.into_iter();
        solvers.find(|name| !self.folder.join(name).is_file())
    }

    /// Compiles and links, unless that is done. The C ABI's static library of `profile` must be
    /// there. Its profile is not part of the stamp: both are optimised and of the same sources.
    pub fn build(&self, workspace: &Workspace, profile: CargoProfile) -> TaskResult<()> {
        if self.is_current() {
            say("the OpenFOAM adapter is up to date");
            return Ok(());
        }
        fs::create_dir_all(&self.folder).map_err(|cause| Stop::io(&self.folder, &cause))?;
        let _ = fs::remove_file(self.stamp_file());
        let log = new_log(&workspace.logs, "openfoam-adapter")?;
        let sources = workspace.root.join("adapters");
        let library = workspace
            .target
            .join(profile.folder())
            .join("libcalcine_wire.a");
        let mut command = Command::new("bash");
        command
            .arg(sources.join("openfoam/build.sh"))
            .current_dir(sources.join("openfoam"))
            .env("HEADERS_DIR", &self.headers)
            .env("WIRE_INCLUDE", sources.join("wire/include"))
            .env("WIRE_LIB", &library)
            .env("OUT_DIR", &self.folder);
        step("compile the OpenFOAM adapter (a few minutes)", || {
            quietly(&mut command, &log)
        })?;
        if let Some(name) = self.missing() {
            let message = format!("build.sh left no {name} in {}", self.folder.display());
            return Err(Stop(message));
        }
        let path = self.stamp_file();
        fs::write(&path, &self.stamp).map_err(|cause| Stop::io(&path, &cause))
    }

    /// The finished programs and libraries.
    pub fn products(&self) -> TaskResult<Vec<PathBuf>> {
        let mut files = Vec::new();
        collect(&self.folder, &mut files)?;
        files.retain(|path| {
            let mode = fs::metadata(path).map_or(0, |data| data.permissions().mode());
            mode & 0o111 != 0
        });
        files.sort();
        Ok(files)
    }

    fn stamp_file(&self) -> PathBuf {
        self.folder.join(".stamp")
    }
}

/// A short text that differs when anything does that the C++ is made of.
fn stamp(root: &Path, headers: &Path) -> TaskResult<String> {
    let mut files = vec![
        root.join("Cargo.lock"),
        root.join("adapters/wire/Cargo.toml"),
    ];
    for part in [
        "adapters/openfoam",
        "adapters/wire/include",
        "adapters/wire/src",
    ] {
        collect(&root.join(part), &mut files)?;
    }
    files.sort();
    let mut hasher = DefaultHasher::new();
    headers.file_name().hash(&mut hasher);
    for compiler in ["g++", "rustc"] {
        output(Command::new(compiler).arg("--version")).hash(&mut hasher);
    }
    for file in files {
        file.strip_prefix(root).unwrap_or(&file).hash(&mut hasher);
        fs::read(&file)
            .map_err(|cause| Stop::io(&file, &cause))?
            .hash(&mut hasher);
    }
    Ok(format!("{:016x}\n", hasher.finish()))
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> TaskResult<()> {
    for entry in fs::read_dir(folder)
        .map_err(|cause| Stop::io(folder, &cause))?
        .flatten()
    {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.is_file() {
            files.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stamp_changes_with_a_source_and_not_with_time() {
        let root = std::env::temp_dir().join(format!("xtask stamp {}", std::process::id()));
        let (foam, wire) = (
            root.join("adapters/openfoam"),
            root.join("adapters/wire/src"),
        );
        for folder in [&foam, &wire, &root.join("adapters/wire/include")] {
            fs::create_dir_all(folder).unwrap();
        }
        let others = ["Cargo.lock", "adapters/wire/Cargo.toml"].map(|name| root.join(name));
        for file in others
            .into_iter()
            .chain([foam.join("solver.C"), wire.join("lib.rs")])
        {
            fs::write(file, "one").unwrap();
        }
        let headers = root.join("1912");
        let first = stamp(&root, &headers).unwrap();
        fs::write(foam.join("solver.C"), "one").unwrap();
        assert_eq!(stamp(&root, &headers).unwrap(), first);
        fs::write(wire.join("lib.rs"), "two").unwrap();
        assert_ne!(stamp(&root, &headers).unwrap(), first);
        assert_ne!(
            stamp(&root, &root.join("2006")).unwrap(),
            stamp(&root, &headers).unwrap()
        );
        fs::remove_dir_all(&root).unwrap();
    }
}
