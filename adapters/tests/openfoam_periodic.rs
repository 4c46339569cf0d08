//! calcineGasFoam in periodic, plane and axisymmetric domains (docs/theory.md, BND-2, BND-3), against exact solutions and the native
//! gas' own discretisation of them.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::gas::LinkedGas;
use calcine_adapters::launch::Launcher;
use calcine_adapters::openfoam::OpenfoamLaunch;
use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::conformance::wedge::pipe_slice;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{Balance, Bed, CellReceived, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::{ConstantGas, GasModel};
use calcine_coupler::setup::{
    Convection, GasPatch, GasSetup, GasStart, TimeScheme, WallHeat, WallVelocity,
};
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};

use crate::openfoam_support::{exchange_of_nothing, setup};

pub fn fluid(viscosity: f64) -> GasModel {
    GasModel::Constant(ConstantGas {
        density: 1.0,
        heat_capacity: 1000.0,
        viscosity,
        conductivity: 1.0,
    })
}

fn periodic(with: &str) -> GasPatch {
    GasPatch::Periodic { with: with.into() }
}

fn no_slip() -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::NoSlip,
        heat: WallHeat::Adiabatic,
    }
}

pub fn at_rest(patches: &[(&str, GasPatch)]) -> GasSetup {
    let mut setup = setup();
    setup.velocity = Vec3::zeros();
    setup.patches = patches
        .iter()
        .map(|(name, patch)| ((*name).to_owned(), patch.clone()))
        .collect();
    setup.controls.outer_iterations = 100;
    setup.controls.outer_tolerance = 1e-9;
    setup.controls.linear_tolerance = Some(1e-12);
    setup
}

fn named_box(size: [f64; 3], cells: [usize; 3], pairs: &[[&str; 2]]) -> Mesh {
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: size.into(),
        cells,
        patches: ["left", "right", "lower", "upper", "front", "back"].map(str::to_owned),
    });
    let pairs: Vec<[String; 2]> = pairs.iter().map(|pair| pair.map(str::to_owned)).collect();
    mesh.unwrap().with_periodic(&pairs).unwrap()
}

/// A running gas, driven window by window in an empty domain.
pub struct Run {
    pub gas: LinkedGas,
    supervisor: Supervisor,
    window: Window,
    received: CellReceived,
    cells: usize,
    _folder: tempfile::TempDir,
}

impl Run {
    pub fn new(mesh: &Mesh, setup: &GasSetup, start: Option<&GasStart>, ranks: u32) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut supervisor = Supervisor::new(Duration::from_secs(60), Interrupts::default());
        let launch = OpenfoamLaunch {
            setup,
            mesh: Arc::new(mesh.clone()),
            template: None,
            start: None,
            gas: start,
            solver: StockSolver::default(),
            case_hash: "test".into(),
            folder: folder.path().join("case"),
            log: folder.path().join("log"),
            ranks,
            launcher: Launcher::Mpirun,
            resume: None,
            from: None,
            deadline: Duration::from_secs(60),
        };
        let gas = launch.launch(&mut supervisor);
        Self {
            gas: gas.unwrap_or_else(|error| panic!("{error}")),
            supervisor,
            window: Window::default(),
            received: CellReceived::default(),
            cells: mesh.cells(),
            _folder: folder,
        }
    }

    pub fn windows(&mut self, count: usize, span: f64) {
        let span = Ticks::from_seconds(span).unwrap();
        let bed = Bed {
            void_fraction: vec![1.0; self.cells],
        };
        let exchange = exchange_of_nothing(self.cells);
        for _ in 0..count {
            self.window.span = Clocks {
                motion: span,
                process: span,
            };
            self.gas.start(&self.window, &bed, &exchange).unwrap();
            self.gas
                .finish(&self.supervisor, &mut self.received)
                .unwrap_or_else(|error| panic!("{error}"));
            self.gas.commit().unwrap();
            self.window.index += 1;
            self.window.start = self.window.end().unwrap();
        }
    }
}

fn closure(balance: &Balance) -> f64 {
    let error = balance.stored - balance.boundary - balance.exchange - balance.source;
    let parts = [
        balance.stored_magnitude,
        balance.boundary_magnitude,
        balance.source_magnitude,
    ];
    error.abs() / parts.into_iter().fold(f64::MIN_POSITIVE, f64::max)
}

pub fn rms(mesh: &Mesh, error: impl Fn(usize) -> f64) -> f64 {
    let volume = mesh.cell_volume();
    let sum: f64 = (0..mesh.cells())
        .map(|cell| volume[cell] * error(cell).powi(2))
        .sum();
    (sum / volume.iter().sum::<f64>()).sqrt()
}

pub fn orders(errors: &[f64]) -> Vec<f64> {
    let pairs = errors.windows(2);
    pairs.map(|pair| (pair[0] / pair[1]).log2()).collect()
}

