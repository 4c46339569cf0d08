//! A checked case: plain SI values, nothing left to parse.

mod agreement;
mod laws;
mod material;
mod mesh;
mod particles;
mod quantity;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::bodies::HeatBody;
use calcine_coupler::feeds::Outlet;
use calcine_coupler::hold::Holds;
use calcine_coupler::interior::reacting::{Reaction, SizeChange};
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::motion::{ContactLaw, LostParticles, Wall};
use calcine_coupler::parcels::{ParcelCollisions, ParcelFriction, ParcelPacking};
pub use calcine_coupler::paths::SURROUNDINGS;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::setup::{GasSetup, Schedule};
use calcine_coupler::time::{Acceleration, GasStorage, Ticks};
use calcine_coupler::window_control::WindowBounds;
use calcine_coupler::window_drag::WindowDrag;

pub use agreement::{AgreementSpec, FieldBand};
pub use laws::{ConductionArea, ConductionSpec, Laws, RadiationSpec};
pub use material::{Inside, MaterialSpec, RadialSpec, SizeLaw};
pub use mesh::MeshSpec;
pub use particles::{
    FeedSpec, MotionSpec, PackingSection, PackingSpace, PlacementSpec, Population, RandomAmount,
};
pub use quantity::{
    Discharged, Expect, ForcePart, GasPlace, Measure, ParticlePlace, Passing, Probe, Quantity,
    Statistic, ToleranceBand,
};

/// A checked case.
#[derive(Clone, Debug)]
pub struct Case {
    /// File stem, for example `heated-column`.
    pub name: String,
    /// Title for people.
    pub title: String,
    /// The case file.
    pub path: PathBuf,
    /// SHA-256 (hex) of the case's effective TOML, `--set` applied.
    pub hash: String,
    /// Effective TOML text, `--set` applied, as written next to the results.
    pub effective: String,
    /// SHA-256 (hex) of what is in each file that the case reads, by the key that names it.
    pub files: BTreeMap<String, String>,
    /// The line in the file, from 1, of each line of the effective text; empty where they are the same.
    pub lines: Vec<usize>,
    /// What `--set` changed: key, new and old value.
    pub changes: Vec<String>,
    /// What of the case is likely not meant, or out of range before anything runs, in words; empty until mesh and particles
    /// are made (`ValidCase`).
    pub warnings: Vec<String>,
    /// Clocks.
    pub time: TimeSpec,
    /// The gas mesh.
    pub mesh: MeshSpec,
    /// Materials, in the order of the file.
    pub materials: Vec<MaterialSpec>,
    /// Solids that materials are made of, and what reacts.
    pub chemistry: ReactionSpec,
    /// Contact properties of pairs of materials.
    pub contacts: Vec<ContactSpec>,
    /// Walls that particles touch.
    pub walls: Vec<Wall>,
    /// Temperature in K of each wall that particles exchange heat with; `None`: adiabatic.
    pub wall_temperatures: Vec<Option<Schedule>>,
    /// The body that each wall is of, by its place; such a wall has the temperature of its body at the start.
    pub wall_bodies: Vec<Option<usize>>,
    /// Bodies that store heat, in the order of the file.
    pub bodies: Vec<HeatBody>,
    /// Material of each.
    pub body_materials: Vec<usize>,
    /// What of the files of walls is left out, in words.
    pub left_out_of_walls: Vec<String>,
    /// How particles that are free move.
    pub motion: Option<FreeMotion>,
    /// The gas.
    pub gas: GasSetup,
    /// True where the gas is held as it is at the start.
    pub gas_held: bool,
    /// True where the case says what gravity is.
    pub gravity_is_stated: bool,
    /// Files of the gas' reactions.
    pub gas_files: Vec<PathBuf>,
    /// Populations, in the order of the file.
    pub particles: Vec<Population>,
    /// What comes in.
    pub feeds: Vec<FeedSpec>,
    /// What goes out.
    pub outlets: Vec<Outlet>,
    /// Laws between and inside the phases.
    pub laws: Laws,
    /// How gas and particles are coupled.
    pub coupling: Coupling,
    /// What only an OpenFOAM gas needs.
    pub openfoam: ExternalSpec,
    /// What only LIGGGHTS particles need.
    pub liggghts: ExternalSpec,
    /// The gas solver of the user's own, where the case names one.
    pub external_gas: Option<ExternalProgram>,
    /// Particles of the user's own, for `--particles external`.
    pub external_particles: Option<ExternalProgram>,
    /// What is written.
    pub output: Output,
    /// Points at which fields are sampled.
    pub probes: Vec<Probe>,
    /// Quantities of interest with their bands.
    pub quantities: Vec<Quantity>,
    /// What `compare` judges beside them.
    pub agreement: AgreementSpec,
}

