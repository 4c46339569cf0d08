//! Debian's packages: what a task needs of them, what is missing, and its installation.

use std::env;
use std::io::{self, IsTerminal};
use std::path::Path;
use std::process::Command;

use crate::steps::{Stop, TaskResult, new_log, output, quietly, say, shown, step};

/// What a task needs besides Rust and a C compiler.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The OpenFOAM side: its package, headers and our C++.
    pub openfoam: bool,
    /// The LIGGGHTS host.
    pub liggghts: bool,
    /// The program that spawns solvers by MPI.
    pub mpi: bool,
    /// What tests read results and check cases with, and a compiler for the C ABI.
    pub tests: bool,
    /// The Python package, and an environment for its tests.
    pub python: bool,
    /// OpenFOAM's tutorials, which a benchmark runs.
    pub examples: bool,
}

/// Packages with others that have the same: ParaView's Python has VTK, and conflicts with the package of VTK's.
const STAND_INS: &[(&str, &str)] = &[("python3-vtk9", "python3-paraview")];

impl Needs {
    /// A native run only.
    pub const NATIVE: Self = Self {
        openfoam: false,
        liggghts: false,
        mpi: false,
        tests: false,
        python: false,
        examples: false,
    };
    /// Everything that runs and tests need.
    pub const ALL: Self = Self {
        openfoam: true,
        liggghts: true,
        mpi: true,
        tests: true,
        python: true,
        examples: false,
    };

    /// Names of Debian's packages, each once.
    pub fn packages(self) -> Vec<&'static str> {
        let mut names = vec!["libhdf5-dev"];
        let mut add = |wanted: bool, more: &[&'static str]| {
            for name in more.iter().filter(|_| wanted) {
                if !names.contains(name) {
                    names.push(name);
                }
            }
        };
        add(
            self.openfoam,
            &[
                "openfoam",
                "dpkg-dev",
                "g++",
                "libopenmpi-dev",
                "openmpi-bin",
            ],
        );
        add(
            self.liggghts,
            &[
                "liggghts",
                "libliggghts-dev",
                "libopenmpi-dev",
                "openmpi-bin",
            ],
        );
        // What rsmpi is built with: mpicc, and libclang for its bindings.
        add(self.mpi, &["libopenmpi-dev", "openmpi-bin", "libclang-dev"]);
        add(
            self.tests,
            &["g++", "python3-vtk9", "python3-h5py", "python3-jsonschema"],
        );
        add(self.python, &["python3-venv"]);
        add(self.examples, &["openfoam-examples"]);
        names
    }
}

/// Installs what is missing of the packages needed.
pub fn install(needs: Needs, logs: &Path) -> TaskResult<()> {
    let wanted = needs.packages();
    if !is_here("dpkg-query") {
        return without_debian(needs, &wanted);
    }
    let missing: Vec<&str> = wanted
        .iter()
        .copied()
        .filter(|name| !is_installed(name) && !stands_in(name))
        .collect();
    if missing.is_empty() {
        say(&format!("Debian's packages are here: {}", wanted.join(" ")));
        return Ok(());
    }
    let commands = [update(), installation(&missing)];
    let prefix = privileges(&commands)?;
    let log = new_log(logs, "packages")?;
    let [update, installation] = commands;
    step("apt-get update", || {
        quietly(&mut with(&prefix, &update), &log)
    })?;
    step(&format!("install {}", missing.join(" ")), || {
        quietly(&mut with(&prefix, &installation), &log)
    })
}

fn update() -> Command {
    let mut command = apt_get();
    command.arg("update");
    command
}

fn installation(missing: &[&str]) -> Command {
    let mut command = apt_get();
    command
        .args(["install", "-y", "--no-install-recommends", "--no-remove"])
        .args(missing);
    command
}

/// `apt-get` that asks nothing and waits up to two minutes for another one to end.
fn apt_get() -> Command {
    let mut command = Command::new("env");
    command.args(["DEBIAN_FRONTEND=noninteractive", "apt-get", "-q"]);
    command.args(["-o", "DPkg::Lock::Timeout=120"]);
    command
}

