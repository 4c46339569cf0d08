//! Starting a solver's processes and ending them, whatever happens.

use std::ffi::{OsStr, OsString};
use std::fmt;
use std::fs::{self, File};
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::supervisor::has_ended;
use calcine_wire::run::VARIABLE;
use calcine_wire::{LinkAddress, SolverNetwork, Transport, WireError};
use rustix::process::{Pid, PidfdFlags, Signal, kill_process_group, pidfd_open, pidfd_send_signal};

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

/// Who starts a solver's ranks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Launcher {
    /// One rank directly, more under `mpirun`.
    #[default]
    Mpirun,
    /// The user's words before the program, for example `srun -n 16`; they start as many ranks as asked
    /// for.
    Own(Vec<String>),
    /// The user, by hand: Calcine says what to start, and waits.
    Hand,
    /// MPI, in a world of their own that also carries the messages.
    Network(Spawner),
}

/// What spawns ranks.
#[derive(Clone)]
pub struct Spawner(pub Arc<dyn SolverNetwork>);

impl fmt::Debug for Spawner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Spawner")
    }
}

impl PartialEq for Spawner {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for Spawner {}

/// A line without words, which starts nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a launcher needs at least one word, for example `srun -n 16`")]
pub struct EmptyLauncher;

impl Launcher {
    /// The launcher of a command line, words separated by blanks.
    pub fn parse(line: &str) -> Result<Self, EmptyLauncher> {
        let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        if words.is_empty() {
            return Err(EmptyLauncher);
        }
        Ok(Self::Own(words))
    }

    /// The words before the program.
    fn words(&self, ranks: u32) -> Vec<OsString> {
        if let Launcher::Own(words) = self {
            return words.iter().map(OsString::from).collect();
        }
        if ranks <= 1 {
            return Vec::new();
        }
        let mut words = vec!["mpirun".into()];
        // Open MPI refuses root otherwise.
        if rustix::process::geteuid().is_root() {
            words.push("--allow-run-as-root".into());
        }
        words.extend(["--bind-to", "none"].map(OsString::from));
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        if ranks as usize > processors {
            words.push("--oversubscribe".into());
        }
        words.extend(["-n".into(), ranks.to_string().into()]);
        words
    }
}

/// The file by a name without blanks, which OpenFOAM's file names cannot have: where there are some, by a
/// link in the folder.
pub fn without_blanks(file: &Path, folder: &Path) -> std::io::Result<PathBuf> {
    let (true, Some(name)) = (
        file.to_string_lossy().contains(char::is_whitespace),
        file.file_name(),
    ) else {
        return Ok(file.to_owned());
    };
    let link = std::path::absolute(folder.join(name))?;
    match fs::remove_file(&link) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
        _ => std::os::unix::fs::symlink(std::path::absolute(file)?, &link)?,
    }
    Ok(link)
}

impl Program {
    /// The same program by a name without blanks: OpenFOAM refuses a name of its own program that has one
    /// anywhere in its path.
    pub fn without_blanks(mut self) -> std::io::Result<Self> {
        self.path = without_blanks(&self.path, &self.directory)?;
        Ok(self)
    }

    /// The command for a number of ranks.
    fn command(&self, launcher: &Launcher, ranks: u32) -> Command {
        let words = launcher.words(ranks);
        let mut command = if let Some((first, others)) = words.split_first() {
            let mut command = Command::new(first);
            command.args(others).arg(&self.path);
            command
        } else {
            let mut command = Command::new(&self.path);
            // OpenFOAM refuses a name of its own program that has a space anywhere in its path.
            if let Some(name) = self.path.file_name() {
                std::os::unix::process::CommandExt::arg0(&mut command, name);
            }
            command
        };
        command.args(&self.arguments).current_dir(&self.directory);
        for (name, value) in &self.environment {
            command.env(name, value);
        }
        command
    }

    /// A line of a shell that starts the program in its folder, behind a launcher's words.
    fn line(&self, words: &[OsString], variables: &[(&str, OsString)]) -> String {
        let mut line = format!("cd {} && exec env", quoted(self.directory.as_os_str()));
        let own = self.environment.iter();
        let own = own.map(|(name, value)| (name.to_string_lossy(), value));
        let ours = variables
            .iter()
            .map(|(name, value)| ((*name).into(), value));
        for (name, value) in ours.chain(own) {
            line.push_str(&format!(" {name}={}", quoted(value)));
        }
        let words = words.iter().map(|word| word.to_string_lossy().into_owned());
        let program = [self.path.as_os_str()].into_iter();
        let program = program.chain(self.arguments.iter().map(OsString::as_os_str));
        for word in words.chain(program.map(quoted)) {
            line.push(' ');
            line.push_str(&word);
        }
        line
    }
}

