//! What can go wrong on a wire.

use std::path::PathBuf;

use thiserror::Error;

use crate::failure::SolverFailure;
use crate::record::MessageKind;

/// What can go wrong on a wire.
#[derive(Debug, Error)]
pub enum WireError {
    /// The other end's process has ended.
    #[error("coordinator (pid {pid}) died; this solver ends, and the run's files are removed")]
    PeerDead {
        /// Its process id.
        pid: u32,
    },
    /// A solver in C was compiled against the header of another version than the library's.
    #[error(
        "calcine_wire.h is of protocol version {header}, the library of version {library}: compile against the header \
         that came with the library"
    )]
    Header {
        /// The header's version.
        header: u32,
        /// The library's.
        library: u32,
    },
    /// The handshake found two different values.
    #[error("the handshake failed: the {what} is {ours} here, but {theirs} at the other end")]
    Mismatch {
        /// What was compared.
        what: &'static str,
        /// Our value.
        ours: String,
        /// The other end's value.
        theirs: String,
    },
    /// The other end reported a failure.
    #[error("{text}")]
    Failed {
        /// Of which kind it is.
        kind: SolverFailure,
        /// Its words.
        text: String,
    },
    /// A message that is not of this run, rank, version or length.
    #[error("a message of {what} {found} arrived, but {expected} was expected")]
    Foreign {
        /// What differs.
        what: &'static str,
        /// As it came.
        found: u64,
        /// As it should be.
        expected: u64,
    },
    /// A kind of message that does not belong here.
    #[error("{} arrived where {expected} was expected", named(*found))]
    Unexpected {
        /// The number of the kind.
        found: u32,
        /// What was expected.
        expected: &'static str,
    },
    /// A text that is not UTF-8, or not of the expected form.
    #[error("the text of a message cannot be read: {detail}")]
    Text {
        /// What is wrong with it.
        detail: String,
    },
    /// Nothing came in time.
    #[error("no answer within {seconds} s while waiting for {what}")]
    Silent {
        /// How long was waited, in s.
        seconds: f64,
        /// For what.
        what: &'static str,
    },
    /// A line that is no field of a catalogue.
    #[error("`{line}` is no field; write `start|state|owned name components unit item|rank`")]
    Catalogue {
        /// The line.
        line: String,
    },
    /// No such role.
    #[error("`{role}` is no role of a solver; there are `gas` and `particles`")]
    Role {
        /// The name given.
        role: String,
    },
    /// A column that the catalogue does not have.
    #[error("the {record} record has no column `{name}`")]
    NoColumn {
        /// The name asked for.
        name: String,
        /// The record.
        record: &'static str,
    },
    /// A message that would leave with a column nobody filled.
    #[error("the message was not sent: its column `{name}` was never filled")]
    Unfilled {
        /// The column.
        name: String,
    },
    /// A call out of order.
    #[error("{what}")]
    Order {
        /// What was missing.
        what: &'static str,
    },
    /// Too little shared memory.
    #[error(
        "/dev/shm has {free} bytes free, but this link may need {needed} bytes; \
         enlarge it (`mount -o remount,size=4G /dev/shm`; docker: `--shm-size 4g`)"
    )]
    SharedMemoryFull {
        /// Bytes free.
        free: u64,
        /// Bytes that a link of this size may take.
        needed: u64,
    },
    /// The shared-memory layer refused.
    #[error("shared memory: {doing} failed: {detail}")]
    SharedMemory {
        /// What was tried.
        doing: &'static str,
        /// The layer's own words.
        detail: String,
    },
    /// The coordinator cannot be watched.
    #[error("coordinator (pid {pid}) cannot be watched: {cause}")]
    Watch {
        /// Its process id.
        pid: u32,
        /// Why.
        cause: std::io::Error,
    },
    /// MPI refused.
    #[error("MPI: {doing} failed with code {code}")]
    Mpi {
        /// What was tried.
        doing: &'static str,
        /// The error code of the MPI library.
        code: i32,
    },
    /// A solver's ranks did not come up.
    #[error("{ranks} ranks did not start MPI within {seconds} s")]
    NotSpawned {
        /// How many were asked for.
        ranks: u32,
        /// How long was waited, in s.
        seconds: f64,
    },
    /// A rank that died where MPI would wait for it for ever.
    #[error("of {ranks} ranks {left} are left, and they had not started MPI yet")]
    DiedStarting {
        /// How many were asked for.
        ranks: u32,
        /// How many live.
        left: usize,
    },
    /// Nobody, or a full buffer, at the other end.
    #[error("a message was not delivered: {receivers} of 1 receivers took it")]
    NotDelivered {
        /// Number of receivers.
        receivers: usize,
    },
    /// The variable that describes a link is missing or wrong.
    #[error(
        "the variable CALCINE_LINK {detail}; it is set by the coordinator that starts a solver"
    )]
    Address {
        /// What is wrong.
        detail: String,
    },
    /// A path that is too long for a socket of the wire.
    #[error("the scratch directory {} is too long for the wire ({length} characters, at most {limit}); set TMPDIR to a shorter one", path.display())]
    LongPath {
        /// The path.
        path: PathBuf,
        /// Its length with the names that are appended.
        length: usize,
        /// The limit.
        limit: usize,
    },
    /// A file or directory of the run.
    #[error("{}: {source}", path.display())]
    File {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// A kind of message by its number and its name in the C header.
fn named(number: u32) -> String {
    match MessageKind::from_number(number) {
        Some(kind) => format!("a message {} ({number})", kind.name()),
        None => format!("a message of kind {number}"),
    }
}
