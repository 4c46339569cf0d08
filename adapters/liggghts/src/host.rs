//! The host's loop: hello, state, then windows, commits and checkpoints until the coordinator says
//! goodbye.

mod kept;
mod window;

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use calcine_wire::hello::NEW;
use calcine_wire::shared_memory::LinkEnd;
use calcine_wire::{
    CarriedTransport, Catalogue, Header, Hello, Link, LinkAddress, MessageKind, SharedMemory,
    Transport, TransportKind, WireError,
};

use crate::drag::{self, DRAG};
use crate::error::HostError;
use crate::library::{self, Liggghts, StepHook};
use crate::parent::ParentCarrier;
use crate::population_update::PopulationUpdate;
use crate::pushed_force::{self, EACH_STEP, PUSH};
use crate::rank_particles::{RankParticles, WEIGHT};

/// Ticks of the wire's clocks in one second.
const TICKS: f64 = 1e12;
/// How long the coordinator may take to answer the introduction.
const GREETING: Duration = Duration::from_secs(30);
/// Name of the restart file in a checkpoint's folder.
const RESTART: &str = "liggghts.restart";
/// How the lines of a script begin that make its groups by particles' types.
const GROUPS: &str = "group calcine_";
/// How the line of a script begins that makes the group of particles that are held.
const HELD: &str = "group calcine_held type ";
/// What a wall's line of the script has where its forces are to be counted; LIGGGHTS keeps them by particle
/// in a fix named after the wall's.
const COUNTED: (&str, &str) = (" store_force yes", "force_");
/// What makes a line of the script a wall's.
const WALL: &str = " wall/gran ";
/// What is sent where walls' impulses are not counted.
const UNCOUNTED: [f64; 3] = [f64::NAN; 3];
/// The file of ids and statistical weights, in the script's folder.
const WEIGHTS: &str = "particles.weight";
/// LIGGGHTS' own log, in the script's folder; it ends where the windows begin.
const LOG: &str = "log.liggghts";

/// What the host was started with.
#[derive(Debug)]
pub struct HostStart {
    /// The script; it ends with the setup, without a `run`.
    pub script: PathBuf,
    /// Hash of the case that the script was written for.
    pub case_hash: String,
    /// Restart file instead of the script's `read_data`.
    pub restart: Option<PathBuf>,
}

/// A running LIGGGHTS and what it must keep.
pub struct Host {
    liggghts: Liggghts,
    start: HostStart,
    state: RankParticles,
    particles: u64,
    rank: u32,
    told: Instant,
    /// Fixes that hold the force of each wall on particles; empty where they are not counted.
    walls: Vec<String>,
    /// True where rows have statistical weights.
    weights: bool,
    /// True where drag may be pushed by coefficient and gas velocity.
    moving_drag: bool,
    /// True where the whole bed is held.
    frozen: bool,
    /// Populations that are held in a bed that moves.
    held: Vec<u64>,
    /// Has the pushed forces act; nothing where the whole bed is held.
    acting: Option<StepHook>,
}

impl Host {
    /// Starts MPI, opens the link, runs the script, shakes hands and sends the first state.
    pub fn begin(start: HostStart) -> Result<Self, HostError> {
        let (rank, ranks) = library::start_mpi();
        let address = LinkAddress::from_environment()?;
        let transport: Box<dyn Transport + Send> = match address.means {
            TransportKind::SharedMemory => {
                Box::new(SharedMemory::open(&address, rank, LinkEnd::Solver)?)
            }
            TransportKind::Mpi { .. } => Box::new(CarriedTransport::of_solver(
                ParentCarrier::find()?,
                &address,
            )?),
        };
        library::keep_link(Link::new(transport, address.number(), rank));
        let mut host = Self {
            liggghts: Liggghts::open(LOG),
            start,
            state: RankParticles::default(),
            particles: 0,
            rank,
            told: Instant::now(),
            walls: Vec::new(),
            weights: false,
            moving_drag: false,
            frozen: false,
            held: Vec::new(),
            acting: None,
        };
        let restart = host.start.restart.clone();
        host.set_up(restart.as_deref())?;
        host.particles = host.liggghts.particles().unwrap_or_default();
        // The sum over the ranks comes first: the first rank has then closed the log that says the version.
        let mesh_hash = host.state.hash();
        let hello = Hello {
            role: "particles".into(),
            name: "LIGGGHTS".into(),
            version: version(),
            case_hash: host.start.case_hash.clone(),
            mesh_hash,
            origin: host.start.restart.as_ref().map_or_else(
                || NEW.to_owned(),
                |file| file.to_string_lossy().into_owned(),
            ),
            count: host.particles,
            ranks,
            catalogue: Catalogue::particles_with(host.weights, host.moving_drag),
        };
        host.tell(&format!("{} with {} particles", hello.version, hello.count));
        on_link(|link| link.greet(&hello, GREETING).map(|_| ()))?;
        host.answer(Header::of(MessageKind::State))?;
        Ok(host)
    }

