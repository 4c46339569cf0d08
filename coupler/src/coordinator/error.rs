//! Why a run could not go on.

use std::io;
use std::path::PathBuf;

use calcine_physics::Vec3;
use calcine_physics::figures::Brief;
use thiserror::Error;

use crate::checkpoint::StateFileError;
use crate::closures::ClosureError;
use crate::error::PartError;
use crate::finite::NotFinite;
use crate::mapping::MappingError;
use crate::models::{ParticleModelError, RestoreError};
use crate::motion::LOST_REMEDY;
use crate::observer::ObserverError;
use crate::packing::PackingError;
use crate::physical::UnphysicalGas;
use crate::smoother::SmootherError;
use crate::time::{Ticks, TimeError};

/// A run that could not go on.
#[derive(Debug, Error)]
pub enum RunError {
    /// A part failed.
    #[error(transparent)]
    Part(#[from] PartError),
    /// Particles could not be mapped onto cells.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// A particle that left the mesh.
    #[error(
        "particle {id} of \"{population}\" left the gas mesh at ({}, {}, {}) m with a velocity of ({}, {}, {}) m/s, before window {window} \
         (from {start}); {LOST_REMEDY}",
        place.x, place.y, place.z, velocity.x, velocity.y, velocity.z
    )]
    Lost {
        /// Its id.
        id: u64,
        /// Name of its population.
        population: String,
        /// Its centre in m.
        place: Vec3,
        /// Its velocity in m/s of motion time.
        velocity: Vec3,
        /// Index of the window that cannot begin.
        window: u64,
        /// Start of that window, process time.
        start: Ticks,
    },
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
    /// A law that met gas that is none.
    #[error(
        "window {window}: the gas that the particles see is not physical: {found}; with it {cause}. Shorter windows help \
         (`time.motion_window`, or `time.process_step` of a frozen bed)"
    )]
    ClosureInGas {
        /// Index of the window.
        window: u64,
        /// What of the gas is none.
        found: UnphysicalGas,
        /// What the law said.
        cause: ClosureError,
    },
    /// A window whose gas is none, however often it is cut.
    #[error(
        "window {window} (from {start}): {found} after windows of {span}, cut {cuts} times: what particles take of the gas and what the \
         gas has do not agree. Shorter windows (`time.process_step`, `time.motion_window`) or more `coupling.exchange.attempts` help"
    )]
    Unphysical {
        /// Index of the window.
        window: u64,
        /// Process time at which it began.
        start: Ticks,
        /// Its length.
        span: Ticks,
        /// How often it was cut.
        cuts: u32,
        /// What of the gas is none.
        found: UnphysicalGas,
    },
    /// A failure while particles reacted, with the one whose rates moved most.
    #[error("{cause}\n  {reacting}")]
    Reacting {
        /// The failure.
        cause: Box<RunError>,
        /// The particle, its reaction, and what helps.
        reacting: String,
    },
    /// The inside of a particle that cannot be followed.
    #[error("window {window}: {cause}")]
    Interior {
        /// Index of the window.
        window: u64,
        /// Which particle, and why.
        cause: ParticleModelError,
    },
    /// Particles that their models do not take.
    #[error(transparent)]
    Models(#[from] ParticleModelError),
    /// State of particles that cannot be taken up.
    #[error(transparent)]
    Restore(#[from] RestoreError),
    /// A row that stands for several particles where heat passes between particles.
    #[error(
        "particle {id} stands for {weight} particles, but heat passes between particles by contacts or radiation, which \
         only rows of weight 1 have; write `none` for `laws.conduction` and `laws.radiation`, or weight = 1"
    )]
    WeightInNetwork {
        /// The particle's id.
        id: u64,
        /// Its statistical weight.
        weight: f64,
    },
    /// A statistical weight that means nothing.
    #[error("particle {id} stands for {weight} particles; a weight must be finite and above 0")]
    Weight {
        /// The particle's id.
        id: u64,
        /// Its statistical weight.
        weight: f64,
    },
    /// Drag that follows the particles, with a solver that does not take it.
    #[error(
        "{solver} takes no column `{column}`, by which drag follows the particles within a window; write \
         `coupling.window_drag` = \"constant\", or leave it out"
    )]
    NoFollowingDrag {
        /// The solver.
        solver: String,
        /// The column that it does not take.
        column: &'static str,
    },
    /// Drag that followed the particles, whose impulse is not reported.
    #[error(
        "{solver} does not report the impulse of drag on {count} particles: the column `drag_impulse`, three values each"
    )]
    NoDragImpulse {
        /// The solver.
        solver: String,
        /// Number of particles.
        count: usize,
    },
    /// A number that is not finite.
    #[error(transparent)]
    NotFinite(#[from] NotFinite),
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

/// A checkpoint that could not be written or taken up.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// A folder could not be made, renamed or removed.
    #[error("checkpoint {path}: {doing}: {cause}")]
    Io {
        /// The folder.
        path: PathBuf,
        /// What was tried.
        doing: &'static str,
        /// Why it failed.
        cause: io::Error,
    },
    /// No checkpoint is as it was written.
    #[error(
        "the checkpoint {what}, and no older one is whole; start again, or continue by `--from` from the results of \
         another run"
    )]
    Damaged {
        /// The folder of the last one.
        path: PathBuf,
        /// Which, and what is wrong with it.
        what: String,
    },
    /// The checkpoint is of another case.
    #[error(
        "the checkpoint in {path} is of another case (its hash is {found}, this case's {expected}); \
         `--from` continues from a changed case's results"
    )]
    OtherCase {
        /// The folder.
        path: PathBuf,
        /// Hash in the checkpoint.
        found: String,
        /// Hash of the case.
        expected: String,
    },
    /// Numbers of particles that differ.
    #[error("the checkpoint in {path} holds {found} particles, the run has {expected}")]
    Particles {
        /// The folder.
        path: PathBuf,
        /// Particles in the checkpoint.
        found: usize,
        /// Particles of the run.
        expected: usize,
    },
}

