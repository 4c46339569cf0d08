//! The only place that knows every backend: from a checked case to a run that is ready to go.

use std::path::Path;
use std::sync::Arc;

use calcine_adapters::launch::Launcher;
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_adapters::liggghts::template::Template;
use calcine_adapters::liggghts::{FROZEN_STEP, LiggghtsLaunch, LiggghtsParticles};
use calcine_adapters::openfoam::case::OpenfoamCase;
use calcine_adapters::openfoam::{LIBRARY, OpenfoamGas, OpenfoamLaunch};
use calcine_coupler::closures::Closures;
use calcine_coupler::coordinator::{CheckpointPaths, Origin, Pace, Parts, Plan, Run, RunError};
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::held::HeldGas;
use calcine_coupler::interior::reacting::{Chemistry, LayersError};
use calcine_coupler::interior::{Network, ParticleModel, Reacting, Thin};
use calcine_coupler::mapping::{Mapper, Method};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::motion::Motion;
use calcine_coupler::part::{Gas, ParticleFields, Particles};
use calcine_coupler::paths::{HeatWall, PathsSetup};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::smoother::{Settings as Smoothing, Smoother};
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::traffic::{Feed, Traffic};
use calcine_native::gas::{NativeError, NativeGas};
use calcine_native::particles::NativeParticles;
use clap::ValueEnum;
use thiserror::Error;

use crate::case::model::{Case, Mapping, ReactionSpec};
use crate::case::sizes::{self, TooLarge};
use crate::case::{MeshingError, PlaceError, Placed, contacts, mesh, particles};
use crate::laws;

/// Who computes the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum GasBackend {
    /// Calcine's own finite-volume solver.
    #[default]
    Native,
    /// calcineGasFoam on Debian's OpenFOAM.
    Openfoam,
}

/// Who computes the particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ParticleBackend {
    /// Calcine's own.
    #[default]
    Native,
    /// Debian's LIGGGHTS as a library.
    Liggghts,
}

/// A gas and a particle backend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pairing {
    /// The gas.
    pub gas: GasBackend,
    /// The particles.
    pub particles: ParticleBackend,
}

impl Pairing {
    /// All four pairings.
    pub const ALL: [Pairing; 4] = [
        Pairing {
            gas: GasBackend::Native,
            particles: ParticleBackend::Native,
        },
        Pairing {
            gas: GasBackend::Native,
            particles: ParticleBackend::Liggghts,
        },
        Pairing {
            gas: GasBackend::Openfoam,
            particles: ParticleBackend::Native,
        },
        Pairing {
            gas: GasBackend::Openfoam,
            particles: ParticleBackend::Liggghts,
        },
    ];

    /// The name as `compare --pairings` takes it, for example `openfoam+native`.
    pub fn name(self) -> String {
        format!("{}+{}", self.gas.name(), self.particles.name())
    }

    /// The pairing of a name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|pairing| pairing.name() == name)
    }

    /// True where no external solver takes part.
    pub fn is_native(self) -> bool {
        self == Self::default()
    }
}

impl GasBackend {
    /// The name as users write it.
    pub fn name(self) -> &'static str {
        match self {
            GasBackend::Native => "native",
            GasBackend::Openfoam => "openfoam",
        }
    }
}

impl ParticleBackend {
    /// The name as users write it.
    pub fn name(self) -> &'static str {
        match self {
            ParticleBackend::Native => "native",
            ParticleBackend::Liggghts => "liggghts",
        }
    }
}

