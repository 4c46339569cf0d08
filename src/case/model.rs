//! A checked case: plain SI values, nothing left to parse.

use std::path::PathBuf;
use std::time::Duration;

use calcine_adapters::openfoam::stock::Solver;
use calcine_coupler::interior::reacting::{Reaction, Size};
use calcine_coupler::mesh::grading::Stretch;
use calcine_coupler::mesh::openings::Opening;
use calcine_coupler::mesh::refine::Refinement;
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::motion::{ContactLaw, Wall};
use calcine_coupler::packing::Sizes;
use calcine_coupler::packing::regular::Lattice;
pub use calcine_coupler::paths::SURROUNDINGS;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::conduction::Conductivity;
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::setup::{GasSetup, Schedule};
use calcine_coupler::sight::Sight;
use calcine_coupler::time::{Acceleration, GasStorage, Ticks};
use calcine_coupler::traffic::Outlet;

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
    /// Clocks.
    pub time: Time,
    /// The gas mesh.
    pub mesh: MeshSpec,
    /// Materials, in the order of the file.
    pub materials: Vec<Material>,
    /// Solids that materials are made of, and what reacts.
    pub chemistry: ReactionSpec,
    /// Contact properties of pairs of materials.
    pub contacts: Vec<Contact>,
    /// Walls that particles touch.
    pub walls: Vec<Wall>,
    /// Temperature in K of each wall that particles exchange heat with; `None`: adiabatic.
    pub wall_temperatures: Vec<Option<Schedule>>,
    /// How particles that are free move.
    pub motion: Option<FreeMotion>,
    /// The gas.
    pub gas: GasSetup,
    /// True where the gas is held as it is at the start.
    pub gas_held: bool,
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
    pub openfoam: External,
    /// What only LIGGGHTS particles need.
    pub liggghts: External,
    /// What is written.
    pub output: Output,
    /// Points at which fields are sampled.
    pub probes: Vec<Probe>,
    /// Quantities of interest with their bands.
    pub quantities: Vec<Quantity>,
}

/// Clocks and checkpoints.
#[derive(Clone, Debug)]
pub struct Time {
    /// End of the run, process time.
    pub end: Ticks,
    /// Length of a coupling window in process time, where the case states that instead of the
    /// next two; they then follow from the mesh (`case::settle`).
    pub process_step: Option<Ticks>,
    /// Length of a coupling window, motion time.
    pub motion_window: Ticks,
    /// Acceleration factor over process time.
    pub acceleration: Acceleration,
    /// Over which clock the gas stores.
    pub storage: GasStorage,
    /// A checkpoint each so much process time; `None`: only on interrupt.
    pub checkpoint_every: Option<Ticks>,
    /// A checkpoint each so much wall time.
    pub checkpoint_wall: Option<Duration>,
}

/// Where the gas mesh comes from.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one a case")]
pub enum MeshSpec {
    /// A box, generated. Patches by default `side` (x−, x+, y−, y+), `bottom` (z−), `top` (z+).
    Box {
        /// Corner with the smallest coordinates in m.
        origin: Vec3,
        /// Edge lengths in m.
        size: Vec3,
        /// Cells along x, y, z.
        cells: [usize; 3],
        /// How cell sizes change along x, y, z; empty for equal ones.
        grading: [Vec<Stretch>; 3],
        /// Zones in which cells are split.
        refine: Vec<Refinement>,
        /// Parts of the boundary with patches of their own.
        openings: Vec<Opening>,
        /// Patch names of x−, x+, y−, y+, z−, z+; equal names make one patch.
        patches: [String; 6],
    },
    /// An upright cylinder, generated as an O-grid. Patches `side`, `bottom`, `top`.
    Cylinder {
        /// Centre of the bottom in m.
        origin: Vec3,
        /// Diameter in m.
        diameter: f64,
        /// Length along z in m.
        length: f64,
        /// Cells across the diameter, and along z.
        cells: [usize; 2],
        /// How cell sizes change along z; empty for equal ones.
        grading: Vec<Stretch>,
        /// Zones in which cells are split.
        refine: Vec<Refinement>,
        /// Parts of the boundary with patches of their own.
        openings: Vec<Opening>,
    },
    /// An OpenFOAM polyMesh folder (absolute path).
    PolyMesh(PathBuf),
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
    /// How particles of each material take up room.
    pub sizes: Vec<Size>,
}

