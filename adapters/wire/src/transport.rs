//! What every transport does.

use std::ffi::OsString;
use std::time::Duration;

use crate::error::WireError;
use crate::record::Header;
use crate::run::LinkAddress;

/// Moves messages between the two ends of a link. At most one message is reserved and at most one is
/// held as received at a time; both stay in place, nothing is copied.
pub trait Transport: Send {
    /// Reserves the next message with a payload of `words` words of 8 bytes, whose content is
    /// unspecified until written; a reserved message that was not sent is dropped.
    fn loan(&mut self, header: Header, words: usize) -> Result<&mut [u64], WireError>;

    /// The payload of the reserved message.
    fn loaned(&mut self) -> Option<&mut [u64]>;

    /// Sends the reserved message.
    fn send(&mut self) -> Result<(), WireError>;

    /// Drops what was received before and waits at most `patience`; true where a message arrived.
    fn receive(&mut self, patience: Duration) -> Result<bool, WireError>;

    /// Waits at most `patience` until what was sent needs this process no more. What lies in shared
    /// memory never does.
    fn settle(&mut self, _patience: Duration) -> Result<(), WireError> {
        Ok(())
    }

    /// The message received last, in place.
    fn received(&self) -> Option<(&Header, &[u64])>;
}

/// Starts solvers and connects with them in one: the ranks come up in a world of their own.
pub trait SolverNetwork: Send + Sync {
    /// The address that a role's ranks are given.
    fn address(&self, role: &str) -> LinkAddress;

    /// Starts a command line on a number of ranks and gives the coordinator's ends, by rank; an error after `patience`, or where
    /// `is_over` says that the run has ended meanwhile.
    fn spawn(
        &self,
        line: &[OsString],
        ranks: u32,
        patience: Duration,
        is_over: &dyn Fn() -> bool,
    ) -> Result<Vec<Box<dyn Transport + Send>>, WireError>;

    /// Rank and process id of a role's ranks that run on this machine, from when they were spawned on.
    fn ranks_here(&self, role: &str) -> Vec<(usize, u32)>;

    /// Name and process id of a process of this machine that all ranks end with, where there is one.
    fn daemon(&self) -> Option<(String, u32)>;

    /// A solver has said goodbye: its world ends in an orderly way.
    fn goodbye(&self);
}
