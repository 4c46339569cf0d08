//! The calls of MPI. Everything unsafe is here.
//!
//! MPI's own waits spin and never end where the other process has died, so none is used: messages are
//! posted and tested, looked for and taken, and whoever waits sleeps in between. Errors are returned
//! codes; rsmpi's safe calls drop those.

use std::collections::VecDeque;
use std::ffi::{CString, OsString, c_char, c_int};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process;
use std::ptr;
use std::sync::OnceLock;

use calcine_wire::{Carrier, Message, WireError};
use mpi::environment::Universe;
use mpi::ffi;

/// Tag of messages from the coordinator to a rank.
const DOWN: c_int = 1;
/// Tag of messages from a rank to the coordinator.
const UP: c_int = 2;

/// An MPI result as ours.
fn checked(doing: &'static str, code: c_int) -> Result<(), WireError> {
    if code == 0 {
        return Ok(());
    }
    Err(WireError::Mpi { doing, code })
}

fn length(words: usize) -> Result<c_int, WireError> {
    c_int::try_from(words).map_err(|_| WireError::Order {
        what: "a message of 2^31 words and more does not go over MPI; use more ranks",
    })
}

/// Sets variables that Open MPI reads when it starts, unless the user has set them: its files go where
/// the run's go, and more ranks than processors are no error. To be called before any thread starts.
pub fn place_files(root: &Path, memory: &Path) {
    let set = |name: &str, value: &std::ffi::OsStr| {
        if std::env::var_os(name).is_none() {
            // SAFETY: called by `main` before there is another thread.
            unsafe { std::env::set_var(name, value) };
        }
    };
    set("OMPI_MCA_orte_tmpdir_base", root.as_os_str());
    set("OMPI_MCA_btl_vader_backing_directory", memory.as_os_str());
    set("OMPI_MCA_rmaps_base_oversubscribe", "1".as_ref());
    set("OMPI_MCA_mpi_yield_when_idle", "1".as_ref());
    // Each world would bind its ranks to the same processors.
    set("OMPI_MCA_hwloc_base_binding_policy", "none".as_ref());
    // Between processes of one machine that are not of one world Open MPI uses TCP.
    let elsewhere = [
        "OMPI_MCA_orte_default_hostfile",
        "SLURM_JOB_ID",
        "OMPI_COMM_WORLD_SIZE",
    ];
    if elsewhere
        .iter()
        .all(|name| std::env::var_os(name).is_none())
    {
        set("OMPI_MCA_btl_tcp_if_include", "lo".as_ref());
    }
}

unsafe extern "C" {
    // ISO C's name of what POSIX calls `_exit`.
    #[link_name = "_Exit"]
    fn leave(code: c_int) -> !;
    fn atexit(function: extern "C" fn()) -> c_int;
}

/// This process' id, and what is called where it ends.
static AT_END: OnceLock<(u32, extern "C" fn())> = OnceLock::new();

/// Has a function called where this process ends by `exit` or `_exit`, whoever calls that; by `exit` as many times
/// as threads may call that at once.
pub fn at_end(function: extern "C" fn(), threads: usize) {
    let _ = AT_END.set((process::id(), function));
    for _ in 0..threads {
        // SAFETY: the function lives as long as the program; a handler that cannot be registered is not called.
        unsafe { atexit(function) };
    }
}

/// POSIX' `_exit`, which Open MPI calls a second after it has lost its daemon, past all handlers of `exit`: the
/// dynamic linker prefers the executable's symbols over the C library's.
#[unsafe(no_mangle)]
extern "C" fn _exit(code: c_int) -> ! {
    // A child between its start and its program has these, too, but is not meant.
    if let Some((own, function)) = AT_END.get()
        && *own == process::id()
    {
        function();
    }
    // SAFETY: takes any code.
    unsafe { leave(code) }
}

/// Ends this process without what MPI would do then, which waits for the dead.
pub fn end_at_once(code: u8) -> ! {
    // SAFETY: takes any code.
    unsafe { leave(code.into()) }
}

/// Ends MPI in a process that MPI has spawned; rsmpi would part from the parent a second time.
pub fn finalize(universe: Universe) {
    std::mem::forget(universe);
    // SAFETY: MPI was started, and ends once: the universe that would end it again is gone.
    unsafe { ffi::MPI_Finalize() };
}

/// A communicator with ranks that were spawned, or one within this process.
#[derive(Clone, Copy)]
pub struct SpawnedWorld {
    comm: ffi::MPI_Comm,
}

// SAFETY: MPI is started for calls from any thread, and a communicator's handle is an address.
unsafe impl Send for SpawnedWorld {}

impl SpawnedWorld {
    /// Spawns a command line on a number of ranks; returns once they have started MPI, if ever.
    pub fn spawn(line: &[OsString], ranks: u32) -> Result<Self, WireError> {
        let text = |word: &OsString| CString::new(word.as_bytes()).unwrap_or_default();
        let words: Vec<CString> = line.iter().map(text).collect();
        let Some((program, arguments)) = words.split_first() else {
            return Err(WireError::Order {
                what: "there is no program to spawn",
            });
        };
        let mut pointers: Vec<*mut c_char> = arguments
            .iter()
            .map(|word| word.as_ptr().cast_mut())
            .chain([ptr::null_mut()])
            .collect();
        let mut codes = vec![0; ranks as usize];
        // SAFETY: texts and lists live during the call, the list of words ends with NULL, and there is
        // a code for each rank; MPI does not write into the words.
        let comm = unsafe {
            let mut comm = ffi::RSMPI_COMM_NULL;
            let code = ffi::MPI_Comm_set_errhandler(ffi::RSMPI_COMM_SELF, ffi::RSMPI_ERRORS_RETURN);
            checked("setting up", code)?;
            let code = ffi::MPI_Comm_spawn(
                program.as_ptr(),
                pointers.as_mut_ptr(),
                length(ranks as usize)?,
                ffi::RSMPI_INFO_NULL,
                0,
                ffi::RSMPI_COMM_SELF,
                &mut comm,
                codes.as_mut_ptr(),
            );
            checked("spawning", code)?;
            let code = ffi::MPI_Comm_set_errhandler(comm, ffi::RSMPI_ERRORS_RETURN);
            checked("setting up", code)?;
            comm
        };
        Ok(Self { comm })
    }