impl ReactionSpec {
    /// True where some reaction exchanges gas.
    pub fn exchanges(&self) -> bool {
        self.reactions.iter().any(|one| !one.gases.is_empty())
    }
}

/// A solid material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Density in kg/m³.
    pub density: f64,
    /// Specific heat capacity over temperature; of a material with a composition that of its solids.
    pub heat_capacity: HeatCapacity,
    /// Mass fractions of all solids that there are; `None` where it is not said what it is made of.
    pub composition: Option<Vec<f64>>,
    /// How its particles take up room while they react.
    pub size: SizeLaw,
    /// Thermal conductivity over temperature.
    pub conductivity: Option<Conductivity>,
    /// Emissivity of its surface.
    pub emissivity: Option<f64>,
    /// Young's modulus in Pa, as contacts are computed.
    pub young: Option<f64>,
    /// Young's modulus in Pa of the real material, where the other one is softened.
    pub real_young: Option<f64>,
    /// Poisson's ratio.
    pub poisson: Option<f64>,
}

/// How particles of a material take up room while they react.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SizeLaw {
    /// The diameter stays.
    #[default]
    Constant,
    /// The density stays.
    ConstantDensity {
        /// Radius in m below which none shrinks.
        least_radius: f64,
    },
    /// Each solid has its own density in the particle.
    Densities {
        /// In kg/m³, of all solids that there are; `None` where it is not said.
        densities: Vec<Option<f64>>,
        /// Radius in m below which none shrinks.
        least_radius: f64,
    },
}

/// Contact properties of a pair of materials.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
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
}

/// `[motion]`: how particles that are free move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMotion {
    /// Which clock the motion belongs to.
    pub kind: MotionKind,
    /// Time step in s of motion time; `None`: chosen from the contacts.
    pub step: Option<f64>,
    /// Law of contacts.
    pub law: ContactLaw,
}

/// Which clock the motion of particles belongs to (requirements TSM-7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// Fluidised beds, drums, sprays: the motion is what it is in process time, so that AF is 1.
    RealTime,
    /// Shafts and moving beds, slow and the same at any pace: AF times faster on the motion clock.
    Accelerated,
}

/// Particles of one kind.
#[derive(Clone, Debug)]
pub struct Population {
    /// Name.
    pub name: String,
    /// Index into `Case::materials`.
    pub material: usize,
    /// Diameters; a file of particles may state its own.
    pub sizes: Sizes,
    /// Seed by which diameters that differ are drawn.
    pub size_seed: u64,
    /// How the particles move.
    pub motion: Motion,
    /// Velocity at the start in m/s of motion time.
    pub velocity: Vec3,
    /// Where they are at the start.
    pub place: Place,
    /// Start temperature in K; a file of particles may state its own.
    pub temperature: f64,
}

/// Particles that come in.
#[derive(Clone, Debug, PartialEq)]
pub struct FeedSpec {
    /// Name.
    pub name: String,
    /// Index of their population, which gives material and sizes.
    pub population: usize,
    /// Where they appear.
    pub zone: Zone,
    /// Mass flow in kg/s.
    pub rate: f64,
    /// Mass in kg at the start.
    pub batch: f64,
    /// Their velocity in m/s of process time.
    pub velocity: Vec3,
    /// Their temperature in K.
    pub temperature: f64,
    /// Equal seeds give equal particles.
    pub seed: u64,
}

/// How particles move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// They stay where they are.
    Frozen,
    /// They move by gravity, contacts and the force of the gas.
    Free,
}

/// Where particles are at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A regular stacking: `counts` particles along x, y, z from `first` on.
    Grid {
        /// Centre of the first particle in m.
        first: Vec3,
        /// Distances between centres along x, y, z in m.
        spacing: Vec3,
        /// Number along x, y, z.
        counts: [usize; 3],
    },
    /// A random packing in a layer of a box or cylinder mesh, from wall to wall.
    Random {
        /// Lowest and highest z of the layer in m.
        layer: [f64; 2],
        /// Volume of spheres over the filled space, layers at the walls included.
        solid_fraction: f64,
        /// Equal seeds give equal packings.
        seed: u64,
    },
    /// A regular stacking in a layer of a box or cylinder mesh, from wall to wall.
    Regular {
        /// The stacking.
        lattice: Lattice,
        /// Lowest and highest z of the layer in m.
        layer: [f64; 2],
    },
    /// Read from a file: CSV, a LIGGGHTS dump, or VTK.
    File {
        /// Absolute path.
        path: PathBuf,
        /// The snapshot of a dump; `None`: its last one.
        timestep: Option<u64>,
        /// Those of one type; `None`: all.
        kind: Option<u64>,
    },
}

