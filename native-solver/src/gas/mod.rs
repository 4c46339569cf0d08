//! The native gas: finite volumes on a general polyhedral mesh, low-Mach ideal gas, volume
//! fraction in every term, one file per equation.

mod acceleration;
mod attempt;
mod backflow;
mod balance;
mod boundary;
mod chemistry;
mod continuation;
mod enthalpy;
mod error;
mod failure;
mod friction;
mod guard;
mod inflow;
mod momentum;
mod normal_friction;
mod opening;
mod outer;
mod pace;
mod phases;
mod pressure;
mod recovery;
mod species;
mod stages;
mod state;
mod stirring;
mod tolerance;
mod transport;
mod turbulence;
mod window;

use std::path::Path;
use std::sync::Arc;

use calcine_coupler::boundary_value::BoundaryValue;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::{
    Backflow, Bed, CellExchange, CellReceived, Convergence, Gas, GasFields, GasPhases, Part,
    SolverInfo,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{GasControls, GasSetup, Turbulence};
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::time::Window;

use boundary::Boundaries;
pub use boundary::match_patches;
pub use error::NativeError;
pub use failure::GasFailure;
use failure::Place;
use outer::Equations;
use phases::Stopwatch;
use stages::StageStates;
use state::GasState;
pub(crate) use state::{flat, vectors};
use turbulence::{Eddies, KEpsilonEquations, TurbulenceStep};

use crate::numerics::grid::MeshGraph;
use crate::numerics::matrix::Matrix;
use crate::numerics::parallel::fill;

/// Name of the state file in a checkpoint's folder.
const STATE: &str = "gas.state";

/// The native gas.
#[derive(Debug)]
pub struct NativeGas {
    about: SolverInfo,
    mesh: Arc<Mesh>,
    grid: Arc<MeshGraph>,
    setup: GasSetup,
    boundaries: Boundaries,
    equations: Equations,
    /// Of a turbulent gas.
    eddies: Option<KEpsilonEquations>,
    committed: GasState,
    /// True once a window is committed; before, the bed of an attempt says how much gas there is.
    started: bool,
    /// Fields of another run to start from, their velocity superficial.
    taken_over: Option<GasState>,
    now: GasState,
    /// What a scheme of several stages keeps.
    steps: StageStates,
    /// The attempt that `now` is of, as long as it is not committed.
    attempted: Option<Window>,
    window: Option<Window>,
    void_fraction: Vec<f64>,
    /// Share of −∇p and ρ g that the gas of each cell takes.
    pressure_share: Vec<f64>,
    exchange: CellExchange,
    /// Of the last attempt.
    backflow: Option<Backflow>,
    /// Absolute pressure in Pa, for the eyes of others.
    pressure: Vec<f64>,
    /// Density of the equation of state in kg/m³, for the eyes of others.
    density: Vec<f64>,
    /// Pressure gradient in Pa/m with the mean one, for the eyes of others.
    pressure_gradient: Vec<Vec3>,
}

impl NativeGas {
    /// The gas at the start of a run. Before the first window nothing is known of the bed, so
    /// that the fields show the superficial start velocity.
    pub fn new(mesh: impl Into<Arc<Mesh>>, setup: &GasSetup) -> Result<Self, NativeError> {
        let mesh = mesh.into();
        check(setup)?;
        let boundaries = Boundaries::new(&mesh, setup)?;
        let grid = Arc::new(MeshGraph::new(&mesh));
        let (cells, faces) = (mesh.cells(), grid.faces.len());
        let committed = start(setup, cells, faces);
        let mut gas = Self {
            about: SolverInfo {
                name: "native gas".into(),
                version: env!("CARGO_PKG_VERSION").into(),
                ranks: 1,
            },
            mesh,
            equations: Equations::new(&grid),
            eddies: eddies(setup, &grid, &boundaries),
            grid,
            setup: setup.clone(),
            boundaries,
            now: committed.clone(),
            steps: StageStates::default(),
            attempted: None,
            committed,
            started: false,
            taken_over: None,
            window: None,
            void_fraction: Vec::new(),
            pressure_share: Vec::new(),
            exchange: CellExchange::default(),
            backflow: None,
            pressure: vec![0.0; cells],
            density: vec![0.0; cells],
            pressure_gradient: vec![Vec3::zeros(); cells],
        };
        gas.update_fields();
        Ok(gas)
    }

    /// Takes up the state that a checkpoint left in a folder.
    pub fn restore(&mut self, directory: &Path) -> Result<(), NativeError> {
        let path = directory.join(STATE);
        self.committed = GasState::read(
            &path,
            self.mesh.cells(),
            self.grid.faces.len(),
            self.setup.properties.species().len(),
        )?;
        self.started = !self.committed.mass.is_empty();
        self.attempted = None;
        self.now.take(&self.committed);
        self.update_fields();
        Ok(())
    }

    fn update_fields(&mut self) {
        let (now, setup) = (&self.now, &self.setup);
        let (gas, base) = (&setup.properties, now.base_pressure);
        fill(&mut self.pressure, |cell| base + now.pressure[cell]);
        let mean = setup.pressure_gradient;
        fill(&mut self.pressure_gradient, |cell| {
            now.pressure_gradient[cell] + mean
        });
        fill(&mut self.density, |cell| {
            let composition = now.composition_of(cell, gas.species().len());
            gas.density(base, now.temperature[cell], composition)
        });
    }

    fn failure(&self, kind: FailureKind, message: impl Into<String>) -> PartError {
        PartError::new(self.about.name.clone(), kind, message)
    }

    /// The failure of an attempt.
    fn failed(&self, cause: GasFailure) -> PartError {
        self.failure(cause.kind(), cause.to_string())
            .caused_by(cause)
    }

    /// Eddies over the motion span of the window that is committed, if there is one.
    fn advance_eddies(&mut self) -> Result<(), GasFailure> {
        let (Some(eddies), Some(window)) = (&mut self.eddies, self.attempted) else {
            return Ok(());
        };
        let Turbulence::KEpsilon { iterations, .. } = self.setup.turbulence else {
            return Ok(());
        };
        let step = TurbulenceStep {
            grid: &self.grid,
            boundary: &self.boundaries,
            gas: &self.setup.properties,
            viscosity: &self.equations.material.viscosity,
            gradients: self.equations.momentum.gradients(),
            turbulence: &self.setup.turbulence,
            particles: &self.exchange.eddies,
            span: window.span.motion.seconds(),
            tolerance: self
                .setup
                .controls
                .linear_tolerance
                .unwrap_or(GasControls::CLOSE),
            iterations,
        };
        let mut watch = Stopwatch::new();
        let advanced = eddies.advance(&step, &mut self.equations.krylov, &mut self.now);
        watch.lap(&mut self.equations.phases.turbulence);
        advanced
    }

    fn check_inputs(&self, bed: &Bed, exchange: &CellExchange) -> Result<(), GasFailure> {
        let cells = self.mesh.cells();
        for (field, found) in [
            ("void fraction", bed.void_fraction.len()),
            ("drag coefficient", exchange.drag_coefficient.len()),
            ("drag source", exchange.drag_source.len()),
            ("heat coefficient", exchange.heat_coefficient.len()),
            ("heat source", exchange.heat_source.len()),
        ] {
            if found != cells {
                return Err(GasFailure::Length {
                    field,
                    found,
                    cells,
                });
            }
        }
        let species = &exchange.species;
        let wanted = match species.is_none() {
            true => 0,
            false => cells * self.setup.properties.species().len(),
        };
        for (field, list) in [
            ("source", &species.source),
            ("coefficient", &species.coefficient),
            ("taken", &species.taken),
        ] {
            let odd = list.iter().find(|value| !value.is_finite());
            if list.len() != wanted || odd.is_some() {
                return Err(GasFailure::Species {
                    field,
                    found: list.len(),
                    wanted,
                    odd: odd.copied().unwrap_or_default(),
                });
            }
        }
        let eddies = &exchange.eddies;
        let told = if eddies.energy.is_empty() { 0 } else { cells };
        for (field, list) in [
            ("production of k by particles", &eddies.energy),
            (
                "production of its dissipation by particles",
                &eddies.dissipation,
            ),
            ("growth of eddies by particles", &eddies.growth),
        ] {
            let found = list.len();
            if found != told {
                return Err(GasFailure::Length {
                    field,
                    found,
                    cells: told,
                });
            }
        }
        let place = |cell: usize| Place {
            cell,
            centre: self.grid.centre[cell],
        };
        let finite = |value: f64| value.is_finite();
        let coefficient = |value: f64| value.is_finite() && value >= 0.0;
        for cell in 0..cells {
            let pores = bed.void_fraction[cell];
            if !(pores > 0.0 && pores <= 1.0) {
                return Err(GasFailure::VoidFraction {
                    value: pores,
                    place: place(cell),
                });
            }
            let source = exchange.drag_source[cell];
            let allowed = coefficient(exchange.drag_coefficient[cell])
                && coefficient(exchange.heat_coefficient[cell])
                && finite(exchange.heat_source[cell])
                && source.iter().all(|&value| finite(value));
            if !allowed {
                return Err(GasFailure::Exchange {
                    drag_coefficient: exchange.drag_coefficient[cell],
                    drag_source: source.norm(),
                    heat_coefficient: exchange.heat_coefficient[cell],
                    heat_source: exchange.heat_source[cell],
                    place: place(cell),
                });
            }
        }
        Ok(())
    }
}

impl Part for NativeGas {
    fn about(&self) -> &SolverInfo {
        &self.about
    }

    fn commit(&mut self) -> Result<(), PartError> {
        self.advance_eddies().map_err(|cause| self.failed(cause))?;
        self.committed.take(&self.now);
        self.started = !self.committed.mass.is_empty();
        self.attempted = None;
        self.taken_over = None;
        Ok(())
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        // What an attempt without a commit placed or found is no state of the run.
        if !self.started {
            self.committed = self.origin();
        }
        if self.attempted.take().is_some() {
            self.now.take(&self.committed);
            self.update_fields();
        }
        let path = directory.join(STATE);
        self.committed.write(&path).map_err(|error| {
            self.failure(FailureKind::Io, error.to_string())
                .caused_by(error)
        })
    }
}

impl Gas for NativeGas {
    fn fields(&self) -> GasFields<'_> {
        GasFields {
            temperature: &self.now.temperature,
            pressure: &self.pressure,
            density: &self.density,
            composition: &self.now.composition,
            velocity: &self.now.velocity,
            pressure_gradient: &self.pressure_gradient,
            turbulence: self.now.turbulence.fields(),
        }
    }

    fn begins_again(&self) -> bool {
        true
    }

    fn backflow(&self) -> Option<Backflow> {
        self.backflow
    }

    fn phases(&self) -> Option<GasPhases> {
        Some(self.equations.phases)
    }

    fn turbulence_residual(&self) -> Option<f64> {
        self.eddies.as_ref().and_then(KEpsilonEquations::unsolved)
    }

    fn set_boundary(&mut self, value: &BoundaryValue) -> Result<(), PartError> {
        let set = value.apply(&mut self.setup.patches);
        set.map_err(|error| {
            self.failure(FailureKind::Refused, error.to_string())
                .caused_by(error)
        })?;
        self.boundaries.take(&self.setup);
        Ok(())
    }

    fn start(
        &mut self,
        window: &Window,
        bed: &Bed,
        exchange: &CellExchange,
    ) -> Result<(), PartError> {
        self.check_inputs(bed, exchange)
            .map_err(|cause| self.failed(cause).in_window(window))?;
        self.window = Some(*window);
        self.void_fraction.clone_from(&bed.void_fraction);
        self.exchange.clone_from(exchange);
        Ok(())
    }

    fn finish(
        &mut self,
        _supervisor: &Supervisor,
        received: &mut CellReceived,
    ) -> Result<Convergence, PartError> {
        let Some(window) = self.window.take() else {
            return Err(self.failure(FailureKind::Protocol, "finished without a start"));
        };
        // A repeated attempt takes what the one before found as its first guess; old is what is committed.
        let continues = self
            .attempted
            .is_some_and(|last| last.index == window.index && last.attempt + 1 == window.attempt);
        self.attempted = Some(window);
        let convergence = match self.advance(&window, continues, received) {
            Ok(convergence) => convergence,
            Err(cause) => {
                // What a failed attempt leaves is no gas.
                self.now.take(&self.committed);
                self.attempted = None;
                return Err(self.failed(cause).in_window(&window));
            }
        };
        self.update_fields();
        self.backflow = self.find_backflow(self.setup.storage.span(&window));
        Ok(convergence)
    }
}

