//! Who is at the other end of the links: its names, its death, its last words, and the wait for its answers.

use std::path::{Path, PathBuf};
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::motion::LOST_REMEDY;
use calcine_coupler::supervisor::{Supervisor, log_end};
use calcine_coupler::time::Window;
use calcine_wire::{Link, MessageKind, SolverFailure, WireError};

/// Who is at the other end, for errors and for waits of its own.
pub(super) struct Peer {
    pub(super) name: String,
    /// The solver or its launcher; `None` where somebody else started it.
    pub(super) pid: Option<u32>,
    /// Ranks' process ids, once they introduced themselves.
    pub(super) ranks: Vec<u32>,
    pub(super) log: PathBuf,
    /// Watches this solver only, for waits that have no supervisor of the run.
    pub(super) own: Supervisor,
}

/// The kind of failure that a solver reported.
fn reported(kind: SolverFailure) -> FailureKind {
    match kind {
        SolverFailure::Other => FailureKind::Reported,
        SolverFailure::Diverged => FailureKind::Diverged,
        SolverFailure::NotConverged => FailureKind::NotConverged,
        SolverFailure::InvalidInput => FailureKind::InvalidInput,
        SolverFailure::LostParticles => FailureKind::LostParticles,
        SolverFailure::OutOfMemory => FailureKind::OutOfMemory,
        SolverFailure::NotFinite => FailureKind::NotFinite,
        SolverFailure::File => FailureKind::Io,
        SolverFailure::Unsupported => FailureKind::Refused,
    }
}

impl Peer {
    /// The solver of a name and a log; `silence` is its longest while hands are shaken.
    pub(super) fn new(
        (name, log): (&str, &Path),
        silence: Duration,
        pid: Option<u32>,
        supervisor: &Supervisor,
    ) -> Result<Self, PartError> {
        let mut peer = Self {
            name: name.to_owned(),
            pid,
            ranks: Vec::new(),
            log: log.to_owned(),
            own: Supervisor::new(silence, supervisor.interrupts().clone()),
        };
        if let Some(pid) = pid {
            peer.own.watch(&peer.name, pid, Some(&peer.log))?;
        }
        Ok(peer)
    }

    /// Has a supervisor watch every process of the solver, the ranks first: a launcher ends soon after
    /// the rank that is to be named.
    pub(super) fn watch(
        &self,
        supervisor: &mut Supervisor,
        local: &[(usize, u32)],
    ) -> Result<(), PartError> {
        for &(rank, pid) in local.iter().filter(|(_, pid)| Some(*pid) != self.pid) {
            supervisor.watch(&self.called(&format!("rank {rank}")), pid, Some(&self.log))?;
        }
        let Some(pid) = self.pid else { return Ok(()) };
        let name = if local.iter().any(|&(_, rank)| rank == pid) {
            self.name.clone()
        } else {
            self.called("launcher")
        };
        supervisor.watch(&name, pid, Some(&self.log))
    }

    /// The name with more in its brackets: "OpenFOAM (gas, rank 1)".
    fn called(&self, what: &str) -> String {
        match self.name.strip_suffix(')') {
            Some(name) => format!("{name}, {what})"),
            None => format!("{} ({what})", self.name),
        }
    }

    /// Name and process id, of a rank where one is meant.
    pub(super) fn who(&self, rank: Option<usize>) -> String {
        let of_rank = rank.and_then(|rank| self.ranks.get(rank));
        match (rank, of_rank, self.pid) {
            (Some(rank), Some(pid), _) if self.ranks.len() > 1 => {
                format!("{}, pid {pid}", self.called(&format!("rank {rank}")))
            }
            (_, Some(pid), None) => format!("{}, pid {pid}", self.name),
            (_, _, Some(pid)) => format!("{}, pid {pid}", self.name),
            _ => self.name.clone(),
        }
    }

    /// A wire's error as the part's: its own words, else its death, else the wire's.
    pub(super) fn failure(
        &self,
        rank: Option<usize>,
        window: Option<&Window>,
        error: WireError,
    ) -> PartError {
        let who = self.who(rank);
        let log = log_end(&self.log);
        let mut part = match error {
            WireError::Failed { kind, text } => {
                let kind = reported(kind);
                let text = match kind {
                    FailureKind::LostParticles => format!("{text}; {LOST_REMEDY}"),
                    _ => text,
                };
                PartError::new(who, kind, text)
            }
            WireError::Mismatch { .. } => {
                PartError::new(who, FailureKind::NotStarted, error.to_string())
            }
            error => {
                // What ended may be noticed on the wire before its process is gone.
                std::thread::sleep(Duration::from_millis(50));
                if let Err(death) = self.own.check(window) {
                    return death;
                }
                let message = format!("the link failed: {error}");
                PartError::new(who, FailureKind::Protocol, message)
            }
        };
        part.window = window.copied();
        part.with_log(log)
    }

    /// Waits until every link holds a message of a kind, which it was asked for when the supervisor had waited `asked`.
    pub(super) fn wait(
        &self,
        links: &mut [Link],
        supervisor: &Supervisor,
        window: Option<&Window>,
        kind: MessageKind,
        asked: Duration,
    ) -> Result<(), PartError> {
        let mut arrived = vec![false; links.len()];
        let mut poll = |slice: Duration| {
            let share = slice / u32::try_from(arrived.len().max(1)).unwrap_or(1);
            for (rank, (link, arrived)) in links.iter_mut().zip(&mut arrived).enumerate() {
                if *arrived {
                    continue;
                }
                let received = link.receive(share);
                let received = received.map_err(|error| self.failure(Some(rank), window, error))?;
                if let Some(header) = received {
                    if header.kind() != Some(kind) {
                        let error = WireError::Unexpected {
                            found: header.kind,
                            expected: kind.name(),
                        };
                        return Err(self.failure(Some(rank), window, error));
                    }
                    *arrived = true;
                }
            }
            Ok(arrived.iter().all(|&arrived| arrived).then_some(()))
        };
        let waited = supervisor.wait_since(asked, &self.name, window, &mut poll);
        match waited {
            // The last word of a solver that ended says more than its end.
            Err(death) if death.kind == FailureKind::Died => match poll(Duration::ZERO) {
                Ok(Some(())) => Ok(()),
                Err(word) if word.kind.is_reported() => Err(word),
                _ => Err(death),
            },
            Err(mut silence) if silence.kind == FailureKind::Silent => {
                let rank = arrived.iter().position(|arrived| !arrived);
                silence.who = self.who(rank);
                Err(silence.with_log(log_end(&self.log)))
            }
            waited => waited,
        }
    }
}
