//! Starting a solver's processes and ending them, whatever happens.

use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use calcine_coupler::error::{FailureKind, PartError};
use calcine_wire::LinkAddress;
use calcine_wire::run::VARIABLE;
use rustix::process::{Pid, Signal, kill_process_group};

/// How long processes may take to end after SIGTERM, before SIGKILL.
const GRACE: Duration = Duration::from_secs(2);

/// A program to run as a solver.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// The executable.
    pub path: PathBuf,
    /// Its arguments.
    pub arguments: Vec<OsString>,
    /// Where it runs.
    pub directory: PathBuf,
    /// Variables added to its environment.
    pub environment: Vec<(OsString, OsString)>,
}

impl Program {
    /// The command line for a number of ranks: one rank directly, more under `mpirun`.
    fn command(&self, ranks: u32) -> Command {
        let mut command = if ranks <= 1 {
            let mut command = Command::new(&self.path);
            // OpenFOAM refuses a name of its own program that has a space anywhere in its path.
            if let Some(name) = self.path.file_name() {
                std::os::unix::process::CommandExt::arg0(&mut command, name);
            }
            command
        } else {
            let mut mpirun = Command::new("mpirun");
            mpirun.args(["--allow-run-as-root", "--bind-to", "none"]);
            let processors = std::thread::available_parallelism().map_or(1, usize::from);
            if ranks as usize > processors {
                mpirun.arg("--oversubscribe");
            }
            mpirun.args(["-n", &ranks.to_string()]).arg(&self.path);
            mpirun
        };
        command.args(&self.arguments).current_dir(&self.directory);
        for (name, value) in &self.environment {
            command.env(name, value);
        }
        command
    }
}

/// Finds a program of Calcine: the variable's path, or beside the running executable (also one folder
/// up, for tests; in `openfoam/bin` of the target folder; in `libexec/calcine` of an installation).
pub fn find_program(variable: &str, name: &str, remedy: &str) -> Result<PathBuf, PartError> {
    if let Some(path) = std::env::var_os(variable).map(PathBuf::from) {
        return Ok(path);
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
    found.ok_or_else(|| {
        let place = folder.display();
        let message = format!(
            "the program was found neither in {place} nor in the variable {variable}; {remedy}"
        );
        PartError::new(name, FailureKind::NotStarted, message)
    })
}

/// The processes of a started solver: a group of their own, ended and reaped when this is dropped.
#[derive(Debug)]
pub struct Processes {
    child: Child,
    ended: bool,
}

impl Processes {
    /// Starts a program with its output in a log file.
    pub fn start(
        who: &str,
        program: &Program,
        ranks: u32,
        address: &LinkAddress,
        log: &Path,
    ) -> Result<Self, PartError> {
        let refuse = |doing: String| {
            move |error: std::io::Error| {
                PartError::new(who, FailureKind::NotStarted, doing).caused_by(error)
            }
        };
        if let Some(folder) = log.parent() {
            let doing = format!("the folder {} cannot be made", folder.display());
            fs::create_dir_all(folder).map_err(refuse(doing))?;
        }
        let unwritable = || refuse(format!("the log {} cannot be written", log.display()));
        let output = File::create(log).map_err(unwritable())?;
        let errors = output.try_clone().map_err(unwritable())?;
        let mut command = program.command(ranks);
        command
            .env(VARIABLE, address.to_text())
            // Open MPI's session files go where the run's files go, and with them.
            .env("OMPI_MCA_orte_tmpdir_base", &address.root)
            .stdin(Stdio::null())
            .stdout(output)
            .stderr(errors);
        // A group of its own: the terminal's Ctrl-C reaches the coordinator only, which decides.
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let line = format!("{} cannot be started", program.path.display());
        let child = command.spawn().map_err(refuse(line))?;
        Ok(Self {
            child,
            ended: false,
        })
    }

    /// Process id of the solver, or of the `mpirun` above it.
    pub fn pid(&self) -> u32 {
        self.child.id()
    }

    /// Waits until the processes have ended by themselves; an error tells how else they ended.
    pub fn wait(&mut self, who: &str, patience: Duration) -> Result<(), PartError> {
        let refuse = |message| Err(PartError::new(who, FailureKind::Protocol, message));
        let begun = Instant::now();
        while begun.elapsed() < patience {
            match self.child.try_wait() {
                Ok(Some(status)) if status.success() => {
                    self.ended = true;
                    return Ok(());
                }
                Ok(Some(status)) => {
                    self.ended = true;
                    return refuse(format!("said goodbye, but ended with {status}"));
                }
                Ok(None) => std::thread::sleep(Duration::from_millis(2)),
                Err(error) => return refuse(format!("cannot be waited for: {error}")),
            }
        }
        refuse(format!(
            "said goodbye, but still runs {} s later",
            patience.as_secs()
        ))
    }

    fn signal(&self, signal: Signal) {
        let pid = i32::try_from(self.child.id()).ok().and_then(Pid::from_raw);
        if let Some(group) = pid {
            // A group without processes is what is wanted.
            let _ = kill_process_group(group, signal);
        }
    }
}

impl Drop for Processes {
    fn drop(&mut self) {
        if self.ended {
            return;
        }
        self.signal(Signal::TERM);
        let begun = Instant::now();
        while begun.elapsed() < GRACE {
            if matches!(self.child.try_wait(), Ok(Some(_)) | Err(_)) {
                // The leader is reaped; others of its group may linger.
                self.signal(Signal::KILL);
                return;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        self.signal(Signal::KILL);
        let _ = self.child.wait();
    }
}
