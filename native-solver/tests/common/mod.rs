//! What the gas tests share: meshes, setups, and a driver of windows.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{Bed, CellExchange, CellReceived, Convergence, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::physics::gas_model::{ConstantGas, GasModel};
pub use calcine_coupler::setup::GasSetup;
use calcine_coupler::setup::{
    Convection, GasControls, GasPatch, InletScalars, Schedule, WallHeat, WallVelocity,
};
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, GasStorage, Ticks, Window};
use calcine_native::gas::NativeGas;

/// Air as the cases have it.
pub const AIR: GasProperties = GasProperties {
    molar_mass: 0.028_96,
    heat_capacity: 1005.0,
    sutherland_coefficient: 1.4792e-6,
    sutherland_temperature: 116.0,
};
/// One atmosphere in Pa.
pub const ATMOSPHERE: f64 = 101_325.0;

/// Air without viscosity, and so without conduction.
pub fn inviscid() -> GasModel {
    GasProperties {
        sutherland_coefficient: 1e-30,
        ..AIR
    }
    .into()
}

/// A fluid of constant density, round numbers for water.
pub fn water() -> GasModel {
    GasModel::Constant(ConstantGas {
        density: 1000.0,
        heat_capacity: 4000.0,
        viscosity: 1e-3,
        conductivity: 0.6,
    })
}

/// A fluid of constant properties: density in kg/m³, c_p in J/kg/K, viscosity in Pa s, conductivity
/// in W/m/K.
pub fn fluid(density: f64, heat_capacity: f64, viscosity: f64, conductivity: f64) -> GasModel {
    GasModel::Constant(ConstantGas {
        density,
        heat_capacity,
        viscosity,
        conductivity,
    })
}

/// A no-slip wall with heat through it.
pub fn wall(heat: WallHeat) -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::NoSlip,
        heat,
    }
}

/// A slip wall with heat through it.
pub fn slip_wall(heat: WallHeat) -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::Slip,
        heat,
    }
}

/// Observed orders between errors on meshes (or with steps) each twice as fine as the one before.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    let pairs = errors.windows(2);
    pairs.map(|pair| (pair[0] / pair[1]).log2()).collect()
}

/// Root mean square over cells, weighted by their volumes.
pub fn rms(mesh: &Mesh, error: impl Fn(usize) -> f64) -> f64 {
    let volume = mesh.cell_volume();
    let sum: f64 = (0..mesh.cells())
        .map(|c| volume[c] * error(c).powi(2))
        .sum();
    (sum / volume.iter().sum::<f64>()).sqrt()
}

/// A box with `bottom` and `top` across z and four sides named `side`.
pub fn duct(size: [f64; 3], cells: [usize; 3]) -> Arc<Mesh> {
    let patches = ["side", "side", "side", "side", "bottom", "top"];
    named_box(size, cells, patches)
}

pub fn named_box(size: [f64; 3], cells: [usize; 3], patches: [&str; 6]) -> Arc<Mesh> {
    let spec = BoxSpec {
        origin: Vec3::zeros(),
        size: size.into(),
        cells,
        patches: patches.map(str::to_owned),
    };
    Arc::new(box_mesh(&spec).unwrap())
}

pub fn inlet(velocity: f64, temperature: f64) -> GasPatch {
    GasPatch::inlet(
        Schedule::constant(velocity),
        Schedule::constant(temperature),
    )
}

/// An inlet whose temperature holds at the face.
pub fn holding_inlet(velocity: f64, temperature: f64) -> GasPatch {
    let mut patch = inlet(velocity, temperature);
    if let GasPatch::Inlet { scalars, .. } = &mut patch {
        *scalars = InletScalars::Value;
    }
    patch
}

pub fn outlet() -> GasPatch {
    GasPatch::outlet(Schedule::constant(ATMOSPHERE))
}

pub fn slip() -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::Slip,
        heat: WallHeat::Adiabatic,
    }
}

pub fn no_slip() -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::NoSlip,
        heat: WallHeat::Adiabatic,
    }
}

pub fn warm_wall(temperature: f64) -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::NoSlip,
        heat: WallHeat::Temperature(Schedule::constant(temperature)),
    }
}

/// Air of 300 K at rest, without gravity, solved tightly.
pub fn setup(patches: &[(&str, GasPatch)]) -> GasSetup {
    GasSetup {
        mixture: "air".into(),
        properties: AIR.into(),
        schmidt: 1.0,
        chemistry: Default::default(),
        composition: Vec::new(),
        storage: GasStorage::Process,
        temperature: 300.0,
        pressure: ATMOSPHERE,
        velocity: Vec3::zeros(),
        gravity: Vec3::zeros(),
        pressure_gradient: Vec3::zeros(),
        turbulence: Default::default(),
        momentum: Default::default(),
        patches: patches
            .iter()
            .map(|(name, patch)| ((*name).to_owned(), patch.clone()))
            .collect(),
        controls: GasControls {
            outer_iterations: 50,
            convection: Convection::Upwind,
            pressure_corrections: 2,
            time_scheme: Default::default(),
            most_pressure_corrections: 16,
            outer_tolerance: 1e-9,
            linear_tolerance: Some(1e-12),
        },
    }
}

