//! A run without solvers: a duct with a temperature front that moves up through ten particles.

pub mod meshes;

use std::path::{Path, PathBuf};
use std::time::Duration;

use calcine::case::model::*;
use calcine::results::{Recorder, RunInfo};
use calcine_coupler::exchange::ExchangeConvergence;
use calcine_coupler::ledger::Ledger;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::models::ParticleModels;
use calcine_coupler::observer::{CommittedState, Observer, Timing};
use calcine_coupler::part::{Bed, Convergence, GasFields, ParticleFields, SolverInfo};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::conduction::{CONDUCTION_LAWS, GAP_LAWS};
use calcine_coupler::physics::drag::DRAG_LAWS;
use calcine_coupler::physics::film::{FilmTemperature, FilmTheory, StefanFlow};
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::physics::heat_transfer::HEAT_TRANSFER_LAWS;
use calcine_coupler::physics::law::{LawChoice, NONE};
use calcine_coupler::physics::turbulence::BED_EDDY_LAWS;
use calcine_coupler::setup::{Convection, GasControls, GasSetup};
use calcine_coupler::time::{Acceleration, Clocks, GasStorage, Ticks, Window};

use self::meshes::{CELLS, SIZE, duct};

fn seconds(time: f64) -> Ticks {
    Ticks::from_seconds(time).unwrap()
}

/// An exchange that the first attempt settled.
const SETTLED: ExchangeConvergence = ExchangeConvergence {
    attempts: 1,
    cuts: 0,
    misplaced: 1e-7,
    settled: true,
};

/// A case of 20 s at AF 50 in windows of 10 ms, with rows each 0.7 s and snapshots each 5 s.
pub fn case() -> Case {
    let quantity = |name: &str, unit, measure, expect| Quantity {
        column: None,
        name: name.into(),
        measure,
        unit,
        agree: Some(ToleranceBand::Relative(0.01)),
        agree_from: 0.0,
        agree_over: 0.0,
        expect,
    };
    Case {
        name: "heated-column".into(),
        title: "Hot air heats a column of ten spheres".into(),
        path: PathBuf::from("heated-column.toml"),
        hash: "0123456789abcdef".repeat(4),
        warnings: Vec::new(),
        changes: Vec::new(),
        files: Default::default(),
        effective: "format = 1\n".into(),
        lines: Vec::new(),
        time: TimeSpec {
            end: seconds(20.0),
            process_step: None,
            window_bounds: None,
            motion_window: seconds(0.01),
            acceleration: Acceleration::constant(50.0).unwrap(),
            storage: GasStorage::Process,
            checkpoint_every: None,
            checkpoint_wall: None,
        },
        mesh: MeshSpec::Box {
            origin: Vec3::zeros(),
            size: Vec3::from(SIZE),
            cells: CELLS,
            grading: Default::default(),
            refine: vec![],
            cut: vec![],
            openings: vec![],
            patches: ["side", "side", "side", "side", "bottom", "top"].map(String::from),
        },
        materials: vec![],
        chemistry: Default::default(),
        contacts: vec![],
        walls: vec![],
        wall_temperatures: vec![],
        wall_bodies: vec![],
        bodies: vec![],
        body_materials: vec![],
        left_out_of_walls: Vec::new(),
        motion: None,
        feeds: vec![],
        outlets: vec![],
        gas_held: false,
        gravity_is_stated: true,
        gas_files: vec![],
        gas: gas_setup(),
        particles: vec![],
        laws: Laws {
            momentum: Default::default(),
            drag: LawChoice::named(DRAG_LAWS, "ergun-wen-yu", Vec::new()).unwrap(),
            conduction: ConductionSpec {
                law: LawChoice::named(CONDUCTION_LAWS, NONE, Vec::new()).unwrap(),
                area: ConductionArea::Overlap,
                gap: LawChoice::named(GAP_LAWS, NONE, Vec::new()).unwrap(),
            },
            radiation: None,
            heat_transfer: LawChoice::named(HEAT_TRANSFER_LAWS, "gunn", Vec::new()).unwrap(),
            heat_film: FilmTemperature::Gas,
            mass_transfer: LawChoice::named(HEAT_TRANSFER_LAWS, NONE, Vec::new()).unwrap(),
            film_diffusivity: Default::default(),
            bed_eddies: LawChoice::named(BED_EDDY_LAWS, NONE, Vec::new()).unwrap(),
            film: FilmTheory {
                temperature: FilmTemperature::TwoThirds,
                stefan_flow: StefanFlow::Mass,
            },
        },
        coupling: Coupling {
            mapping: MappingSpec::Overlap,
            max_solid_fraction: 0.64,
            diffusion_length: None,
            excluded: vec![],
            smoother_tolerance: 1e-12,
            exchange_tolerance: 1e-10,
            exchange_attempts: 20,
            exchange_cuts: 0,
            window_drag: Default::default(),
            deadline: Duration::from_secs(10),
        },
        openfoam: ExternalSpec::default(),
        liggghts: ExternalSpec::default(),
        external_gas: None,
        external_particles: None,
        output: Output {
            every: seconds(5.0),
            series_every: Some(seconds(0.7)),
            gas: ["temperature", "velocity", "pressure", "void_fraction"]
                .map(String::from)
                .into(),
            particles: ["temperature", "heat"].map(String::from).into(),
            means: None,
        },
        probes: vec![Probe {
            name: "axis".into(),
            points: (0..25)
                .map(|i| Vec3::new(0.005, 0.005, 0.005 * f64::from(i)))
                .collect(),
            gas: true,
            particles: true,
        }],
        agreement: Default::default(),
        quantities: vec![
            quantity(
                "pressure_drop",
                "Pa",
                Measure::Difference {
                    field: "pressure".into(),
                    patches: ["bottom".into(), "top".into()],
                },
                Some(Expect {
                    at: Some(10.0),
                    value: 18.0,
                    within: ToleranceBand::Relative(0.01),
                }),
            ),
            quantity(
                "top_temperature",
                "K",
                Measure::Particle {
                    field: "temperature".into(),
                    number: 10,
                },
                None,
            ),
            quantity(
                "mean_temperature",
                "K",
                Measure::Particles {
                    field: "temperature".into(),
                    over: ParticlePlace::EVERYWHERE,
                    statistic: Statistic::Mean,
                },
                Some(Expect {
                    at: None,
                    value: 500.0,
                    within: ToleranceBand::Absolute(1.0),
                }),
            ),
        ],
    }
}

