//! An external solver as both adapters use it: launched, linked, shaken hands with, asked, waited for,
//! and ended. One link per rank; every wait goes through a supervisor.

use std::path::{Path, PathBuf};
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::supervisor::{Supervisor, log_end};
use calcine_coupler::time::Window;
use calcine_wire::shared_memory::End;
use calcine_wire::{Header, Hello, Kind, Link, Run, SharedMemory, WireError};

use crate::launch::{Processes, Program};

/// What is to be launched.
#[derive(Clone, Debug)]
pub struct Launch {
    /// Name for messages, for example "LIGGGHTS (particles)".
    pub name: String,
    /// The program; with more than one rank it runs under `mpirun`.
    pub program: Program,
    /// Where its output goes.
    pub log: PathBuf,
    /// What the solver must agree with; `ranks` says how many are started.
    pub hello: Hello,
    /// Longest silence during the handshake.
    pub handshake: Duration,
    /// Longest silence while it writes a checkpoint or ends.
    pub deadline: Duration,
}

/// Who is at the other end, for errors and for waits of its own.
struct Peer {
    name: String,
    pid: u32,
    log: PathBuf,
    /// Watches this solver only, for waits that have no supervisor of the run.
    own: Supervisor,
}

/// A running solver. Dropping it ends its processes and removes the run's files.
pub struct ExternalSolver {
    links: Vec<Link>,
    // Dropped in this order: processes end before the run's files go.
    processes: Processes,
    _run: Run,
    peer: Peer,
    hello: Hello,
    deadline: Duration,
}

/// The header of a request in a window; times as the wire has them.
pub fn header(kind: Kind, window: &Window) -> Header {
    Header {
        attempt: window.attempt,
        window: window.index,
        start_motion: window.start.motion.count(),
        start_process: window.start.process.count(),
        span_motion: window.span.motion.count(),
        span_process: window.span.process.count(),
        ..Header::of(kind)
    }
}

/// Opens the coordinator's end of every rank's link.
fn open_links(run: &Run, hello: &Hello) -> Result<Vec<Link>, WireError> {
    let address = run.address(&hello.role);
    (0..hello.ranks)
        .map(|rank| {
            let transport = SharedMemory::open(&address, rank, End::Coordinator)?;
            Ok(Link::new(Box::new(transport), address.number(), rank))
        })
        .collect()
}

impl Peer {
    fn watched(
        name: &str,
        pid: u32,
        log: &Path,
        deadline: Duration,
        supervisor: &Supervisor,
    ) -> Result<Self, PartError> {
        let mut own = Supervisor::new(deadline, supervisor.interrupts().clone());
        own.watch(name, pid, Some(log))?;
        Ok(Self {
            name: name.into(),
            pid,
            log: log.into(),
            own,
        })
    }