/// Results that this case cannot continue from.
#[derive(Debug, Error)]
pub enum OriginError {
    /// Another gas mesh.
    #[error(
        "the checkpoint {path} has another gas mesh ({found} cells, this case {expected}): a run \
         continues on the same mesh only; leave `mesh` as it was"
    )]
    Mesh {
        /// The checkpoint.
        path: PathBuf,
        /// Cells there.
        found: u64,
        /// Cells of this case.
        expected: u64,
    },
    /// Another number of particles.
    #[error(
        "the checkpoint {path} holds {found} particles, this case has {expected}: a run continues \
         with the same particles only; leave `particles` and their places as they were"
    )]
    Count {
        /// The checkpoint.
        path: PathBuf,
        /// Particles there.
        found: usize,
        /// Particles of this case.
        expected: usize,
    },
    /// A particle of another id, size or place.
    #[error(
        "in the checkpoint {path} particle {number} in the order of ids has the id {}, the radius \
         {} m and its centre at ({}, {}, {}) m; in this case {}, {} m and ({}, {}, {}) m: a run \
         continues with the same particles only",
        .found.0, .found.2, .found.1.x, .found.1.y, .found.1.z,
        .expected.0, .expected.2, .expected.1.x, .expected.1.y, .expected.1.z
    )]
    Particle {
        /// The checkpoint.
        path: PathBuf,
        /// Which one, from 1.
        number: usize,
        /// Id, centre and radius there.
        found: (u64, Vec3, f64),
        /// Id, centre and radius in this case.
        expected: (u64, Vec3, f64),
    },
    /// A particle of another statistical weight.
    #[error(
        "in the checkpoint {path} particle {id} stands for {found} particles, in this case for {expected}: a run \
         continues with the same particles only"
    )]
    Weight {
        /// The checkpoint.
        path: PathBuf,
        /// Which particle.
        id: u64,
        /// Its weight there.
        found: f64,
        /// Its weight in this case.
        expected: f64,
    },
    /// Other populations of a bed that moves.
    #[error(
        "the checkpoint {path} has particles of the populations [{found}], this case has [{expected}]: a bed that moves \
         continues with the same populations only, by name and in the same order"
    )]
    Populations {
        /// The checkpoint.
        path: PathBuf,
        /// Populations there.
        found: String,
        /// Populations of this case.
        expected: String,
    },
    /// Particles of other solids.
    #[error(
        "the particles of the checkpoint {path} are made of the solids [{found}], those of this case of [{expected}]: a run \
         continues with the same solids only; leave the `composition` of `materials`, and the solids of `reactions`, as they were"
    )]
    Solids {
        /// The checkpoint.
        path: PathBuf,
        /// Solids there.
        found: String,
        /// Solids of this case.
        expected: String,
    },
    /// Particles whose inside is described otherwise.
    #[error(
        "what is inside the particles of the checkpoint {path} is described otherwise in this case ({cause}): a run continues \
         with the same kinds of material for each population only; leave which `materials` have a `composition`, and which \
         particles have them, as they were"
    )]
    Inside {
        /// The checkpoint.
        path: PathBuf,
        /// What does not suit.
        cause: String,
    },
    /// Another gas mixture.
    #[error(
        "the gas of the checkpoint {path} has the species [{found}], this case has [{expected}]: a \
         run continues with the same `gas.species` only"
    )]
    Species {
        /// The checkpoint.
        path: PathBuf,
        /// Species there.
        found: String,
        /// Species of this case.
        expected: String,
    },
}

/// A feed or an outlet that cannot be set.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ControlError {
    /// There is none of this name.
    #[error("the run has no {what} `{name}`; it has {present}")]
    NotThere {
        /// `feed` or `outlet`.
        what: &'static str,
        /// The name that was given.
        name: String,
        /// Those that are there.
        present: String,
    },
    /// A value that means nothing.
    #[error("{what} `{name}`: {value} {unit}; it must be {rule}")]
    Value {
        /// `feed` or `outlet`.
        what: &'static str,
        /// Its name.
        name: String,
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// What is allowed.
        rule: &'static str,
    },
}

/// A particle of which reactions have left too little.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "particle {id} has come to a radius of {radius} m and {mass} kg by what reacted in it: a surface wave \
     crosses it in {time} s, and the time step of contacts is {step} s; write a shorter `motion.motion_step`, \
     or a larger `least_diameter` in the size of its material", radius = Brief(*.radius), mass = Brief(*.mass), time = Brief(*.time), step = Brief(*.step))]
pub struct TooLight {
    /// Its id.
    pub id: u64,
    /// Its radius in m.
    pub radius: f64,
    /// Its mass in kg.
    pub mass: f64,
    /// The step in s.
    pub step: f64,
    /// Rayleigh's time in s.
    pub time: f64,
}