/// Clocks and checkpoints.
#[derive(Clone, Debug)]
pub struct TimeSpec {
    /// End of the run, process time.
    pub end: Ticks,
    /// Length of a coupling window in process time, from a process time on, where the case states that instead of the
    /// next two; they then follow from the mesh (`case::settle`).
    pub process_step: Option<Vec<(Ticks, Ticks)>>,
    /// Length of a coupling window, motion time; the longest, where it follows the gas.
    pub motion_window: Ticks,
    /// Between which bounds it follows the gas; `None`: all windows are of one length.
    pub window_bounds: Option<WindowBounds>,
    /// Acceleration factor over process time.
    pub acceleration: Acceleration,
    /// Over which clock the gas stores.
    pub storage: GasStorage,
    /// A checkpoint each so much process time; `None`: only on interrupt.
    pub checkpoint_every: Option<Ticks>,
    /// A checkpoint each so much wall time.
    pub checkpoint_wall: Option<Duration>,
}

/// Solids and reactions of particles; empty where nothing reacts.
#[derive(Clone, Debug, Default)]
pub struct ReactionSpec {
    /// Solids.
    pub solids: Vec<SolidSpecies>,
    /// Reactions.
    pub reactions: Vec<Reaction>,
    /// Mass fractions of the solids in each material.
    pub compositions: Vec<Vec<f64>>,
    /// True density in kg/m³ of the solids in each material; infinite where it is not said.
    pub true_densities: Vec<Vec<f64>>,
    /// How particles of each material take up room.
    pub sizes: Vec<SizeChange>,
}

impl ReactionSpec {
    /// True where some reaction exchanges gas.
    pub fn exchanges(&self) -> bool {
        self.reactions.iter().any(|one| !one.gases.is_empty())
    }
}

/// Contact properties of a pair of materials.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSpec {
    /// Indices into `Case::materials`.
    pub between: [usize; 2],
    /// Coefficient of restitution.
    pub restitution: Option<f64>,
    /// Coefficient of friction.
    pub friction: Option<f64>,
    /// Coefficient of rolling friction.
    pub rolling_friction: Option<f64>,
    /// Damping of rolling as a share of the critical one.
    pub rolling_damping: Option<f64>,
    /// Cohesion energy density in J/m³.
    pub cohesion_energy: Option<f64>,
    /// Work of adhesion in J/m².
    pub work_of_adhesion: Option<f64>,
}

/// `[motion]`: how particles that are free move.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMotion {
    /// Which clock the motion belongs to.
    pub kind: MotionKind,
    /// Time step in s of motion time; `None`: chosen from the contacts.
    pub step: Option<f64>,
    /// True where a step that is too long for the contacts is warned of, not refused.
    pub long_step: bool,
    /// Law of contacts; of parcels, which have none, it is never used.
    pub law: ContactLaw,
    /// How parcels move; `None` where particles move one by one.
    pub parcels: Option<ParcelSpec>,
    /// When the bed is held.
    pub held: Holds,
    /// What becomes of particles that leave the gas mesh.
    pub lost: LostParticles,
}

