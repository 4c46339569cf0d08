//! The Python package: its environment below the target directory, its tests, its wheel.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::steps::{Stop, TaskResult, loud_step, new_log, quietly, say, step, visibly};
use crate::workspace::{CargoProfile, Workspace};

/// What the environment was made of, kept in it.
const MADE_OF: &str = "requirements-test.txt";

/// The environment with what the tests of the package use.
pub struct PythonEnvironment {
    folder: PathBuf,
}

impl PythonEnvironment {
    /// The environment, made where it is missing or of other requirements.
    pub fn prepare(workspace: &Workspace) -> TaskResult<Self> {
        let folder = workspace.target.join("python");
        let source = workspace.root.join("python").join(MADE_OF);
        let wanted = fs::read(&source).map_err(|cause| Stop::io(&source, &cause))?;
        let stamp = folder.join(MADE_OF);
        let environment = Self { folder };
        if fs::read(&stamp).is_ok_and(|made| made == wanted) {
            return Ok(environment);
        }
        step("install the Python packages of the tests", || {
            let log = new_log(&workspace.logs, "python")?;
            let mut make = Command::new("python3");
            make.args(["-m", "venv", "--clear"])
                .arg(&environment.folder);
            quietly(&mut make, &log)?;
            let mut install = Command::new(environment.program("pip"));
            install.args(["install", "--disable-pip-version-check", "-r"]);
            quietly(install.arg(&source), &log)?;
            fs::write(&stamp, &wanted).map_err(|cause| Stop::io(&stamp, &cause))
        })?;
        Ok(environment)
    }

    /// A folder of the package alone, with the library of a build.
    fn site(&self, workspace: &Workspace, built: &Path, name: &str) -> TaskResult<PathBuf> {
        let site = self.folder.join(name);
        let package = site.join("calcine");
        assemble(&workspace.root.join("python/calcine"), &package)?;
        let (from, to) = (
            built.join("lib_calcine.so"),
            package.join("_calcine.abi3.so"),
        );
        fs::copy(&from, &to).map_err(|cause| Stop::io(&from, &cause))?;
        Ok(site)
    }

    fn program(&self, name: &str) -> PathBuf {
        self.folder.join("bin").join(name)
    }
}

/// Runs the tests of the package and its notebooks, with the library and the command that were built for tests.
pub fn test(workspace: &Workspace) -> TaskResult<()> {
    let environment = PythonEnvironment::prepare(workspace)?;
    let built = workspace.target.join(CargoProfile::Dev.folder());
    let site = environment.site(workspace, &built, "site")?;
    // Not `python -m pytest`, which would import the package from its sources.
    let mut tests = Command::new(environment.program("pytest"));
    tests
        .args(["-q", "-p", "no:cacheprovider"])
        .current_dir(workspace.root.join("python"))
        .env("PYTHONPATH", &site)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        // External solvers are found beside the command.
        .env("PATH", before_path(&built))
        .env("CALCINE", built.join("calcine"));
    loud_step("tests of the Python package", || visibly(&mut tests))
}

/// The variable PATH with a folder before all others.
fn before_path(folder: &Path) -> OsString {
    let mut path = folder.as_os_str().to_owned();
    if let Some(others) = env::var_os("PATH") {
        path.push(":");
        path.push(others);
    }
    path
}

/// Builds command and package in the profile for runs and prints what runs from Python cost beyond the command's, in processor time.
pub fn overhead(workspace: &Workspace, words: &[OsString]) -> TaskResult<()> {
    let environment = PythonEnvironment::prepare(workspace)?;
    let log = new_log(&workspace.logs, "python-overhead")?;
    step("build the command and the package", || {
        // In one call, so that both share their libraries: apart they have other features, and each is built for itself.
        let packages = ["--release", "-p", "calcine", "-p", "calcine-python"];
        quietly(workspace.cargo("build").args(packages), &log)
    })?;
    let built = workspace.target.join(CargoProfile::Release.folder());
    let site = environment.site(workspace, &built, "bench-site")?;
    let mut bench = Command::new(environment.program("python"));
    bench
        .arg(workspace.root.join("python/benches/overhead.py"))
        .args(words)
        .env("PYTHONPATH", &site)
        .env("CALCINE", built.join("calcine"));
    loud_step("overhead of runs from Python", || visibly(&mut bench))
}

/// Builds the wheel in the profile for runs.
pub fn wheel(workspace: &Workspace) -> TaskResult<()> {
    let environment = PythonEnvironment::prepare(workspace)?;
    let out = workspace.target.join("wheels");
    let mut maturin = Command::new(environment.program("maturin"));
    maturin
        .args(["build", "--release", "--manifest-path"])
        .arg(workspace.root.join("python/Cargo.toml"))
        .arg("--out")
        .arg(&out);
    loud_step("build the wheel", || visibly(&mut maturin))?;
    say(&format!("the wheel is in {}", out.display()));
    Ok(())
}

/// Makes the package's folder anew, of its Python files.
fn assemble(source: &Path, package: &Path) -> TaskResult<()> {
    if package.exists() {
        fs::remove_dir_all(package).map_err(|cause| Stop::io(package, &cause))?;
    }
    fs::create_dir_all(package).map_err(|cause| Stop::io(package, &cause))?;
    let entries = fs::read_dir(source).map_err(|cause| Stop::io(source, &cause))?;
    for entry in entries.flatten().filter(|entry| entry.path().is_file()) {
        let to = package.join(entry.file_name());
        fs::copy(entry.path(), &to).map_err(|cause| Stop::io(&to, &cause))?;
    }
    Ok(())
}
