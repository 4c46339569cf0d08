//! Eddies of the gas: the standard k-epsilon model, per cell
//!
//! M (k − k_old)/Δt + Σ φ_f (k_f − k) − Σ (μ_t/σ_k + εμ)_f ∇k·S = μ_t P V + m (a + b k) − m (ε_t/k + ⅔ ∇·u) k
//!
//! and likewise ε_t ([`equations`]); ε the void fraction, m = ε ρ V the gas of the cell, M = m + Δt Σ φ_f, so that
//! the form subtracts k times the continuity residual as momentum does. k and ε_t live on the motion clock under
//! either storage: they belong to the inertia of the flow, which under time splitting is that of the motion
//! clock, and eddies of a few milliseconds have no place on a clock of hours. They advance once for each committed
//! window, so that attempts may be repeated; in an attempt the eddy viscosity is that of its start.
//!
//! The bed (docs/theory.md, FLO-2) is every cell with a solid fraction above 0.1, whatever its neighbours are. With a law
//! of eddies in the bed (TRB-1) the exchange tells what its particles make, a and b; its walls have no wall functions
//! and friction of the laminar gas. Without one eddies carry nothing there (μ_t = 0) and none are made (P = a = b = 0);
//! those that flow in decay by the model's own law. At a face between bed and free gas the coefficients are the mean
//! of both sides, as at any other face.

mod eddies;
mod equations;
pub mod wall;

use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::turbulence::KEpsilon;
use calcine_coupler::turbulence::{Turbulence, is_free};

pub use eddies::Eddies;
pub use equations::{KEpsilonEquations, TurbulenceStep};
use wall::WallLaw;

use super::boundary::{Boundaries, FaceCondition};
use super::state::GasState;
use crate::numerics::grid::MeshGraph;
use crate::numerics::parallel::fill;

/// The eddy viscosities that k and ε_t of a state stand for, with its mass, void fraction and temperature.
pub fn update_viscosity(
    grid: &MeshGraph,
    boundary: &Boundaries,
    gas: &GasModel,
    turbulence: &Turbulence,
    state: &mut GasState,
) {
    let mut eddies = std::mem::take(&mut state.turbulence);
    if !eddies.is_laminar() {
        fill_viscosity(grid, boundary, gas, turbulence, state, &mut eddies);
    }
    state.turbulence = eddies;
}

fn fill_viscosity(
    grid: &MeshGraph,
    boundary: &Boundaries,
    gas: &GasModel,
    turbulence: &Turbulence,
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
        if turbulence.reaches(state.void_fraction[cell]) {
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
        if !turbulence.reaches(pores) {
            return 0.0;
        }
        match *boundary.at(index) {
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
                if !is_free(pores) {
                    return 0.0;
                }
                let laminar = wall::viscosity(boundary, gas, state, index, cell);
                laminar * law.eddy_ratio(energy[cell], face.distance(), laminar / held(cell))
            }
            FaceCondition::Inlet { .. }
            | FaceCondition::Wall { sticks: None, .. }
            | FaceCondition::Outlet { .. } => viscosity[cell],
        }
    });
}