    /// A communicator of this process with itself, for both ends in one process.
    pub fn alone() -> Result<Self, WireError> {
        // SAFETY: a place of the right type; every process may duplicate its own communicator.
        unsafe {
            let mut comm = ffi::RSMPI_COMM_NULL;
            checked(
                "setting up",
                ffi::MPI_Comm_dup(ffi::RSMPI_COMM_SELF, &mut comm),
            )?;
            let code = ffi::MPI_Comm_set_errhandler(comm, ffi::RSMPI_ERRORS_RETURN);
            checked("setting up", code)?;
            Ok(Self { comm })
        }
    }

    /// The coordinator that spawned this process by MPI.
    pub fn parent() -> Result<Self, WireError> {
        // SAFETY: a place of the right type.
        unsafe {
            let mut comm = ffi::RSMPI_COMM_NULL;
            checked("finding the parent", ffi::MPI_Comm_get_parent(&mut comm))?;
            if comm == ffi::RSMPI_COMM_NULL {
                return Err(WireError::Order {
                    what: "no coordinator has spawned this process by MPI",
                });
            }
            let code = ffi::MPI_Comm_set_errhandler(comm, ffi::RSMPI_ERRORS_RETURN);
            checked("setting up", code)?;
            Ok(Self { comm })
        }
    }

    /// The coordinator's place opposite a rank.
    pub fn of_rank(self, rank: u32) -> MpiCarrier {
        MpiCarrier {
            comm: self.comm,
            rank: c_int::try_from(rank).unwrap_or(c_int::MAX),
            send: DOWN,
            receive: UP,
            posted: VecDeque::new(),
        }
    }

    /// A rank's place opposite the coordinator.
    pub fn of_coordinator(self) -> MpiCarrier {
        MpiCarrier {
            comm: self.comm,
            rank: 0,
            send: UP,
            receive: DOWN,
            posted: VecDeque::new(),
        }
    }
}

/// One end of a connection.
pub struct MpiCarrier {
    comm: ffi::MPI_Comm,
    rank: c_int,
    send: c_int,
    receive: c_int,
    /// What the other end has not taken, in order.
    posted: VecDeque<(ffi::MPI_Request, Message)>,
}

// SAFETY: as for `SpawnedWorld`; a request is used by its place only.
unsafe impl Send for MpiCarrier {}

impl Carrier for MpiCarrier {
    fn post(&mut self, message: Message) -> Result<(), WireError> {
        let words = message.words();
        let (start, count) = (words.as_ptr().cast(), length(words.len())?);
        // SAFETY: the words live, and do not move, until the request has ended: both stay in `posted`.
        let request = unsafe {
            let mut request = ffi::RSMPI_REQUEST_NULL;
            // Synchronous: it ends when the message is being taken, so that nothing piles up unseen.
            let code = ffi::MPI_Issend(
                start,
                count,
                ffi::RSMPI_UINT64_T,
                self.rank,
                self.send,
                self.comm,
                &mut request,
            );
            checked("sending", code)?;
            request
        };
        self.posted.push_back((request, message));
        Ok(())
    }

    fn pending(&mut self) -> Result<usize, WireError> {
        while let Some((request, _)) = self.posted.front_mut() {
            let mut done = 0;
            // SAFETY: a request that has not ended, and a place of the right type.
            let code = unsafe { ffi::MPI_Test(request, &mut done, ffi::RSMPI_STATUS_IGNORE) };
            checked("sending", code)?;
            if done == 0 {
                break;
            }
            self.posted.pop_front();
        }
        Ok(self.posted.len())
    }

    fn arrived(&mut self) -> Result<Option<usize>, WireError> {
        let (mut there, mut count) = (0, 0);
        // SAFETY: places of the right types; the status is read once MPI has filled it in.
        unsafe {
            let mut status: ffi::MPI_Status = std::mem::zeroed();
            let code = ffi::MPI_Iprobe(self.rank, self.receive, self.comm, &mut there, &mut status);
            checked("looking for a message", code)?;
            if there == 0 {
                return Ok(None);
            }
            let code = ffi::MPI_Get_count(&status, ffi::RSMPI_UINT64_T, &mut count);
            checked("looking for a message", code)?;
        }
        Ok(Some(count.unsigned_abs() as usize))
    }

    fn take(&mut self, words: &mut [u64]) -> Result<(), WireError> {
        let (start, count) = (words.as_mut_ptr().cast(), length(words.len())?);
        // SAFETY: room for as many words as are asked for.
        let code = unsafe {
            ffi::MPI_Recv(
                start,
                count,
                ffi::RSMPI_UINT64_T,
                self.rank,
                self.receive,
                self.comm,
                ffi::RSMPI_STATUS_IGNORE,
            )
        };
        checked("receiving", code)
    }
}
