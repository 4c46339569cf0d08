//! Beds of parcels that a gas flows through: what carries their weight, and when they begin to float.
#![allow(clippy::print_stdout)]

use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use calcine_coupler::closures::Closures;
use calcine_coupler::coordinator::{CheckpointPaths, CoupledRun, Plan, RunParts};
use calcine_coupler::error::PartError;
use calcine_coupler::interior::Thin;
use calcine_coupler::mapping::Method;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::models::ParticleModels;
use calcine_coupler::motion::ParticleChanges;
use calcine_coupler::parcels::{ParcelCollisions, ParcelPacking};
use calcine_coupler::part::{
    Bed, Part, ParticleFields, ParticlePush, ParticleReceived, Particles, SolverInfo,
};
use calcine_coupler::physics::drag::Gidaspow;
use calcine_coupler::physics::film::{FilmTemperature, FilmTheory, StefanFlow};
use calcine_coupler::physics::heat_transfer::NoHeatTransfer;
use calcine_coupler::physics::parcels::{CollisionTimes, HarrisCrighton};
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::turbulence::NoBedEddies;
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::{Convection, GasPatch, Schedule};
use calcine_coupler::smoother::{Smoother, SmootherSettings};
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Acceleration, GasStorage, Ticks, Window};
use calcine_coupler::window_drag::WindowDrag;
use calcine_native::gas::NativeGas;
use calcine_native::parcels::NativeParcels;

use crate::common::{self, ATMOSPHERE, duct, fluid, outlet, slip};
use crate::parcel_beds::{motion, setup};

const RADIUS: f64 = 0.435e-3;
const DENSITY: f64 = 860.0;
const GAS_DENSITY: f64 = 1.2;
const VISCOSITY: f64 = 1.8e-5;
const GRAVITY: f64 = 9.81;
const CLOSE: f64 = 0.6;

/// Parcels that tell what walls gave them.
struct Watched {
    parcels: NativeParcels,
    support: Arc<Mutex<Vec3>>,
    most: Arc<Mutex<f64>>,
}

impl Part for Watched {
    fn about(&self) -> &SolverInfo {
        self.parcels.about()
    }

    fn commit(&mut self) -> Result<(), PartError> {
        self.parcels.commit()
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        self.parcels.checkpoint(directory)
    }
}

impl Particles for Watched {
    fn fields(&self) -> ParticleFields<'_> {
        self.parcels.fields()
    }

    fn change(
        &mut self,
        supervisor: &Supervisor,
        change: &ParticleChanges,
    ) -> Result<(), PartError> {
        self.parcels.change(supervisor, change)
    }

    fn takes(&self, column: &str) -> bool {
        self.parcels.takes(column)
    }

    fn start(&mut self, window: &Window, bed: &Bed, push: &ParticlePush) -> Result<(), PartError> {
        self.parcels.start(window, bed, push)
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut ParticleReceived,
    ) -> Result<(), PartError> {
        self.parcels.finish(supervisor, received)?;
        *self.support.lock().unwrap() = received.support.unwrap();
        let fullest = self.parcels.solid_fraction().into_iter();
        *self.most.lock().unwrap() = fullest.fold(0.0, f64::max);
        Ok(())
    }
}

/// A bed in a box between slip walls, gas from below.
struct FluidisedBed {
    run: CoupledRun,
    mesh: Arc<Mesh>,
    support: Arc<Mutex<Vec3>>,
    most: Arc<Mutex<f64>>,
    area: f64,
    /// Weight of the parcels less their buoyancy over the cross-section, in Pa.
    weight: f64,
    supervisor: Supervisor,
    _results: tempfile::TempDir,
}

/// Means of some windows, in Pa but for the last.
#[derive(Clone, Copy, Debug, Default)]
struct Carried {
    /// Fall of pressure, without that of gas at rest.
    gas: f64,
    /// Impulse of the walls along z.
    floor: f64,
    /// What the momentum of the parcels has gained.
    gain: f64,
    /// Largest solid fraction of a cell.
    most: f64,
}