    /// Answers requests until the coordinator says goodbye.
    pub fn serve(mut self) -> Result<(), HostError> {
        loop {
            let Some(header) = on_link(|link| link.receive(Duration::from_secs(1)))? else {
                continue;
            };
            match header.kind() {
                Some(MessageKind::Start) => self.window(header)?,
                // Particles have one attempt a window: what is finished is already the start.
                Some(MessageKind::Commit) => {}
                Some(MessageKind::Checkpoint) => {
                    let directory = on_link(|link| link.text().map(PathBuf::from))?;
                    self.checkpoint(&directory)?;
                    self.answer(header.answer(MessageKind::Checkpointed))?;
                }
                Some(MessageKind::Change) => {
                    let text = on_link(|link| link.text().map(str::to_owned))?;
                    self.change(&text)?;
                    self.answer(header.answer(MessageKind::Changed))?;
                }
                Some(MessageKind::Bye) => {
                    self.tell("goodbye");
                    on_link(|link| link.send_plain(header.answer(MessageKind::Bye)))?;
                    return Ok(());
                }
                _ => {
                    let unexpected = WireError::Unexpected {
                        found: header.kind,
                        expected: "a request",
                    };
                    return Err(unexpected.into());
                }
            }
        }
    }

    /// Takes particles out and puts new ones in, then sets everything up for them.
    fn change(&mut self, text: &str) -> Result<(), HostError> {
        let change = PopulationUpdate::parse(text)?;
        self.particles = change.apply(&mut self.liggghts, &self.state, self.particles)?;
        // A group holds what was there when it was made: it is told again, and takes up who came.
        for line in self.script()?.lines() {
            if line.starts_with(GROUPS) {
                self.liggghts.command(line);
            }
        }
        self.liggghts.command("run 0 post no");
        drag::forget(&mut self.liggghts);
        self.look()
    }

    /// Writes a checkpoint and goes on from what it wrote.
    fn checkpoint(&mut self, directory: &Path) -> Result<(), HostError> {
        self.keep_forces()?;
        // LIGGGHTS splits its commands at blanks: it writes here, then the file is copied.
        self.liggghts.command(&format!("write_restart {RESTART}"));
        let copy = directory.join(RESTART);
        if self.rank == 0 {
            let failed = |cause| HostError::File {
                path: copy.clone(),
                cause,
            };
            fs::copy(RESTART, &copy).map_err(failed)?;
            File::open(&copy)
                .and_then(|file| file.sync_all())
                .map_err(failed)?;
        }
        self.liggghts.command("clear");
        self.set_up(Some(Path::new(RESTART)))?;
        self.tell(&format!("checkpoint in {}", directory.display()));
        Ok(())
    }

    /// Runs the script, with a restart file in place of its data file, and LIGGGHTS' own setup.
    fn set_up(&mut self, restart: Option<&Path>) -> Result<(), HostError> {
        if let Some(file) = restart
            && file != Path::new(RESTART)
            && self.rank == 0
        {
            fs::copy(file, RESTART).map_err(|cause| HostError::File {
                path: file.into(),
                cause,
            })?;
        }
        self.walls.clear();
        let mut uncounted = false;
        for line in self.script()?.lines() {
            let id = line.split_ascii_whitespace().nth(1);
            match (line.contains(WALL), line.contains(COUNTED.0), id) {
                (true, true, Some(id)) => self.walls.push(format!("{}{id}", COUNTED.1)),
                (true, _, _) => uncounted = true,
                (false, _, _) => {}
            }
            let reads = line.split_ascii_whitespace().next() == Some("read_data");
            if reads && restart.is_some() {
                self.liggghts.command(&format!("read_restart {RESTART}"));
            } else {
                self.liggghts.command(line);
            }
        }
        if uncounted {
            self.walls.clear(); // of a script of the user's: a part of the walls is no balance
        }
        if restart.is_some() {
            self.make_kept();
        }
        self.moving_drag = self.has_fix(DRAG)?;
        self.frozen = !self.has_fix(PUSH)?;
        self.held = held(&self.script()?);
        if !self.frozen && self.acting.is_none() {
            self.acting = Some(pushed_force::act(&mut self.liggghts, &self.held));
        }
        self.liggghts.command("run 0");
        let acts = self.has_fix(EACH_STEP)? && pushed_force::acts();
        if !self.frozen && !acts {
            return Err(HostError::NoPush { name: EACH_STEP });
        }
        drag::forget(&mut self.liggghts);
        if restart.is_some() {
            self.take_kept()?;
        }
        self.weights = self.has_fix(WEIGHT)?;
        if self.weights && restart.is_none() {
            self.weigh()?;
        }
        // Each window would add its lines to the log.
        self.liggghts.command("log none");
        self.look()
    }

    /// True where the script makes a fix of this name.
    fn has_fix(&self, name: &str) -> Result<bool, HostError> {
        let begins = ["fix", name];
        let script = self.script()?;
        Ok(script
            .lines()
            .any(|line| line.split_ascii_whitespace().take(2).eq(begins)))
    }

