//! What a state holds of eddies.

use calcine_coupler::checkpoint::{StateFile, StateFileError};
use calcine_coupler::part::TurbulenceFields;
use calcine_coupler::physics::turbulence::KEpsilon;
use calcine_coupler::setup::Turbulence;

/// Eddies of a state; all lists are empty for a laminar gas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Eddies {
    /// k of each cell in m²/s².
    pub energy: Vec<f64>,
    /// ε_t of each cell in m²/s³.
    pub dissipation: Vec<f64>,
    /// Void fraction × eddy viscosity μ_t of each cell in Pa s; zero in a bed at which eddies end.
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