/// Laws; each is stated in the case file, none has a default.
#[derive(Clone, Debug, PartialEq)]
pub struct Laws {
    /// Drag on a particle.
    pub drag: DragLaw,
    /// How gas and particles share their momentum.
    pub momentum: MomentumModel,
    /// Heat transfer between gas and particle.
    pub heat_transfer: HeatLaw,
    /// Heat conduction between particles.
    pub conduction: Conduction,
    /// Mass transfer between gas and particles that react.
    pub mass_transfer: HeatLaw,
    /// Radiation between particles; `None`: none.
    pub radiation: Option<Radiation>,
}

impl Laws {
    /// True where heat passes contacts or gaps.
    pub fn conducts(&self) -> bool {
        self.conduction.law != ConductionLaw::None || self.conduction.gap != Gap::None
    }
}

/// How particles conduct heat to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conduction {
    /// Through contacts.
    pub law: ConductionLaw,
    /// By which overlap.
    pub area: Area,
    /// Through the gas between surfaces.
    pub gap: Gap,
}

/// The overlap by which contacts conduct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Area {
    /// As it is.
    Overlap,
    /// That of the real materials under the computed force.
    Force,
    /// That of the real materials under one force.
    Load {
        /// The force in N.
        force: f64,
        /// The widest gap in m that counts as a contact.
        within: f64,
    },
}

/// Conduction through the gas between surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gap {
    /// None.
    None,
    /// Rong and Horio 1999.
    RongHorio {
        /// Thickness of the film over the radius.
        lens: f64,
        /// Least width of a gap in m.
        least_width: f64,
    },
    /// Cheng, Yu and Zulli 1999.
    Cheng {
        /// Radius of the cones' base over the particle's.
        cone: f64,
        /// Widest gap over the radius.
        widest: f64,
    },
}

/// How particles radiate.
#[derive(Clone, Debug, PartialEq)]
pub struct Radiation {
    /// How views are found.
    pub sight: Sight,
    /// True where badly conducting spheres pass on less.
    pub inside: bool,
    /// Temperature in K of what is seen beyond all walls; `None`: nothing leaves.
    pub surroundings: Option<Schedule>,
    /// Views of moving particles hold for so much process time in s.
    pub refresh: f64,
}

/// True where a wall is the named one, or a part of it.
pub fn belongs(wall: &str, name: &str) -> bool {
    wall.strip_prefix(name)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Conduction laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConductionLaw {
    /// No conduction.
    None,
    /// Batchelor and O'Brien 1977 (requirements COR-17).
    BatchelorObrien,
    /// By the circle of intersection, as LIGGGHTS has it.
    Lens,
}

/// Drag laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DragLaw {
    /// No drag.
    None,
    /// Ergun below a void fraction of 0.8, Wen and Yu above (requirements COR-6).
    ErgunWenYu,
    /// Ergun 1952.
    Ergun,
    /// Wen and Yu 1966.
    WenYu,
    /// Ergun and Wen-Yu, blended.
    Gidaspow,
    /// Di Felice 1994.
    DiFelice,
    /// Koch and Hill 2001.
    KochHill,
    /// Beetstra, van der Hoef and Kuipers 2007.
    Beetstra,
}

/// Heat transfer laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeatLaw {
    /// No heat transfer.
    None,
    /// Gunn 1978 (requirements COR-3).
    Gunn,
    /// Ranz and Marshall (requirements COR-1).
    RanzMarshall,
    /// Wakao and Kaguei 1982 (requirements COR-2).
    Wakao,
    /// Gnielinski 1980 (requirements COR-4).
    Gnielinski,
}

/// Mapping, smoother, exchange.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// Base mapping of a particle onto cells.
    pub mapping: Mapping,
    /// Largest solid fraction of a cell after smoothing, below 1.
    pub max_solid_fraction: f64,
    /// Zones into and out of which the smoother moves nothing.
    pub excluded: Vec<Zone>,
    /// The smoother stops when the excess left is below this share of the solid volume.
    pub smoother_tolerance: f64,
    /// Length ℓ of the diffusion F in m (requirements VFS-6); `None`: half the particles' mean
    /// diameter where that is above a third of the cell size, else zero.
    pub diffusion_length: Option<f64>,
    /// A window is repeated while the mismatch of the exchange, relative to its magnitude, is
    /// above this.
    pub exchange_tolerance: f64,
    /// Attempts per window at most.
    pub exchange_attempts: u32,
    /// The longest a solver may stay silent.
    pub deadline: Duration,
}