    /// Gives this rank's particles the weights of the file beside the script, by their ids.
    fn weigh(&mut self) -> Result<(), HostError> {
        let text = fs::read_to_string(WEIGHTS).map_err(|cause| HostError::File {
            path: WEIGHTS.into(),
            cause,
        })?;
        let mut by_id = HashMap::new();
        for line in text.lines() {
            let refuse = || HostError::Change { line: line.into() };
            let (id, weight) = line.split_once(' ').ok_or_else(refuse)?;
            let id: i32 = id.parse().map_err(|_| refuse())?;
            let weight: f64 = weight.parse().map_err(|_| refuse())?;
            by_id.insert(id, weight);
        }
        let missing = |name| HostError::Missing { name };
        let tags = self.liggghts.integers("id").ok_or_else(|| missing("id"))?;
        let own: Vec<f64> = tags
            .iter()
            .map(|id| by_id.get(id).copied().unwrap_or(1.0))
            .collect();
        let kept = self.liggghts.fix_scalars_mut(WEIGHT);
        kept.ok_or_else(|| missing(WEIGHT))?.copy_from_slice(&own);
        Ok(())
    }

    fn script(&self) -> Result<String, HostError> {
        let path = &self.start.script;
        fs::read_to_string(path).map_err(|cause| HostError::File {
            path: path.clone(),
            cause,
        })
    }

    /// Reads the particles; none may be lost.
    fn look(&mut self) -> Result<(), HostError> {
        let found = self.liggghts.particles().unwrap_or_default();
        if self.particles != 0 && found != self.particles {
            return Err(HostError::Lost {
                found,
                expected: self.particles,
                which: self.first_lost()?,
            });
        }
        self.state = RankParticles::read(&self.liggghts, self.weights)?;
        Ok(())
    }

    /// The particle of the lowest id that no rank has any longer, in words; all ranks must call it.
    fn first_lost(&self) -> Result<String, HostError> {
        let now = RankParticles::read(&self.liggghts, self.weights)?;
        let own = self.state.id.iter().chain(&now.id).copied().max();
        let largest = library::largest_over_ranks(own.unwrap_or_default());
        let mut held = vec![0u64; largest as usize + 1];
        for id in &self.state.id {
            held[*id as usize] += 1;
        }
        for id in &now.id {
            held[*id as usize] = held[*id as usize].wrapping_sub(1);
        }
        library::add_over_ranks(&mut held);
        let Some(id) = held.iter().position(|count| *count == 1) else {
            return Ok(String::new());
        };
        // The rank that had it knows where; the others add nothing to the bits.
        let row = self.state.id.binary_search(&(id as u64)).ok();
        let state = &self.state.position;
        let place = |axis: usize| row.map_or(0, |row| f64::to_bits(state[3 * row + axis]));
        let mut at = [0, 1, 2].map(place);
        library::add_over_ranks(&mut at);
        let at = at.map(f64::from_bits);
        Ok(format!(
            "; particle {id} was last seen at ({:.6}, {:.6}, {:.6}) m",
            at[0], at[1], at[2]
        ))
    }

    /// Sends the state between windows, with impulses of zero.
    fn answer(&self, header: Header) -> Result<(), HostError> {
        let none = vec![0.0; 3 * self.state.id.len()];
        self.reply(header, [&none, &none], [0.0; 4])
    }

    fn reply(
        &self,
        header: Header,
        [impulse, drag]: [&[f64]; 2],
        support: [f64; 4],
    ) -> Result<(), HostError> {
        let drag = self.moving_drag.then_some(drag);
        on_link(|link| self.state.send(link, header, (impulse, drag), support))
    }

    /// A line for the log that the coordinator shows when something goes wrong.
    fn tell(&mut self, line: &str) {
        self.told = Instant::now();
        let line = format!("calcine-liggghts, rank {}: {line}\n", self.rank);
        // In one piece, or the ranks' lines would mix; a log that is full ends no run.
        let _ = io::stderr().write_all(line.as_bytes());
    }
}

/// Populations whose particles the script holds: LIGGGHTS' types, counted from 1, of the group of these.
fn held(script: &str) -> Vec<u64> {
    let lines = script.lines().filter_map(|line| line.strip_prefix(HELD));
    let types = lines.flat_map(str::split_ascii_whitespace);
    let types = types.filter_map(|word| word.parse::<u64>().ok());
    types.map(|kind| kind.saturating_sub(1)).collect()
}

fn on_link<T>(work: impl FnOnce(&mut Link) -> Result<T, WireError>) -> Result<T, HostError> {
    let outcome = library::with_link(work).ok_or(HostError::Usage)?;
    Ok(outcome?)
}

/// LIGGGHTS' version as its log begins: "LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0, compiled …".
fn version() -> String {
    let text = fs::read_to_string(LOG).unwrap_or_default();
    let after = text.split_once("(Version ").map_or("", |(_, after)| after);
    let name = after.split([',', ')']).next().unwrap_or_default();
    if name.is_empty() {
        "LIGGGHTS".into()
    } else {
        name.to_owned()
    }
}
