//! Eddies of the gas outside the bed: the standard k-epsilon model with wall functions, per cell
//!
//! M (k − k_old)/Δt + Σ φ_f (k_f − k) − Σ (μ_t/σ_k + εμ)_f ∇k·S = μ_t P V − m (ε_t/k + ⅔ ∇·u) k
//!
//! and likewise ε_t ([`equations`]); ε the void fraction, m = ε ρ V the gas of the cell, M = m + Δt Σ φ_f, so that
//! the form subtracts k times the continuity residual as momentum does. k and ε_t live on the motion clock under
//! either storage: they belong to the inertia of the flow, which under time splitting is that of the motion
//! clock, and eddies of a few milliseconds have no place on a clock of hours. They advance once for each committed
//! window, so that attempts may be repeated; in an attempt the eddy viscosity is that of its start.
//!
//! The bed (requirements FLO-2) is every cell with a solid fraction above 0.1, whatever its neighbours are. There
//! eddies carry nothing (μ_t = 0) and none are made (P = 0); those that flow in decay by the model's own law. At
//! a face between bed and free gas the coefficients are the mean of both sides, as at any other face.

mod equations;
pub mod wall;

use calcine_coupler::checkpoint::{StateFile, StateFileError};
use calcine_coupler::part::TurbulenceFields;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::turbulence::KEpsilon;
use calcine_coupler::setup::Turbulence;
use calcine_coupler::turbulence::is_free;

pub use equations::{KEpsilonEquations, TurbulenceStep};
use wall::WallLaw;

use super::boundary::{Boundaries, FaceCondition};
use super::state::GasState;
use crate::numerics::grid::MeshGraph;
use crate::numerics::parallel::fill;

/// Eddies of a state; all lists are empty for a laminar gas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Eddies {
    /// k of each cell in m²/s².
    pub energy: Vec<f64>,
    /// ε_t of each cell in m²/s³.
    pub dissipation: Vec<f64>,
    /// Void fraction × eddy viscosity μ_t of each cell in Pa s; zero in the bed.
    pub viscosity: Vec<f64>,
    /// The same on each boundary face; on a wall such that the plain difference of velocities gives the wall
    /// function's stress.
    pub boundary: Vec<f64>,
}

impl Eddies {
    /// True where there are none.
    pub fn is_laminar(&self) -> bool {
        self.energy.is_empty()
    }

    /// As others see them.
    pub fn fields(&self) -> TurbulenceFields<'_> {
        TurbulenceFields {
            energy: &self.energy,
            dissipation: &self.dissipation,
            viscosity: &self.viscosity,
        }
    }

    /// Takes the values of others into the memory that is there.
    pub fn take(&mut self, other: &Self) {
        self.energy.clone_from(&other.energy);
        self.dissipation.clone_from(&other.dissipation);
        self.viscosity.clone_from(&other.viscosity);
        self.boundary.clone_from(&other.boundary);
    }

    /// Writes them into a state file.
    pub fn write(&self, file: &mut StateFile) {
        file.set_f64s("turbulent_energy", &self.energy);
        file.set_f64s("dissipation", &self.dissipation);
        file.set_f64s("eddy_viscosity", &self.viscosity);
        file.set_f64s("boundary_eddy_viscosity", &self.boundary);
    }

    /// Reads those of so many cells from a state file; of a laminar gas there are none.
    pub fn read(file: &StateFile, cells: usize) -> Result<Self, StateFileError> {
        let cells = match file.f64s("turbulent_energy")?.is_empty() {
            true => 0,
            false => cells,
        };
        Ok(Self {
            energy: file.f64s_of("turbulent_energy", cells)?.to_vec(),
            dissipation: file.f64s_of("dissipation", cells)?.to_vec(),
            viscosity: file.f64s_of("eddy_viscosity", cells)?.to_vec(),
            boundary: file.f64s("boundary_eddy_viscosity")?.to_vec(),
        })
    }

    /// Eddies at the start of a run: those of the setup, or those there are.
    pub fn begin(&mut self, setup: &Turbulence, cells: usize) {
        let &Turbulence::KEpsilon {
            energy,
            length_scale,
            ..
        } = setup
        else {
            *self = Self::default();
            return;
        };
        if self.is_laminar() {
            self.energy = vec![energy; cells];
            self.dissipation = vec![KEpsilon::STANDARD.dissipation(energy, length_scale); cells];
            // Nothing is known of the bed yet.
            self.viscosity = vec![0.0; cells];
        }
    }
}

/// The eddy viscosities that k and ε_t of a state stand for, with its mass, void fraction and temperature.
pub fn update_viscosity(
    grid: &MeshGraph,
    boundary: &Boundaries,
    gas: &GasModel,
    state: &mut GasState,
) {
    let mut eddies = std::mem::take(&mut state.turbulence);
    if !eddies.is_laminar() {
        fill_viscosity(grid, boundary, gas, state, &mut eddies);
    }
    state.turbulence = eddies;
}

fn fill_viscosity(
    grid: &MeshGraph,
    boundary: &Boundaries,
    gas: &GasModel,
    state: &GasState,
    eddies: &mut Eddies,
) {
    let (model, law) = (KEpsilon::STANDARD, WallLaw::new());
    let held = |cell: usize| state.mass[cell] / grid.volume[cell];
    let Eddies {
        energy,
        dissipation,
        viscosity,
        boundary: on_boundary,
    } = eddies;
    viscosity.resize(grid.cells(), 0.0);
    fill(viscosity, |cell| {
        if is_free(state.void_fraction[cell]) {
            held(cell) * model.eddy_viscosity(energy[cell], dissipation[cell])
        } else {
            0.0
        }
    });
    on_boundary.resize(grid.faces.len() - grid.internal, 0.0);
    fill(on_boundary, |i| {
        let index = grid.internal + i;
        let face = &grid.faces[index];
        let cell = face.owner;
        let pores = state.void_fraction[cell];
        if !is_free(pores) {
            return 0.0;
        }
        match boundary.at(index) {
            FaceCondition::Inlet {
                superficial_velocity,
                mass_flux,
                ..
            } if superficial_velocity > 0.0 => {
                let [energy, dissipation] = boundary.eddies(index, pores);
                let density = pores * mass_flux / superficial_velocity;
                density * model.eddy_viscosity(energy, dissipation)
            }
            FaceCondition::Wall {
                sticks: Some(_), ..
            } => {
                let laminar = wall::viscosity(boundary, gas, state, index, cell);
                laminar * law.eddy_ratio(energy[cell], face.distance(), laminar / held(cell))
            }
            FaceCondition::Inlet { .. }
            | FaceCondition::Wall { sticks: None, .. }
            | FaceCondition::Outlet { .. } => viscosity[cell],
        }
    });
}
