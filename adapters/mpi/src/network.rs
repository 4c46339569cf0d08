//! Spawning solvers, and how a coordinator that has spawned some comes to its end.

use std::ffi::OsString;
use std::fs;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{self, Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use calcine_wire::run::VARIABLE;
use calcine_wire::{Carried, LinkAddress, Network, Run, Transport, WireError};
use mpi::Threading;
use mpi::environment::Universe;

use crate::carrier::{World, at_end, end_at_once, place_files};

/// What removes the files of a coordinator that was killed while MPI started, when there is no solver yet to do
/// it: it waits for the end of a pipe that only the coordinator holds, and looks for what MPI's daemon still leaves.
const GUARD: &str =
    "read -r nothing; for i in 1 2 3 4 5 6; do sleep 0.4; rm -rf -- \"$0\" \"$1\"_*; done";

/// A process that outlives the coordinator where that is killed, and no longer than it otherwise.
struct Guard(Child);

impl Guard {
    fn start(address: &LinkAddress) -> Result<Self, WireError> {
        let child = Command::new("/bin/sh")
            .args(["-c", GUARD])
            .arg(&address.root)
            .arg(Path::new("/dev/shm").join(&address.name))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .process_group(0)
            .spawn();
        child.map(Self).map_err(|source| WireError::File {
            path: "/bin/sh".into(),
            source,
        })
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        // One that has ended is what is wanted.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Between two looks at ranks that are starting, short enough to see one that dies at once; and how many looks
/// make its end certain.
const LOOK: Duration = Duration::from_millis(10);
const CERTAIN: u32 = 20;

/// Begins the variable by which Open MPI tells a process its rank.
const RANK: &str = "OMPI_COMM_WORLD_RANK=";

/// MPI in this process, and the worlds that it has spawned.
pub struct MpiNetwork {
    _guard: Guard,
    run: Run,
    /// Worlds that have not ended in an orderly way.
    worlds: AtomicU32,
}

/// Where this run's files are, and whether this process comes to its end by itself.
static FILES: OnceLock<LinkAddress> = OnceLock::new();
/// As many threads as may call `exit` at once.
const THREADS: usize = 4;
static ENDS: AtomicBool = AtomicBool::new(false);

/// Open MPI ends its process by `exit` or `_exit` where its own daemon has died, from any thread and from several at
/// once: the first has to say so and to clean up, the others wait for it here.
extern "C" fn ended_by_mpi() {
    static TAKEN: AtomicBool = AtomicBool::new(false);
    let Some(files) = FILES.get().filter(|_| !ENDS.load(Ordering::SeqCst)) else {
        return;
    };
    if TAKEN.swap(true, Ordering::SeqCst) {
        std::thread::sleep(Duration::from_secs(5));
        return;
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
        let run = Run::create()?;
        let address = run.address("mpi");
        let guard = Guard::start(&address)?;
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
            _guard: guard,
            run,
            worlds: AtomicU32::new(0),
        };
        Ok((network, universe))
    }

    /// True where every world that was spawned has ended in an orderly way.
    pub fn is_quiet(&self) -> bool {
        self.worlds.load(Ordering::SeqCst) == 0
    }
}

impl Network for MpiNetwork {
    fn address(&self, role: &str) -> LinkAddress {
        self.run.address(role).over_mpi()
    }

    fn spawn(
        &self,
        line: &[OsString],
        ranks: u32,
        patience: Duration,
    ) -> Result<Vec<Box<dyn Transport + Send>>, WireError> {
        self.worlds.fetch_add(1, Ordering::SeqCst);
        // MPI's call comes back only when all ranks have started MPI: one that died before never does.
        let (sender, receiver) = channel();
        let mark = address_in(line);
        let line = line.to_vec();
        std::thread::spawn(move || {
            // Nobody listens after the time is over.
            let _ = sender.send(World::spawn(&line, ranks));
        });
        let begun = Instant::now();
        let (mut most, mut fewer) = (0, 0);
        let world = loop {
            match receiver.recv_timeout(LOOK) {
                Ok(world) => break world?,
                Err(RecvTimeoutError::Timeout) if begun.elapsed() < patience => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                    let seconds = patience.as_secs_f64();
                    return Err(WireError::NotSpawned { ranks, seconds });
                }
            }
            let left = mark.as_deref().map_or(0, |mark| living_with(mark).count());
            most = most.max(left);
            fewer = if left < most { fewer + 1 } else { 0 };
            if fewer >= CERTAIN {
                return Err(WireError::DiedStarting { ranks, left });
            }
        };
        let end = |rank| Box::new(Carried::new(world.of_rank(rank))) as Box<dyn Transport + Send>;
        Ok((0..ranks).map(end).collect())
    }

    fn ranks_here(&self, role: &str) -> Vec<(usize, u32)> {
        let mark = format!("{VARIABLE}={}", self.address(role).to_text());
        let rank = |(pid, environment): (u32, Vec<u8>)| {
            let own = environment.split(|&byte| byte == 0);
            let mut ranks = own.filter_map(|word| {
                let text = std::str::from_utf8(word).ok()?;
                text.strip_prefix(RANK)?.parse().ok()
            });
            Some((ranks.next()?, pid))
        };
        let mut ranks: Vec<_> = living_with(&mark).filter_map(rank).collect();
        ranks.sort_unstable();
        ranks
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

/// Processes of this machine that live and have a variable of this value, with their environments.
fn living_with(variable: &str) -> impl Iterator<Item = (u32, Vec<u8>)> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    entries.filter_map(move |entry| {
        let pid = entry.file_name().to_str()?.parse().ok()?;
        let text = fs::read(entry.path().join("environ")).unwrap_or_default();
        let has = text
            .split(|&byte| byte == 0)
            .any(|word| word == variable.as_bytes());
        has.then_some((pid, text))
    })
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
