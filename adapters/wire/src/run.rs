//! The private place of a run in shared memory and on disk: names, the address that solvers get, and
//! the removal of everything, also what dead coordinators left.

use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::ErrorKind;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use rustix::fs::{FlockOperation, flock};

use crate::error::WireError;
use crate::guard::Guard;
use crate::process::{machine, started};

/// The variable that tells a solver which link to open.
pub const VARIABLE: &str = "CALCINE_LINK";
/// Where Linux keeps shared memory.
const MEMORY: &str = "/dev/shm";
const NAME: &str = "calcine-";
/// Begins the address of a link over MPI.
const MPI: &str = "mpi@";
/// A socket's path ends at 108 bytes (unix(7)); the wire appends the prefix and about 46 more.
const LONGEST: usize = 60;

/// How often, and after what pause, a dead coordinator's files are looked for again.
const TRIES: u32 = 5;
const AGAIN: Duration = Duration::from_millis(10);

static SERIAL: AtomicU32 = AtomicU32::new(0);

/// What carries a link's messages.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum TransportKind {
    /// Shared memory of this machine.
    #[default]
    SharedMemory,
    /// MPI, from a coordinator on this machine.
    Mpi {
        /// The coordinator's boot and process-id namespace.
        machine: String,
    },
}

/// Where a run keeps its files: what both ends of a link must agree on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkAddress {
    /// Name of the run, `calcine-PID-STARTED-SERIAL`; begins the names of its shared memory.
    pub name: String,
    /// Which solver, for example "gas".
    pub role: String,
    /// Directory of the wire's sockets and service files.
    pub root: PathBuf,
    /// What carries the messages.
    pub means: TransportKind,
}

impl LinkAddress {
    /// The same address for ranks that MPI spawns.
    pub fn over_mpi(self) -> Self {
        Self {
            means: TransportKind::Mpi { machine: machine() },
            ..self
        }
    }

    /// True where the coordinator is on this machine, so that its process id means something.
    pub fn is_here(&self) -> bool {
        match &self.means {
            TransportKind::SharedMemory => true,
            TransportKind::Mpi { machine: theirs } => *theirs == machine(),
        }
    }

    /// The text that the launcher puts into [`VARIABLE`].
    pub fn to_text(&self) -> String {
        let root = self.root.display();
        let means = match &self.means {
            TransportKind::SharedMemory => "1".into(),
            TransportKind::Mpi { machine } => format!("{MPI}{machine}"),
        };
        format!("{means} {} {} {root}", self.name, self.role)
    }

    /// Reads what [`LinkAddress::to_text`] wrote.
    pub fn from_text(text: &str) -> Result<Self, WireError> {
        let refuse = || WireError::Address {
            detail: format!("holds `{text}`, which is no address of a link"),
        };
        let mut parts = text.splitn(4, ' ');
        let mut next = || {
            parts
                .next()
                .filter(|part| !part.is_empty())
                .ok_or_else(refuse)
        };
        let first = next()?;
        let means = match first.strip_prefix(MPI) {
            Some(machine) => TransportKind::Mpi {
                machine: machine.into(),
            },
            None if first == "1" => TransportKind::SharedMemory,
            None => return Err(refuse()),
        };
        let (name, role, root) = (
            next()?.to_owned(),
            next()?.to_owned(),
            PathBuf::from(next()?),
        );
        // Files are removed by this name and root: nothing but a run's own may pass.
        let own = |name: &str| owner_of(name).is_some() && !name.contains('/');
        if !own(&name) || root.file_name().and_then(|last| last.to_str()) != Some(&name) {
            return Err(refuse());
        }
        Ok(Self {
            name,
            role,
            root,
            means,
        })
    }

    /// The address in this process' environment.
    pub fn from_environment() -> Result<Self, WireError> {
        let text = std::env::var(VARIABLE).map_err(|_| WireError::Address {
            detail: "is not set".into(),
        })?;
        Self::from_text(&text)
    }

