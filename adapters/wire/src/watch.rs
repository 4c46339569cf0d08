//! A solver's eye on its coordinator, whatever carries their messages.

use std::os::fd::OwnedFd;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, PidfdFlags, Signal, getpid, kill_process, pidfd_open};

use crate::error::WireError;
use crate::process::started;
use crate::run::LinkAddress;

/// How long after the coordinator's death a solver may take to end by itself.
const GRACE: Duration = Duration::from_millis(400);

/// The coordinator's process, as a solver on the same machine sees it.
#[derive(Debug)]
pub(crate) struct Watch {
    pid: u32,
    /// Without one the process is already dead.
    pidfd: Option<OwnedFd>,
}

impl Watch {
    /// Begins to watch.
    fn begin(address: &LinkAddress) -> Result<Self, WireError> {
        let (pid, since) = address.coordinator()?;
        let raw = i32::try_from(pid).ok().and_then(Pid::from_raw);
        let pidfd = raw.and_then(|raw| pidfd_open(raw, PidfdFlags::empty()).ok());
        // The number may belong to a later process by now.
        let pidfd = pidfd.filter(|_| started(pid) == Some(since));
        if let Some(pidfd) = &pidfd {
            end_with(address, pid, pidfd)?;
        }
        Ok(Self { pid, pidfd })
    }

    /// The same, of one that lives; the files of a dead one are removed.
    pub(crate) fn living(address: &LinkAddress) -> Result<Self, WireError> {
        let watch = Self::begin(address)?;
        if watch.is_dead() {
            address.remove_files();
            return Err(WireError::PeerDead { pid: watch.pid });
        }
        Ok(watch)
    }

    /// Its process id.
    pub(crate) fn pid(&self) -> u32 {
        self.pid
    }

    /// True once it has ended.
    pub(crate) fn is_dead(&self) -> bool {
        let Some(pidfd) = &self.pidfd else {
            return true;
        };
        let now = Timespec {
            tv_sec: 0,
            tv_nsec: 0,
        };
        let mut fds = [PollFd::new(pidfd, PollFlags::IN)];
        matches!(poll(&mut fds, Some(&now)), Ok(ready) if ready > 0)
    }
}

/// A solver that computes does not look at its link. A thread of its own ends it when the coordinator
/// has died and the solver did not end by itself meanwhile.
fn end_with(address: &LinkAddress, pid: u32, pidfd: &OwnedFd) -> Result<(), WireError> {
    let failed = |cause: std::io::Error| WireError::Watch { pid, cause };
    let pidfd = pidfd.try_clone().map_err(failed)?;
    let address = address.clone();
    let watch = move || {
        let mut fds = [PollFd::new(&pidfd, PollFlags::IN)];
        while !matches!(poll(&mut fds, None), Ok(ready) if ready > 0) {}
        std::thread::sleep(GRACE);
        eprintln!("{}", WireError::PeerDead { pid });
        address.remove_files();
        // No handler of an exit may hold the process up: MPI's would wait for other ranks.
        let _ = kill_process(getpid(), Signal::KILL);
    };
    std::thread::Builder::new()
        .name("calcine-watch".into())
        .spawn(watch)
        .map_err(failed)?;
    Ok(())
}
