//! An external solver as both adapters use it: launched, linked, shaken hands with, asked, waited for,
//! and ended. One link per rank; every wait goes through a supervisor.

mod cells;
mod peer;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::supervisor::{SolverWait, Supervisor, log_end};
use calcine_coupler::time::Window;
use calcine_wire::shared_memory::LinkEnd;
use calcine_wire::{
    ColumnSet, Field, Header, Hello, Link, MessageKind, RunDirectory, SharedMemory, SolverNetwork,
    WireError,
};

use crate::answer::WrongAnswer;
use crate::launch::{Launcher, Processes, Program, Spawner, spawn};
use peer::Peer;

/// What is to be launched.
#[derive(Clone, Debug)]
pub struct Launch {
    /// Name for messages, for example "LIGGGHTS (particles)".
    pub name: String,
    /// The program of each rank.
    pub program: Program,
    /// Who starts it.
    pub launcher: Launcher,
    /// Where its output goes.
    pub log: PathBuf,
    /// What the solver must agree with; `ranks` says how many are started.
    pub hello: Hello,
    /// Columns that the solver may have beside those of `hello`.
    pub optional: Vec<Field>,
    /// The mesh with whose cells those of a gas are compared, where no hash is.
    pub cells: Option<Arc<Mesh>>,
    /// Longest silence during the handshake.
    pub handshake: Duration,
    /// Longest silence while it writes a checkpoint or ends.
    pub deadline: Duration,
}

impl Launch {
    /// Of a solver of Calcine's own, which has the columns and the mesh that `hello` tells, and no longer for its handshake than for
    /// anything else.
    pub fn of_own(
        name: &str,
        program: Program,
        launcher: Launcher,
        log: PathBuf,
        hello: Hello,
        deadline: Duration,
    ) -> Self {
        Self {
            name: name.into(),
            program,
            launcher,
            log,
            hello,
            optional: Vec::new(),
            cells: None,
            handshake: deadline,
            deadline,
        }
    }
}

/// How long somebody may take who starts a solver by hand.
const BY_HAND: Duration = Duration::from_secs(24 * 3600);

/// A running solver. Dropping it ends its processes and removes the run's files.
pub struct ExternalSolver {
    links: Vec<Link>,
    // Dropped in this order: processes end before the run's files go.
    processes: Processes,
    run: Option<RunDirectory>,
    /// Where MPI spawned the ranks: told when they have ended well.
    network: Option<Arc<dyn SolverNetwork>>,
    peer: Peer,
    hello: Hello,
    /// By rank: the cells of the whole mesh that it has; empty for particles.
    owned: Arc<[Vec<usize>]>,
    deadline: Duration,
    /// What the run has waited for solvers, and had when this one was asked or answered last.
    waited: SolverWait,
    asked: Duration,
    /// Processor time of the ranks of this machine when they were ready.
    used_at_start: Duration,
}