/// A case that cannot be assembled, although its file was in order.
#[derive(Debug, Error)]
pub enum AssemblyError {
    /// The mesh cannot be made or read.
    #[error("mesh: {0}")]
    Mesh(#[from] MeshingError),
    /// An excluded zone beside the mesh.
    #[error(
        "`coupling.smoother.excluded[{index}]` holds no centre of a cell; enlarge it, or move it into \
         the mesh"
    )]
    Excluded {
        /// Number of the zone, from 0.
        index: usize,
    },
    /// More than this machine's memory.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// The particles cannot be placed.
    #[error("particles: {0}")]
    Particles(#[from] PlaceError),
    /// Reactions that make no shrinking core.
    #[error("reactions: {0}")]
    Layers(#[from] LayersError),
    /// A native solver refuses the case or a checkpoint.
    #[error(transparent)]
    Native(#[from] NativeError),
    /// A part could not start.
    #[error(transparent)]
    Part(#[from] PartError),
    /// The bed does not fit, or a checkpoint cannot be taken up.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// What does not change during a run, made from a case: mesh and particles at the start.
#[derive(Debug)]
pub struct Prepared {
    /// The gas mesh.
    pub mesh: Arc<Mesh>,
    /// The particles at the start.
    pub particles: ParticleSetup,
    /// Their temperatures in K.
    pub temperature: Vec<f64>,
}

impl Prepared {
    /// Generates or reads the mesh and places the particles.
    pub fn new(case: &Case) -> Result<Self, AssemblyError> {
        sizes::fits(case)?;
        let Placed {
            mut setup,
            temperature,
        } = particles(case)?;
        let mesh = Arc::new(mesh(&case.mesh)?);
        setup.motion = contacts::motion(case, &mesh, &setup).map_err(PlaceError::from)?;
        Ok(Self {
            mesh,
            particles: setup,
            temperature,
        })
    }

    /// Mean void fraction that the particles see, mapped and smoothed as in a run.
    pub fn void_fraction(&self, case: &Case) -> Result<f64, AssemblyError> {
        let particles = &self.particles;
        let volume = |r: &f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
        let volumes: Vec<f64> = particles.radius.iter().map(volume).collect();
        let mapper = Mapper::new(&self.mesh);
        let weights = mapper
            .fill(method(case), &particles.position, &particles.radius)
            .map_err(RunError::from)?;
        let smoother = smoother(case, self)?;
        let operator = smoother
            .operator(weights, &volumes)
            .map_err(RunError::from)?;
        let mut seen = vec![0.0; volumes.len()];
        operator.sample(operator.solid_fraction(), &mut seen);
        Ok(1.0 - seen.iter().sum::<f64>() / seen.len() as f64)
    }
}

/// How an external solver is started.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Start {
    /// Number of ranks.
    pub ranks: u32,
    /// Who starts them.
    pub launcher: Launcher,
}

impl Default for Start {
    fn default() -> Self {
        Self {
            ranks: 1,
            launcher: Launcher::default(),
        }
    }
}

/// How the external solvers of a run are started; natively it does not matter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Starts {
    /// That of the gas.
    pub gas: Start,
    /// That of the particles.
    pub particles: Start,
}

impl Starts {
    /// As many ranks as the case says, started by Calcine.
    pub fn of(case: &Case) -> Self {
        let start = |ranks: u32| Start {
            ranks: ranks.max(1),
            ..Start::default()
        };
        Self {
            gas: start(case.openfoam.ranks),
            particles: start(case.liggghts.ranks),
        }
    }
}

/// How a run is put together, beside its case.
#[derive(Clone, Copy, Debug)]
pub struct Settings<'a> {
    /// Who computes what.
    pub pairing: Pairing,
    /// How external solvers are started.
    pub starts: &'a Starts,
    /// The results folder; inputs of external solvers go to `solvers/`, logs to `log/` in it.
    pub results: &'a Path,
    /// True where every part starts from the committed checkpoint.
    pub resume: bool,
    /// Another run of the same mesh and particles to continue from; not with `resume`.
    pub from: Option<&'a Origin>,
}

/// Builds the run.
pub fn assemble<'m>(
    case: &Case,
    prepared: &'m Prepared,
    settings: &Settings<'_>,
    supervisor: &mut Supervisor,
) -> Result<Run<'m>, AssemblyError> {
    if let Some(origin) = settings.from {
        let species = case.gas.properties.species();
        origin.check(&prepared.mesh, species, &prepared.particles)?;
    }
    let checkpoint = CheckpointPaths::new(settings.results);
    let from = settings.resume.then(|| checkpoint.committed());
    let assembly = Assembly {
        case,
        prepared,
        settings,
        from: from.as_deref(),
    };
    let gas = assembly.gas(supervisor)?;
    let particles = assembly.particles(supervisor)?;
    let interior = interior(case, prepared, &particles.fields())?;
    let parts = Parts {
        gas,
        particles,
        interior,
    };
    let smoother = smoother(case, prepared)?;
    let mut plan = plan(case, prepared, checkpoint);
    let foam = settings.pairing.gas == GasBackend::Openfoam;
    if foam && case.openfoam.solver.is_stock() {
        // A stock solver cannot go back to the start of a time step.
        plan.exchange_attempts = 1;
        plan.repeats = false;
    }
    let mut run = Run::new(plan, &prepared.mesh, smoother, closures(case), parts)?;
    if settings.resume {
        run.resume()?;
    } else if let Some(origin) = settings.from {
        run.take_over(origin)?;
    }
    Ok(run)
}

