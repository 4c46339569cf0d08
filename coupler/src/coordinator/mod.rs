//! The loop: windows, attempts, commits, checkpoints.

mod checkpoint;
mod controls;
mod feeds;
mod hold;
mod momentum;
mod origin;
mod react;
mod resize;
mod span;
mod window;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use calcine_interior::ParticleModel;
use calcine_interior::reacting::ReactError;
use calcine_physics::Vec3;
use calcine_physics::thermo::Element;
use thiserror::Error;

pub use checkpoint::{CheckpointError, CheckpointPaths};
pub use controls::{Control, ControlError};
pub use origin::{Origin, OriginError};
pub use resize::{ContactStepLimit, LONGEST_STEP, TooLight};

use crate::checkpoint::StateFileError;
use crate::closures::{ClosureError, Closures, CouplingCoefficients, SampledGas};
use crate::error::PartError;
use crate::exchange::{Exchange, ExchangeConvergence};
use crate::feeds::FeedsAndOutlets;
use crate::hold::Holds;
use crate::ledger::{BalanceLine, Ledger};
use crate::mapping::{Mapper, MappingError, Method};
use crate::mesh::Mesh;
use crate::observer::{CommittedState, Observer, ObserverError, ParticleGasExchange, Timing};
use crate::packing::PackingError;
use crate::part::{Bed, CellReceived, Convergence, Gas, ParticlePush, ParticleReceived, Particles};
use crate::paths::{Paths, PathsSetup};
use crate::smoother::{Operator, Smoother, SmootherError};
use crate::species_coupling::SpeciesCoupling;
use crate::supervisor::Supervisor;
use crate::time::{Acceleration, Clocks, GasStorage, Ticks, TimeError};

/// When windows, checkpoints and the run end, and how exactly a window is exchanged.
#[derive(Clone, Debug)]
pub struct Plan {
    /// End of the run, process time.
    pub end: Ticks,
    /// Length of a window, motion time.
    pub motion_window: Ticks,
    /// Acceleration factor over process time.
    pub acceleration: Acceleration,
    /// Over which clock the gas stores.
    pub storage: GasStorage,
    /// A checkpoint each so much process time.
    pub checkpoint_every: Option<Ticks>,
    /// A checkpoint each so much wall time.
    pub checkpoint_wall: Option<Duration>,
    /// Base mapping.
    pub mapping: Method,
    /// A window is repeated while more than this share of the exchange is misplaced.
    pub exchange_tolerance: f64,
    /// Attempts per window at most.
    pub exchange_attempts: u32,
    /// False for a gas that cannot go back to the start of a window: then there is one attempt at each.
    pub repeats: bool,
    /// Hash of the case, compared on resume.
    pub case_hash: String,
    /// Where checkpoints go.
    pub checkpoint: CheckpointPaths,
    /// True for each population that moves; empty where none does.
    pub free: Vec<bool>,
    /// When those that move are held.
    pub holds: Holds,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Feeds and outlets.
    pub feeds_and_outlets: FeedsAndOutlets,
    /// Material of each population, for what feeds bring in.
    pub substance: Vec<usize>,
    /// Heat between particles and to walls.
    pub paths: PathsSetup,
    /// How light particles that move may become by what reacts in them; `None` where none moves.
    pub step_limit: Option<ContactStepLimit>,
}

/// How a run ended without an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// At the end of process time.
    Finished,
    /// On the user's interrupt, with a checkpoint in this folder.
    Checkpointed(PathBuf),
}

