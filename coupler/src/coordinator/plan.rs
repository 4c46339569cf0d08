//! What a run is told beside its parts and laws.

use std::time::Duration;

use calcine_physics::Vec3;

use super::checkpoint_paths::CheckpointPaths;
use super::step_limit::ContactStepLimit;
use crate::feeds::FeedsAndOutlets;
use crate::hold::Holds;
use crate::mapping::Method;
use crate::motion::LostParticles;
use crate::paths::PathsSetup;
use crate::setup::{Convection, TimeScheme};
use crate::time::{Acceleration, GasStorage, Ticks};
use crate::window_control::WindowBounds;
use crate::window_drag::WindowDrag;

/// When windows, checkpoints and the run end, and how exactly a window is exchanged.
#[derive(Clone, Debug)]
pub struct Plan {
    /// End of the run, process time.
    pub end: Ticks,
    /// Length of a window, motion time; the longest where it follows the run.
    pub motion_window: Ticks,
    /// Bounds between which the length follows the run; `None`: it is always the same.
    pub window_bounds: Option<WindowBounds>,
    /// Time step of the particles that move in s of motion time: windows that follow the run are whole numbers of it.
    pub particle_step: Option<f64>,
    /// Process times at which boundary values begin to follow another line; windows that follow the run end there.
    pub breaks: Vec<Ticks>,
    /// Those of them at which the shortest window begins anew.
    pub jumps: Vec<Ticks>,
    /// How the case wants the gas stepped where its clocks are one.
    pub time_scheme: TimeScheme,
    /// How the case wants the gas carried to faces.
    pub convection: Convection,
    /// True where gas reacts with itself.
    pub gas_reacts: bool,
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
    /// Residual above which the gas' outer loop goes on.
    pub gas_tolerance: f64,
    /// Attempts per window at most.
    pub exchange_attempts: u32,
    /// How often a window whose exchange does not settle may be halved, where no particle moves.
    pub cuts: u32,
    /// False for a gas that cannot go back to the start of a window: then there is one attempt at each.
    pub repeats: bool,
    /// How drag acts on particles that move within a window.
    pub window_drag: WindowDrag,
    /// Hash of the case, compared on resume.
    pub case_hash: String,
    /// Where checkpoints go.
    pub checkpoint: CheckpointPaths,
    /// Names of the populations.
    pub populations: Vec<String>,
    /// True for each population that moves; empty where none does.
    pub free: Vec<bool>,
    /// When those that move are held.
    pub holds: Holds,
    /// What becomes of particles that leave the mesh.
    pub lost: LostParticles,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Feeds and outlets.
    pub feeds_and_outlets: FeedsAndOutlets,
    /// Material of each population, for the heat between particles.
    pub substance: Vec<usize>,
    /// Heat between particles and to walls.
    pub paths: PathsSetup,
    /// How light particles that move may become by what reacts in them; `None` where none moves.
    pub step_limit: Option<ContactStepLimit>,
}
