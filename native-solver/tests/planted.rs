//! Numbers that are not finite, planted in gas, particles and ledger: the run ends with what, where and when, and the
//! last checkpoint is one to go on from.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::boundary_value::BoundaryValue;
use calcine_coupler::closures::Closures;
use calcine_coupler::coordinator::{CheckpointPaths, CoupledRun, Ending, Plan, RunError, RunParts};
use calcine_coupler::error::PartError;
use calcine_coupler::finite::NotFinitePlace;
use calcine_coupler::interior::Thin;
use calcine_coupler::mapping::Method;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::models::ParticleModels;
use calcine_coupler::motion::ParticleChanges;
use calcine_coupler::part::{
    Backflow, Bed, CellExchange, CellReceived, Convergence, Gas, GasFields, Part, ParticleFields,
    ParticlePush, ParticleReceived, Particles, SolverInfo,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::drag::{Drag, ErgunWenYu};
use calcine_coupler::physics::heat_transfer::{Gunn, HeatTransfer, NoHeatTransfer};
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::turbulence::NoBedEddies;
use calcine_coupler::setup::{Convection, ParticleSetup};
use calcine_coupler::smoother::{Smoother, SmootherSettings};
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Acceleration, GasStorage, Ticks, Window};
use calcine_native::gas::NativeGas;
use calcine_native::particles::NativeParticles;

use crate::common::{self, duct, inlet, no_slip, outlet};

/// Window in s in which the number is planted, counted from 0.
const WINDOW: u64 = 3;

/// Where it is planted.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Planted {
    Nowhere,
    Temperature,
    Velocity,
    PressureGradient,
    Position,
    Spin,
    Ledger,
}

/// A gas that shows another field than it has, or tells another balance, from a window on.
struct FalseGas {
    gas: NativeGas,
    planted: Planted,
    vectors: Vec<Vec3>,
    scalars: Vec<f64>,
    broken: bool,
}

impl Part for FalseGas {
    fn about(&self) -> &SolverInfo {
        self.gas.about()
    }

    fn commit(&mut self) -> Result<(), PartError> {
        self.gas.commit()
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        self.gas.checkpoint(directory)
    }

    fn processor_time(&self) -> Duration {
        self.gas.processor_time()
    }

    fn finish_run(&mut self, supervisor: &Supervisor) -> Result<(), PartError> {
        self.gas.finish_run(supervisor)
    }
}

impl Gas for FalseGas {
    fn fields(&self) -> GasFields<'_> {
        let mut fields = self.gas.fields();
        if self.broken {
            match self.planted {
                Planted::Temperature => fields.temperature = &self.scalars,
                Planted::Velocity => fields.velocity = &self.vectors,
                Planted::PressureGradient => fields.pressure_gradient = &self.vectors,
                _ => {}
            }
        }
        fields
    }

    fn backflow(&self) -> Option<Backflow> {
        self.gas.backflow()
    }

    fn begins_again(&self) -> bool {
        self.gas.begins_again()
    }

    fn turbulence_residual(&self) -> Option<f64> {
        self.gas.turbulence_residual()
    }

    fn set_boundary(&mut self, value: &BoundaryValue) -> Result<(), PartError> {
        self.gas.set_boundary(value)
    }

    fn start(
        &mut self,
        window: &Window,
        bed: &Bed,
        exchange: &CellExchange,
    ) -> Result<(), PartError> {
        self.broken = window.index == WINDOW;
        self.gas.start(window, bed, exchange)
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut CellReceived,
    ) -> Result<Convergence, PartError> {
        let convergence = self.gas.finish(supervisor, received)?;
        let fields = self.gas.fields();
        self.scalars = fields.temperature.to_vec();
        self.scalars[5] = f64::NAN;
        self.vectors = fields.velocity.to_vec();
        self.vectors[5].z = f64::INFINITY;
        if self.broken && self.planted == Planted::Ledger {
            received.energy.boundary = f64::NAN;
        }
        Ok(convergence)
    }
}