/// A run that could not go on.
#[derive(Debug, Error)]
pub enum RunError {
    /// A part failed.
    #[error(transparent)]
    Part(#[from] PartError),
    /// Particles could not be mapped onto cells.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The bed does not fit the mesh.
    #[error(transparent)]
    Smoother(#[from] SmootherError),
    /// A law met a state that it is not defined for.
    #[error("window {window}: {cause}")]
    Closure {
        /// Index of the window.
        window: u64,
        /// What the law said.
        cause: ClosureError,
    },
    /// Reactions that cannot be followed.
    #[error("window {window}: {cause}")]
    React {
        /// Index of the window.
        window: u64,
        /// Which particle, and why.
        cause: ReactError,
    },
    /// A particle too light for the solver's time step.
    #[error(transparent)]
    TooLight(#[from] TooLight),
    /// Something that cannot be set.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A feed whose particles cannot be drawn.
    #[error("feeds: {0}")]
    Feed(#[from] PackingError),
    /// The clock ended.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// An observer failed, for example because a disk is full.
    #[error(transparent)]
    Observer(#[from] ObserverError),
    /// A checkpoint could not be written or read.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// Another run's results that this case cannot continue from.
    #[error(transparent)]
    Origin(#[from] OriginError),
    /// A state file could not be written or read.
    #[error(transparent)]
    StateFile(#[from] StateFileError),
}

/// The parts that a run is made of.
pub struct RunParts {
    /// The gas.
    pub gas: Box<dyn Gas>,
    /// The particles.
    pub particles: Box<dyn Particles>,
    /// What is inside the particles.
    pub interior: Box<dyn ParticleModel>,
}

/// Bed and operator, valid for the positions they were made from.
struct Mapped {
    operator: Operator,
    bed: Bed,
    position: Vec<Vec3>,
    radius: Vec<f64>,
    solid_volume: Vec<f64>,
}

/// Memory of one window, reused.
#[derive(Default)]
struct Workspace {
    sampled_gas: SampledGas,
    coefficients: CouplingCoefficients,
    exchange: Exchange,
    species_coupling: SpeciesCoupling,
    /// Pressure in Pa that each particle sees, where some react.
    pressure: Vec<f64>,
    /// Masses in kg and mass fractions of solids, for observers.
    particle_mass: Vec<f64>,
    solid_fractions: Vec<f64>,
    received: CellReceived,
    particle_received: ParticleReceived,
    push: ParticlePush,
    pressure_force: Vec<Vec3>,
    /// Velocities in m/s at the start of the window.
    velocity: Vec<Vec3>,
    /// All but drag that acted on each particle in the last window, in N.
    other: Vec<Vec3>,
    free: Vec<bool>,
    /// As many as `free`, and none of them free.
    still: Vec<bool>,
    /// Heat of the last window from walls and surroundings into the particles in W.
    reservoir_heat: Vec<f64>,
}

/// A run: the parts, the laws, the state of the loop.
pub struct CoupledRun {
    plan: Plan,
    mesh: Arc<Mesh>,
    mapper: Mapper<Arc<Mesh>>,
    smoother: Smoother,
    closures: Closures,
    parts: RunParts,
    mapped: Mapped,
    clocks: Clocks,
    /// Motion time for which the bed has been held so far.
    held: Ticks,
    windows: u64,
    ledger: Ledger,
    timing: Timing,
    convergence: Convergence,
    exchange_convergence: ExchangeConvergence,
    work: Workspace,
    paths: Paths,
    /// What was set while the run goes on, each condition once.
    controls: Vec<Control>,
    /// The window committed last, and when the last checkpoint was written.
    last: Option<crate::time::Window>,
    last_checkpoint: Instant,
}

impl CoupledRun {
    /// Maps the bed for the first time; the clocks stand at zero.
    pub fn new(
        plan: Plan,
        mesh: Arc<Mesh>,
        smoother: Smoother,
        closures: Closures,
        parts: RunParts,
    ) -> Result<Self, RunError> {
        let mapper = Mapper::new(Arc::clone(&mesh));
        let elements = elements(&closures, &*parts.interior).into_iter();
        let mut timing = Timing::default();
        let particles = &*parts.particles;
        let mapped = window::map(&mapper, plan.mapping, &smoother, particles, &mut timing)?;
        let mut work = Workspace::default();
        work.exchange
            .heat
            .resize(parts.particles.fields().len(), 0.0);
        work.begin(&parts.particles.fields(), &plan.free, plan.gravity);
        let pores = &mut work.sampled_gas.void_fraction;
        pores.resize(mapped.operator.particles(), 1.0);
        mapped.operator.sample(&mapped.bed.void_fraction, pores);
        let paths = Paths::new(plan.paths.clone());
        let mut run = Self {
            paths,
            plan,
            mesh,
            mapper,
            smoother,
            closures,
            parts,
            mapped,
            clocks: Clocks::default(),
            held: Ticks::ZERO,
            windows: 0,
            ledger: Ledger {
                elements: elements
                    .map(|name| (name, BalanceLine::default()))
                    .collect(),
                ..Ledger::default()
            },
            timing,
            convergence: Convergence::default(),
            exchange_convergence: ExchangeConvergence {
                settled: true,
                ..ExchangeConvergence::default()
            },
            work,
            controls: Vec::new(),
            last: None,
            last_checkpoint: Instant::now(),
        };
        run.find_contacts();
        run.weigh();
        Ok(run)
    }

    /// Runs to the end, to an interrupt's checkpoint, or to an error.
    pub fn run(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Ending, RunError> {
        self.begin(observers)?;
        loop {
            if let Some(ending) = self.step(supervisor, observers)? {
                return Ok(ending);
            }
        }
    }

    /// Shows the observers where the run stands, before the first step of this process.
    pub fn begin(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), RunError> {
        for observer in observers.iter_mut() {
            observer.start(&self.state())?;
        }
        self.last_checkpoint = Instant::now();
        Ok(())
    }

    /// One window, with the output and the checkpoint that are due after it; `None` as long as the run goes on.
    ///
    /// A finished run leaves a last checkpoint without the observers' part: another case may
    /// continue from it, but there is nothing left to resume.
    pub fn step(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Option<Ending>, RunError> {
        if self.clocks.process >= self.plan.end {
            return self.finish(supervisor, observers).map(Some);
        }
        let window = self.next_window()?;
        self.bring_to_rest(supervisor, &window)?;
        self.feed_and_discharge(supervisor, &window)?;
        self.advance(supervisor, &window)?;
        self.resize(supervisor)?;
        self.last = Some(window);

        let output = Instant::now();
        for observer in observers.iter_mut() {
            observer.window(&self.moment(Some(&window)))?;
        }
        self.timing.output += output.elapsed();

        if self.clocks.process >= self.plan.end {
            return self.finish(supervisor, observers).map(Some);
        }
        if supervisor.interrupts().count() > 0 {
            return self.stop(supervisor, observers).map(Some);
        }
        if self.checkpoint_due(window.start.process, self.last_checkpoint.elapsed()) {
            self.checkpoint(observers)?;
        }
        Ok(None)
    }

    /// Ends the run where it stands, with a checkpoint from which it can go on.
    pub fn stop(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Ending, RunError> {
        self.checkpoint(observers)?;
        self.finish_parts(supervisor)?;
        Ok(Ending::Checkpointed(self.plan.checkpoint.committed()))
    }

    /// Ends the run at the end of process time.
    fn finish(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Ending, RunError> {
        self.note_processors();
        let last = self.last;
        for observer in observers.iter_mut() {
            observer.finish(&self.moment(last.as_ref()))?;
        }
        self.checkpoint(&mut [])?;
        self.finish_parts(supervisor)?;
        Ok(Ending::Finished)
    }

    /// The committed state: clocks, fields, particles, ledger.
    pub fn state(&self) -> CommittedState<'_> {
        self.moment(None)
    }

    fn finish_parts(&mut self, supervisor: &Supervisor) -> Result<(), PartError> {
        let gas = self.parts.gas.finish_run(supervisor);
        let particles = self.parts.particles.finish_run(supervisor);
        gas.and(particles)
    }

    /// What the solvers' own processes have used so far.
    fn note_processors(&mut self) {
        self.timing.gas_processes = self.parts.gas.processor_time();
        self.timing.particles_processes = self.parts.particles.processor_time();
    }

    /// True where a multiple of `checkpoint_every` lies in (start, now], or wall time is up.
    fn checkpoint_due(&self, start: Ticks, since_last: Duration) -> bool {
        let crossed = self.plan.checkpoint_every.is_some_and(|every| {
            every.count() > 0
                && start.count() / every.count() < self.clocks.process.count() / every.count()
        });
        crossed
            || self
                .plan
                .checkpoint_wall
                .is_some_and(|wall| since_last >= wall)
    }

    fn moment<'a>(&'a self, window: Option<&'a crate::time::Window>) -> CommittedState<'a> {
        CommittedState {
            windows: self.windows,
            clocks: self.clocks,
            window,
            mesh: &self.mesh,
            gas: self.parts.gas.fields(),
            bed: &self.mapped.bed,
            particles: self.parts.particles.fields(),
            particle_temperature: self.parts.interior.temperature(),
            particle_heat: &self.work.exchange.heat,
            particle_mass: &self.work.particle_mass,
            solid_fractions: &self.work.solid_fractions,
            particle_gas: ParticleGasExchange {
                force: &self.work.push.force,
                void_fraction: &self.work.sampled_gas.void_fraction,
                slip: &self.work.coefficients.slip,
            },
            reservoirs: self.paths.names(),
            reservoir_heat: &self.work.reservoir_heat,
            ledger: &self.ledger,
            convergence: &self.convergence,
            exchange_convergence: &self.exchange_convergence,
            timing: &self.timing,
            about: [self.parts.gas.about(), self.parts.particles.about()],
        }
    }

    /// Wall times so far.
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// The ledger so far.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }
}

/// Symbols of the elements of gas and particles.
fn elements(closures: &Closures, interior: &dyn ParticleModel) -> Vec<String> {
    let mut names: Vec<String> = closures
        .gas
        .elements()
        .into_iter()
        .map(|one| one.0)
        .collect();
    if let Some(reacting) = interior.reactions() {
        let solids = &reacting.chemistry().solids;
        for element in Element::ALL {
            let held = solids.iter().any(|one| one.atoms()[element as usize] > 0.0);
            if held && !names.iter().any(|name| name == element.symbol()) {
                names.push(element.symbol().to_owned());
            }
        }
    }
    names
}
