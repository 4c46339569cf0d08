//! The supervisor: the one place that waits. It holds every peer's pidfd, the deadline and the
//! user's interrupts, so that the death of one solver is noticed while another computes.

use std::cell::Cell;
use std::fmt;
use std::fs;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, PidfdFlags, WaitId, WaitIdOptions, pidfd_open, waitid};

use crate::error::{FailureKind, PartError};
use crate::time::Window;

/// How long one slice of a wait may last before every peer is looked at again.
const SLICE: Duration = Duration::from_millis(20);
/// What a slice counts at most: it is longer only where the whole run was suspended (Ctrl-Z, a queue).
const LONGEST_SLICE: Duration = Duration::from_secs(1);
/// How often peers are looked at for whether they are stopped.
const LOOK: Duration = Duration::from_millis(200);
/// How many lines of a log an error shows.
const LOG_LINES: usize = 12;
/// How many lines of an error that is earlier in the log it shows before them.
const ERROR_LINES: usize = 6;

/// A process that the run depends on.
#[derive(Debug)]
struct Peer {
    name: String,
    pid: u32,
    pidfd: OwnedFd,
    log: Option<PathBuf>,
    /// What had been waited when it was first seen stopped; `None` while it is not.
    stopped: Cell<Option<Duration>>,
}

impl Peer {
    /// True where a signal has stopped it and none let it go on.
    fn is_stopped(&self) -> bool {
        let status = fs::read_to_string(format!("/proc/{}/status", self.pid));
        status.is_ok_and(|text| text.lines().any(|line| line.starts_with("State:\tT")))
    }
}

/// Interrupts of the user, counted by a signal handler: one asks for a checkpoint at the end of
/// the window, two end the run at once.
#[derive(Clone, Debug, Default)]
pub struct Interrupts(Arc<AtomicU32>);

impl Interrupts {
    /// One more Ctrl-C or SIGTERM.
    pub fn raise(&self) {
        self.0.fetch_add(1, Ordering::SeqCst);
    }

    /// Number of interrupts so far.
    pub fn count(&self) -> u32 {
        self.0.load(Ordering::SeqCst)
    }
}

/// How long a run has waited for its solvers so far, one after the other: while one answers, the others have had
/// that time too. What the coordinator computes by itself does not count.
#[derive(Clone, Debug, Default)]
pub struct SolverWait(Arc<AtomicU64>);

impl SolverWait {
    /// All of it.
    pub fn so_far(&self) -> Duration {
        Duration::from_nanos(self.0.load(Ordering::SeqCst))
    }

    fn add(&self, more: Duration) {
        let nanos = u64::try_from(more.as_nanos()).unwrap_or(u64::MAX);
        self.0.fetch_add(nanos, Ordering::SeqCst);
    }
}

/// Holds the peers' pidfds, the deadline and the interrupts.
#[derive(Debug)]
pub struct Supervisor {
    peers: Vec<Peer>,
    deadline: Duration,
    interrupts: Interrupts,
    waited: SolverWait,
    /// What had been waited when peers were looked at last.
    looked: Cell<Duration>,
}

impl Supervisor {
    /// A supervisor without peers; `deadline` is the longest a peer may stay silent.
    pub fn new(deadline: Duration, interrupts: Interrupts) -> Self {
        Self {
            peers: Vec::new(),
            deadline,
            interrupts,
            waited: SolverWait::default(),
            looked: Cell::default(),
        }
    }

    /// What this supervisor has waited.
    pub fn waited(&self) -> &SolverWait {
        &self.waited
    }

    /// Interrupts so far.
    pub fn interrupts(&self) -> &Interrupts {
        &self.interrupts
    }

    /// Watches a process from now on, if it is not watched already. `name` as in "OpenFOAM (gas, rank 0)".
    pub fn watch(&mut self, name: &str, pid: u32, log: Option<&Path>) -> Result<(), PartError> {
        if self.peers.iter().any(|peer| peer.pid == pid) {
            return Ok(());
        }
        let gone = |message: String| {
            PartError::new(label(name, pid), FailureKind::Died, message)
                .with_log(log.map(log_end).unwrap_or_default())
        };
        let raw = i32::try_from(pid)
            .ok()
            .and_then(Pid::from_raw)
            .ok_or_else(|| gone(format!("{pid} is not a process id")))?;
        let pidfd = pidfd_open(raw, PidfdFlags::empty())
            .map_err(|error| gone(format!("ended before it could be watched: {error}")))?;
        self.peers.push(Peer {
            name: name.into(),
            pid,
            pidfd,
            log: log.map(Path::to_owned),
            stopped: Cell::new(None),
        });
        Ok(())
    }