    /// A wire's error as the part's: its own words, else its death, else the wire's.
    fn failure(&self, window: Option<&Window>, error: WireError) -> PartError {
        let who = format!("{}, pid {}", self.name, self.pid);
        let log = log_end(&self.log);
        let mut part = match error {
            WireError::Failed { text } => PartError::new(who, FailureKind::Reported, text),
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

    /// Waits until every link holds a message of a kind.
    fn wait(
        &self,
        links: &mut [Link],
        supervisor: &Supervisor,
        window: Option<&Window>,
        kind: Kind,
    ) -> Result<(), PartError> {
        let mut arrived = vec![false; links.len()];
        let mut poll = |slice: Duration| {
            let share = slice / u32::try_from(arrived.len().max(1)).unwrap_or(1);
            for (link, arrived) in links.iter_mut().zip(&mut arrived) {
                if *arrived {
                    continue;
                }
                let received = link.receive(share);
                let received = received.map_err(|error| self.failure(window, error))?;
                if let Some(header) = received {
                    if header.kind() != Some(kind) {
                        let error = WireError::Unexpected {
                            found: header.kind,
                            expected: "another answer",
                        };
                        return Err(self.failure(window, error));
                    }
                    *arrived = true;
                }
            }
            Ok(arrived.iter().all(|&arrived| arrived).then_some(()))
        };
        let waited = supervisor.wait(&self.name, window, &mut poll);
        match waited {
            // The last word of a solver that ended says more than its end.
            Err(death) if death.kind == FailureKind::Died => match poll(Duration::ZERO) {
                Ok(Some(())) => Ok(()),
                Err(word) if word.kind == FailureKind::Reported => Err(word),
                _ => Err(death),
            },
            waited => waited,
        }
    }
}

impl ExternalSolver {
    /// Starts the solver, shakes hands with every rank, and waits for the state it starts from:
    /// afterwards each link holds a `State`.
    pub fn launch(launch: Launch, supervisor: &mut Supervisor) -> Result<Self, PartError> {
        let unopened = |error: WireError| {
            let message = "its link cannot be opened";
            PartError::new(&launch.name, FailureKind::NotStarted, message).caused_by(error)
        };
        let run = Run::create().map_err(unopened)?;
        let links = open_links(&run, &launch.hello).map_err(unopened)?;
        let (name, log) = (&launch.name, &launch.log);
        let address = run.address(&launch.hello.role);
        let ranks = launch.hello.ranks;
        let processes = Processes::start(name, &launch.program, ranks, &address, log)?;
        let pid = processes.pid();
        let mut solver = Self {
            links,
            processes,
            _run: run,
            peer: Peer::watched(name, pid, log, launch.handshake, supervisor)?,
            hello: launch.hello.clone(),
            deadline: launch.deadline,
        };
        solver.shake_hands()?;
        solver.peer = Peer::watched(name, pid, log, launch.deadline, supervisor)?;
        supervisor.watch(name, pid, Some(log))?;
        Ok(solver)
    }

    fn shake_hands(&mut self) -> Result<(), PartError> {
        let ours = self.hello.clone();
        self.wait_alone(Kind::Hello)?;
        for link in &mut self.links {
            let answer = link.answer_greeting(&ours);
            self.hello = answer.map_err(|error| self.peer.failure(None, error))?;
        }
        self.wait_alone(Kind::State)
    }

    /// The solver's introduction: name and version.
    pub fn hello(&self) -> &Hello {
        &self.hello
    }

    /// Process id of the solver, or of the `mpirun` above it.
    pub fn pid(&self) -> u32 {
        self.peer.pid
    }

    /// Links, one per rank, each with the message that was waited for last.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// A wire's error as the part's, with name, pid and the end of the log.
    pub fn failure(&self, window: Option<&Window>, error: WireError) -> PartError {
        self.peer.failure(window, error)
    }

    /// An error of this part in words, with name, pid and the end of the log.
    pub fn refuse(&self, window: Option<&Window>, message: String) -> PartError {
        let who = format!("{}, pid {}", self.peer.name, self.peer.pid);
        let mut error = PartError::new(who, FailureKind::Protocol, message);
        error.window = window.copied();
        error.with_log(log_end(&self.peer.log))
    }

    /// Sends every rank a message of `count` items whose columns `fill` fills in.
    pub fn send_columns(
        &mut self,
        window: &Window,
        header: Header,
        count: usize,
        fill: impl Fn(&mut Link) -> Result<(), WireError>,
    ) -> Result<(), PartError> {
        let sent = self.links.iter_mut().try_for_each(|link| {
            link.loan(header, count)?;
            fill(link)?;
            link.send()
        });
        sent.map_err(|error| self.peer.failure(Some(window), error))
    }

    /// Waits until every rank has answered with a message of a kind; the links then hold it.
    pub fn wait(
        &mut self,
        supervisor: &Supervisor,
        window: &Window,
        kind: Kind,
    ) -> Result<(), PartError> {
        self.peer
            .wait(&mut self.links, supervisor, Some(window), kind)
    }

    /// The same outside windows, watching this solver only.
    fn wait_alone(&mut self, kind: Kind) -> Result<(), PartError> {
        self.peer.wait(&mut self.links, &self.peer.own, None, kind)
    }

    /// Tells every rank to take the last attempt as the new start; there is no answer.
    pub fn commit(&mut self) -> Result<(), PartError> {
        self.send_text(Kind::Commit, "")
    }

    /// Has a checkpoint written into a directory; afterwards each link holds a `Checkpointed`.
    pub fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        let absolute = std::path::absolute(directory).map_err(|error| {
            let message = format!("the folder {} cannot be used", directory.display());
            PartError::new(&self.peer.name, FailureKind::Io, message).caused_by(error)
        })?;
        self.send_text(Kind::Checkpoint, &absolute.to_string_lossy())?;
        self.wait_alone(Kind::Checkpointed)
    }

    /// Has particles taken out and put in, as told in a text; afterwards each link holds a `Changed`.
    pub fn change(&mut self, supervisor: &Supervisor, text: &str) -> Result<(), PartError> {
        self.send_text(Kind::Change, text)?;
        self.peer
            .wait(&mut self.links, supervisor, None, Kind::Changed)
    }

    /// Ends the solver in an orderly way.
    pub fn goodbye(&mut self) -> Result<(), PartError> {
        self.send_text(Kind::Bye, "")?;
        self.wait_alone(Kind::Bye)?;
        self.processes.wait(&self.peer.name, self.deadline)
    }

    fn send_text(&mut self, kind: Kind, text: &str) -> Result<(), PartError> {
        let sent = self
            .links
            .iter_mut()
            .try_for_each(|link| link.send_text(Header::of(kind), text));
        sent.map_err(|error| self.peer.failure(None, error))
    }
}
