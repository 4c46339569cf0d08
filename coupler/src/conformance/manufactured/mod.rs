//! Orders of convergence towards a manufactured solution of the porous momentum and energy equations, on any mesh of a box.
//!
//! Void fraction, drag and density vary; gas is carried, sheared and conducts heat. Sources come by the exchange with
//! particles, so that any [`Gas`](crate::part::Gas) can be asked. The box is closed: its walls have one temperature and gas
//! sticks to them, two sides are planes of symmetry.

pub mod meshes;
pub mod prisms;
pub mod solution;
pub mod tetrahedra;

use std::sync::Arc;

use calcine_physics::Vec3;

pub use meshes::CellShape;
pub use solution::ManufacturedFields;

use super::gas::MakeGas;
use super::{LawError, supervisor, window};
use crate::mesh::{Mesh, MeshError};
use crate::momentum_model::MomentumModel;
use crate::part::{Bed, CellExchange, CellReceived};
use crate::setup::{Convection, GasControls, GasPatch, GasSetup, Schedule, WallHeat, WallVelocity};
use crate::time::GasStorage;

/// Errors of a steady state, root mean squares weighted by volumes.
#[derive(Clone, Copy, Debug)]
pub struct FieldErrors {
    /// Cells along ξ.
    pub cells: usize,
    /// Of the velocity in m/s.
    pub velocity: f64,
    /// Of the temperature in K.
    pub temperature: f64,
    /// Of the pressure in Pa, up to a constant.
    pub pressure: f64,
    /// Windows until nothing changed.
    pub windows: usize,
    /// Outer iterations of the last.
    pub outer_iterations: u32,
    /// True where it converged.
    pub converged: bool,
}

impl FieldErrors {
    /// Observed orders of velocity, temperature and pressure from a coarser mesh to this one.
    pub fn orders(&self, coarser: &Self) -> [f64; 3] {
        let finer = (self.cells as f64 / coarser.cells as f64).ln();
        [
            (coarser.velocity / self.velocity).ln() / finer,
            (coarser.temperature / self.temperature).ln() / finer,
            (coarser.pressure / self.pressure).ln() / finer,
        ]
    }
}

/// A case: its fields, cells and scheme.
#[derive(Clone, Debug)]
pub struct ManufacturedCase {
    /// The fields.
    pub fields: ManufacturedFields,
    /// What cells are.
    pub shape: CellShape,
    /// How cell values are carried to faces.
    pub convection: Convection,
    /// Length of a window in s.
    pub span: f64,
    /// Windows at most.
    pub windows: usize,
}

/// Windows end when one changes velocities by less than this share of their largest.
const STEADY: f64 = 1e-7;

impl ManufacturedCase {
    /// The case on a box that leans by an angle in degrees.
    pub fn new(degrees: f64, shape: CellShape) -> Self {
        Self {
            fields: ManufacturedFields::leaning(degrees),
            shape,
            convection: Convection::Central(1.0),
            span: 0.25,
            windows: 80,
        }
    }

    /// The mesh of so many cells along ξ.
    pub fn mesh(&self, cells: usize) -> Result<Mesh, MeshError> {
        meshes::shaped_box(self.shape, cells, |point| self.fields.displaced(point))
    }

    /// The setup; the gas begins at rest at the walls' temperature, with the mass that the solution holds.
    fn setup(&self, mesh: &Mesh) -> GasSetup {
        let fields = &self.fields;
        let [mut hot, mut cold] = [0.0; 2];
        for (&at, volume) in mesh.cell_centre().iter().zip(mesh.cell_volume()) {
            let pores = fields.void_fraction(at) * volume;
            hot += pores / fields.temperature(at);
            cold += pores / solution::WALL;
        }
        let wall = GasPatch::Wall {
            velocity: WallVelocity::NoSlip,
            heat: WallHeat::Temperature(Schedule::constant(solution::WALL)),
        };
        GasSetup {
            mixture: "air".into(),
            properties: fields.gas.clone(),
            schmidt: 1.0,
            chemistry: Default::default(),
            composition: Vec::new(),
            storage: GasStorage::Process,
            temperature: solution::WALL,
            pressure: solution::PRESSURE * hot / cold,
            velocity: Vec3::zeros(),
            gravity: fields.gravity,
            pressure_gradient: Vec3::zeros(),
            turbulence: Default::default(),
            momentum: if fields.takes_all_pressure {
                MomentumModel::B
            } else {
                MomentumModel::A
            },
            patches: vec![
                ("wall".to_owned(), wall),
                ("symmetry".to_owned(), GasPatch::Symmetry),
            ],
            controls: GasControls {
                outer_iterations: 100,
                convection: self.convection,
                pressure_corrections: 2,
                time_scheme: Default::default(),
                most_pressure_corrections: 16,
                outer_tolerance: 1e-9,
                linear_tolerance: Some(1e-12),
            },
        }
    }