fn gas_setup() -> GasSetup {
    GasSetup {
        mixture: "air".into(),
        properties: GasProperties {
            molar_mass: 0.02896,
            heat_capacity: 1007.0,
            sutherland_coefficient: 1.4792e-6,
            sutherland_temperature: 116.0,
        }
        .into(),
        schmidt: 1.0,
        chemistry: Default::default(),
        composition: Vec::new(),
        storage: GasStorage::Process,
        temperature: 300.0,
        pressure: 101_325.0,
        velocity: Vec3::zeros(),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        pressure_gradient: Vec3::zeros(),
        turbulence: Default::default(),
        momentum: Default::default(),
        patches: vec![],
        controls: GasControls {
            convection: Convection::Upwind,
            outer_iterations: 50,
            pressure_corrections: 2,
            time_scheme: Default::default(),
            most_pressure_corrections: 16,
            outer_tolerance: 1e-10,
            linear_tolerance: Some(1e-12),
        },
    }
}

/// Ten particles on the axis and the fields at one time; everything is a function of time, so that
/// a resumed run takes the same path.
pub struct World {
    pub mesh: Mesh,
    pub clocks: Clocks,
    windows: u64,
    window: Option<Window>,
    pub ledger: Ledger,
    bed: Bed,
    gas: Gas,
    id: Vec<u64>,
    population: Vec<u32>,
    position: Vec<Vec3>,
    still: Vec<Vec3>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    pub temperature: Vec<f64>,
    heat: Vec<f64>,
    models: ParticleModels,
    bodies: calcine_coupler::bodies::HeatBodies,
    convergence: Convergence,
    timing: Timing,
    about: [SolverInfo; 2],
    /// Temperature added to every particle, to make two runs differ.
    pub shift: f64,
}

/// Fields of the gas.
struct Gas {
    temperature: Vec<f64>,
    pressure: Vec<f64>,
    density: Vec<f64>,
    velocity: Vec<Vec3>,
    pressure_gradient: Vec<Vec3>,
}

impl World {
    pub fn new() -> Self {
        Self::on(duct())
    }

    pub fn on(mesh: Mesh) -> Self {
        let cells = mesh.cells();
        let about = |name: &str| SolverInfo {
            name: name.into(),
            version: "0.1.0".into(),
            ranks: 1,
        };
        let mut world = Self {
            bed: Bed {
                void_fraction: mesh
                    .cell_centre()
                    .iter()
                    .map(|x| {
                        if x.z < 0.11 && x.z > 0.01 {
                            0.4764
                        } else {
                            1.0
                        }
                    })
                    .collect(),
            },
            gas: Gas {
                temperature: vec![300.0; cells],
                pressure: vec![101_325.0; cells],
                density: vec![1.2; cells],
                velocity: vec![Vec3::new(0.0, 0.0, 0.5); cells],
                pressure_gradient: vec![Vec3::new(0.0, 0.0, -150.0); cells],
            },
            mesh,
            clocks: Clocks::default(),
            windows: 0,
            window: None,
            ledger: Ledger::default(),
            id: (1..=10).collect(),
            population: vec![0; 10],
            position: (0..10)
                .map(|n| Vec3::new(0.005, 0.005, 0.015 + 0.01 * n as f64))
                .collect(),
            still: vec![Vec3::zeros(); 10],
            radius: vec![0.005; 10],
            mass: vec![1.3e-3; 10],
            temperature: vec![300.0; 10],
            heat: vec![0.0; 10],
            models: ParticleModels::default(),
            bodies: Default::default(),
            convergence: Convergence::default(),
            timing: Timing::default(),
            about: [about("Calcine gas"), about("Calcine particles")],
            shift: 0.0,
        };
        world.evaluate();
        world
    }

