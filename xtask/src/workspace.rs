//! Where things are: the clone, the target folder, Cargo.

use std::env;
use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::steps::{Stop, TaskResult, output};

/// Places of this clone.
#[derive(Debug)]
pub struct Workspace {
    /// Root of the clone.
    pub root: PathBuf,
    /// Cargo's target folder.
    pub target: PathBuf,
    /// Logs of quiet steps.
    pub logs: PathBuf,
    /// Sources' headers, and what is built against them.
    pub openfoam: PathBuf,
    cargo: OsString,
}

impl Workspace {
    /// Finds the places from what `cargo run` hands over.
    pub fn find() -> TaskResult<Self> {
        let manifest = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
        let root = manifest
            .as_deref()
            .and_then(Path::parent)
            .map(Path::to_path_buf);
        let root = root.ok_or_else(|| {
            Stop::new("CARGO_MANIFEST_DIR is not set: start this as `cargo xtask …` in a clone")
        })?;
        // This program is TARGET/PROFILE/xtask, wherever the user's settings put TARGET.
        let own = env::current_exe().ok();
        let target = own.as_deref().and_then(|path| path.parent()?.parent());
        let target = target.map_or_else(|| root.join("target"), Path::to_path_buf);
        let logs = target.join("xtask");
        let openfoam = target.join("openfoam");
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        Ok(Self {
            root,
            target,
            logs,
            openfoam,
            cargo,
        })
    }

    /// Cargo, to be run in the root of the clone.
    pub fn cargo(&self, subcommand: &str) -> Command {
        let mut command = Command::new(&self.cargo);
        command.current_dir(&self.root).arg(subcommand);
        // What `cargo run` told this program about itself must not leak into other packages.
        for (name, _) in env::vars_os() {
            let text = name.to_string_lossy();
            if text.starts_with("CARGO_PKG_") || text.starts_with("CARGO_MANIFEST_") {
                command.env_remove(&name);
            }
        }
        command
    }

    /// Waits until no other xtask sets up or builds in this target folder. The lock ends with
    /// the returned file, or with this process.
    pub fn lock(&self) -> TaskResult<File> {
        fs::create_dir_all(&self.logs).map_err(|cause| Stop::io(&self.logs, &cause))?;
        let path = self.logs.join("lock");
        let file = File::create(&path).map_err(|cause| Stop::io(&path, &cause))?;
        file.lock().map_err(|cause| Stop::io(&path, &cause))?;
        Ok(file)
    }

    /// Megabytes that are free where the target folder is; `None` where `df` cannot say.
    pub fn free_megabytes(&self) -> Option<u64> {
        let told = output(Command::new("df").args(["-Pm"]).arg(&self.target))?;
        available(&told)
    }
}

/// The fourth column below the heading of POSIX `df`.
fn available(told: &str) -> Option<u64> {
    told.lines().nth(1)?.split_whitespace().nth(3)?.parse().ok()
}

/// A Cargo profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CargoProfile {
    /// For tests; optimised, with debug assertions.
    Dev,
    /// For runs.
    Release,
}

impl CargoProfile {
    /// Its folder below the target folder.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Dev => "debug",
            Self::Release => "release",
        }
    }

    /// Its name for `--profile`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dev => "dev",
            Self::Release => "release",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_room_is_read_from_df() {
        let told = "Filesystem 1048576-blocks Used Available Capacity Mounted on\n/dev/vda 257933 14683 82000 16% /\n";
        assert_eq!(available(told), Some(82000));
        assert_eq!(available("df: no such file\n"), None);
    }
}