impl FluidisedBed {
    /// A box of so many cells with a bed of so many layers of cells, each of `across`³ parcels of half the volume.
    fn new(
        (cells, size): ([usize; 3], f64),
        (across, layers): (usize, usize),
        pressure: f64,
        velocity: Schedule,
    ) -> Self {
        let extent = cells.map(|count| count as f64 * size);
        let mesh = duct(extent, cells);
        let mut rules = motion(&mesh, 0.5, 0.1);
        rules.gravity = Vec3::z() * -GRAVITY;
        rules.packing = ParcelPacking::Implicit(HarrisCrighton {
            pressure,
            exponent: 2.0,
            floor: 1e-7,
            close_packing: CLOSE,
        });
        rules.collisions = ParcelCollisions {
            times: CollisionTimes {
                restitution: 0.9,
                close_packing: CLOSE,
            },
            damping: true,
            isotropy: true,
            seed: 1,
        };
        let step = size / across as f64;
        let counts = [cells[0] * across, cells[1] * across, layers * across];
        let mut places = Vec::new();
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    let place = Vec3::new(i as f64, j as f64, k as f64).add_scalar(0.5) * step;
                    places.push((place, Vec3::zeros()));
                }
            }
        }
        let of_one = 0.55 * step.powi(3) / sphere::volume(RADIUS);
        let mut parcels = setup(rules, &places, RADIUS, of_one);
        parcels.density.fill(DENSITY);
        let area = extent[0] * extent[1];
        let solid = 0.55 * step.powi(3) * places.len() as f64;
        let inlet = GasPatch::inlet(velocity, Schedule::constant(300.0));
        let mut gas = common::setup(&[("bottom", inlet), ("top", outlet()), ("side", slip())]);
        gas.properties = fluid(GAS_DENSITY, 1000.0, VISCOSITY, 0.026);
        gas.gravity = Vec3::z() * -GRAVITY;
        let results = tempfile::tempdir().unwrap();
        let closures = Closures {
            gas: gas.properties.clone(),
            drag: Box::new(Gidaspow),
            momentum: Default::default(),
            heat_transfer: Box::new(NoHeatTransfer),
            mass_transfer: Box::new(NoHeatTransfer),
            film_diffusivity: Default::default(),
            bed_eddies: Box::new(NoBedEddies),
            heat_film: FilmTemperature::Gas,
            film: FilmTheory {
                temperature: FilmTemperature::Gas,
                stefan_flow: StefanFlow::None,
            },
        };
        let particles = NativeParcels::new(Arc::clone(&mesh), &parcels).unwrap();
        let thin = Box::new(Thin::new(HeatCapacity::constant(1300.0)));
        let mut models = ParticleModels::new(vec![thin], vec![0]).unwrap();
        let fields = particles.fields();
        let masses = fields.mass.to_vec();
        let kelvin = vec![300.0; fields.len()];
        models.fill(&fields, &masses, &kelvin).unwrap();
        let (support, most) = (Arc::default(), Arc::default());
        let parts = RunParts {
            gas: Box::new(NativeGas::new(Arc::clone(&mesh), &gas).unwrap()),
            particles: Box::new(Watched {
                parcels: particles,
                support: Arc::clone(&support),
                most: Arc::clone(&most),
            }),
            models,
            network: None,
            bodies: Default::default(),
        };
        let smoother = Smoother::new(&mesh, SmootherSettings::default()).unwrap();
        let plan = plan(results.path());
        let run = CoupledRun::new(plan, Arc::clone(&mesh), smoother, closures, parts).unwrap();
        Self {
            run,
            mesh,
            support,
            most,
            area,
            weight: solid * (DENSITY - GAS_DENSITY) * GRAVITY / area,
            supervisor: Supervisor::new(Duration::from_secs(60), Interrupts::default()),
            _results: results,
        }
    }

    /// Momentum of the parcels along z over the cross-section.
    fn momentum(&self) -> f64 {
        let fields = self.run.state().particles;
        let rows = 0..fields.len();
        rows.map(|row| fields.row_mass(row) * fields.velocity[row].z)
            .sum::<f64>()
            / self.area
    }

    /// Fall of pressure from bottom to top in Pa, less that of gas at rest.
    fn fall(&self) -> f64 {
        let gas = self.run.state().gas;
        let mean = |patch: &str| {
            let patch = self.mesh.patch(patch).unwrap();
            let faces = patch.faces().map(|face| {
                let cell = self.mesh.owner()[face] as usize;
                let arm = self.mesh.face_centre()[face] - self.mesh.cell_centre()[cell];
                gas.pressure[cell] - ATMOSPHERE + gas.pressure_gradient[cell].dot(&arm)
            });
            faces.sum::<f64>() / patch.count as f64
        };
        let [low, high] = self.mesh.bounds();
        mean("bottom") - mean("top") - GAS_DENSITY * GRAVITY * (high.z - low.z)
    }

    /// Runs for a time in s; what carried the bed in the mean over it.
    fn run(&mut self, time: f64) -> Carried {
        let windows = (time / SPAN).round() as usize;
        let before = self.momentum();
        let mut sum = Carried::default();
        for _ in 0..windows {
            self.run.step(&self.supervisor, &mut []).unwrap();
            sum.gas += self.fall() / windows as f64;
            let support = self.support.lock().unwrap().z / (self.area * SPAN);
            sum.floor += support / windows as f64;
            sum.most = sum.most.max(*self.most.lock().unwrap());
        }
        sum.gain = (self.momentum() - before) / time;
        sum
    }
}

