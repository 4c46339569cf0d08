//! A run without solvers: a duct with a temperature front that moves up through ten particles.

use std::path::{Path, PathBuf};
use std::time::Duration;

use calcine::case::model::*;
use calcine::results::{Recorder, RunInfo};
use calcine_coupler::ledger::Ledger;
use calcine_coupler::mesh::{Mesh, Patch, Topology};
use calcine_coupler::observer::{Moment, Observer, Timing};
use calcine_coupler::part::{About, Bed, Convergence, GasFields, ParticleFields};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::setup::{GasControls, GasSetup};
use calcine_coupler::time::{Acceleration, Clocks, GasStorage, Ticks, Window};

/// Cells along x, y and z of the duct, and its edge lengths in m.
const CELLS: [usize; 3] = [2, 2, 12];
const SIZE: [f64; 3] = [0.01, 0.01, 0.12];

/// A box of hexahedra with the patches `side`, `bottom`, `top`.
pub fn duct() -> Mesh {
    let [nx, ny, nz] = CELLS;
    let point = |i: usize, j: usize, k: usize| (i + (nx + 1) * (j + (ny + 1) * k)) as u32;
    let cell = |i: usize, j: usize, k: usize| (i + nx * (j + ny * k)) as u32;
    let mut topology = Topology::default();
    for (k, j, i) in triples(nz + 1, ny + 1, nx + 1) {
        let at = |n: usize, axis: usize| n as f64 * SIZE[axis] / CELLS[axis] as f64;
        topology
            .points
            .push(Vec3::new(at(i, 0), at(j, 1), at(k, 2)));
    }
    let across = |i, j, k| {
        [
            point(i, j, k),
            point(i, j + 1, k),
            point(i, j + 1, k + 1),
            point(i, j, k + 1),
        ]
    };
    let along_y = |i, j, k| {
        [
            point(i, j, k),
            point(i, j, k + 1),
            point(i + 1, j, k + 1),
            point(i + 1, j, k),
        ]
    };
    let along_z = |i, j, k| {
        [
            point(i, j, k),
            point(i + 1, j, k),
            point(i + 1, j + 1, k),
            point(i, j + 1, k),
        ]
    };
    let (mut inner, mut side, mut bottom, mut top) = (vec![], vec![], vec![], vec![]);
    for (k, j, i) in triples(nz, ny, nx) {
        let own = cell(i, j, k);
        if i + 1 < nx {
            inner.push((own, Some(cell(i + 1, j, k)), across(i + 1, j, k)));
        } else {
            side.push((own, None, across(nx, j, k)));
        }
        if i == 0 {
            side.push((own, None, reversed(across(0, j, k))));
        }
        if j + 1 < ny {
            inner.push((own, Some(cell(i, j + 1, k)), along_y(i, j + 1, k)));
        } else {
            side.push((own, None, along_y(i, ny, k)));
        }
        if j == 0 {
            side.push((own, None, reversed(along_y(i, 0, k))));
        }
        if k + 1 < nz {
            inner.push((own, Some(cell(i, j, k + 1)), along_z(i, j, k + 1)));
        } else {
            top.push((own, None, along_z(i, j, nz)));
        }
        if k == 0 {
            bottom.push((own, None, reversed(along_z(i, j, 0))));
        }
    }
    finish(topology.points, [inner, side, bottom, top])
}

/// A face: owner, neighbour, points.
type Face<P> = (u32, Option<u32>, P);

/// The mesh of internal faces, then those of `side`, `bottom`, `top`.
fn finish<P: AsRef<[u32]>>(points: Vec<Vec3>, faces: [Vec<Face<P>>; 4]) -> Mesh {
    let mut topology = Topology {
        points,
        face_offsets: vec![0],
        ..Topology::default()
    };
    let mut start = faces[0].len();
    for (name, list) in ["side", "bottom", "top"].into_iter().zip(&faces[1..]) {
        topology.patches.push(Patch {
            name: name.into(),
            start,
            count: list.len(),
        });
        start += list.len();
    }
    for (owner, neighbour, points) in faces.into_iter().flatten() {
        topology.owner.push(owner);
        topology.neighbour.extend(neighbour);
        topology.face_points.extend(points.as_ref());
        let end = topology.face_points.len() as u32;
        topology.face_offsets.push(end);
    }
    Mesh::new(topology).unwrap()
}