/// Writes the inputs of the external solvers of a pairing, as a run would, into `openfoam/` and
/// `liggghts/` below a folder; returns what was written.
pub fn write_inputs(
    case: &Case,
    prepared: &Prepared,
    pairing: Pairing,
    folder: &Path,
) -> Result<Vec<std::path::PathBuf>, AssemblyError> {
    let starts = Starts::of(case);
    let mut written = Vec::new();
    if pairing.gas == GasBackend::Openfoam {
        let target = folder.join("openfoam");
        OpenfoamCase {
            setup: &case.gas,
            mesh: &prepared.mesh,
            template: case.openfoam.template.as_deref(),
            start: case.openfoam.start.as_deref(),
            solver: case.openfoam.solver,
            library: Path::new(LIBRARY),
            case_hash: &case.hash,
            ranks: starts.gas.ranks,
        }
        .write(&target)?;
        written.push(target);
    }
    if pairing.particles == ParticleBackend::Liggghts {
        let target = folder.join("liggghts");
        let template = own_script(case)?;
        let inputs = liggghts_inputs(case, prepared, template.as_ref(), starts.particles.ranks);
        inputs.write(&target)?;
        written.push(target);
    }
    Ok(written)
}

/// The user's own script of the particles, where the case names one.
fn own_script(case: &Case) -> Result<Option<Template>, PartError> {
    let Some(path) = &case.liggghts.template else {
        return Ok(None);
    };
    let populations = case.particles.iter().map(|one| one.name.clone()).collect();
    let materials = case.materials.iter().map(|one| one.name.clone()).collect();
    let read = Template::read(path, populations, materials);
    read.map(Some).map_err(|error| {
        let message = format!("the script {} cannot be used", path.display());
        PartError::new("LIGGGHTS (particles)", FailureKind::NotStarted, message).caused_by(error)
    })
}

/// What LIGGGHTS would not take of the user's own script, for `calcine check`.
pub fn check_own_script(case: &Case, prepared: &Prepared) -> Result<(), PartError> {
    let template = own_script(case)?;
    let inputs = liggghts_inputs(
        case,
        prepared,
        template.as_ref(),
        case.liggghts.ranks.max(1),
    );
    inputs.script().map(|_| ())
}

/// What LIGGGHTS is told of the particles, in the box of the mesh's points.
fn liggghts_inputs<'a>(
    case: &Case,
    prepared: &'a Prepared,
    template: Option<&'a Template>,
    ranks: u32,
) -> Inputs<'a> {
    let points = &prepared.mesh.topology().points;
    let bounds = points.iter().fold(
        (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)),
        |(low, high), point| (low.inf(point), high.sup(point)),
    );
    Inputs {
        setup: &prepared.particles,
        bounds,
        step: match &prepared.particles.motion {
            Motion::Frozen => FROZEN_STEP,
            Motion::Free(contacts) => contacts.step,
        },
        ranks,
        wall_impulse: case.liggghts.wall_impulse,
        template,
    }
}

