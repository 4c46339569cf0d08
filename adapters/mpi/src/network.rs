//! Spawning solvers, and how a coordinator that has spawned some comes to its end.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::process;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use calcine_wire::process::parent;
use calcine_wire::run::VARIABLE;
use calcine_wire::{
    CarriedTransport, LinkAddress, RunDirectory, SolverNetwork, Transport, WireError,
};
use mpi::Threading;
use mpi::environment::Universe;

use crate::carrier::{SpawnedWorld, at_end, end_at_once, place_files};

/// Between two looks at ranks that are starting, short enough to see one that dies at once; and how many looks
/// make its end certain.
const LOOK: Duration = Duration::from_millis(10);
const CERTAIN: u32 = 20;

/// What Open MPI starts beside a process that no launcher of its own has started.
const DAEMON: &str = "orted";

/// Begins the variable by which Open MPI tells a process its rank.
const RANK: &str = "OMPI_COMM_WORLD_RANK=";

/// MPI in this process, and the worlds that it has spawned.
pub struct MpiNetwork {
    run: RunDirectory,
    /// Worlds that have not ended in an orderly way.
    worlds: AtomicU32,
    /// Ranks that were seen while they started, by the variable with their link's address.
    seen: Mutex<BTreeMap<String, Ranks>>,
}

/// Process ids and the rank of each.
type Ranks = BTreeMap<u32, usize>;

/// Where this run's files are, and whether this process comes to its end by itself.
static FILES: OnceLock<LinkAddress> = OnceLock::new();
/// As many threads as may call `exit` at once.
const THREADS: usize = 4;
static ENDS: AtomicBool = AtomicBool::new(false);

/// How long the run has, once Open MPI ends this process, to find by itself who has died, to say so and to end.
const ITSELF: Duration = Duration::from_millis(2500);

/// Open MPI ends its process by `exit` or `_exit` a second after its own daemon has died, from any thread and from several at
/// once. The run, which watches the daemon too, has mostly ended by then or is about to; else the first that comes here has to say so
/// and to clean up, and the others wait for it.
extern "C" fn ended_by_mpi() {
    static TAKEN: AtomicBool = AtomicBool::new(false);
    let Some(files) = FILES.get().filter(|_| !ENDS.load(Ordering::SeqCst)) else {
        return;
    };
    if TAKEN.swap(true, Ordering::SeqCst) {
        std::thread::sleep(Duration::from_secs(5));
        return;
    }
    // The thread in which the run would end cannot while it is here.
    if rustix::thread::gettid() != rustix::process::getpid() {
        std::thread::sleep(ITSELF);
    }
    eprintln!(
        "MPI has ended this run: its daemon (orted) died, or MPI could not be started; see the logs of \
         the solvers in the folder `log` of the results. `--resume` goes on from the last checkpoint"
    );
    files.remove_files();
    end_at_once(calcine::exit::PEER);
}

impl MpiNetwork {
    /// Starts MPI in a process that MPI may end: then it says so, and its files go.
    pub fn start_guarded() -> Result<(Self, Universe), WireError> {
        at_end(ended_by_mpi, THREADS);
        Self::start()
    }

    /// Starts MPI, before any thread is started. The universe ends with [`end`].
    pub fn start() -> Result<(Self, Universe), WireError> {
        let run = RunDirectory::create()?;
        let address = run.address("mpi");
        place_files(&address.root, &address.make_mpi_memory()?);
        // A second run of this process, as in tests, keeps the first one's.
        let _ = FILES.set(address);
        let started = mpi::initialize_with_threading(Threading::Multiple);
        let (universe, threading) = started.ok_or(WireError::Order {
            what: "MPI was started before",
        })?;
        if threading != Threading::Multiple {
            return Err(WireError::Order {
                what: "this MPI does not serve several threads; Debian's Open MPI does",
            });
        }
        let network = Self {
            run,
            worlds: AtomicU32::new(0),
            seen: Mutex::default(),
        };
        Ok((network, universe))
    }

    /// True where every world that was spawned has ended in an orderly way.
    pub fn is_quiet(&self) -> bool {
        self.worlds.load(Ordering::SeqCst) == 0
    }

    /// Looks which ranks with this variable live, and keeps them in mind beyond their death.
    fn look(&self, variable: &str) -> (usize, Ranks) {
        let living = living_with(variable);
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let all = seen.entry(variable.to_owned()).or_default();
        all.extend(&living);
        (living.len(), all.clone())
    }
}

impl Drop for MpiNetwork {
    fn drop(&mut self) {
        if self.is_quiet() {
            self.run.end();
        }
    }
}

impl SolverNetwork for MpiNetwork {
    fn address(&self, role: &str) -> LinkAddress {
        self.run.address(role).over_mpi()
    }

