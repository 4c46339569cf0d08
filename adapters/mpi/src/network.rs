//! Spawning solvers, and how a coordinator that has spawned some comes to its end.

use std::ffi::OsString;
use std::fs;
use std::process;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use calcine_wire::{Carried, LinkAddress, Network, Run, Transport, WireError};
use mpi::Threading;
use mpi::environment::Universe;

use crate::carrier::{World, at_exit, end_at_once, place_files};

/// MPI in this process, and the worlds that it has spawned.
pub struct MpiNetwork {
    run: Run,
    /// Worlds that have not ended in an orderly way.
    worlds: AtomicU32,
}

/// Where this run's files are, and whether this process comes to its end by itself.
static FILES: OnceLock<LinkAddress> = OnceLock::new();
/// As many threads as may call `exit` at once.
const THREADS: usize = 4;
static ENDS: AtomicBool = AtomicBool::new(false);

/// Open MPI ends its process by `exit` where its own daemon has died, from any thread and from several at once:
/// the first has to say so and to clean up, the others wait for it here.
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
        for _ in 0..THREADS {
            at_exit(ended_by_mpi);
        }
        Self::start()
    }

    /// Starts MPI, before any thread is started. The universe ends with [`end`].
    pub fn start() -> Result<(Self, Universe), WireError> {
        let run = Run::create()?;
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
        let line = line.to_vec();
        std::thread::spawn(move || {
            // Nobody listens after the time is over.
            let _ = sender.send(World::spawn(&line, ranks));
        });
        let world = match receiver.recv_timeout(patience) {
            Ok(world) => world?,
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                let seconds = patience.as_secs_f64();
                return Err(WireError::NotSpawned { ranks, seconds });
            }
        };
        let end = |rank| Box::new(Carried::new(world.of_rank(rank))) as Box<dyn Transport + Send>;
        Ok((0..ranks).map(end).collect())
    }

    fn goodbye(&self) {
        self.worlds.fetch_sub(1, Ordering::SeqCst);
    }
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