/// As natively: beside the exact profile half cells at the walls add G h²/(8 μ).
#[test]
fn a_pressure_gradient_drives_plane_poiseuille_flow_on_one_rank_and_on_two() {
    let (gradient, viscosity, height, across) = (0.5, 0.1, 0.1, 12);
    let mesh = named_box([0.02, height, 0.01], [4, across, 1], &[["left", "right"]]);
    let mut setup = at_rest(&[
        ("left", periodic("right")),
        ("right", periodic("left")),
        ("lower", no_slip()),
        ("upper", no_slip()),
        ("front", GasPatch::Empty),
        ("back", GasPatch::Empty),
    ]);
    setup.properties = fluid(viscosity);
    setup.pressure_gradient = Vec3::new(-gradient, 0.0, 0.0);
    for ranks in [1, 2] {
        let mut run = Run::new(&mesh, &setup, None, ranks);
        run.windows(15, 10.0);
        let fields = run.gas.fields();
        let step = height / across as f64;
        for (cell, velocity) in fields.velocity.iter().enumerate() {
            let y = mesh.cell_centre()[cell].y;
            let expected = gradient * y * (height - y) / (2.0 * viscosity)
                + gradient * step * step / (8.0 * viscosity);
            assert!(
                (velocity.x / expected - 1.0).abs() < 1e-8,
                "{velocity} {expected}"
            );
            assert!(
                velocity.y.abs() < 1e-10 && velocity.z.abs() < 1e-14,
                "{velocity}"
            );
            assert!((fields.pressure_gradient[cell].x + gradient).abs() < 1e-8);
        }
        let momentum = &run.received.momentum[0];
        assert!(closure(momentum) < 1e-10, "{momentum:?}");
    }
}

/// The vortices of Taylor and Green carried by a mean flow through the planes.
#[test]
fn vortices_are_carried_through_periodic_planes_with_order_two() {
    let (viscosity, end) = (0.01, 0.4);
    let mean = Vec3::new(1.0, 0.5, 0.0);
    let exact = |at: Vec3, time: f64| {
        let place = 2.0 * PI * (at - time * mean);
        let decay = (-8.0 * PI * PI * viscosity * time).exp();
        let (x, y) = (place.x, place.y);
        mean + decay * Vec3::new(x.sin() * y.cos(), -x.cos() * y.sin(), 0.0)
    };
    let mut errors = Vec::new();
    for cells in [12, 24, 48] {
        let pairs = [["left", "right"], ["lower", "upper"]];
        let mesh = named_box([1.0, 1.0, 0.1], [cells, cells, 1], &pairs);
        let mut setup = at_rest(&[
            ("left", periodic("right")),
            ("right", periodic("left")),
            ("lower", periodic("upper")),
            ("upper", periodic("lower")),
            ("front", GasPatch::Empty),
            ("back", GasPatch::Empty),
        ]);
        setup.properties = fluid(viscosity);
        setup.controls.convection = Convection::Central(1.0);
        setup.controls.time_scheme = TimeScheme::Sdirk2;
        let start = GasStart {
            temperature: vec![300.0; mesh.cells()],
            pressure: vec![101_325.0; mesh.cells()],
            velocity: mesh
                .cell_centre()
                .iter()
                .map(|at| exact(*at, 0.0))
                .collect(),
            ..GasStart::default()
        };
        let mut run = Run::new(&mesh, &setup, Some(&start), 1);
        run.windows(2 * cells, end / (2 * cells) as f64);
        // Nothing is warmer than the rest, so that there is no heat whose balance could be judged.
        assert!(closure(&run.received.mass) < 1e-10);
        let velocity = run.gas.fields().velocity;
        errors.push(rms(&mesh, |cell| {
            (velocity[cell] - exact(mesh.cell_centre()[cell], end)).norm()
        }));
    }
    let orders = orders(&errors);
    println!("errors {errors:?} m/s, orders {orders:?}");
    assert!(orders.iter().all(|order| *order > 1.8), "{orders:?}");
}

#[test]
fn a_slice_of_a_pipe_has_the_profile_of_poiseuille_to_order_two() {
    let (gradient, viscosity, radius) = (0.5, 0.1, 0.05);
    let mut errors = Vec::new();
    for across in [8, 16] {
        let pairs = [["bottom".to_owned(), "top".to_owned()]];
        let mesh = pipe_slice(radius, 0.02, [across, 3], 5.0).unwrap();
        let mesh = mesh.with_periodic(&pairs).unwrap();
        let mut setup = at_rest(&[
            ("wall", no_slip()),
            ("front", GasPatch::Wedge),
            ("back", GasPatch::Wedge),
            ("bottom", periodic("top")),
            ("top", periodic("bottom")),
        ]);
        setup.properties = fluid(viscosity);
        setup.pressure_gradient = Vec3::new(0.0, 0.0, -gradient);
        let mut run = Run::new(&mesh, &setup, None, 1);
        run.windows(15, 1.0);
        let fields = run.gas.fields();
        errors.push(rms(&mesh, |cell| {
            let r = mesh.cell_centre()[cell].x;
            let exact = gradient * (radius * radius - r * r) / (4.0 * viscosity);
            (fields.velocity[cell] - Vec3::new(0.0, 0.0, exact)).norm()
        }));
        assert!(closure(&run.received.momentum[2]) < 1e-10);
    }
    let orders = orders(&errors);
    println!("errors {errors:?} m/s, orders {orders:?}");
    assert!(orders.iter().all(|order| *order > 1.9), "{orders:?}");
}
