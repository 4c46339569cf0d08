//! A duct of twelve cells with the real solver.

// Each test file uses its own part of this.
#![allow(dead_code)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::gas::LinkedGas;
use calcine_adapters::launch::Launcher;
use calcine_adapters::openfoam::OpenfoamLaunch;
use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::error::PartError;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{Bed, CellExchange, CellReceived, Convergence, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::{
    Convection, GasControls, GasPatch, GasSetup, InletFlow, Schedule, WallHeat, WallVelocity,
};
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, GasStorage, Ticks, Window};

/// Cells along the duct.
pub const CELLS: usize = 12;
/// Side of the duct, and height of a cell, in m.
pub const SIDE: f64 = 0.01;
/// Superficial velocity in m/s.
pub const SPEED: f64 = 0.5;
/// Reference pressure in Pa.
pub const PRESSURE: f64 = 101_325.0;
/// Start temperature, and that of the inlet unless a test changes it, in K.
pub const TEMPERATURE: f64 = 300.0;

/// The duct of `cases/heated-column.toml`, divided as wanted.
pub fn mesh(cells: [usize; 3]) -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(SIDE, SIDE, SIDE * CELLS as f64),
        cells,
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    })
    .unwrap()
}

/// Air that flows upwards.
pub fn setup() -> GasSetup {
    let wall = || GasPatch::Wall {
        velocity: WallVelocity::Slip,
        heat: WallHeat::Adiabatic,
    };
    let mesh = mesh([1, 1, CELLS]);
    let patches = mesh.patches().iter().map(|patch| {
        let condition = match patch.name.as_str() {
            "bottom" => GasPatch::inlet(Schedule::constant(SPEED), Schedule::constant(TEMPERATURE)),
            "top" => GasPatch::outlet(Schedule::constant(PRESSURE)),
            _ => wall(),
        };
        (patch.name.clone(), condition)
    });
    GasSetup {
        mixture: "air".into(),
        properties: GasProperties::air().into(),
        schmidt: 1.0,
        chemistry: Default::default(),
        composition: Vec::new(),
        storage: GasStorage::Process,
        temperature: TEMPERATURE,
        pressure: PRESSURE,
        velocity: Vec3::new(0.0, 0.0, SPEED),
        gravity: Vec3::zeros(),
        pressure_gradient: Vec3::zeros(),
        turbulence: Default::default(),
        momentum: Default::default(),
        patches: patches.collect(),
        controls: GasControls {
            outer_iterations: 50,
            convection: Convection::Upwind,
            pressure_corrections: 2,
            time_scheme: Default::default(),
            most_pressure_corrections: 16,
            outer_tolerance: 1e-11,
            linear_tolerance: Some(1e-13),
        },
    }
}

/// Air with hardly any viscosity, and so hardly any conduction.
pub fn inviscid() -> GasModel {
    GasProperties {
        sutherland_coefficient: 1e-16,
        ..GasProperties::air()
    }
    .into()
}

/// Nothing flows in.
pub fn stop(setup: &mut GasSetup) {
    for (_, patch) in &mut setup.patches {
        if let GasPatch::Inlet { flow, .. } = patch {
            *flow = InletFlow::SuperficialVelocity(Schedule::constant(0.0));
        }
    }
}

/// No exchange in any number of cells.
pub fn exchange_of_nothing(cells: usize) -> CellExchange {
    CellExchange {
        drag_coefficient: vec![0.0; cells],
        drag_source: vec![Vec3::zeros(); cells],
        heat_coefficient: vec![0.0; cells],
        heat_source: vec![0.0; cells],
        ..CellExchange::default()
    }
}

/// No exchange in the twelve cells.
pub fn no_exchange() -> CellExchange {
    exchange_of_nothing(CELLS)
}

/// A bed that leaves this share of each cell.
pub fn bed(void_fraction: f64) -> Bed {
    Bed {
        void_fraction: vec![void_fraction; CELLS],
    }
}

/// A running gas with its supervisor, and the window to come.
pub struct Duct {
    pub gas: LinkedGas,
    pub supervisor: Supervisor,
    pub window: Window,
    pub received: CellReceived,
}

impl Duct {
    /// Starts the solver in a folder; windows of 1 ms, 50 times as long on the process clock.
    pub fn try_launch(
        mesh: Mesh,
        setup: &GasSetup,
        folder: &Path,
        resume: Option<&Path>,
    ) -> Result<Self, PartError> {
        Self::try_launch_on_ranks(1, mesh, setup, folder, resume)
    }

    /// The same on a number of ranks.
    pub fn try_launch_on_ranks(
        ranks: u32,
        mesh: Mesh,
        setup: &GasSetup,
        folder: &Path,
        resume: Option<&Path>,
    ) -> Result<Self, PartError> {
        let mut supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
        let launch = OpenfoamLaunch {
            setup,
            mesh: Arc::new(mesh),
            template: None,
            start: None,
            gas: None,
            solver: StockSolver::default(),
            case_hash: "test".into(),
            folder: folder.join("case"),
            log: folder.join("log"),
            ranks,
            launcher: Launcher::Mpirun,
            resume: resume.map(Path::to_owned),
            from: None,
            deadline: Duration::from_secs(30),
        };
        let gas = launch.launch(&mut supervisor)?;
        let span = Clocks {
            motion: Ticks::from_seconds(1e-3).unwrap(),
            process: Ticks::from_seconds(0.05).unwrap(),
        };
        Ok(Self {
            gas,
            supervisor,
            window: Window {
                span,
                ..Window::default()
            },
            received: CellReceived::default(),
        })
    }

    /// The same; the message of a failure says what is missing.
    pub fn launch(setup: &GasSetup, folder: &Path) -> Self {
        Self::launch_on(mesh([1, 1, CELLS]), setup, folder)
    }

    /// The same, on another mesh.
    pub fn launch_on(mesh: Mesh, setup: &GasSetup, folder: &Path) -> Self {
        Self::try_launch(mesh, setup, folder, None).unwrap_or_else(|error| panic!("{error}"))
    }

    /// One attempt.
    pub fn attempt(&mut self, bed: &Bed, exchange: &CellExchange) -> Convergence {
        self.gas.start(&self.window, bed, exchange).unwrap();
        self.gas
            .finish(&self.supervisor, &mut self.received)
            .unwrap_or_else(|error| panic!("{error}"))
    }

    /// Takes the last attempt.
    pub fn commit(&mut self) {
        self.gas.commit().unwrap();
        self.window.index += 1;
        self.window.start = self.window.end().unwrap();
    }

    /// Attempts and commits windows.
    pub fn advance(&mut self, windows: usize, bed: &Bed, exchange: &CellExchange) -> Convergence {
        let mut last = Convergence::default();
        for _ in 0..windows {
            last = self.attempt(bed, exchange);
            self.commit();
        }
        last
    }

    /// All bits of what the gas shows and received.
    pub fn bits(&self) -> Vec<u64> {
        let fields = self.gas.fields();
        let scalars = [
            fields.temperature,
            fields.pressure,
            fields.density,
            &self.received.heat,
        ];
        let vectors = [
            fields.velocity,
            fields.pressure_gradient,
            &self.received.drag,
        ];
        let scalars = scalars.into_iter().flatten().copied();
        let vectors = vectors.into_iter().flatten().flat_map(|v| [v.x, v.y, v.z]);
        scalars.chain(vectors).map(f64::to_bits).collect()
    }
}