    /// The front: 300 K above, 400 K below, moving up.
    fn front(&self, z: f64) -> f64 {
        let time = self.clocks.process.seconds();
        let height = 0.12 * time / 20.0 * 1.4 - 0.02;
        300.0 + 100.0 / (1.0 + ((z - height) / 0.012).exp())
    }

    fn evaluate(&mut self) {
        for cell in 0..self.mesh.cells() {
            let z = self.mesh.cell_centre()[cell].z;
            self.gas.temperature[cell] = self.front(z) + 2.0;
            self.gas.pressure[cell] = 101_325.0 + 150.0 * (0.12 - z);
        }
        for n in 0..10 {
            self.temperature[n] = self.front(self.position[n].z) + self.shift;
            self.heat[n] = 0.01 * (400.0 - self.temperature[n]);
        }
    }

    /// Moves on by one window of the case.
    pub fn step(&mut self, case: &Case) {
        let span = case
            .time
            .acceleration
            .span(self.clocks, case.time.motion_window, case.time.end)
            .unwrap();
        self.window = Some(Window {
            index: self.windows,
            attempt: 0,
            start: self.clocks,
            span,
        });
        self.clocks = self.clocks.advanced(span).unwrap();
        self.windows += 1;
        self.evaluate();
        self.ledger
            .energy
            .book(1e-13, 3.0 + self.clocks.process.seconds());
        self.ledger.mass.book(-2e-16, 1e-3);
        self.convergence = Convergence {
            outer_iterations: 4,
            linear_iterations: 60,
            residual: 1e-11 * (2.0 + (self.windows as f64).sin()),
            volume_residual: 1e-9,
            converged: true,
        };
        self.timing.gas += Duration::from_millis(7);
        self.timing.interior += Duration::from_millis(1);
        self.timing.smoother += Duration::from_millis(2);
        self.timing.exchange += Duration::from_millis(3);
    }

    /// The world as an observer sees it.
    pub fn moment(&self) -> CommittedState<'_> {
        CommittedState {
            windows: self.windows,
            clocks: self.clocks,
            window: self.window.as_ref(),
            mesh: &self.mesh,
            gas: GasFields {
                composition: &[],
                temperature: &self.gas.temperature,
                pressure: &self.gas.pressure,
                density: &self.gas.density,
                velocity: &self.gas.velocity,
                pressure_gradient: &self.gas.pressure_gradient,
                turbulence: Default::default(),
            },
            bed: &self.bed,
            smoothed_share: 0.0,
            particles: ParticleFields {
                id: &self.id,
                population: &self.population,
                position: &self.position,
                velocity: &self.still,
                angular_velocity: &self.still,
                radius: &self.radius,
                mass: &self.mass,
                weight: &[],
            },
            particle_temperature: &self.temperature,
            particle_heat: &self.heat,
            particle_mass: &self.mass,
            models: &self.models,
            particle_gas: Default::default(),
            findings: &[],
            step_error: None,
            courant: None,
            exchange_convergence: &SETTLED,
            patch_flows: &[],
            outlets: &[],
            bodies: &self.bodies,
            reservoirs: &[],
            reservoir_heat: &[],
            ledger: &self.ledger,
            waiting: 0.0,
            convergence: &self.convergence,
            timing: &self.timing,
            about: [&self.about[0], &self.about[1]],
        }
    }
}

/// What the caller says of a run.
pub fn info() -> RunInfo {
    RunInfo {
        gas: "native".into(),
        particles: "native".into(),
        transport: "none".into(),
        from: None,
    }
}

/// Runs the case to its end with results in `out`; particles `shift` K hotter.
pub fn run(case: &Case, out: &Path, shift: f64) -> Recorder {
    run_on(duct(), case, out, shift)
}

/// The same on a mesh.
pub fn run_on(mesh: Mesh, case: &Case, out: &Path, shift: f64) -> Recorder {
    let mut world = World::on(mesh);
    world.shift = shift;
    world.evaluate();
    let mut recorder = Recorder::create(case, info(), out, None).unwrap();
    recorder.start(&world.moment()).unwrap();
    while world.clocks.process < case.time.end {
        world.step(case);
        recorder.window(&world.moment()).unwrap();
    }
    recorder.finish(&world.moment()).unwrap();
    recorder
}
