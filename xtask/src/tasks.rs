//! The tasks: set-up, run, test, install.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::adapters::OpenfoamAdapter;
use crate::headers;
use crate::packages::{self, Needs};
use crate::python::{self, PythonEnvironment};
use crate::steps::{Stop, TaskResult, loud_step, new_log, quietly, say, step, visibly};
use crate::workspace::{CargoProfile, Workspace};

/// Installs the packages, prepares the headers and, with `build`, builds for runs.
pub fn set_up(workspace: &Workspace, needs: Needs, build: bool) -> TaskResult<()> {
    let _lock = workspace.lock()?;
    packages::install(needs, &workspace.logs)?;
    if needs.python {
        PythonEnvironment::prepare(workspace)?;
    }
    if build {
        build_parts(workspace, needs, BuildScope::Runs)?;
    } else if needs.openfoam {
        headers::prepare(&workspace.openfoam, &workspace.logs)?;
    }
    Ok(())
}

/// Sets up and builds what the subcommand of Calcine needs, then becomes it.
pub fn run(workspace: &Workspace, words: &[OsString]) -> TaskResult<()> {
    let needs = needs_of(words);
    set_up(workspace, needs, true)?;
    let calcine = workspace
        .target
        .join(CargoProfile::Release.folder())
        .join("calcine");
    let cause = Command::new(&calcine).args(words).exec();
    Err(Stop::io(&calcine, &cause))
}

/// Sets up and builds everything, then runs all tests; natively: those without other solvers.
pub fn test(workspace: &Workspace, native: bool, words: &[OsString]) -> TaskResult<()> {
    let needs = if native {
        Needs {
            tests: true,
            ..Needs::NATIVE
        }
    } else {
        Needs::ALL
    };
    {
        let _lock = workspace.lock()?;
        packages::install(needs, &workspace.logs)?;
        build_parts(workspace, needs, BuildScope::Tests(&["--tests"]))?;
    }
    let mut command = workspace.cargo("test");
    command.arg("--no-fail-fast");
    if !native && !chooses_packages(words) {
        command.arg("--workspace");
    }
    let tested = loud_step("all tests", || visibly(command.args(words)));
    // Words choose among the tests in Rust.
    if native || !words.is_empty() {
        return tested;
    }
    let in_python = python::test(workspace);
    tested.and(in_python)
}

/// Sets up and builds the wheel of the Python package.
pub fn wheel(workspace: &Workspace) -> TaskResult<()> {
    let _lock = workspace.lock()?;
    let needs = Needs {
        python: true,
        ..Needs::NATIVE
    };
    packages::install(needs, &workspace.logs)?;
    python::wheel(workspace)
}

/// Runs one of the test programs of the package `calcine` that have words of their own.
pub fn program(
    workspace: &Workspace,
    name: &str,
    needs: Needs,
    words: &[OsString],
) -> TaskResult<()> {
    let all = needs.openfoam && needs.liggghts && needs.mpi;
    packages::install(needs, &workspace.logs)?;
    if all {
        let _lock = workspace.lock()?;
        build_parts(workspace, needs, BuildScope::Tests(&["--test", name]))?;
    }
    let mut command = workspace.cargo("test");
    command.args(if all {
        &["--workspace"][..]
    } else {
        &["-p", "calcine"]
    });
    command.args(["--test", name, "--"]);
    loud_step(name, || visibly(command.args(words)))
}

/// Copies the command to PREFIX/bin, its adapters to PREFIX/libexec/calcine, and what a solver of the user's own is
/// compiled against to PREFIX/include, PREFIX/lib and PREFIX/share/calcine.
pub fn install(workspace: &Workspace, prefix: &Path, needs: Needs) -> TaskResult<()> {
    {
        let _lock = workspace.lock()?;
        packages::install(needs, &workspace.logs)?;
        build_parts(workspace, needs, BuildScope::Installation)?;
    }
    let built = workspace.target.join(CargoProfile::Release.folder());
    let (bin, libexec) = (prefix.join("bin"), prefix.join("libexec/calcine"));
    let mut copies = vec![(built.join("calcine"), bin.join("calcine"))];
    if needs.liggghts {
        copies.push((
            built.join("calcine-liggghts"),
            libexec.join("calcine-liggghts"),
        ));
    }
    if needs.mpi {
        copies.push((built.join("calcine-mpi"), libexec.join("calcine-mpi")));
    }
    if needs.openfoam {
        for path in OpenfoamAdapter::new(workspace)?.products()? {
            let name = path.file_name().unwrap_or_default().to_owned();
            copies.push((path, libexec.join(name)));
        }
    }
    step(
        &format!("copy {} files below {}", copies.len(), prefix.display()),
        || copies.iter().try_for_each(|(from, to)| copy(from, to)),
    )?;
    step(
        "install the header, library and examples of the C ABI",
        || {
            let script = workspace.root.join("adapters/wire/install.sh");
            let mut command = Command::new(script);
            command.arg(prefix).arg(built.join("libcalcine_wire.a"));
            let log = new_log(&workspace.logs, "install-interface")?;
            quietly(&mut command, &log)
        },
    )?;
    step("install docs, cases, completions and man pages", || {
        let share = prefix.join("share");
        for folder in ["docs", "cases"] {
            copy_tree(
                &workspace.root.join(folder),
                &share.join("calcine").join(folder),
            )?;
        }
        for file in ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE"] {
            copy(
                &workspace.root.join(file),
                &share.join("calcine").join(file),
            )?;
        }
        shell_files(&bin.join("calcine"), &share)
    })?;
    say(&format!("the command is {}", bin.join("calcine").display()));
    Ok(())
}