    /// Stops watching a process, before it is asked to end.
    pub fn forget(&mut self, pid: u32) {
        self.peers.retain(|peer| peer.pid != pid);
    }

    /// An error that names the peers found dead, with the end of the first one's log. Which of them was
    /// the first to die cannot be known, since MPI ends all ranks soon after one; but one that a signal ended did
    /// not follow others.
    pub fn check(&self, window: Option<&Window>) -> Result<(), PartError> {
        let is_dead = |peer: &&Peer| has_ended(&peer.pidfd, Duration::ZERO);
        let dead = self.peers.iter().filter(is_dead);
        let mut dead: Vec<(&Peer, Ending)> = dead.map(|peer| (peer, ending(&peer.pidfd))).collect();
        dead.sort_by_key(|(_, how)| !matches!(how, Ending::Signal(_)));
        let Some(((peer, how), others)) = dead.split_first() else {
            return Ok(());
        };
        let mut message = format!("died: {how}");
        for (other, how) in others {
            let who = label(&other.name, other.pid);
            message.push_str(&format!("; so did {who}: {how}"));
        }
        let who = label(&peer.name, peer.pid);
        let mut error = PartError::new(who, FailureKind::Died, message)
            .with_log(peer.log.as_deref().map(log_end).unwrap_or_default());
        error.window = window.copied();
        Err(error)
    }

    /// Calls `poll` with short time slices until it yields a value, watching every peer, the
    /// deadline and the interrupts in between. `poll` must return within its slice.
    pub fn wait<T>(
        &self,
        who: &str,
        window: Option<&Window>,
        poll: impl FnMut(Duration) -> Result<Option<T>, PartError>,
    ) -> Result<T, PartError> {
        self.wait_since(self.waited.so_far(), who, window, poll)
    }

    /// The same, for the answer to what was asked when [`Supervisor::waited`] was `asked`.
    pub fn wait_since<T>(
        &self,
        asked: Duration,
        who: &str,
        window: Option<&Window>,
        mut poll: impl FnMut(Duration) -> Result<Option<T>, PartError>,
    ) -> Result<T, PartError> {
        loop {
            let begun = Instant::now();
            let answer = poll(SLICE);
            self.waited.add(begun.elapsed().min(LONGEST_SLICE));
            if let Some(value) = answer? {
                return Ok(value);
            }
            self.check(window)?;
            self.check_stopped(window)?;
            if self.interrupts.count() >= 2 {
                return Err(self.failure(
                    who,
                    window,
                    FailureKind::Interrupted,
                    "interrupted".into(),
                ));
            }
            if self.waited.so_far().saturating_sub(asked) > self.deadline {
                let message = format!("silent for {} s", self.deadline.as_secs_f64());
                return Err(self.failure(who, window, FailureKind::Silent, message));
            }
        }
    }

    /// An error that names a peer that has been stopped for longer than the deadline, whoever is waited for: others
    /// that work may answer again and again before its own answer is due.
    fn check_stopped(&self, window: Option<&Window>) -> Result<(), PartError> {
        let now = self.waited.so_far();
        if now.saturating_sub(self.looked.get()) < LOOK {
            return Ok(());
        }
        self.looked.set(now);
        for peer in &self.peers {
            let since = peer.stopped.get().unwrap_or(now);
            peer.stopped.set(peer.is_stopped().then_some(since));
            if peer.stopped.get().is_some() && now - since > self.deadline {
                let message = format!(
                    "silent for {} s: the process is stopped (SIGSTOP)",
                    self.deadline.as_secs_f64()
                );
                return Err(self.failure(&peer.name, window, FailureKind::Silent, message));
            }
        }
        Ok(())
    }

    fn failure(
        &self,
        who: &str,
        window: Option<&Window>,
        kind: FailureKind,
        message: String,
    ) -> PartError {
        let peer = self.peers.iter().find(|peer| peer.name.starts_with(who));
        let log = peer
            .and_then(|peer| peer.log.as_deref())
            .map(log_end)
            .unwrap_or_default();
        let name = peer.map_or_else(|| who.to_owned(), |peer| label(&peer.name, peer.pid));
        let mut error = PartError::new(name, kind, message).with_log(log);
        error.window = window.copied();
        error
    }
}

fn label(name: &str, pid: u32) -> String {
    format!("{name}, pid {pid}")
}

