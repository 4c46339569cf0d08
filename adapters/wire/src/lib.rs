//! The wire between Calcine's coordinator and external solvers: records, transports, the C ABI.
//!
//! A link is one rank's connection. Both ends speak in messages: a [`Header`] and either columns, laid
//! out by the [`Catalogue`] that the handshake fixed, or a text. The coordinator asks, the solver
//! answers; only `Commit` has no answer.

pub mod carried;
pub mod catalogue;
mod column_set;
pub mod columns;
pub mod error;
pub mod failure;
pub mod hello;
pub mod link;
pub mod process;
pub mod record;
pub mod reference;
pub mod run;
pub mod shared_memory;
pub mod transport;

#[allow(unsafe_code)]
mod c_abi;
mod guard;
mod watch;
#[allow(unsafe_code)]
mod words;

pub use carried::{CarriedTransport, Carrier, Message};
pub use catalogue::{Catalogue, Field};
pub use column_set::ColumnSet;
pub use error::WireError;
pub use failure::SolverFailure;
pub use hello::Hello;
pub use link::Link;
pub use process::Process;
pub use record::{Header, MessageKind};
pub use run::{LinkAddress, RunDirectory, TransportKind};
pub use shared_memory::SharedMemory;
pub use transport::{SolverNetwork, Transport};
