//! The state of the gas: what is committed, and what a checkpoint keeps.

use std::path::Path;

use calcine_coupler::checkpoint::{StateFile, StateFileError};
use calcine_coupler::physics::Vec3;

use super::turbulence::Eddies;

/// The fields of the gas; an attempt makes new ones from the committed ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GasState {
    /// Gas mass of each cell in kg, advanced by continuity alone; empty before the first window,
    /// because only the bed says how much gas a cell holds.
    pub mass: Vec<f64>,
    /// Sensible enthalpy in J/kg.
    pub enthalpy: Vec<f64>,
    /// Temperature in K.
    pub temperature: Vec<f64>,
    /// Mass fractions, species by species within each cell; empty for a single gas.
    pub composition: Vec<f64>,
    /// What flows brought a cell of each species in kg beyond m Y: what the linear solver left of its equation,
    /// which the next window begins with. In the order of the mass fractions.
    pub remainder: Vec<f64>,
    /// What flows brought a cell of heat in J beyond m h, in the same way.
    pub heat_remainder: Vec<f64>,
    /// Base pressure of the low-Mach gas in Pa; it changes in a closed domain alone.
    pub base_pressure: f64,
    /// Interstitial velocity in m/s.
    pub velocity: Vec<Vec3>,
    /// Pressure above the setup's pressure (in a closed domain: above the base pressure) in Pa.
    pub pressure: Vec<f64>,
    /// Cell gradient of the pressure in Pa/m.
    pub pressure_gradient: Vec<Vec3>,
    /// Superficial mass flux through each face in kg/s, out of its owner.
    pub flux: Vec<f64>,
    /// Void fraction.
    pub void_fraction: Vec<f64>,
    /// Eddies.
    pub turbulence: Eddies,
}

impl GasState {
    /// Mass fractions of a cell, of so many species.
    #[inline]
    pub fn composition_of(&self, cell: usize, species: usize) -> &[f64] {
        &self.composition[cell * species..(cell + 1) * species]
    }

    /// Mass in kg of a species in a cell, by its place among the mass fractions.
    #[inline]
    pub fn content(&self, cell: usize, place: usize) -> f64 {
        self.mass[cell] * self.composition[place] + self.remainder[place]
    }

    /// Enthalpy in J of a cell.
    #[inline]
    pub fn heat(&self, cell: usize) -> f64 {
        self.mass[cell] * self.enthalpy[cell] + self.heat_remainder[cell]
    }

    /// Takes the values of another state into the memory that is there.
    pub fn take(&mut self, other: &GasState) {
        self.mass.clone_from(&other.mass);
        self.enthalpy.clone_from(&other.enthalpy);
        self.temperature.clone_from(&other.temperature);
        self.composition.clone_from(&other.composition);
        self.remainder.clone_from(&other.remainder);
        self.heat_remainder.clone_from(&other.heat_remainder);
        self.base_pressure = other.base_pressure;
        self.velocity.clone_from(&other.velocity);
        self.pressure.clone_from(&other.pressure);
        self.pressure_gradient.clone_from(&other.pressure_gradient);
        self.flux.clone_from(&other.flux);
        self.void_fraction.clone_from(&other.void_fraction);
        self.turbulence.take(&other.turbulence);
    }

    /// Writes the state.
    pub fn write(&self, path: &Path) -> Result<(), StateFileError> {
        let mut file = StateFile::new();
        file.set_f64s("mass", &self.mass);
        file.set_f64s("enthalpy", &self.enthalpy);
        file.set_f64s("temperature", &self.temperature);
        file.set_f64s("composition", &self.composition);
        file.set_f64s("remainder", &self.remainder);
        file.set_f64s("heat_remainder", &self.heat_remainder);
        file.set_f64s("base_pressure", &[self.base_pressure]);
        file.set_f64s("velocity", &flat(&self.velocity));
        file.set_f64s("pressure", &self.pressure);
        file.set_f64s("pressure_gradient", &flat(&self.pressure_gradient));
        file.set_f64s("flux", &self.flux);
        file.set_f64s("void_fraction", &self.void_fraction);
        self.turbulence.write(&mut file);
        file.write(path)
    }

    /// Reads a state of this many cells, faces and species.
    pub fn read(
        path: &Path,
        cells: usize,
        faces: usize,
        species: usize,
    ) -> Result<Self, StateFileError> {
        let file = StateFile::read(path)?;
        let started = !file.f64s("mass")?.is_empty();
        let placed = if started { cells } else { 0 };
        Ok(Self {
            mass: file.f64s_of("mass", placed)?.to_vec(),
            enthalpy: file.f64s_of("enthalpy", cells)?.to_vec(),
            temperature: file.f64s_of("temperature", cells)?.to_vec(),
            composition: file.f64s_of("composition", species * cells)?.to_vec(),
            remainder: file.f64s_of("remainder", species * cells)?.to_vec(),
            heat_remainder: file.f64s_of("heat_remainder", cells)?.to_vec(),
            base_pressure: file.f64s_of("base_pressure", 1)?.iter().sum(),
            velocity: vectors(file.f64s_of("velocity", 3 * cells)?),
            pressure: file.f64s_of("pressure", cells)?.to_vec(),
            pressure_gradient: vectors(file.f64s_of("pressure_gradient", 3 * cells)?),
            flux: file.f64s_of("flux", faces)?.to_vec(),
            void_fraction: file.f64s_of("void_fraction", placed)?.to_vec(),
            turbulence: Eddies::read(&file, cells)?,
        })
    }
}

/// Components of vectors, one vector after the other.
pub(crate) fn flat(vectors: &[Vec3]) -> Vec<f64> {
    vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect()
}

/// Vectors from their components.
pub(crate) fn vectors(components: &[f64]) -> Vec<Vec3> {
    let triples = components.as_chunks::<3>().0.iter();
    triples.map(|&[x, y, z]| Vec3::new(x, y, z)).collect()
}