/// What the builders of the parts share.
struct Assembly<'a> {
    case: &'a Case,
    prepared: &'a Prepared,
    settings: &'a Settings<'a>,
    from: Option<&'a Path>,
}

impl Assembly<'_> {
    fn gas(&self, supervisor: &mut Supervisor) -> Result<Box<dyn Gas>, AssemblyError> {
        let from = self.from.map(|folder| folder.join("gas"));
        if self.case.gas_held {
            let mesh = Arc::clone(&self.prepared.mesh);
            return Ok(Box::new(HeldGas::new(mesh, &self.case.gas)));
        }
        match self.settings.pairing.gas {
            GasBackend::Native => {
                let mut gas = NativeGas::new(Arc::clone(&self.prepared.mesh), &self.case.gas)?;
                if let Some(folder) = from {
                    gas.restore(&folder)?;
                } else if let Some(origin) = self.settings.from {
                    gas.take_over(&origin.path.join("gas"))?;
                }
                Ok(Box::new(gas))
            }
            GasBackend::Openfoam => {
                let launch = OpenfoamLaunch {
                    setup: &self.case.gas,
                    mesh: Arc::clone(&self.prepared.mesh),
                    template: self.case.openfoam.template.as_deref(),
                    start: self.case.openfoam.start.as_deref(),
                    solver: self.case.openfoam.solver,
                    case_hash: self.case.hash.clone(),
                    folder: self.absolute("solvers/openfoam")?,
                    log: self.absolute("log/openfoam.log")?,
                    from: match (&from, self.settings.from) {
                        (None, Some(origin)) => Some(origin.path.join("gas")),
                        _ => None,
                    },
                    ranks: self.settings.starts.gas.ranks,
                    launcher: self.settings.starts.gas.launcher.clone(),
                    resume: from,
                    deadline: self.case.coupling.deadline,
                };
                Ok(Box::new(OpenfoamGas::launch(launch, supervisor)?))
            }
        }
    }

    fn particles(&self, supervisor: &mut Supervisor) -> Result<Box<dyn Particles>, AssemblyError> {
        let from = self.from.map(|folder| folder.join("particles"));
        let setup = &self.prepared.particles;
        match self.settings.pairing.particles {
            ParticleBackend::Native => {
                let mut particles = NativeParticles::new(setup)?;
                if let Some(folder) = from {
                    particles.restore(&folder)?;
                }
                Ok(Box::new(particles))
            }
            ParticleBackend::Liggghts => {
                let start = &self.settings.starts.particles;
                let template = own_script(self.case)?;
                let inputs =
                    liggghts_inputs(self.case, self.prepared, template.as_ref(), start.ranks);
                let launch = LiggghtsLaunch {
                    inputs,
                    launcher: start.launcher.clone(),
                    case_hash: self.case.hash.clone(),
                    folder: self.absolute("solvers/liggghts")?,
                    log: self.absolute("log/liggghts.log")?,
                    resume: from,
                    deadline: self.case.coupling.deadline,
                };
                Ok(Box::new(LiggghtsParticles::launch(launch, supervisor)?))
            }
        }
    }

    /// A path in the results folder that holds whatever the working directory of a solver is.
    fn absolute(&self, below: &str) -> Result<std::path::PathBuf, AssemblyError> {
        let path = self.settings.results.join(below);
        std::path::absolute(&path).map_err(|cause| {
            let message = format!("{} has no absolute path", path.display());
            PartError::new("calcine", FailureKind::Io, message)
                .caused_by(cause)
                .into()
        })
    }
}

/// The smoother, which leaves the case's excluded zones alone.
fn smoother(case: &Case, prepared: &Prepared) -> Result<Smoother, AssemblyError> {
    let (mesh, zones) = (&prepared.mesh, &case.coupling.excluded);
    for (index, zone) in zones.iter().enumerate() {
        if !mesh.cell_centre().iter().any(|&centre| zone.holds(centre)) {
            return Err(AssemblyError::Excluded { index });
        }
    }
    let settings = smoothing(case, prepared);
    let made = Smoother::with_excluded(mesh, settings, &Zone::cells(zones, mesh));
    Ok(made.map_err(RunError::from)?)
}