/// Particles that show another place or spin than they have after a window.
struct FalseParticles {
    particles: NativeParticles,
    planted: Planted,
    vectors: Vec<Vec3>,
    broken: bool,
}

impl Part for FalseParticles {
    fn about(&self) -> &SolverInfo {
        self.particles.about()
    }

    fn commit(&mut self) -> Result<(), PartError> {
        self.particles.commit()
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        self.particles.checkpoint(directory)
    }

    fn processor_time(&self) -> Duration {
        self.particles.processor_time()
    }

    fn finish_run(&mut self, supervisor: &Supervisor) -> Result<(), PartError> {
        self.particles.finish_run(supervisor)
    }
}

impl Particles for FalseParticles {
    fn fields(&self) -> ParticleFields<'_> {
        let mut fields = self.particles.fields();
        if self.broken {
            match self.planted {
                Planted::Position => fields.position = &self.vectors,
                Planted::Spin => fields.angular_velocity = &self.vectors,
                _ => {}
            }
        }
        fields
    }

    fn change(
        &mut self,
        supervisor: &Supervisor,
        change: &ParticleChanges,
    ) -> Result<(), PartError> {
        self.particles.change(supervisor, change)
    }

    fn takes(&self, column: &str) -> bool {
        self.particles.takes(column)
    }

    fn start(&mut self, window: &Window, bed: &Bed, push: &ParticlePush) -> Result<(), PartError> {
        self.particles.start(window, bed, push)?;
        self.vectors = self.particles.fields().position.to_vec();
        self.vectors[1].x = f64::NAN;
        self.broken = window.index == WINDOW;
        Ok(())
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut ParticleReceived,
    ) -> Result<(), PartError> {
        self.particles.finish(supervisor, received)
    }
}

/// Six windows of warm air through three frozen beads, a checkpoint after each.
fn beads(planted: Planted, results: &Path) -> CoupledRun {
    let mesh: Arc<Mesh> = duct([0.02, 0.02, 0.06], [2, 2, 6]);
    let patches = [
        ("bottom", inlet(0.2, 350.0)),
        ("top", outlet()),
        ("side", no_slip()),
    ];
    let setup = common::setup(&patches);
    let window = Ticks::from_seconds(1e-2).unwrap();
    let plan = Plan {
        end: Ticks::from_seconds(6e-2).unwrap(),
        motion_window: window,
        window_bounds: None,
        particle_step: None,
        breaks: Vec::new(),
        jumps: Vec::new(),
        time_scheme: Default::default(),
        convection: Convection::default(),
        gas_reacts: false,
        acceleration: Acceleration::constant(1.0).unwrap(),
        storage: GasStorage::Process,
        checkpoint_every: Some(window),
        checkpoint_wall: None,
        mapping: Method::Overlap,
        exchange_tolerance: 1e-3,
        gas_tolerance: 1e-8,
        exchange_attempts: 4,
        cuts: 2,
        repeats: true,
        window_drag: Default::default(),
        case_hash: "beads".into(),
        checkpoint: CheckpointPaths::new(results),
        free: Vec::new(),
        holds: Default::default(),
        lost: Default::default(),
        gravity: Vec3::zeros(),
        feeds_and_outlets: Default::default(),
        substance: vec![0],
        populations: vec!["beads".into()],
        paths: Default::default(),
        step_limit: None,
    };
    let closures = Closures {
        gas: setup.properties.clone(),
        drag: Box::new(ErgunWenYu) as Box<dyn Drag>,
        momentum: Default::default(),
        heat_transfer: Box::new(Gunn) as Box<dyn HeatTransfer>,
        mass_transfer: Box::new(NoHeatTransfer),
        film_diffusivity: Default::default(),
        bed_eddies: Box::new(NoBedEddies),
        heat_film: calcine_coupler::physics::film::FilmTemperature::Gas,
        film: calcine_coupler::physics::film::FilmTheory {
            temperature: calcine_coupler::physics::film::FilmTemperature::Gas,
            stefan_flow: calcine_coupler::physics::film::StefanFlow::None,
        },
    };
    let bed = ParticleSetup {
        id: vec![1, 2, 3],
        population: vec![0; 3],
        position: [0.01, 0.03, 0.05].map(|z| Vec3::new(0.01, 0.01, z)).into(),
        radius: vec![2e-3; 3],
        density: vec![2500.0; 3],
        ..ParticleSetup::default()
    };
    let mut gas = NativeGas::new(Arc::clone(&mesh), &setup).unwrap();
    let mut particles = NativeParticles::new(&bed).unwrap();
    let checkpoint = CheckpointPaths::new(results).committed();
    if checkpoint.exists() {
        gas.restore(&checkpoint.join("gas")).unwrap();
        particles.restore(&checkpoint.join("particles")).unwrap();
    }
    let thin = Box::new(Thin::new(HeatCapacity::constant(840.0)));
    let mut models = ParticleModels::new(vec![thin], vec![0]).unwrap();
    let fields = particles.fields();
    let masses = fields.mass.to_vec();
    models.fill(&fields, &masses, &[300.0; 3]).unwrap();
    let parts = RunParts {
        gas: Box::new(FalseGas {
            gas,
            planted,
            vectors: Vec::new(),
            scalars: Vec::new(),
            broken: false,
        }),
        particles: Box::new(FalseParticles {
            particles,
            planted,
            vectors: Vec::new(),
            broken: false,
        }),
        models,
        network: None,
        bodies: Default::default(),
    };
    let smoother = Smoother::new(&mesh, SmootherSettings::default()).unwrap();
    let mut run = CoupledRun::new(plan, mesh, smoother, closures, parts).unwrap();
    if checkpoint.exists() {
        run.resume().unwrap();
    }
    run
}