/// The header of a request in a window; times as the wire has them.
pub fn header(kind: MessageKind, window: &Window) -> Header {
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

/// Opens the coordinator's end of every rank's link, which the ranks wait for.
fn open_links(run: &RunDirectory, hello: &Hello) -> Result<Vec<Link>, WireError> {
    let address = run.address(&hello.role);
    (0..hello.ranks)
        .map(|rank| {
            let transport = SharedMemory::open(&address, rank, LinkEnd::Coordinator)?;
            Ok(Link::new(Box::new(transport), address.number(), rank))
        })
        .collect()
}

impl ExternalSolver {
    /// Starts the solver, shakes hands with every rank, and waits for the state it starts from:
    /// afterwards each link holds a `State`.
    pub fn launch(mut launch: Launch, supervisor: &mut Supervisor) -> Result<Self, PartError> {
        let program = std::mem::take(&mut launch.program);
        launch.program = program.without_blanks().map_err(|error| {
            let message = "its program cannot be linked in its folder";
            PartError::new(&launch.name, FailureKind::NotStarted, message).caused_by(error)
        })?;
        let unopened = |error: WireError| {
            let message = "its link cannot be opened";
            PartError::new(&launch.name, FailureKind::NotStarted, message).caused_by(error)
        };
        let ranks = launch.hello.ranks;
        let (run, links, processes);
        if let Launcher::Network(Spawner(network)) = &launch.launcher {
            let address = network.address(&launch.hello.role);
            let program = &launch.program;
            let ends = spawn(
                &**network,
                program,
                ranks,
                &address,
                &launch.log,
                launch.handshake,
                &|| supervisor.check(None).is_err(),
            );
            let ends = ends.map_err(|error| {
                // Who dies takes those with it that MPI is starting.
                if let Err(death) = supervisor.check(None) {
                    return death;
                }
                let message = "its ranks cannot be spawned by MPI";
                let error =
                    PartError::new(&launch.name, FailureKind::NotStarted, message).caused_by(error);
                error.with_log(log_end(&launch.log))
            })?;
            let number = address.number();
            let opened = ends.into_iter().zip(0..);
            links = opened
                .map(|(end, rank)| Link::new(end, number, rank))
                .collect();
            processes = Processes::elsewhere();
            run = None;
        } else {
            let own = RunDirectory::create().map_err(unopened)?;
            // The processes first: whatever happens to this one from here on, they remove the run's files.
            processes = Processes::start(
                &launch.name,
                &launch.program,
                &launch.launcher,
                ranks,
                &own.address(&launch.hello.role),
                &launch.log,
            )?;
            links = open_links(&own, &launch.hello).map_err(unopened)?;
            run = Some(own);
        }
        let silence = match launch.launcher {
            Launcher::Hand => BY_HAND,
            _ => launch.handshake,
        };
        let about = (launch.name.as_str(), launch.log.as_path());
        let mut peer = Peer::new(about, silence, processes.pid(), supervisor)?;
        if let Launcher::Network(Spawner(network)) = &launch.launcher {
            // No launcher of ours would end with a rank that dies before it introduces itself.
            let mut own = Supervisor::new(launch.handshake, supervisor.interrupts().clone());
            peer.watch(&mut own, &network.ranks_here(&launch.hello.role))?;
            peer.own = own;
        }
        let mut solver = Self {
            links,
            processes,
            run,
            network: match launch.launcher {
                Launcher::Network(Spawner(network)) => Some(network),
                _ => None,
            },
            peer,
            hello: launch.hello,
            owned: Arc::default(),
            deadline: launch.deadline,
            waited: supervisor.waited().clone(),
            asked: Duration::ZERO,
            used_at_start: Duration::ZERO,
        };
        solver.shake_hands(supervisor, &launch.optional, launch.cells.as_deref())?;
        solver.used_at_start = solver.used();
        Ok(solver)
    }

    fn shake_hands(
        &mut self,
        supervisor: &mut Supervisor,
        optional: &[Field],
        mesh: Option<&Mesh>,
    ) -> Result<(), PartError> {
        let mut ours = self.hello.clone();
        self.wait_alone(MessageKind::Hello)?;
        let mut local = Vec::new();
        for (rank, link) in self.links.iter_mut().enumerate() {
            // What the first rank has, all have.
            let answer = link.answer_offer(&ours, if rank == 0 { optional } else { &[] });
            ours.catalogue.clone_from(link.catalogue());
            self.hello = answer.map_err(|error| self.peer.failure(None, None, error))?;
            let Some(process) = link.peer() else { continue };
            self.peer.ranks.push(process.pid);
            if process.is_here() {
                local.push((rank, process.pid));
                self.processes.add_rank(process.pid);
            }
        }
        let mut own = Supervisor::new(self.deadline, supervisor.interrupts().clone());
        self.peer.watch(&mut own, &local)?;
        self.peer.watch(supervisor, &local)?;
        let daemon = self.network.as_ref().and_then(|network| network.daemon());
        if let Some((name, pid)) = daemon {
            own.watch(&name, pid, Some(&self.peer.log))?;
            supervisor.watch(&name, pid, Some(&self.peer.log))?;
        }
        self.peer.own = own;
        if ours.catalogue.of(ColumnSet::Owned).next().is_some() {
            self.wait_alone(MessageKind::Owned)?;
            let owned = self.claims();
            self.owned = owned.map_err(|error| self.failure(None, error))?.into();
            self.check_claims()?;
            if let Some(mesh) = mesh {
                self.check_geometry(mesh)?;
            }
        }
        self.wait_alone(MessageKind::State)
    }

    /// By rank: the cells of the whole mesh that it has, in the order of its columns.
    pub fn owned(&self) -> &Arc<[Vec<usize>]> {
        &self.owned
    }

    /// The solver's introduction: name and version.
    pub fn hello(&self) -> &Hello {
        &self.hello
    }

    /// Process id of the solver, or of the launcher above it.
    pub fn pid(&self) -> u32 {
        let first = || self.peer.ranks.first().copied();
        self.peer.pid.or_else(first).unwrap_or_default()
    }

    /// Process ids of the ranks, as they introduced themselves.
    pub fn rank_pids(&self) -> &[u32] {
        &self.peer.ranks
    }

    /// Processor time of the ranks of this machine, all threads, since they were ready.
    pub fn processor_time(&self) -> Duration {
        self.used().saturating_sub(self.used_at_start)
    }

    fn used(&self) -> Duration {
        let ranks = self.links.iter().filter_map(Link::peer);
        let local = ranks.filter(|process| process.is_here());
        local.map(|process| process.processor_time()).sum()
    }

    /// Links, one per rank, each with the message that was waited for last.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// A wire's error as the part's, with name, pid and the end of the log.
    pub fn failure(&self, window: Option<&Window>, error: WireError) -> PartError {
        self.peer.failure(None, window, error)
    }

    /// An answer that is not as it must be.
    pub fn wrong(&self, window: Option<&Window>, wrong: WrongAnswer) -> PartError {
        let mut error = self.refuse(window, wrong.message);
        error.kind = wrong.kind;
        error
    }

    /// An error of this part in words, with name, pid and the end of the log.
    pub fn refuse(&self, window: Option<&Window>, message: String) -> PartError {
        let mut error = PartError::new(self.peer.who(None), FailureKind::Protocol, message);
        error.window = window.copied();
        error.with_log(log_end(&self.peer.log))
    }

    /// Sends every rank a message of as many items as `count` says, whose columns `fill` fills in.
    pub fn send_columns(
        &mut self,
        window: &Window,
        header: Header,
        count: impl Fn(usize) -> usize,
        fill: impl Fn(usize, &mut Link) -> Result<(), WireError>,
    ) -> Result<(), PartError> {
        self.asked = self.waited.so_far();
        for (rank, link) in self.links.iter_mut().enumerate() {
            let sent = link
                .loan(header, count(rank))
                .and_then(|()| fill(rank, link))
                .and_then(|()| link.send());
            sent.map_err(|error| self.peer.failure(Some(rank), Some(window), error))?;
        }
        Ok(())
    }

    /// Waits until every rank has answered with a message of a kind; the links then hold it.
    pub fn wait(
        &mut self,
        supervisor: &Supervisor,
        window: &Window,
        kind: MessageKind,
    ) -> Result<(), PartError> {
        self.peer
            .wait(&mut self.links, supervisor, Some(window), kind, self.asked)?;
        self.asked = self.waited.so_far();
        Ok(())
    }

    /// The same outside windows, watching this solver only.
    fn wait_alone(&mut self, kind: MessageKind) -> Result<(), PartError> {
        let own = &self.peer.own;
        let asked = own.waited().so_far();
        self.peer.wait(&mut self.links, own, None, kind, asked)
    }

    /// Tells every rank to take the last attempt as the new start. True where it is answered: each link then holds a
    /// `Committed`.
    pub fn commit(&mut self) -> Result<bool, PartError> {
        self.send_text(MessageKind::Commit, "")?;
        let answers = self
            .hello
            .catalogue
            .of(ColumnSet::Committed)
            .next()
            .is_some();
        if answers {
            self.wait_alone(MessageKind::Committed)?;
        }
        Ok(answers)
    }

    /// Has a checkpoint written into a directory; afterwards each link holds a `Checkpointed`.
    pub fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        let absolute = std::path::absolute(directory).map_err(|error| {
            let message = format!("the folder {} cannot be used", directory.display());
            PartError::new(&self.peer.name, FailureKind::Io, message).caused_by(error)
        })?;
        self.send_text(MessageKind::Checkpoint, &absolute.to_string_lossy())?;
        self.wait_alone(MessageKind::Checkpointed)
    }

    /// Has particles taken out and put in, as told in a text; afterwards each link holds a `Changed`.
    pub fn change(&mut self, supervisor: &Supervisor, text: &str) -> Result<(), PartError> {
        self.send_text(MessageKind::Change, text)?;
        let links = &mut self.links;
        self.peer
            .wait(links, supervisor, None, MessageKind::Changed, self.asked)
    }

    /// Sets conditions of patches from the next window on, told in a text.
    pub fn set_boundary(&mut self, text: &str) -> Result<(), PartError> {
        self.send_text(MessageKind::Boundary, text)?;
        self.wait_alone(MessageKind::Boundary)
    }

    /// Ends the solver in an orderly way.
    pub fn goodbye(&mut self) -> Result<(), PartError> {
        self.send_text(MessageKind::Bye, "")?;
        match self.wait_alone(MessageKind::Bye) {
            // A solver may end before its answer is read, and the answer with it: its status tells.
            Err(death) if death.kind == FailureKind::Died => {}
            answered => answered?,
        }
        self.processes.wait(&self.peer.name, self.deadline)?;
        if let Some(network) = &self.network {
            network.goodbye();
        }
        if let Some(run) = &mut self.run {
            run.end();
        }
        Ok(())
    }

    fn send_text(&mut self, kind: MessageKind, text: &str) -> Result<(), PartError> {
        self.asked = self.waited.so_far();
        for (rank, link) in self.links.iter_mut().enumerate() {
            let sent = link.send_text(Header::of(kind), text);
            sent.map_err(|error| self.peer.failure(Some(rank), None, error))?;
        }
        Ok(())
    }
}