    /// The coordinator's process id and the start time that tells it from a later process.
    pub fn coordinator(&self) -> Result<(u32, u64), WireError> {
        owner_of(&self.name).ok_or_else(|| WireError::Address {
            detail: format!("names the run `{}`, which has no process id", self.name),
        })
    }

    /// The run's number on the wire: the FNV-1a hash of its name.
    pub fn number(&self) -> u64 {
        let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        self.name.bytes().fold(0xcbf2_9ce4_8422_2325, mix)
    }

    /// Makes the folder where Open MPI keeps the shared memory between a solver's ranks. Its own
    /// names would say neither whose it is nor whether it is still in use.
    pub fn make_mpi_memory(&self) -> Result<PathBuf, WireError> {
        let path = Path::new(MEMORY).join(format!("{}_mpi-{}", self.name, self.role));
        match DirBuilder::new().mode(0o700).create(&path) {
            Err(source) if source.kind() != ErrorKind::AlreadyExists => {
                Err(WireError::File { path, source })
            }
            _ => Ok(path),
        }
    }

    /// Takes the access of other users from the run's shared memory: iceoryx2 opens its management segment to all.
    pub(crate) fn make_private(&self) {
        for file in in_memory(&self.name) {
            let open = |about: fs::Metadata| about.is_file() && about.mode() & 0o077 != 0;
            if file.metadata().is_ok_and(open) {
                // One that is gone meanwhile needs nothing.
                let _ = fs::set_permissions(file.path(), fs::Permissions::from_mode(0o600));
            }
        }
    }

    /// Removes every file of a dead coordinator: of this run, and of others that it began and for which there may
    /// be no solver yet. What somebody else makes or removes meanwhile is looked for again.
    pub fn remove_files(&self) {
        let scratch = self.root.parent().unwrap_or(Path::new("/tmp"));
        let owner = owner_of(&self.name);
        for _ in 0..TRIES {
            let names = names_below(scratch);
            let own = names.iter().filter(|name| owner_of(name) == owner);
            let own: Vec<_> = own.collect();
            if own.is_empty() {
                return;
            }
            for name in own {
                remove_files(name, &scratch.join(name));
            }
            std::thread::sleep(AGAIN);
        }
    }
}

/// A run of this process; its files go when it is dropped.
#[derive(Debug)]
pub struct RunDirectory {
    name: String,
    root: PathBuf,
    /// Locked while this process lives.
    _alive: File,
    guard: Guard,
    is_over: bool,
}

impl RunDirectory {
    /// Makes a private place for a run, after removing what dead coordinators of this user left.
    pub fn create() -> Result<Self, WireError> {
        remove_stale(&std::env::temp_dir());
        let pid = std::process::id();
        let started = started(pid).unwrap_or_default();
        let serial = SERIAL.fetch_add(1, Ordering::Relaxed);
        let name = format!("{NAME}{pid}-{started:x}-{serial}");
        let root = root_of(&name)?;
        // Before there is anything to remove.
        let guard = Guard::start(&root, &Path::new(MEMORY).join(&name))?;
        let alive_path = Path::new(MEMORY).join(format!("{name}_alive"));
        let alive = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(true)
            .mode(0o600)
            .open(&alive_path)
            .map_err(|source| WireError::File {
                path: alive_path.clone(),
                source,
            })?;
        let run = Self {
            name,
            root,
            _alive: alive,
            guard,
            is_over: false,
        };
        flock(&run._alive, FlockOperation::NonBlockingLockExclusive).map_err(|error| {
            WireError::File {
                path: alive_path,
                source: error.into(),
            }
        })?;
        DirBuilder::new()
            .mode(0o700)
            .create(&run.root)
            .map_err(|source| WireError::File {
                path: run.root.clone(),
                source,
            })?;
        Ok(run)
    }

    /// To be called where all processes of the run have ended in an orderly way: nothing makes files any more. Else what
    /// such processes still make after this run is removed for some seconds, when this process may have ended.
    pub fn end(&mut self) {
        self.is_over = true;
    }