/// True where the process of a pidfd has ended, waiting at most `patience`.
pub fn has_ended(pidfd: &OwnedFd, patience: Duration) -> bool {
    let timeout = Timespec {
        tv_sec: patience.as_secs() as i64,
        tv_nsec: i64::from(patience.subsec_nanos()),
    };
    let mut fds = [PollFd::new(pidfd, PollFlags::IN)];
    matches!(poll(&mut fds, Some(&timeout)), Ok(ready) if ready > 0)
}

/// How a process ended.
#[derive(Clone, Copy, Debug)]
enum Ending {
    Code(i32),
    Signal(i32),
    /// Only a child's status can be read.
    Unknown,
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Code(code) => write!(f, "exit code {code}"),
            Self::Signal(signal) => write!(f, "signal {signal} ({})", signal_name(signal)),
            Self::Unknown => f.write_str("its process has ended"),
        }
    }
}

fn ending(pidfd: &OwnedFd) -> Ending {
    use std::os::fd::AsFd;
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    let Ok(Some(status)) = waitid(WaitId::PidFd(pidfd.as_fd()), options) else {
        return Ending::Unknown;
    };
    let signal = || status.terminating_signal().map(Ending::Signal);
    let code = status.exit_status().map(Ending::Code);
    code.or_else(signal).unwrap_or(Ending::Unknown)
}

fn signal_name(signal: i32) -> &'static str {
    match signal {
        4 => "SIGILL",
        6 => "SIGABRT",
        7 => "SIGBUS",
        8 => "SIGFPE",
        9 => "SIGKILL",
        11 => "SIGSEGV",
        13 => "SIGPIPE",
        15 => "SIGTERM",
        _ => "see signal(7)",
    }
}