    fn spawn(
        &self,
        line: &[OsString],
        ranks: u32,
        patience: Duration,
        is_over: &dyn Fn() -> bool,
    ) -> Result<Vec<Box<dyn Transport + Send>>, WireError> {
        self.worlds.fetch_add(1, Ordering::SeqCst);
        // MPI's call comes back only when all ranks have started MPI: one that died before never does.
        let (sender, receiver) = channel();
        let mark = address_in(line);
        let line = line.to_vec();
        std::thread::spawn(move || {
            // Nobody listens after the time is over.
            let _ = sender.send(SpawnedWorld::spawn(&line, ranks));
        });
        let begun = Instant::now();
        let mut fewer = 0;
        let world = loop {
            match receiver.recv_timeout(LOOK) {
                Ok(world) => break world?,
                Err(RecvTimeoutError::Timeout) if begun.elapsed() < patience && !is_over() => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                    let seconds = begun.elapsed().as_secs_f64();
                    return Err(WireError::NotSpawned { ranks, seconds });
                }
            }
            let Some((left, seen)) = mark.as_deref().map(|mark| self.look(mark)) else {
                continue;
            };
            fewer = if left < seen.len() { fewer + 1 } else { 0 };
            if fewer >= CERTAIN {
                return Err(WireError::DiedStarting { ranks, left });
            }
        };
        let end = |rank| {
            Box::new(CarriedTransport::new(world.of_rank(rank))) as Box<dyn Transport + Send>
        };
        Ok((0..ranks).map(end).collect())
    }

    fn ranks_here(&self, role: &str) -> Vec<(usize, u32)> {
        let mark = format!("{VARIABLE}={}", self.address(role).to_text());
        let (_, seen) = self.look(&mark);
        let mut ranks: Vec<_> = seen.into_iter().map(|(pid, rank)| (rank, pid)).collect();
        ranks.sort_unstable();
        ranks
    }

    fn daemon(&self) -> Option<(String, u32)> {
        let mut children = children().into_iter().map(number);
        let pid = children.find(|&pid| name_of(pid).as_deref() == Some(DAEMON))?;
        Some((format!("MPI's daemon ({DAEMON})"), pid))
    }

    fn goodbye(&self) {
        self.worlds.fetch_sub(1, Ordering::SeqCst);
    }
}

/// The variable with a link's address in the command line of a rank.
fn address_in(line: &[OsString]) -> Option<String> {
    let text = line.last()?.to_str()?;
    let (_, after) = text.split_once(&format!("{VARIABLE}='"))?;
    let (address, _) = after.split_once('\'')?;
    Some(format!("{VARIABLE}={address}"))
}

/// Living ranks of this machine that have a variable of this value: what MPI's daemon started. What a rank starts
/// in its turn inherits the variables, and may outlive it.
fn living_with(variable: &str) -> Ranks {
    // Where a launcher started this process, it is the daemon.
    let launcher = rustix::process::getppid().map(number);
    let starts = |pid: u32| Some(pid) == launcher || name_of(pid).as_deref() == Some(DAEMON);
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    let ranks = entries.filter_map(|entry| {
        let pid = entry.file_name().to_str()?.parse().ok()?;
        let environment = fs::read(entry.path().join("environ")).ok()?;
        let mut words = environment.split(|&byte| byte == 0);
        let marked = words.clone().any(|word| word == variable.as_bytes());
        let rank = words.find_map(|word| {
            let text = std::str::from_utf8(word).ok()?;
            text.strip_prefix(RANK)?.parse().ok()
        });
        let is_rank = marked && starts(parent(pid)?);
        Some((pid, rank.filter(|_| is_rank)?))
    });
    ranks.collect()
}

/// The name of a process's program, of 15 letters at most.
fn name_of(pid: u32) -> Option<String> {
    let name = fs::read_to_string(format!("/proc/{pid}/comm")).ok()?;
    Some(name.trim_end().to_owned())
}

fn number(pid: rustix::process::Pid) -> u32 {
    pid.as_raw_nonzero().get().unsigned_abs()
}

/// Ends this process: MPI first, where nothing died. After a death MPI waits for the dead, so that its
/// daemon is ended instead.
pub fn end(quiet: bool, universe: Universe, code: u8) -> ! {
    ENDS.store(true, Ordering::SeqCst);
    if quiet {
        drop(universe);
    } else {
        std::mem::forget(universe);
        for pid in children() {
            let _ = rustix::process::kill_process(pid, rustix::process::Signal::KILL);
        }
        end_at_once(code);
    }
    process::exit(code.into())
}

/// Living children of this process: what MPI has started for itself.
fn children() -> Vec<rustix::process::Pid> {
    let tasks = fs::read_dir("/proc/self/task").into_iter().flatten();
    let lists = tasks
        .flatten()
        .filter_map(|task| fs::read_to_string(task.path().join("children")).ok());
    let text: Vec<String> = lists.collect();
    let words = text.iter().flat_map(|list| list.split_ascii_whitespace());
    words
        .filter_map(|word| rustix::process::Pid::from_raw(word.parse().ok()?))
        .collect()
}