/// Has MPI start a program on every rank, its output in a log; gives the coordinator's ends.
pub fn spawn(
    network: &dyn SolverNetwork,
    program: &Program,
    ranks: u32,
    address: &LinkAddress,
    log: &Path,
    patience: Duration,
    is_over: &dyn Fn() -> bool,
) -> Result<Vec<Box<dyn Transport + Send>>, WireError> {
    let failed = |source| WireError::File {
        path: log.to_owned(),
        source,
    };
    if let Some(folder) = log.parent() {
        fs::create_dir_all(folder).map_err(failed)?;
    }
    File::create(log).map_err(failed)?;
    let line = program.line(&[], &[(VARIABLE, address.to_text().into())]);
    let line = format!("{line} >>{} 2>&1", quoted(log.as_os_str()));
    network.spawn(
        &["/bin/sh".into(), "-c".into(), line.into()],
        ranks,
        patience,
        is_over,
    )
}

/// A word for a shell.
pub fn quoted(word: &OsStr) -> String {
    format!("'{}'", word.to_string_lossy().replace('\'', "'\\''"))
}

/// The processes of a started solver: a group of their own, ended and reaped when this is dropped.
#[derive(Debug)]
pub struct Processes {
    /// The solver, or the launcher above it; `None` where somebody else started them.
    child: Option<Child>,
    /// Ranks that introduced themselves and are not the child, in groups of their own.
    ranks: Vec<OwnedFd>,
    ended: bool,
}

/// Variables that Calcine gives to the processes of a solver.
fn variables(
    ranks: u32,
    address: &LinkAddress,
) -> Result<Vec<(&'static str, OsString)>, WireError> {
    let mut variables = vec![
        (VARIABLE, address.to_text().into()),
        // Open MPI's session files go where the run's files go, and with them.
        (
            "OMPI_MCA_orte_tmpdir_base",
            address.root.clone().into_os_string(),
        ),
    ];
    if ranks > 1 {
        let memory = address.make_mpi_memory()?;
        variables.push((
            "OMPI_MCA_btl_vader_backing_directory",
            memory.into_os_string(),
        ));
        // Ranks that wait for each other leave the processor to those that compute.
        variables.push(("OMPI_MCA_mpi_yield_when_idle", "1".into()));
    }
    Ok(variables)
}

impl Processes {
    /// Starts a program with its output in a log file, or says what to start by hand.
    pub fn start(
        who: &str,
        program: &Program,
        launcher: &Launcher,
        ranks: u32,
        address: &LinkAddress,
        log: &Path,
    ) -> Result<Self, PartError> {
        let refuse = |doing: String| {
            move |error: std::io::Error| {
                PartError::new(who, FailureKind::NotStarted, doing).caused_by(error)
            }
        };
        let variables = variables(ranks, address).map_err(|error| {
            PartError::new(who, FailureKind::NotStarted, "its environment").caused_by(error)
        })?;
        if *launcher == Launcher::Hand {
            let line = program.line(&Launcher::Mpirun.words(ranks), &variables);
            eprintln!("{who} waits for {ranks} rank(s); start them with\n  ({line})");
            return Ok(Self::elsewhere());
        }
        if let Some(folder) = log.parent() {
            let doing = format!("the folder {} cannot be made", folder.display());
            fs::create_dir_all(folder).map_err(refuse(doing))?;
        }
        let unwritable = || refuse(format!("the log {} cannot be written", log.display()));
        let output = File::create(log).map_err(unwritable())?;
        let errors = output.try_clone().map_err(unwritable())?;
        let mut command = program.command(launcher, ranks);
        command
            .envs(variables)
            .stdin(Stdio::null())
            .stdout(output)
            .stderr(errors);
        // A group of its own: the terminal's Ctrl-C reaches the coordinator only, which decides.
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let line = format!(
            "{} cannot be started",
            command.get_program().to_string_lossy()
        );
        let child = command.spawn().map_err(refuse(line))?;
        Ok(Self {
            child: Some(child),
            ranks: Vec::new(),
            ended: false,
        })
    }

