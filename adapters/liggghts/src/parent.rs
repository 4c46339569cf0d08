//! The coordinator that spawned this host by MPI, as a carrier of messages. Open MPI's C interface, by
//! hand, as in library.rs: the host needs nothing to build that LIGGGHTS does not need to run.

use std::collections::VecDeque;
use std::ffi::{c_int, c_void};
use std::ptr;

use calcine_wire::{Carrier, Message, WireError};

/// Tags of messages from and to the coordinator, as in adapters/mpi.
const DOWN: c_int = 1;
const UP: c_int = 2;

/// An object of Open MPI's, of which only the address is used.
#[repr(C)]
struct Object {
    _opaque: [u8; 0],
}

/// Open MPI 4's `MPI_Status`.
#[derive(Default)]
#[repr(C)]
struct Status {
    source: c_int,
    tag: c_int,
    error: c_int,
    cancelled: c_int,
    count: usize,
}

unsafe extern "C" {
    // MPI_UINT64_T, MPI_COMM_NULL and MPI_ERRORS_RETURN are the addresses of these objects.
    static mut ompi_mpi_uint64_t: Object;
    static mut ompi_mpi_comm_null: Object;
    static mut ompi_mpi_errors_return: Object;

    fn MPI_Comm_get_parent(parent: *mut *mut c_void) -> c_int;
    fn MPI_Comm_set_errhandler(comm: *mut c_void, handler: *mut c_void) -> c_int;
    fn MPI_Issend(
        words: *const c_void,
        count: c_int,
        kind: *mut c_void,
        rank: c_int,
        tag: c_int,
        comm: *mut c_void,
        request: *mut *mut c_void,
    ) -> c_int;
    fn MPI_Test(request: *mut *mut c_void, done: *mut c_int, status: *mut Status) -> c_int;
    fn MPI_Iprobe(
        rank: c_int,
        tag: c_int,
        comm: *mut c_void,
        there: *mut c_int,
        status: *mut Status,
    ) -> c_int;
    fn MPI_Get_count(status: *const Status, kind: *mut c_void, count: *mut c_int) -> c_int;
    fn MPI_Recv(
        words: *mut c_void,
        count: c_int,
        kind: *mut c_void,
        rank: c_int,
        tag: c_int,
        comm: *mut c_void,
        status: *mut Status,
    ) -> c_int;
}

fn words_kind() -> *mut c_void {
    (&raw mut ompi_mpi_uint64_t).cast()
}

/// The intercommunicator to the coordinator, whose rank there is 0.
pub struct ParentCarrier {
    comm: *mut c_void,
    /// What the coordinator has not taken, in order.
    posted: VecDeque<(*mut c_void, Message)>,
}

// SAFETY: the handles are addresses that any thread may use; MPI was started by the thread that makes
// all calls, and the link's lock lets one through at a time.
unsafe impl Send for ParentCarrier {}

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

impl ParentCarrier {
    /// Finds the parent of this process; MPI must have been started.
    pub fn find() -> Result<Self, WireError> {
        let mut comm = ptr::null_mut();
        // SAFETY: a place of the right type; the handler is Open MPI's own object.
        unsafe {
            checked("finding the parent", MPI_Comm_get_parent(&mut comm))?;
            if comm == (&raw mut ompi_mpi_comm_null).cast() {
                return Err(WireError::Order {
                    what: "no coordinator has spawned this process by MPI",
                });
            }
            let handler = (&raw mut ompi_mpi_errors_return).cast();
            checked("setting up", MPI_Comm_set_errhandler(comm, handler))?;
        }
        Ok(Self {
            comm,
            posted: VecDeque::new(),
        })
    }
}

impl Carrier for ParentCarrier {
    fn post(&mut self, message: Message) -> Result<(), WireError> {
        let words = message.words();
        let (start, count) = (words.as_ptr().cast(), length(words.len())?);
        let mut request = ptr::null_mut();
        // SAFETY: the words live, and do not move, until the request has ended: both stay in `posted`.
        let code =
            unsafe { MPI_Issend(start, count, words_kind(), 0, UP, self.comm, &mut request) };
        checked("sending", code)?;
        self.posted.push_back((request, message));
        Ok(())
    }

    fn pending(&mut self) -> Result<usize, WireError> {
        while let Some((request, _)) = self.posted.front_mut() {
            let (mut done, mut status) = (0, Status::default());
            // SAFETY: a request that has not ended, and places of the right types.
            checked("sending", unsafe {
                MPI_Test(request, &mut done, &mut status)
            })?;
            if done == 0 {
                break;
            }
            self.posted.pop_front();
        }
        Ok(self.posted.len())
    }

    fn arrived(&mut self) -> Result<Option<usize>, WireError> {
        let (mut there, mut count, mut status) = (0, 0, Status::default());
        // SAFETY: places of the right types; the status is read once MPI has filled it in.
        unsafe {
            let code = MPI_Iprobe(0, DOWN, self.comm, &mut there, &mut status);
            checked("looking for a message", code)?;
            if there == 0 {
                return Ok(None);
            }
            let code = MPI_Get_count(&status, words_kind(), &mut count);
            checked("looking for a message", code)?;
        }
        Ok(Some(count.unsigned_abs() as usize))
    }

    fn take(&mut self, words: &mut [u64]) -> Result<(), WireError> {
        let (start, count) = (words.as_mut_ptr().cast(), length(words.len())?);
        let mut status = Status::default();
        // SAFETY: room for as many words as are asked for.
        let code = unsafe { MPI_Recv(start, count, words_kind(), 0, DOWN, self.comm, &mut status) };
        checked("receiving", code)
    }
}