/// The equations of a turbulent gas.
fn eddies(
    setup: &GasSetup,
    grid: &Arc<MeshGraph>,
    boundary: &Boundaries,
) -> Option<KEpsilonEquations> {
    let turbulent = !setup.turbulence.is_laminar();
    turbulent.then(|| KEpsilonEquations::new(Matrix::new(grid.clone()), boundary))
}

/// The state at the start of a run, before anything is known of the bed.
fn start(setup: &GasSetup, cells: usize, faces: usize) -> GasState {
    let gas = &setup.properties;
    let mut turbulence = Eddies::default();
    turbulence.begin(&setup.turbulence, cells);
    GasState {
        turbulence,
        enthalpy: vec![gas.enthalpy(setup.temperature, &setup.composition); cells],
        temperature: vec![setup.temperature; cells],
        composition: setup.composition.repeat(cells),
        remainder: vec![0.0; setup.composition.len() * cells],
        heat_remainder: vec![0.0; cells],
        base_pressure: setup.pressure,
        velocity: vec![setup.velocity; cells],
        pressure: vec![0.0; cells],
        pressure_gradient: vec![Vec3::zeros(); cells],
        flux: vec![0.0; faces],
        ..GasState::default()
    }
}

fn check(setup: &GasSetup) -> Result<(), NativeError> {
    let place = || "the gas".to_owned();
    for (field, value, unit) in [
        ("the start temperature", setup.temperature, "K"),
        ("the pressure", setup.pressure, "Pa"),
        ("the outer tolerance", setup.controls.outer_tolerance, ""),
        (
            "the linear tolerance",
            setup.controls.linear_tolerance.unwrap_or(1.0),
            "",
        ),
    ] {
        if !(value.is_finite() && value > 0.0) {
            return Err(NativeError::Value {
                field,
                place: place(),
                value,
                unit,
                rule: "positive",
            });
        }
    }
    Ok(())
}