/// Window in s.
const SPAN: f64 = 1e-3;

fn plan(results: &Path) -> Plan {
    Plan {
        end: Ticks::from_seconds(100.0).unwrap(),
        motion_window: Ticks::from_seconds(SPAN).unwrap(),
        window_bounds: None,
        particle_step: None,
        breaks: Vec::new(),
        jumps: Vec::new(),
        time_scheme: Default::default(),
        convection: Convection::default(),
        gas_reacts: false,
        acceleration: Acceleration::constant(1.0).unwrap(),
        storage: GasStorage::Process,
        checkpoint_every: None,
        checkpoint_wall: None,
        mapping: Method::Linear,
        exchange_tolerance: 1e-3,
        gas_tolerance: 1e-8,
        exchange_attempts: 4,
        cuts: 0,
        repeats: true,
        window_drag: WindowDrag::Following,
        case_hash: "fluidised".into(),
        checkpoint: CheckpointPaths::new(results),
        free: vec![true],
        holds: Default::default(),
        gravity: Vec3::z() * -GRAVITY,
        feeds_and_outlets: Default::default(),
        substance: vec![0],
        populations: vec!["beads".into()],
        paths: Default::default(),
        lost: Default::default(),
        step_limit: None,
    }
}

/// Ergun's pressure gradient in Pa/m, which is what the law of Gidaspow has in a dense bed: of the superficial velocity in m/s.
fn ergun(solid: f64, velocity: f64) -> f64 {
    let (void, diameter) = (1.0 - solid, 2.0 * RADIUS);
    let viscous = 150.0 * solid * solid * VISCOSITY / (void.powi(3) * diameter * diameter);
    let inertial = 1.75 * solid * GAS_DENSITY / (void.powi(3) * diameter);
    viscous * velocity + inertial * velocity * velocity
}

/// The superficial velocity in m/s at which it is the weight of the bed.
fn floats_at(solid: f64) -> f64 {
    let weight = solid * (DENSITY - GAS_DENSITY) * GRAVITY;
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if ergun(solid, middle) < weight {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Velocities are held for so many seconds, one after the other, with as much between them.
const HELD: f64 = 0.3;

fn stairs(velocities: &[f64]) -> Schedule {
    let steps = velocities.iter().enumerate();
    Schedule(
        steps
            .flat_map(|(k, &velocity)| {
                let from = 2.0 * HELD * k as f64;
                [(from, velocity), (from + HELD, velocity)]
            })
            .collect(),
    )
}

#[test]
fn gas_and_floor_together_carry_the_bed_whatever_the_stress() {
    for pressure in [10.0, 0.1] {
        let rises = stairs(&[0.15, 0.35]);
        let mut bed = FluidisedBed::new(([2, 2, 20], 4.5e-3), (3, 10), pressure, rises);
        for velocity in [0.15, 0.35] {
            let carried = bed.run(HELD);
            println!(
                "{pressure} Pa, {velocity} m/s of {}: {carried:?}",
                bed.weight
            );
            // Less what accelerates the gas.
            let all = carried.gas + carried.floor - carried.gain;
            assert!(
                (all / bed.weight - 1.0).abs() < 3e-3,
                "{all} {}",
                bed.weight
            );
            assert!(carried.most <= CLOSE, "{}", carried.most);
            bed.run(HELD);
        }
    }
}

#[test]
fn a_bed_begins_to_float_at_the_root_of_the_drag_law_and_then_has_its_weight_as_its_pressure_drop()
{
    let root = floats_at(CLOSE);
    let velocities = [0.1, 0.7 * root, 0.9 * root, 1.2 * root];
    let mut bed = FluidisedBed::new(([1, 1, 34], 4.5e-3), (3, 20), 0.1, stairs(&velocities));
    let [.., slow, fast, floats] = velocities.map(|_| {
        bed.run(0.5 * HELD);
        let carried = bed.run(0.5 * HELD);
        bed.run(HELD);
        carried.gas
    });
    // What the bed that rests has, a U + b U², reaches the weight at:
    let [first, second] = [slow / velocities[1], fast / velocities[2]];
    let b = (second - first) / (velocities[2] - velocities[1]);
    let a = first - b * velocities[1];
    let found = ((a * a + 4.0 * b * bed.weight).sqrt() - a) / (2.0 * b);
    println!(
        "floats at {found} of {root} m/s, then {floats} of {} Pa",
        bed.weight
    );
    assert!((found / root - 1.0).abs() < 0.05, "{found} {root}");
    assert!(
        (floats / bed.weight - 1.0).abs() < 0.01,
        "{floats} {}",
        bed.weight
    );
}