/// Settings of the smoother. Where the case does not state the diffusion's length, it is half the
/// mean diameter where particles are larger than a third of the cells about them (requirements VFS-6): without
/// it a particle that spans several cells would give heat to cells that have nothing to give.
fn smoothing(case: &Case, prepared: &Prepared) -> Smoothing {
    let radii = &prepared.particles.radius;
    let diameter = 2.0 * radii.iter().sum::<f64>() / radii.len() as f64;
    let large = diameter > cell_size(prepared) / 3.0;
    let length = case
        .coupling
        .diffusion_length
        .unwrap_or(if large { 0.5 * diameter } else { 0.0 });
    Smoothing {
        max_solid_fraction: case.coupling.max_solid_fraction,
        tolerance: case.coupling.smoother_tolerance,
        diffusion_length: (length > 0.0).then_some(length),
    }
}

/// Mean size in m of the cells in the box about the particles' centres, or of all where none lies there.
fn cell_size(prepared: &Prepared) -> f64 {
    let (mesh, centres) = (&prepared.mesh, &prepared.particles.position);
    let (mut low, mut high) = (Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN));
    for centre in centres {
        (low, high) = (low.inf(centre), high.sup(centre));
    }
    let within = |centre: &Vec3| (0..3).all(|i| (low[i]..=high[i]).contains(&centre[i]));
    let cells = mesh.cell_volume().iter().zip(mesh.cell_centre());
    let (count, volume) = cells
        .filter(|(_, centre)| within(centre))
        .fold((0.0, 0.0), |(count, sum), (volume, _)| {
            (count + 1.0, sum + volume)
        });
    if count > 0.0 {
        f64::cbrt(volume / count)
    } else {
        (mesh.cell_volume().iter().sum::<f64>() / mesh.cells() as f64).cbrt()
    }
}

fn method(case: &Case) -> Method {
    match case.coupling.mapping {
        Mapping::Centroid => Method::Centroid,
        Mapping::Divided => Method::Divided,
        Mapping::Overlap => Method::Overlap,
    }
}

/// Feeds and outlets of the case; ids go on after those of the start.
fn traffic(case: &Case, prepared: &Prepared) -> Traffic {
    let feeds = case.feeds.iter().map(|feed| {
        let population = &case.particles[feed.population];
        Feed {
            name: feed.name.clone(),
            population: u32::try_from(feed.population).unwrap_or(u32::MAX),
            zone: feed.zone,
            rate: feed.rate,
            batch: feed.batch,
            sizes: population.sizes.clone(),
            density: case.materials[population.material].density,
            velocity: feed.velocity,
            temperature: feed.temperature,
            seed: feed.seed,
        }
    });
    let up = (-case.gas.gravity).try_normalize(0.0).unwrap_or(Vec3::z());
    let next = prepared.particles.id.last().map_or(1, |last| last + 1);
    Traffic::new(feeds.collect(), case.outlets.clone(), up, next)
}

fn plan(case: &Case, prepared: &Prepared, checkpoint: CheckpointPaths) -> Plan {
    Plan {
        end: case.time.end,
        motion_window: case.time.motion_window,
        acceleration: case.time.acceleration.clone(),
        storage: case.time.storage,
        checkpoint_every: case.time.checkpoint_every,
        checkpoint_wall: case.time.checkpoint_wall,
        mapping: method(case),
        exchange_tolerance: case.coupling.exchange_tolerance,
        exchange_attempts: case.coupling.exchange_attempts,
        repeats: true,
        case_hash: case.hash.clone(),
        checkpoint,
        free: match &prepared.particles.motion {
            Motion::Frozen => Vec::new(),
            Motion::Free(contacts) => contacts.held.iter().map(|held| !held).collect(),
        },
        gravity: case.gas.gravity,
        traffic: traffic(case, prepared),
        substance: case.particles.iter().map(|one| one.material).collect(),
        paths: paths(case, prepared),
        pace: match &prepared.particles.motion {
            Motion::Frozen => None,
            Motion::Free(contacts) => Some(Pace::of(contacts)),
        },
    }
}

