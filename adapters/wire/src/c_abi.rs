//! The C ABI of `include/calcine_wire.h`: a solver's end of a link. The header states what each
//! function does; here stands how.
//!
//! Every function catches panics, so that none crosses into C, and leaves its error as text for
//! `calcine_last_error`.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::time::Duration;

use crate::carried::{CarriedTransport, Carrier, Message};
use crate::catalogue::Catalogue;
use crate::error::WireError;
use crate::failure::SolverFailure;
use crate::hello::{Hello, NEW, NOT_COMPARED};
use crate::link::Link;
use crate::record::{Header, MessageKind, VERSION};
use crate::run::{LinkAddress, TransportKind};
use crate::shared_memory::{LinkEnd, SharedMemory};
use crate::transport::Transport;

/// How a call ended; `calcine_status` in C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    Ok = 0,
    Timeout = 1,
    PeerDead = 2,
    Error = 3,
    Panic = 4,
}

/// The opaque `calcine_link` of C.
pub struct CLink {
    link: Link,
    /// Header of the last request: its window and clocks are the answer's.
    last: Header,
    /// The text handed out last, with the zero that C wants.
    text: CString,
}

/// `calcine_hello` of C.
#[repr(C)]
pub struct CHello {
    role: *const c_char,
    name: *const c_char,
    version: *const c_char,
    case_hash: *const c_char,
    mesh_hash: *const c_char,
    origin: *const c_char,
    catalogue: *const c_char,
    count: u64,
    ranks: u32,
}

const _: () = assert!(size_of::<CHello>() == 72);

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// A text for C; a zero inside it becomes a space.
fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

fn leave(status: Status, text: &str) -> Status {
    LAST_ERROR.with_borrow_mut(|last| *last = c_text(text));
    status
}

/// Runs the body of a C function.
fn guarded(body: impl FnOnce() -> Result<Status, WireError>) -> Status {
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(Status::Timeout)) => leave(Status::Timeout, "nothing arrived in time"),
        Ok(Ok(status)) => status,
        Ok(Err(error @ WireError::PeerDead { .. })) => {
            eprintln!("{error}");
            leave(Status::PeerDead, &error.to_string())
        }
        Ok(Err(error)) => leave(Status::Error, &error.to_string()),
        Err(panic) => {
            let words = panic.downcast_ref::<&str>().copied();
            let words = words.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
            let words = words.unwrap_or("no message");
            leave(
                Status::Panic,
                &format!("a defect in Calcine's wire: {words}"),
            )
        }
    }
}

const NULL: WireError = WireError::Order {
    what: "a pointer that must not be NULL is NULL",
};

/// The link behind a handle.
fn of<'a>(link: *mut CLink) -> Result<&'a mut CLink, WireError> {
    // SAFETY: C passes NULL or a handle of `calcine_link_open`, from one thread at a time, and not
    // after `calcine_link_close`.
    unsafe { link.as_mut() }.ok_or(NULL)
}

/// Writes a result where C asked for it.
fn put<T>(place: *mut T, value: T) -> Result<(), WireError> {
    if place.is_null() {
        return Err(NULL);
    }
    // SAFETY: C passes a writable, aligned place for one value.
    unsafe { place.write(value) };
    Ok(())
}

/// A text from C.
fn text_of(text: *const c_char) -> Result<String, WireError> {
    if text.is_null() {
        return Err(NULL);
    }
    // SAFETY: C passes a text that ends with a zero and lives during the call.
    let text = unsafe { CStr::from_ptr(text) };
    Ok(text.to_string_lossy().into_owned())
}

/// The same, with words in the place of NULL.
fn text_or(text: *const c_char, other: &str) -> Result<String, WireError> {
    if text.is_null() {
        return Ok(other.into());
    }
    text_of(text)
}

/// `calcine_carrier` of C: what moves messages there, by functions that give a negative number where
/// they fail.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct CCarrier {
    context: *mut c_void,
    post: extern "C" fn(*mut c_void, *const u64, u64) -> i64,
    pending: extern "C" fn(*mut c_void) -> i64,
    arrived: extern "C" fn(*mut c_void) -> i64,
    take: extern "C" fn(*mut c_void, *mut u64, u64) -> i64,
}

const _: () = assert!(size_of::<CCarrier>() == 40);

/// A carrier of C with the messages that it still sends.
struct CarriedByC {
    calls: CCarrier,
    posted: VecDeque<Message>,
}

// SAFETY: C promises that a link, its carrier with it, may be used by one thread at a time.
unsafe impl Send for CarriedByC {}

/// The result of a carrier's function; negative numbers are its errors.
fn number(doing: &'static str, result: i64) -> Result<usize, WireError> {
    usize::try_from(result).map_err(|_| WireError::Mpi {
        doing,
        code: i32::try_from(-result).unwrap_or(i32::MAX),
    })
}

impl Carrier for CarriedByC {
    fn post(&mut self, message: Message) -> Result<(), WireError> {
        let words = message.words();
        let (start, count) = (words.as_ptr(), words.len() as u64);
        number(
            "sending",
            (self.calls.post)(self.calls.context, start, count),
        )?;
        // The words do not move with the message that owns them.
        self.posted.push_back(message);
        Ok(())
    }

    fn pending(&mut self) -> Result<usize, WireError> {
        let left = number("sending", (self.calls.pending)(self.calls.context))?;
        while self.posted.len() > left {
            self.posted.pop_front();
        }
        Ok(left)
    }

    fn arrived(&mut self) -> Result<Option<usize>, WireError> {
        let words = number("looking", (self.calls.arrived)(self.calls.context))?;
        Ok((words > 0).then_some(words))
    }