    /// Processes that somebody else starts.
    pub fn elsewhere() -> Self {
        Self {
            child: None,
            ranks: Vec::new(),
            ended: false,
        }
    }

    /// Process id of the solver, or of the launcher above it.
    pub fn pid(&self) -> Option<u32> {
        self.child.as_ref().map(Child::id)
    }

    /// Takes note of a rank of this machine, so that it ends with the others.
    pub fn add_rank(&mut self, pid: u32) {
        let raw = i32::try_from(pid).ok().and_then(Pid::from_raw);
        let pidfd = raw.and_then(|raw| pidfd_open(raw, PidfdFlags::empty()).ok());
        self.ranks.extend(pidfd);
    }

    /// Waits until the processes have ended by themselves; an error tells how else they ended.
    pub fn wait(&mut self, who: &str, patience: Duration) -> Result<(), PartError> {
        let refuse = |message| Err(PartError::new(who, FailureKind::Protocol, message));
        let begun = Instant::now();
        while begun.elapsed() < patience {
            match self.look() {
                Ok(Some(None)) => {
                    self.ended = true;
                    return Ok(());
                }
                Ok(Some(Some(status))) if status.success() => {
                    self.ended = true;
                    return Ok(());
                }
                Ok(Some(Some(status))) => {
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

    /// Whether all have ended, and with what status where that can be known.
    fn look(&mut self) -> std::io::Result<Option<Option<ExitStatus>>> {
        if let Some(child) = &mut self.child {
            return Ok(child.try_wait()?.map(Some));
        }
        let ended = self
            .ranks
            .iter()
            .all(|rank| has_ended(rank, Duration::ZERO));
        Ok(ended.then_some(None))
    }

    fn signal(&self, signal: Signal) {
        let pid = self.pid().and_then(|pid| i32::try_from(pid).ok());
        if let Some(group) = pid.and_then(Pid::from_raw) {
            // A group without processes is what is wanted.
            let _ = kill_process_group(group, signal);
        }
    }

    /// A launcher that was killed leaves its ranks.
    fn kill_ranks(&self) {
        for rank in &self.ranks {
            // One that has ended is what is wanted.
            let _ = pidfd_send_signal(rank, Signal::KILL);
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
            if matches!(self.look(), Ok(Some(_)) | Err(_)) {
                break;
            }
            // Stopped ranks do not hear their launcher; nor do those that wait for one that is gone, or have none.
            if self.child.is_none() || begun.elapsed() > GRACE / 8 {
                self.kill_ranks();
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        // The leader may be reaped; others of its group may linger.
        self.signal(Signal::KILL);
        self.kill_ranks();
        if let Some(child) = &mut self.child {
            let _ = child.wait();
        }
        for rank in &self.ranks {
            has_ended(rank, GRACE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program() -> Program {
        Program {
            path: "/opt/it's here/solver".into(),
            arguments: vec!["-parallel".into()],
            directory: "/case".into(),
            environment: vec![("PWD".into(), "/case".into())],
        }
    }

    fn words(command: &Command) -> Vec<String> {
        let words = std::iter::once(command.get_program()).chain(command.get_args());
        words
            .map(|word| word.to_string_lossy().into_owned())
            .collect()
    }

    #[test]
    fn one_rank_starts_directly_and_more_under_mpirun_or_the_user_s_launcher() {
        let alone = program().command(&Launcher::Mpirun, 1);
        assert_eq!(words(&alone), ["/opt/it's here/solver", "-parallel"]);
        let four = words(&program().command(&Launcher::Mpirun, 4));
        assert_eq!(four[0], "mpirun");
        assert!(four.windows(2).any(|pair| pair == ["-n", "4"]), "{four:?}");
        let own = Launcher::parse("srun -n 16").unwrap();
        assert_eq!(
            words(&program().command(&own, 16)),
            ["srun", "-n", "16", "/opt/it's here/solver", "-parallel"]
        );
        assert_eq!(Launcher::parse("  "), Err(EmptyLauncher));
    }

    #[test]
    fn what_to_start_by_hand_can_be_pasted() {
        let line = program().line(&[], &[("CALCINE_LINK", "1 a b".into())]);
        assert_eq!(
            line,
            "cd '/case' && exec env CALCINE_LINK='1 a b' PWD='/case' '/opt/it'\\''s here/solver' \
             '-parallel'"
        );
    }
}