/// Heat between particles and to walls, as the coordinator finds it.
fn paths(case: &Case, prepared: &Prepared) -> PathsSetup {
    let Some(laws) = laws::heat(case) else {
        return PathsSetup::default();
    };
    let radii = &prepared.particles.radius;
    let fed = case
        .feeds
        .iter()
        .map(|feed| 0.5 * case.particles[feed.population].sizes.largest());
    let largest = radii.iter().copied().chain(fed).fold(0.0, f64::max);
    let emissivity = |material: usize| case.materials[material].emissivity.unwrap_or(1.0);
    let walls = case.walls.iter().zip(&case.wall_temperatures);
    let radiation = case.laws.radiation.as_ref();
    PathsSetup {
        walls: walls
            .map(|(wall, temperature)| HeatWall {
                name: wall.name.clone(),
                shape: wall.shape.clone(),
                temperature: temperature.clone(),
                emissivity: emissivity(wall.material),
            })
            .collect(),
        emissivity: case
            .particles
            .iter()
            .map(|one| emissivity(one.material))
            .collect(),
        gap: laws.reach(largest),
        sight: radiation.map(|one| one.sight),
        surroundings: radiation.and_then(|one| one.surroundings.clone()),
        refresh: radiation.map_or(0.0, |one| one.refresh),
    }
}

fn closures(case: &Case) -> Closures {
    Closures {
        gas: case.gas.properties.clone(),
        drag: laws::drag(case.laws.drag),
        momentum: case.gas.momentum,
        heat_transfer: laws::heat_transfer(case.laws.heat_transfer),
        mass_transfer: laws::heat_transfer(case.laws.mass_transfer),
    }
}

/// The interior of the particles that the run starts with; those of a checkpoint may be others than
/// those of the case, and get their temperatures from it.
fn interior(
    case: &Case,
    prepared: &Prepared,
    particles: &ParticleFields<'_>,
) -> Result<Box<dyn ParticleModel>, AssemblyError> {
    let all = 0..particles.id.len();
    let start = prepared.temperature.iter().copied();
    let density = |p: usize| {
        case.materials[case.particles[particles.population[p] as usize].material].density
    };
    let volume = |p: usize| 4.0 / 3.0 * std::f64::consts::PI * particles.radius[p].powi(3);
    let material = |p: usize| case.particles[particles.population[p] as usize].material;
    let network = laws::heat(case).map(|laws| {
        let walls = case.walls.iter().zip(&case.wall_temperatures);
        let warm = walls.filter(|(_, temperature)| temperature.is_some());
        Network::new(
            laws,
            laws::thermal(case),
            all.clone().map(material).collect(),
            warm.map(|(wall, _)| wall.material).collect(),
        )
    });
    let masses: Vec<f64> = all.clone().map(|p| density(p) * volume(p)).collect();
    let materials: Vec<usize> = all.clone().map(material).collect();
    let temperature = start
        .chain(std::iter::repeat(case.gas.temperature))
        .take(all.len())
        .collect();
    if case.chemistry.reactions.is_empty() {
        let laws = case.materials.iter().map(|m| m.heat_capacity.clone());
        let made = Thin::new(masses, materials, laws.collect(), temperature, network);
        return Ok(Box::new(made));
    }
    let made = Reacting::new(
        chemistry(case)?,
        &case.chemistry.compositions,
        &masses,
        materials,
        temperature,
        network,
    );
    Ok(Box::new(made.with_sizes(case.chemistry.sizes.clone())))
}

/// The reactions of a case.
pub fn chemistry(case: &Case) -> Result<Chemistry, AssemblyError> {
    let gas = match &case.gas.properties {
        GasModel::Mixture(mixture) => Some(mixture.clone()),
        GasModel::Perfect(_) | GasModel::Constant(_) => None,
    };
    let ReactionSpec {
        solids, reactions, ..
    } = case.chemistry.clone();
    Ok(Chemistry::new(solids, gas, reactions)?)
}