    fn take(&mut self, words: &mut [u64]) -> Result<(), WireError> {
        let (start, count) = (words.as_mut_ptr(), words.len() as u64);
        number(
            "receiving",
            (self.calls.take)(self.calls.context, start, count),
        )?;
        Ok(())
    }
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_needs_carrier(needs: *mut u32) -> Status {
    guarded(|| {
        let address = LinkAddress::from_environment()?;
        put(
            needs,
            u32::from(address.means != TransportKind::SharedMemory),
        )?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_open_version(
    version: u32,
    rank: u32,
    carrier: *const CCarrier,
    link: *mut *mut CLink,
) -> Status {
    guarded(|| {
        put(link, ptr::null_mut())?;
        if version != VERSION {
            return Err(WireError::Header {
                header: version,
                library: VERSION,
            });
        }
        let address = LinkAddress::from_environment()?;
        // SAFETY: C passes NULL or a filled-in struct that lives during the call.
        let calls = unsafe { carrier.as_ref() }.copied();
        let transport: Box<dyn Transport + Send> = match (&address.means, calls) {
            (TransportKind::SharedMemory, _) => {
                Box::new(SharedMemory::open(&address, rank, LinkEnd::Solver)?)
            }
            (TransportKind::Mpi { .. }, Some(calls)) => {
                let posted = VecDeque::new();
                Box::new(CarriedTransport::of_solver(
                    CarriedByC { calls, posted },
                    &address,
                )?)
            }
            (TransportKind::Mpi { .. }, None) => return Err(NULL),
        };
        let opened = CLink {
            link: Link::new(transport, address.number(), rank),
            last: Header::default(),
            text: CString::default(),
        };
        put(link, Box::into_raw(Box::new(opened)))?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_handshake(
    link: *mut CLink,
    hello: *const CHello,
    timeout_ms: u32,
) -> Status {
    guarded(|| {
        let link = of(link)?;
        // SAFETY: C passes NULL or a filled-in struct that lives during the call.
        let hello = unsafe { hello.as_ref() }.ok_or(NULL)?;
        let role = text_of(hello.role)?;
        let catalogue = match (hello.catalogue.is_null(), hello.mesh_hash.is_null()) {
            (true, false) => Catalogue::standard(&role)?,
            (true, true) if role == "gas" => Catalogue::standard(&role)?.with_geometry(),
            (true, true) => Catalogue::standard(&role)?,
            (false, _) => Catalogue::of_lines(&role, &text_of(hello.catalogue)?)?,
        };
        let ours = Hello {
            role,
            name: text_of(hello.name)?,
            version: text_of(hello.version)?,
            case_hash: text_or(hello.case_hash, NOT_COMPARED)?,
            mesh_hash: text_or(hello.mesh_hash, NOT_COMPARED)?,
            origin: text_or(hello.origin, NEW)?,
            count: hello.count,
            ranks: hello.ranks,
            catalogue,
        };
        let patience = Duration::from_millis(timeout_ms.into());
        link.link.greet(&ours, patience)?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_receive(
    link: *mut CLink,
    timeout_ms: u32,
    header: *mut Header,
    payload: *mut *const c_void,
    bytes: *mut u64,
) -> Status {
    guarded(|| {
        let link = of(link)?;
        let patience = Duration::from_millis(timeout_ms.into());
        let Some(received) = link.link.receive(patience)? else {
            return Ok(Status::Timeout);
        };
        link.last = received;
        put(header, received)?;
        if !payload.is_null() {
            put(payload, link.link.payload()?.as_ptr().cast())?;
        }
        if !bytes.is_null() {
            put(bytes, received.bytes)?;
        }
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_column(
    link: *mut CLink,
    name: *const c_char,
    values: *mut *const f64,
    length: *mut u64,
) -> Status {
    guarded(|| {
        let column = of(link)?.link.column(&text_of(name)?)?;
        put(values, column.as_ptr())?;
        put(length, column.len() as u64)?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_text(link: *mut CLink, text: *mut *const c_char) -> Status {
    guarded(|| {
        let link = of(link)?;
        link.text = c_text(link.link.text()?);
        put(text, link.text.as_ptr())?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_loan(link: *mut CLink, kind: u32, count: u64) -> Status {
    guarded(|| {
        let link = of(link)?;
        let kind = MessageKind::from_number(kind).ok_or(WireError::Unexpected {
            found: kind,
            expected: "a known kind",
        })?;
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        link.link.loan(link.last.answer(kind), count)?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_loaned_column(
    link: *mut CLink,
    name: *const c_char,
    values: *mut *mut f64,
    length: *mut u64,
) -> Status {
    guarded(|| {
        let column = of(link)?.link.column_mut(&text_of(name)?)?;
        put(values, column.as_mut_ptr())?;
        put(length, column.len() as u64)?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_send(link: *mut CLink) -> Status {
    guarded(|| {
        of(link)?.link.send()?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_failed(link: *mut CLink, failure: u32, text: *const c_char) -> Status {
    guarded(|| {
        let link = of(link)?;
        let failure = SolverFailure::from_number(failure.into());
        let header = link.last.answer(MessageKind::Failed);
        link.link.send_last_word(header, failure, &text_of(text)?)?;
        Ok(Status::Ok)
    })
}

#[unsafe(no_mangle)]
extern "C" fn calcine_last_error() -> *const c_char {
    LAST_ERROR.with_borrow(|last| last.as_ptr())
}

#[unsafe(no_mangle)]
extern "C" fn calcine_link_close(link: *mut CLink) {
    guarded(|| {
        if !link.is_null() {
            // SAFETY: the handle came from `Box::into_raw` in `calcine_link_open`, and C does not use
            // it again.
            drop(unsafe { Box::from_raw(link) });
        }
        Ok(Status::Ok)
    });
}