/// A gas with its inputs, driven window by window.
pub struct Driver {
    pub gas: NativeGas,
    pub bed: Bed,
    pub exchange: CellExchange,
    pub received: CellReceived,
    pub clocks: Clocks,
    pub index: u64,
    supervisor: Supervisor,
}

impl Driver {
    /// An empty duct: void fraction 1, no exchange.
    pub fn new(mesh: &Arc<Mesh>, setup: &GasSetup) -> Self {
        let cells = mesh.cells();
        Self {
            gas: NativeGas::new(mesh.clone(), setup).unwrap(),
            bed: Bed {
                void_fraction: vec![1.0; cells],
            },
            exchange: CellExchange {
                drag_coefficient: vec![0.0; cells],
                drag_source: vec![Vec3::zeros(); cells],
                heat_coefficient: vec![0.0; cells],
                heat_source: vec![0.0; cells],
                ..CellExchange::default()
            },
            received: CellReceived::default(),
            clocks: Clocks::default(),
            index: 0,
            supervisor: Supervisor::new(Duration::from_secs(60), Interrupts::default()),
        }
    }

    /// An attempt of a window of this motion span in s, at an acceleration factor.
    pub fn attempt(&mut self, motion: f64, factor: f64) -> (Window, Convergence) {
        let window = Window {
            index: self.index,
            attempt: 0,
            start: self.clocks,
            span: Clocks {
                motion: Ticks::from_seconds(motion).unwrap(),
                process: Ticks::from_seconds(motion * factor).unwrap(),
            },
        };
        self.gas.start(&window, &self.bed, &self.exchange).unwrap();
        let result = self.gas.finish(&self.supervisor, &mut self.received);
        (window, result.unwrap())
    }

    /// A window: an attempt and its commit.
    pub fn window(&mut self, motion: f64, factor: f64) -> Convergence {
        let (window, convergence) = self.attempt(motion, factor);
        self.gas.commit().unwrap();
        self.clocks = window.end().unwrap();
        self.index += 1;
        convergence
    }

    /// Windows until one changes temperature, velocity and pressure gradient by less than 1e-12
    /// of their largest value.
    pub fn settle(&mut self, motion: f64, factor: f64, most: usize) {
        let mut before = self.values();
        for _ in 0..most {
            self.window(motion, factor);
            let now = self.values();
            let small = |(old, new): (&Vec<f64>, &Vec<f64>)| {
                let largest = new.iter().fold(0.0f64, |most, x| most.max(x.abs()));
                old.iter()
                    .zip(new)
                    .all(|(old, new)| (old - new).abs() <= 1e-12 * largest)
            };
            if before.iter().zip(&now).all(small) {
                return;
            }
            before = now;
        }
        panic!("not steady after {most} windows");
    }

    fn values(&self) -> [Vec<f64>; 3] {
        let fields = self.gas.fields();
        [
            fields.temperature.to_vec(),
            fields.velocity.iter().flatten().copied().collect(),
            fields.pressure_gradient.iter().flatten().copied().collect(),
        ]
    }

    /// All fields as bits.
    pub fn bits(&self) -> Vec<u64> {
        let fields = self.gas.fields();
        let eddies = fields.turbulence;
        let scalars = [
            fields.temperature,
            fields.pressure,
            fields.density,
            eddies.energy,
            eddies.dissipation,
            eddies.viscosity,
        ];
        let vectors = [fields.velocity, fields.pressure_gradient];
        scalars
            .iter()
            .flat_map(|field| field.iter())
            .chain(vectors.iter().flat_map(|field| field.iter().flatten()))
            .map(|value| value.to_bits())
            .collect()
    }
}

/// The balance's error relative to the largest of its parts.
pub fn closure(balance: &calcine_coupler::part::Balance) -> f64 {
    let error = balance.stored - balance.boundary - balance.exchange - balance.source;
    let parts = [
        balance.stored_magnitude,
        balance.boundary_magnitude,
        balance.exchange.abs(),
        balance.source_magnitude,
    ];
    error.abs() / parts.into_iter().fold(f64::MIN_POSITIVE, f64::max)
}

/// Numbers in [0, 1), the same at each call (a linear congruential generator, Knuth's MMIX
/// constants).
pub fn scatter(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        })
        .collect()
}