    /// The address of a role's links.
    pub fn address(&self, role: &str) -> LinkAddress {
        LinkAddress {
            name: self.name.clone(),
            role: role.into(),
            root: self.root.clone(),
            means: TransportKind::SharedMemory,
        }
    }
}

impl Drop for RunDirectory {
    fn drop(&mut self) {
        remove_files(&self.name, &self.root);
        if self.is_over {
            self.guard.dismiss();
        }
    }
}

fn root_of(name: &str) -> Result<PathBuf, WireError> {
    let path = std::env::temp_dir().join(name);
    // The prefix, name and an underscore, is appended to the root once more.
    let length = path.as_os_str().len() + name.len() + 1;
    if length <= LONGEST + NAME.len() {
        return Ok(path);
    }
    Err(WireError::LongPath {
        path,
        length,
        limit: LONGEST + NAME.len(),
    })
}

/// Process id and start time in a run's name.
fn owner_of(name: &str) -> Option<(u32, u64)> {
    let mut parts = name.strip_prefix(NAME)?.split('-');
    let pid = parts.next()?.parse().ok()?;
    let started = u64::from_str_radix(parts.next()?, 16).ok()?;
    parts.next()?.parse::<u32>().ok()?;
    parts.next().is_none().then_some((pid, started))
}

/// True where the coordinator of a run lives: its process, or its lock, which also holds across
/// containers that share the memory but not the process ids.
fn lives(name: &str) -> bool {
    let Some((pid, since)) = owner_of(name) else {
        return true;
    };
    if started(pid) == Some(since) {
        return true;
    }
    let Ok(lock) = File::open(Path::new(MEMORY).join(format!("{name}_alive"))) else {
        return false;
    };
    flock(&lock, FlockOperation::NonBlockingLockShared).is_err()
}

/// Removes the files of runs whose coordinator is dead, of this user only.
fn remove_stale(scratch: &Path) {
    for name in names_below(scratch).iter().filter(|name| !lives(name)) {
        remove_files(name, &scratch.join(name));
    }
}

/// Names of this user's runs that have files in shared memory or below the folder for scratch.
fn names_below(scratch: &Path) -> Vec<String> {
    let user = rustix::process::geteuid().as_raw();
    let mut names = Vec::new();
    for directory in [Path::new(MEMORY), scratch] {
        for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
            let file = entry.file_name();
            let name = file.to_str().and_then(|name| name.split('_').next());
            let own = entry.metadata().is_ok_and(|data| data.uid() == user);
            if let Some(name) = name.filter(|name| own && owner_of(name).is_some()) {
                names.push(name.to_owned());
            }
        }
    }
    names.sort();
    names.dedup();
    names
}

/// What a run has in shared memory.
fn in_memory(name: &str) -> impl Iterator<Item = fs::DirEntry> {
    let prefix = format!("{name}_");
    let entries = fs::read_dir(MEMORY).into_iter().flatten().flatten();
    entries.filter(move |entry| {
        let name = entry.file_name();
        name.to_str().is_some_and(|name| name.starts_with(&prefix))
    })
}