/// Base mappings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapping {
    /// All of a particle in the cell of its centre.
    Centroid,
    /// Satellite points inside the particle, each in its cell.
    Divided,
    /// Exact volume of the sphere in each cell.
    Overlap,
}

/// What only an external solver needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct External {
    /// Template (absolute path); `None`: all inputs are generated.
    pub template: Option<PathBuf>,
    /// Time directory of OpenFOAM whose fields the gas starts from (absolute path).
    pub start: Option<PathBuf>,
    /// Program of an OpenFOAM gas.
    pub solver: Solver,
    /// Whether LIGGGHTS counts the impulse of walls.
    pub wall_impulse: bool,
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
}

/// Points at which fields are sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Name.
    pub name: String,
    /// The points in m.
    pub points: Vec<Vec3>,
    /// Whether the gas is sampled.
    pub gas: bool,
    /// Whether the particles are.
    pub particles: bool,
}

/// A quantity of interest.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Name.
    pub name: String,
    /// How it is measured.
    pub measure: Measure,
    /// Which species of the gas, or solid, where the measure is of a mass fraction.
    pub column: Option<usize>,
    /// Unit as printed.
    pub unit: &'static str,
    /// Largest difference between pairings.
    pub agree: Option<Band>,
    /// Process time in s from which `agree` holds.
    pub agree_from: f64,
    /// Process time in s over which values are averaged before pairings are compared; 0: not at all.
    pub agree_over: f64,
    /// Expected value.
    pub expect: Option<Expect>,
}

/// How a quantity is measured.
#[derive(Clone, Debug, PartialEq)]
pub enum Measure {
    /// Area mean on the first patch minus that on the second, of a gas field.
    Difference {
        /// Field: `pressure` (Pa) or `temperature` (K).
        field: String,
        /// The two patches.
        patches: [String; 2],
    },
    /// Statistic of a gas field.
    Gas {
        /// Field: `temperature` (K), `pressure` (Pa), `density` (kg/m³), `speed` (m/s),
        /// `void_fraction`.
        field: String,
        /// Where.
        over: GasPlace,
        /// `mean`, `min` or `max`.
        statistic: Statistic,
    },
    /// Statistic over particles.
    Particles {
        /// Field: `temperature` (K).
        field: String,
        /// Which.
        over: ParticlePlace,
        /// `mean`, `min` or `max`.
        statistic: Statistic,
    },
    /// Heat in W from a wall of a temperature, or from the surroundings, into the particles.
    WallHeat {
        /// Its name.
        wall: String,
    },
    /// One particle, by its place in the order of ids, counted from 1.
    Particle {
        /// Field: `temperature` (K).
        field: String,
        /// Which one.
        number: usize,
    },
    /// Angle in rad of the bed's surface in a drum: by which the centre of mass of all particles has turned
    /// about an axis from straight below it. A surface that is flat stands across the line from the axis to the
    /// centre of mass, so that this is its slope.
    SurfaceAngle {
        /// A point of the axis in m.
        point: Vec3,
        /// Unit vector along the axis.
        axis: Vec3,
        /// Unit vector along gravity.
        down: Vec3,
    },
}

/// Where a statistic of the gas is taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GasPlace {
    /// In all cells; the mean is over the gas' volume.
    Everywhere,
    /// On a patch; the mean is over its area.
    Patch(String),
    /// At the points of a probe.
    Probe(String),
}

/// Of which particles a statistic is taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ParticlePlace {
    /// Of all.
    Everywhere,
    /// Of one population, by its index.
    Population(u32),
    /// Of those at the points of a probe.
    Probe(String),
}

/// Statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    /// Arithmetic mean.
    Mean,
    /// Smallest.
    Min,
    /// Largest.
    Max,
}

/// A band around a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Band {
    /// Fraction of the value.
    Relative(f64),
    /// In the unit of the quantity.
    Absolute(f64),
}

/// An expected value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expect {
    /// Process time in s at which it holds; `None`: at the end.
    pub at: Option<f64>,
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The band.
    pub within: Band,
}