/// Where the shells that `calcine completions` knows look for them below `share`.
const COMPLETIONS: [(&str, &str); 3] = [
    ("bash", "bash-completion/completions/calcine"),
    ("zsh", "zsh/site-functions/_calcine"),
    ("fish", "fish/vendor_completions.d/calcine.fish"),
];

/// Completions and man pages, by the program itself.
fn shell_files(calcine: &Path, share: &Path) -> TaskResult<()> {
    for (shell, file) in COMPLETIONS {
        let output = Command::new(calcine).args(["completions", shell]).output();
        let output = output.map_err(|cause| Stop::io(calcine, &cause))?;
        if !output.status.success() {
            return Err(Stop(format!("calcine completions {shell} failed")));
        }
        let file = share.join(file);
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).map_err(|cause| Stop::io(folder, &cause))?;
        }
        fs::write(&file, output.stdout).map_err(|cause| Stop::io(&file, &cause))?;
    }
    let made = Command::new(calcine)
        .arg("man")
        .arg(share.join("man/man1"))
        .status();
    match made.map_err(|cause| Stop::io(calcine, &cause))?.success() {
        true => Ok(()),
        false => Err(Stop("calcine man failed".into())),
    }
}

/// Copies a folder with all that is in it.
fn copy_tree(from: &Path, to: &Path) -> TaskResult<()> {
    let entries = fs::read_dir(from).map_err(|cause| Stop::io(from, &cause))?;
    for entry in entries.flatten() {
        let (path, target) = (entry.path(), to.join(entry.file_name()));
        match path.is_dir() {
            true => copy_tree(&path, &target)?,
            false => copy(&path, &target)?,
        }
    }
    Ok(())
}

/// What is built.
#[derive(Clone, Copy)]
pub enum BuildScope<'a> {
    /// The programs of a run, in the profile for runs.
    Runs,
    /// The same, and the library of the C ABI.
    Installation,
    /// Everything, in the profile for tests, with these test programs.
    Tests(&'a [&'a str]),
}

/// One call of Cargo for all packages, so that shared dependencies are built once, then the C++.
pub fn build_parts(workspace: &Workspace, needs: Needs, parts: BuildScope<'_>) -> TaskResult<()> {
    let adapter = needs
        .openfoam
        .then(|| OpenfoamAdapter::new(workspace))
        .transpose()?;
    let (profile, megabytes) = match parts {
        BuildScope::Runs | BuildScope::Installation => (CargoProfile::Release, 1000),
        BuildScope::Tests(_) => (CargoProfile::Dev, 3000),
    };
    if let Some(free) = workspace.free_megabytes().filter(|free| *free < megabytes) {
        let target = workspace.target.display();
        say(&format!(
            "only {free} MB are free on the disk of {target}; from nothing this takes {megabytes} MB"
        ));
    }
    let mut command = workspace.cargo("build");
    command.args(["--profile", profile.name()]);
    match parts {
        BuildScope::Tests(tests) => {
            // The C ABI's test links the static library, which only `cargo build` leaves in place. Test programs, because
            // with what they need libraries have other features: each would be built twice.
            command.args((needs.liggghts && needs.mpi).then_some("--workspace"));
            command.args(["--lib", "--bins"]).args(tests);
        }
        BuildScope::Runs | BuildScope::Installation => {
            command.args(["-p", "calcine"]);
            let is_stale = |adapter: &OpenfoamAdapter| !adapter.is_current();
            if matches!(parts, BuildScope::Installation) || adapter.as_ref().is_some_and(is_stale) {
                command.args(["-p", "calcine-wire"]);
            }
            if needs.liggghts {
                command.args(["-p", "calcine-liggghts"]);
            }
            if needs.mpi {
                command.args(["-p", "calcine-mpi"]);
            }
        }
    }
    loud_step("build the Rust parts", || visibly(&mut command))?;
    adapter.map_or(Ok(()), |adapter| adapter.build(workspace, profile))
}