/// Removes a run's shared memory and its root; what cannot be removed is told on stderr.
fn remove_files(name: &str, root: &Path) {
    let tell = |path: &Path, error: std::io::Error| {
        if error.kind() != ErrorKind::NotFound {
            eprintln!("{} could not be removed: {error}", path.display());
        }
    };
    for entry in in_memory(name) {
        let folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        let removed = match folder {
            false => fs::remove_file(entry.path()),
            true => fs::remove_dir_all(entry.path()),
        };
        if let Err(error) = removed {
            tell(&entry.path(), error);
        }
    }
    if let Err(error) = fs::remove_dir_all(root) {
        tell(root, error);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared_memory::{LinkEnd, SharedMemory};

    fn files_of(name: &str) -> usize {
        fs::read_dir(MEMORY)
            .unwrap()
            .flatten()
            .filter(|entry| entry.file_name().to_str().unwrap().starts_with(name))
            .count()
    }

    #[test]
    fn other_users_have_no_access_to_what_a_run_keeps() {
        let run = RunDirectory::create().unwrap();
        let end = LinkEnd::Coordinator;
        let _link = SharedMemory::open(&run.address("gas"), 0, end).unwrap();
        let modes: Vec<u32> = in_memory(&run.name)
            .map(|file| file.metadata().unwrap().mode() & 0o077)
            .collect();
        assert!(modes.len() > 2, "{modes:?}");
        assert!(modes.iter().all(|mode| *mode == 0), "{modes:?}");
        assert_eq!(fs::metadata(&run.root).unwrap().mode() & 0o077, 0);
    }

    #[test]
    fn an_address_survives_its_text_and_names_this_process() {
        let run = RunDirectory::create().unwrap();
        let address = run.address("gas");
        assert_eq!(LinkAddress::from_text(&address.to_text()).unwrap(), address);
        let mpi = address.clone().over_mpi();
        assert_eq!(LinkAddress::from_text(&mpi.to_text()).unwrap(), mpi);
        assert!(mpi.is_here());
        let far = mpi.to_text().replace("mpi@", "mpi@elsewhere-");
        assert!(!LinkAddress::from_text(&far).unwrap().is_here());
        assert_eq!(address.coordinator().unwrap().0, std::process::id());
    }

    #[test]
    fn a_run_leaves_nothing_behind() {
        let run = RunDirectory::create().unwrap();
        let address = run.address("gas");
        assert_eq!(files_of(&address.name), 1);
        assert!(address.root.is_dir());
        fs::write(address.make_mpi_memory().unwrap().join("segment"), b"x").unwrap();
        assert_eq!(files_of(&address.name), 2);
        drop(run);
        assert_eq!(files_of(&address.name), 0);
        assert!(!address.root.exists());
    }

    #[test]
    fn a_dead_coordinators_files_go_and_a_living_ones_stay() {
        let living = RunDirectory::create().unwrap();
        // Process 1 lives, but did not start at tick 2^60.
        let dead = format!("{NAME}1-1000000000000000-7");
        fs::write(Path::new(MEMORY).join(format!("{dead}_x.data")), b"x").unwrap();
        fs::create_dir(std::env::temp_dir().join(&dead)).unwrap();
        let next = RunDirectory::create().unwrap();
        assert_eq!(files_of(&dead), 0);
        assert!(!std::env::temp_dir().join(&dead).exists());
        assert!(living.root.is_dir() && next.root.is_dir());
    }

    #[test]
    fn a_solver_of_a_dead_coordinator_removes_the_files_of_all_its_runs() {
        let scratch = tempfile::tempdir().unwrap();
        let name = |serial: u32| format!("{NAME}1-1000000000000001-{serial}");
        for serial in 0..2 {
            fs::create_dir(scratch.path().join(name(serial))).unwrap();
            fs::write(scratch.path().join(name(serial)).join("socket"), b"x").unwrap();
            let file = format!("{}_alive", name(serial));
            fs::write(Path::new(MEMORY).join(file), b"x").unwrap();
        }
        let other = format!("{NAME}1-1000000000000002-0");
        fs::create_dir(scratch.path().join(&other)).unwrap();
        let root = scratch.path().join(name(0)).display().to_string();
        let address = LinkAddress::from_text(&format!("1 {} gas {root}", name(0))).unwrap();
        address.remove_files();
        assert_eq!(files_of(&name(0)) + files_of(&name(1)), 0);
        let left: Vec<_> = fs::read_dir(scratch.path()).unwrap().flatten().collect();
        assert_eq!(left.len(), 1);
        assert_eq!(left[0].file_name().to_str(), Some(&*other));
    }

    #[test]
    fn an_address_that_could_remove_other_files_is_refused() {
        for text in [
            "",
            "2 calcine-1-1-0 gas /tmp/calcine-1-1-0",
            "1 calcine-1-1-0 gas /var/elsewhere",
            "1 other gas /tmp/other",
            "1 calcine-1-1-0/.. gas /tmp/calcine-1-1-0/..",
        ] {
            assert!(LinkAddress::from_text(text).is_err(), "{text}");
        }
    }
}