    fn exchange(&self, mesh: &Mesh) -> CellExchange {
        let fields = &self.fields;
        let cells = || mesh.cell_centre().iter().copied().zip(mesh.cell_volume());
        CellExchange {
            drag_coefficient: cells()
                .map(|(at, v)| v * fields.drag_coefficient(at))
                .collect(),
            drag_source: cells().map(|(at, v)| *v * fields.drag_source(at)).collect(),
            heat_coefficient: cells()
                .map(|(at, v)| v * fields.heat_coefficient(at))
                .collect(),
            heat_source: cells().map(|(at, v)| v * fields.heat_source(at)).collect(),
            ..CellExchange::default()
        }
    }

    /// Errors of the steady state on a mesh of so many cells along ξ.
    pub fn errors(&self, cells: usize, make: &mut MakeGas<'_>) -> Result<FieldErrors, LawError> {
        let mesh = Arc::new(self.mesh(cells)?);
        let mut supervisor = supervisor();
        let mut gas = make(&self.setup(&mesh), &mesh, None, &mut supervisor)?;
        let bed = Bed {
            void_fraction: mesh
                .cell_centre()
                .iter()
                .map(|&at| self.fields.void_fraction(at))
                .collect(),
        };
        let exchange = self.exchange(&mesh);
        let mut received = CellReceived::default();
        let mut before = vec![Vec3::zeros(); mesh.cells()];
        let mut index = 0;
        loop {
            gas.start(&window(index, self.span, self.span)?, &bed, &exchange)?;
            let done = gas.finish(&supervisor, &mut received)?;
            gas.commit()?;
            index += 1;
            let now = gas.fields().velocity;
            let largest = now.iter().map(|u| u.norm()).fold(0.0, f64::max);
            let change = now
                .iter()
                .zip(&before)
                .map(|(u, old)| (u - old).norm())
                .fold(0.0, f64::max);
            tracing::debug!("window {index}: change {change:.1e} of {largest:.3} m/s, {done:?}");
            let steady = change < STEADY * largest;
            if steady || index as usize == self.windows {
                let fields = gas.fields();
                let mut found =
                    self.measure(&mesh, fields.velocity, fields.temperature, fields.pressure);
                found.cells = cells;
                found.windows = index as usize;
                found.outer_iterations = done.outer_iterations;
                found.converged = done.converged && steady;
                return Ok(found);
            }
            before.copy_from_slice(now);
        }
    }

    fn measure(
        &self,
        mesh: &Mesh,
        velocity: &[Vec3],
        temperature: &[f64],
        pressure: &[f64],
    ) -> FieldErrors {
        let fields = &self.fields;
        let (centre, volume) = (mesh.cell_centre(), mesh.cell_volume());
        let all: f64 = volume.iter().sum();
        let mean = |value: &dyn Fn(usize) -> f64| {
            (0..mesh.cells())
                .map(|cell| volume[cell] * value(cell))
                .sum::<f64>()
                / all
        };
        let off = |cell: usize| pressure[cell] - fields.pressure(centre[cell]);
        let level = mean(&off);
        FieldErrors {
            velocity: mean(&|cell| (velocity[cell] - fields.velocity(centre[cell])).norm_squared())
                .sqrt(),
            temperature: mean(&|cell| {
                (temperature[cell] - fields.temperature(centre[cell])).powi(2)
            })
            .sqrt(),
            pressure: mean(&|cell| (off(cell) - level).powi(2)).sqrt(),
            cells: 0,
            windows: 0,
            outer_iterations: 0,
            converged: false,
        }
    }
}