/// The same duct of twelve layers, each of two prisms on either side of a diagonal.
pub fn prisms() -> Mesh {
    let layers = CELLS[2] as u32;
    let mut points = Vec::new();
    for layer in 0..=layers {
        let z = f64::from(layer) * SIZE[2] / f64::from(layers);
        for (x, y) in [
            (0.0, 0.0),
            (SIZE[0], 0.0),
            (SIZE[0], SIZE[1]),
            (0.0, SIZE[1]),
        ] {
            points.push(Vec3::new(x, y, z));
        }
    }
    let (mut inner, mut side, mut bottom, mut top) = (vec![], vec![], vec![], vec![]);
    for layer in 0..layers {
        let (low, high) = (4 * layer, 4 * layer + 4);
        // The walls of corner a to corner b, seen from outside.
        let wall = |a: u32, b: u32| vec![low + a, low + b, high + b, high + a];
        let (right, left) = (2 * layer, 2 * layer + 1);
        inner.push((right, Some(left), wall(2, 0)));
        side.extend([(right, None, wall(0, 1)), (right, None, wall(1, 2))]);
        side.extend([(left, None, wall(2, 3)), (left, None, wall(3, 0))]);
        for (cell, corners) in [(right, [0, 1, 2]), (left, [0, 2, 3])] {
            let lid = corners.map(|corner| high + corner).to_vec();
            if layer + 1 < layers {
                inner.push((cell, Some(cell + 2), lid));
            } else {
                top.push((cell, None, lid));
            }
            if layer == 0 {
                bottom.push((cell, None, corners.into_iter().rev().collect()));
            }
        }
    }
    finish(points, [inner, side, bottom, top])
}

fn triples(a: usize, b: usize, c: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..a).flat_map(move |k| (0..b).flat_map(move |j| (0..c).map(move |i| (k, j, i))))
}

fn reversed(mut points: [u32; 4]) -> [u32; 4] {
    points.reverse();
    points
}

fn seconds(time: f64) -> Ticks {
    Ticks::from_seconds(time).unwrap()
}

/// A case of 20 s at AF 50 in windows of 10 ms, with rows each 0.7 s and snapshots each 5 s.
pub fn case() -> Case {
    let quantity = |name: &str, unit, measure, expect| Quantity {
        name: name.into(),
        measure,
        unit,
        agree: Some(Band::Relative(0.01)),
        expect,
    };
    Case {
        name: "heated-column".into(),
        title: "Hot air heats a column of ten spheres".into(),
        path: PathBuf::from("heated-column.toml"),
        hash: "0123456789abcdef".repeat(4),
        effective: "format = 1\n".into(),
        time: Time {
            end: seconds(20.0),
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
            patches: ["side", "side", "side", "side", "bottom", "top"].map(String::from),
        },
        materials: vec![],
        gas: gas_setup(),
        particles: vec![],
        laws: Laws {
            drag: DragLaw::ErgunWenYu,
            heat_transfer: HeatLaw::Gunn,
        },
        coupling: Coupling {
            mapping: Mapping::Overlap,
            max_solid_fraction: 0.64,
            smoother_tolerance: 1e-12,
            exchange_tolerance: 1e-10,
            exchange_attempts: 20,
            deadline: Duration::from_secs(10),
        },
        openfoam: External::default(),
        liggghts: External::default(),
        output: Output {
            every: seconds(5.0),
            series_every: Some(seconds(0.7)),
            gas: ["temperature", "velocity", "pressure", "void_fraction"]
                .map(String::from)
                .into(),
            particles: ["temperature", "heat"].map(String::from).into(),
        },
        probes: vec![Probe {
            name: "axis".into(),
            from: Vec3::new(0.005, 0.005, 0.0),
            to: Vec3::new(0.005, 0.005, 0.12),
            points: 25,
        }],
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
                    within: Band::Relative(0.01),
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
                    statistic: Statistic::Mean,
                },
                Some(Expect {
                    at: None,
                    value: 500.0,
                    within: Band::Absolute(1.0),
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
        },
        storage: GasStorage::Process,
        temperature: 300.0,
        pressure: 101_325.0,
        velocity: Vec3::zeros(),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        patches: vec![],
        controls: GasControls {
            outer_iterations: 50,
            pressure_corrections: 2,
            outer_tolerance: 1e-10,
            linear_tolerance: 1e-12,
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
    ledger: Ledger,
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
    convergence: Convergence,
    timing: Timing,
    about: [About; 2],
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
        let about = |name: &str| About {
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
    pub fn moment(&self) -> Moment<'_> {
        Moment {
            windows: self.windows,
            clocks: self.clocks,
            window: self.window.as_ref(),
            mesh: &self.mesh,
            gas: GasFields {
                temperature: &self.gas.temperature,
                pressure: &self.gas.pressure,
                density: &self.gas.density,
                velocity: &self.gas.velocity,
                pressure_gradient: &self.gas.pressure_gradient,
            },
            bed: &self.bed,
            particles: ParticleFields {
                id: &self.id,
                population: &self.population,
                position: &self.position,
                velocity: &self.still,
                angular_velocity: &self.still,
                radius: &self.radius,
                mass: &self.mass,
            },
            particle_temperature: &self.temperature,
            particle_heat: &self.heat,
            ledger: &self.ledger,
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