/// What a subcommand of Calcine needs, from its words: `run --gas openfoam`, `compare
/// --pairings all` (its default), and so on.
fn needs_of(words: &[OsString]) -> Needs {
    let texts: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
    let mut needs = Needs::NATIVE;
    let mut name = |value: &str, everything: bool| {
        needs.openfoam |= everything || value.contains("openfoam");
        needs.liggghts |= everything || value.contains("liggghts");
    };
    let (mut pairings, mut mpi) = (false, false);
    for (at, word) in texts.iter().enumerate() {
        let (option, value) = match word.split_once('=') {
            Some((option, value)) => (option, value),
            None => (&**word, texts.get(at + 1).map_or("", |next| &**next)),
        };
        match option {
            "--gas" | "--particles" => name(value, false),
            "--transport" => mpi |= value == "mpi",
            "--pairings" => {
                pairings = true;
                name(value, value == "all");
            }
            _ => {}
        }
    }
    if texts.first().is_some_and(|word| word == "compare") && !pairings {
        name("", true);
    }
    needs.mpi = mpi && (needs.openfoam || needs.liggghts);
    needs
}

/// True if the words for `cargo test` say which packages.
fn chooses_packages(words: &[OsString]) -> bool {
    words.iter().take_while(|word| *word != "--").any(|word| {
        let text = word.to_string_lossy();
        text.starts_with("-p") || text.starts_with("--package") || text == "--workspace"
    })
}

/// Copies by way of a temporary name, so that a program that runs is replaced, not changed.
fn copy(from: &Path, to: &Path) -> TaskResult<()> {
    let folder = to.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|cause| Stop::io(folder, &cause))?;
    let mut name = OsString::from(".");
    name.push(to.file_name().unwrap_or(OsStr::new("file")));
    name.push(format!(".{}", std::process::id()));
    let temporary: PathBuf = folder.join(name);
    fs::copy(from, &temporary).map_err(|cause| Stop::io(from, &cause))?;
    fs::rename(&temporary, to).map_err(|cause| Stop::io(to, &cause))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn needs(line: &str) -> Needs {
        needs_of(
            &line
                .split_whitespace()
                .map(OsString::from)
                .collect::<Vec<_>>(),
        )
    }

    #[test]
    fn a_run_sets_up_only_the_solvers_it_names() {
        assert_eq!(needs("run case.toml"), Needs::NATIVE);
        assert_eq!(needs("run openfoam.toml --gas native"), Needs::NATIVE);
        let openfoam = Needs {
            openfoam: true,
            ..Needs::NATIVE
        };
        assert_eq!(needs("run case.toml --gas openfoam"), openfoam);
        assert_eq!(
            needs("run case.toml --gas=openfoam --particles native"),
            openfoam
        );
        let liggghts = Needs {
            liggghts: true,
            ..Needs::NATIVE
        };
        assert_eq!(needs("run --particles liggghts case.toml"), liggghts);
        let mpi = Needs {
            mpi: true,
            ..liggghts
        };
        assert_eq!(
            needs("run --particles liggghts case.toml --transport mpi"),
            mpi
        );
        assert_eq!(needs("run case.toml --transport mpi"), Needs::NATIVE);
    }

    #[test]
    fn a_comparison_needs_the_solvers_of_its_pairings() {
        let both = Needs {
            openfoam: true,
            liggghts: true,
            ..Needs::NATIVE
        };
        assert_eq!(needs("compare case.toml"), both);
        assert_eq!(needs("compare case.toml --pairings all"), both);
        let one = Needs {
            openfoam: true,
            ..Needs::NATIVE
        };
        assert_eq!(
            needs("compare case.toml --pairings native+native,openfoam+native"),
            one
        );
        assert_eq!(needs("check case.toml"), Needs::NATIVE);
    }

    #[test]
    fn packages_named_by_the_user_replace_the_workspace() {
        let words = |line: &str| {
            line.split_whitespace()
                .map(OsString::from)
                .collect::<Vec<_>>()
        };
        assert!(chooses_packages(&words("-p calcine-wire")));
        assert!(!chooses_packages(&words("a_law -- -p")));
    }

    #[test]
    fn a_copy_replaces_and_keeps_the_right_to_execute() {
        use std::os::unix::fs::PermissionsExt;
        let root = std::env::temp_dir().join(format!("xtask copy {}", std::process::id()));
        fs::create_dir_all(&root).unwrap();
        let (from, to) = (root.join("from here"), root.join("to there/program"));
        for text in ["old", "new"] {
            fs::write(&from, text).unwrap();
            fs::set_permissions(&from, fs::Permissions::from_mode(0o755)).unwrap();
            copy(&from, &to).unwrap();
        }
        assert_eq!(fs::read_to_string(&to).unwrap(), "new");
        assert_eq!(
            fs::metadata(&to).unwrap().permissions().mode() & 0o777,
            0o755
        );
        assert_eq!(fs::read_dir(to.parent().unwrap()).unwrap().count(), 1);
        fs::remove_dir_all(&root).unwrap();
    }
}