/// The last lines of a log file, after those with which the last error in it begins, where these are earlier; empty where it cannot be
/// read.
pub fn log_end(path: &Path) -> Vec<String> {
    let Ok(bytes) = fs::read(path) else {
        return Vec::new();
    };
    let text = String::from_utf8_lossy(&bytes[bytes.len().saturating_sub(64 * 1024)..]);
    let lines: Vec<String> = text
        .lines()
        .map(str::trim_end)
        .filter(|line| !line.is_empty())
        .map(str::to_owned)
        .collect();
    let first = lines.len().saturating_sub(LOG_LINES);
    let says_why = |line: &String| line.contains("ERROR") || line.contains("sigFpe");
    let why = lines[..first].iter().rposition(says_why);
    let mut end = Vec::new();
    if let Some(why) = why {
        // OpenFOAM prints what called what after its error.
        end.extend_from_slice(&lines[why..first.min(why + ERROR_LINES)]);
        if why + ERROR_LINES < first {
            end.push("…".to_owned());
        }
    }
    end.extend_from_slice(&lines[first..]);
    end
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn the_death_of_a_peer_is_noticed_within_a_second_and_named_with_its_log() {
        let directory = tempfile::tempdir().unwrap();
        let log = directory.path().join("log.gas");
        fs::write(&log, "starting\nTime = 3\n\n").unwrap();
        let mut child = Command::new("sleep").arg("60").spawn().unwrap();
        let mut supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
        supervisor
            .watch("OpenFOAM (gas, rank 0)", child.id(), Some(&log))
            .unwrap();
        child.kill().unwrap();
        let begun = Instant::now();
        let error = supervisor
            .wait("OpenFOAM", Some(&Window::default()), |slice| {
                std::thread::sleep(slice);
                Ok(None::<()>)
            })
            .unwrap_err();
        assert!(begun.elapsed() < Duration::from_secs(1));
        let text = error.to_string();
        assert!(text.contains("OpenFOAM (gas, rank 0)"), "{text}");
        assert!(text.contains("signal 9 (SIGKILL)"), "{text}");
        assert!(text.contains("Time = 3"), "{text}");
        assert_eq!(error.kind, FailureKind::Died);
        child.wait().unwrap();
    }

    #[test]
    fn a_peer_that_a_signal_ended_is_named_before_those_that_ended_after_it() {
        let mut supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
        let start = |line: &str| Command::new("sh").args(["-c", line]).spawn().unwrap();
        let mut follower = start("exit 3");
        let mut daemon = start("kill -9 $$");
        // Watching what is watched already changes nothing.
        for (name, pid) in [
            ("rank", follower.id()),
            ("daemon", daemon.id()),
            ("daemon again", daemon.id()),
        ] {
            supervisor.watch(name, pid, None).unwrap();
        }
        for peer in &supervisor.peers {
            assert!(has_ended(&peer.pidfd, Duration::from_secs(20)));
        }
        let text = supervisor.check(None).unwrap_err().to_string();
        let (first, second) = text.split_once("; so did ").unwrap();
        assert!(
            first.contains(&format!("daemon, pid {}", daemon.id())),
            "{text}"
        );
        assert!(first.contains("signal 9 (SIGKILL)"), "{text}");
        assert!(
            second.contains(&format!("rank, pid {}: exit code 3", follower.id())),
            "{text}"
        );
        assert!(!second.contains("so did"), "{text}");
        follower.wait().unwrap();
        daemon.wait().unwrap();
    }

    #[test]
    fn what_was_waited_for_another_peer_counts_as_silence_too() {
        let supervisor = Supervisor::new(Duration::from_secs(60), Interrupts::default());
        let asked = supervisor.waited().so_far();
        // What another answer took.
        supervisor.waited.add(Duration::from_secs(61));
        let nothing = |_| Ok(None::<()>);
        let error = supervisor.wait_since(asked, "particles", None, nothing);
        assert_eq!(error.unwrap_err().kind, FailureKind::Silent);
        // One that is asked now has its time.
        let mut polls = 0;
        let late = |_| {
            polls += 1;
            Ok((polls > 3).then_some(polls))
        };
        assert_eq!(supervisor.wait("particles", None, late).unwrap(), 4);
        // An answer that is there is taken, however long ago it was asked for.
        let answer = supervisor.wait_since(asked, "particles", None, |_| Ok(Some(7)));
        assert_eq!(answer.unwrap(), 7);
        // What is polled is waited.
        let before = supervisor.waited().so_far();
        let sleeps = |slice| {
            std::thread::sleep(slice);
            Ok(Some(()))
        };
        supervisor.wait("gas", None, sleeps).unwrap();
        assert!(supervisor.waited().so_far() >= before + SLICE);
    }

    #[test]
    fn a_stopped_peer_is_named_whoever_is_waited_for_and_one_that_went_on_is_not() {
        let mut child = Command::new("sleep").arg("60").spawn().unwrap();
        let deadline = Duration::from_secs(5);
        let mut supervisor = Supervisor::new(deadline, Interrupts::default());
        supervisor.watch("particles", child.id(), None).unwrap();
        let pid = Pid::from_child(&child);
        let signal = |signal| rustix::process::kill_process(pid, signal).unwrap();
        let is_stopped = |wanted| {
            while supervisor.peers[0].is_stopped() != wanted {
                std::thread::sleep(Duration::from_millis(1));
            }
        };
        let look = |later: Duration| {
            supervisor.waited.add(later);
            supervisor.check_stopped(None)
        };
        signal(rustix::process::Signal::STOP);
        is_stopped(true);
        look(LOOK).unwrap();
        look(deadline).unwrap();
        signal(rustix::process::Signal::CONT);
        is_stopped(false);
        look(LOOK).unwrap();
        signal(rustix::process::Signal::STOP);
        is_stopped(true);
        look(deadline).unwrap();
        look(deadline).unwrap();
        let error = look(LOOK).unwrap_err();
        assert_eq!(error.kind, FailureKind::Silent);
        let text = error.to_string();
        assert!(
            text.contains(&format!("particles, pid {}", child.id())),
            "{text}"
        );
        assert!(text.contains("stopped"), "{text}");
        child.kill().unwrap();
        child.wait().unwrap();
    }

    #[test]
    fn time_in_which_the_whole_run_was_suspended_is_no_silence() {
        let deadline = LONGEST_SLICE + Duration::from_millis(50);
        let supervisor = Supervisor::new(deadline, Interrupts::default());
        let mut polls = 0;
        let suspended = |_| {
            polls += 1;
            if polls == 1 {
                std::thread::sleep(deadline + Duration::from_millis(50));
            }
            Ok((polls > 1).then_some(()))
        };
        supervisor.wait("gas", None, suspended).unwrap();
        assert_eq!(supervisor.waited().so_far().as_secs(), 1);
    }

    #[test]
    fn a_silent_peer_and_a_second_interrupt_end_a_wait() {
        let supervisor = Supervisor::new(Duration::from_millis(50), Interrupts::default());
        let silent = |slice| {
            std::thread::sleep(slice);
            Ok(None::<()>)
        };
        assert_eq!(
            supervisor.wait("gas", None, silent).unwrap_err().kind,
            FailureKind::Silent
        );
        supervisor.interrupts().raise();
        supervisor.interrupts().raise();
        assert_eq!(
            supervisor.wait("gas", None, silent).unwrap_err().kind,
            FailureKind::Interrupted
        );
    }
}