/// The words before a command that needs root: none, or `sudo`.
fn privileges(commands: &[Command]) -> TaskResult<Vec<&'static str>> {
    if user_id() == Some(0) {
        return Ok(Vec::new());
    }
    if is_here("sudo") {
        if io::stdin().is_terminal() {
            return Ok(vec!["sudo"]);
        }
        if output(Command::new("sudo").args(["-n", "true"])).is_some() {
            return Ok(vec!["sudo", "-n"]);
        }
    }
    let lines: Vec<String> = commands
        .iter()
        .map(|command| format!("  {}", shown(command)))
        .collect();
    Err(Stop(format!(
        "packages of Debian's are missing, and installing them needs root: neither root nor a \
         usable sudo here. Let somebody with root run\n{}\nand start this command again",
        lines.join("\n")
    )))
}

fn with(prefix: &[&str], command: &Command) -> Command {
    let Some((first, rest)) = prefix.split_first() else {
        let mut same = Command::new(command.get_program());
        same.args(command.get_args());
        return same;
    };
    let mut longer = Command::new(first);
    longer
        .args(rest)
        .arg(command.get_program())
        .args(command.get_args());
    longer
}

/// Another system than Debian: a native run may have its HDF5 from elsewhere.
fn without_debian(needs: Needs, wanted: &[&str]) -> TaskResult<()> {
    let hdf5 = env::var_os("HDF5_DIR").is_some()
        || output(Command::new("pkg-config").args(["--exists", "hdf5"])).is_some();
    if needs == Needs::NATIVE && hdf5 {
        return Ok(());
    }
    Err(Stop(format!(
        "this system has no dpkg; set-up knows Debian 12 only. Needed here: {}. With HDF5 \
         installed and HDF5_DIR set, a native run works without",
        wanted.join(" ")
    )))
}

/// True if `dpkg` says that the package is installed.
pub fn is_installed(package: &str) -> bool {
    query(package, "${db:Status-Status}").is_some_and(|status| status == "installed")
}

/// True where another installed package has what this one has, and both cannot be installed.
fn stands_in(package: &str) -> bool {
    let mut pairs = STAND_INS.iter().filter(|(name, _)| *name == package);
    pairs.any(|(_, other)| is_installed(other))
}

/// Version of the source package that an installed package was built from.
pub fn source_version(package: &str) -> Option<String> {
    is_installed(package)
        .then(|| query(package, "${source:Version}"))
        .flatten()
}

/// What `dpkg-query` shows; of several architectures the first.
fn query(package: &str, field: &str) -> Option<String> {
    let format = format!("{field}\\n");
    let text = output(Command::new("dpkg-query").args(["-W", "-f", &format, package]))?;
    text.lines()
        .next()
        .map(|line| line.trim().to_owned())
        .filter(|line| !line.is_empty())
}

/// True if a program of this name is on the PATH.
pub fn is_here(program: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// The effective user id, 0 for root.
pub fn user_id() -> Option<u32> {
    output(Command::new("id").arg("-u"))?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_native_run_needs_hdf5_and_no_solver() {
        assert_eq!(Needs::NATIVE.packages(), ["libhdf5-dev"]);
    }

    #[test]
    fn no_package_is_asked_for_twice() {
        let mut names = Needs::ALL.packages();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        for name in [
            "openfoam",
            "libliggghts-dev",
            "openmpi-bin",
            "libclang-dev",
            "dpkg-dev",
            "python3-h5py",
        ] {
            assert!(names.contains(&name), "{name}");
        }
    }

    #[test]
    fn the_command_for_somebody_with_root_can_be_pasted() {
        assert_eq!(
            shown(&installation(&["libhdf5-dev", "g++"])),
            "env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=120 install -y \
             --no-install-recommends --no-remove libhdf5-dev g++"
        );
    }

    #[test]
    fn sudo_goes_before_the_whole_command() {
        let command = with(&["sudo", "-n"], &update());
        assert!(shown(&command).starts_with("sudo -n env DEBIAN_FRONTEND=noninteractive apt-get"));
    }
}