/// `[motion.parcels]`: how parcels move.
#[derive(Clone, Debug, PartialEq)]
pub struct ParcelSpec {
    /// Courant number of a parcel at most.
    pub courant: f64,
    /// Steps of a window at most.
    pub most_steps: u32,
    /// Solid fraction of the closest packing.
    pub close_packing: f64,
    /// How the stress of the solid acts.
    pub packing: ParcelPacking,
    /// Damping and isotropy.
    pub collisions: ParcelCollisions,
    /// Friction under the stress.
    pub friction: Option<ParcelFriction>,
    /// Rate in 1/s of the resistance against a wall, and its name.
    pub resistance: Option<(f64, String)>,
}

/// Which clock the motion of particles belongs to (docs/theory.md, TSM-7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// Fluidised beds, drums, sprays: the motion is what it is in process time, so that AF is 1.
    RealTime,
    /// Shafts and moving beds, slow and the same at any pace: AF times faster on the motion clock.
    Accelerated,
}

/// True where a wall is the named one, or a part of it.
pub fn belongs(wall: &str, name: &str) -> bool {
    wall.strip_prefix(name)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Mapping, smoother, exchange.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// Base mapping of a particle onto cells.
    pub mapping: MappingSpec,
    /// Largest solid fraction of a cell after smoothing, below 1.
    pub max_solid_fraction: f64,
    /// Zones into and out of which the smoother moves nothing.
    pub excluded: Vec<Zone>,
    /// The smoother stops when the excess left is below this share of the solid volume.
    pub smoother_tolerance: f64,
    /// Length ℓ of the diffusion F in m (docs/theory.md, VFS-6); `None`: half the particles' mean
    /// diameter where that is above a third of the cell size, else zero.
    pub diffusion_length: Option<f64>,
    /// A window is repeated while the mismatch of the exchange, relative to its magnitude, is
    /// above this.
    pub exchange_tolerance: f64,
    /// Attempts per window at most.
    pub exchange_attempts: u32,
    /// How often a window whose exchange does not settle may be halved.
    pub exchange_cuts: u32,
    /// How drag acts on particles that move within a window.
    pub window_drag: WindowDrag,
    /// The longest a solver may stay silent.
    pub deadline: Duration,
}

/// Base mappings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MappingSpec {
    /// All of a particle in the cell of its centre.
    Centroid,
    /// Satellite points inside the particle, each in its cell.
    Divided,
    /// Exact volume of the sphere in each cell.
    Overlap,
    /// Linear weights of the centre in the tetrahedra of the mesh.
    Linear,
}

/// What only an external solver needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExternalSpec {
    /// Template (absolute path); `None`: all inputs are generated.
    pub template: Option<PathBuf>,
    /// Time directory of OpenFOAM whose fields the gas starts from (absolute path).
    pub start: Option<PathBuf>,
    /// Program of an OpenFOAM gas.
    pub solver: StockSolver,
    /// Whether LIGGGHTS counts the impulse of walls.
    pub wall_impulse: bool,
    /// MPI ranks, unless the command line states others.
    pub ranks: u32,
}

/// `[external.gas]` or `[external.particles]`: a solver of the user's own, which couples through Calcine's C ABI.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExternalProgram {
    /// The program (absolute path).
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// MPI ranks, unless the command line states others.
    pub ranks: u32,
}

/// What is written.
#[derive(Clone, Debug)]
pub struct Output {
    /// A snapshot each so much process time (and one at the start and the end).
    pub every: Ticks,
    /// A row of the time series each so much process time; `None`: with every snapshot.
    pub series_every: Option<Ticks>,
    /// Gas fields of the snapshots: temperature, velocity, pressure, density, void_fraction.
    pub gas: Vec<String>,
    /// Particle fields of the snapshots: temperature, velocity, heat, mass, solids.
    pub particles: Vec<String>,
    /// Fields of which means over time are written.
    pub means: Option<MeanSpec>,
}

/// Means of fields over time.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanSpec {
    /// Process time from which they are taken.
    pub from: Ticks,
    /// Process time up to which they are taken.
    pub to: Ticks,
    /// Fields of the gas.
    pub gas: Vec<String>,
    /// Quantities of particles, on the cells of the gas.
    pub particles: Vec<String>,
}