fn supervisor() -> Supervisor {
    Supervisor::new(Duration::from_secs(60), Interrupts::default())
}

#[test]
fn a_number_that_is_not_finite_ends_the_run_with_its_place_and_the_last_checkpoint_goes_on() {
    let whole = tempfile::tempdir().unwrap();
    let mut run = beads(Planted::Nowhere, whole.path());
    assert_eq!(run.run(&supervisor(), &mut []).unwrap(), Ending::Finished);
    let warm: Vec<u64> = run
        .state()
        .particle_temperature
        .iter()
        .map(|kelvin| kelvin.to_bits())
        .collect();
    for (planted, words) in [
        (Planted::Temperature, "temperature of the gas"),
        (Planted::Velocity, "velocity of the gas"),
        (Planted::PressureGradient, "pressure gradient"),
        (Planted::Position, "position"),
        (Planted::Spin, "angular velocity"),
        (Planted::Ledger, "balance `energy`"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let error = beads(planted, folder.path())
            .run(&supervisor(), &mut [])
            .unwrap_err();
        let RunError::NotFinite(told) = &error else {
            panic!("{planted:?}: {error}");
        };
        assert_eq!(told.window, WINDOW, "{planted:?}");
        assert!(error.to_string().contains(words), "{planted:?}: {error}");
        let named = match planted {
            Planted::Ledger => told.place == NotFinitePlace::Ledger,
            Planted::Position | Planted::Spin => {
                matches!(told.place, NotFinitePlace::Particle { id: 2, .. })
            }
            _ => matches!(told.place, NotFinitePlace::Cell { cell: 5, .. }),
        };
        assert!(named, "{planted:?}: {error}");
        let mut again = beads(Planted::Nowhere, folder.path());
        assert_eq!(again.state().windows, WINDOW, "{planted:?}");
        assert_eq!(again.run(&supervisor(), &mut []).unwrap(), Ending::Finished);
        let state = again.state();
        let found = state.particle_temperature.iter().map(|one| one.to_bits());
        assert_eq!(found.collect::<Vec<u64>>(), warm, "{planted:?}");
    }
}
