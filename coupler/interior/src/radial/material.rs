//! What the particles of a material are, as those with shells need it.

use calcine_physics::conduction::Conductivity;
use calcine_physics::gas_model::GasModel;
use calcine_physics::pores::{Permeability, PorousConductivity};

use super::grid::ShellGrid;
use crate::reacting::SizeChange;

/// A porous solid.
#[derive(Clone, Debug, PartialEq)]
pub struct PorousSolid {
    /// True density of each solid in kg/m³, without pores.
    pub true_densities: Vec<f64>,
    /// Conductivity of the material.
    pub conductivity: Conductivity,
    /// What comes of it with pores.
    pub conduction: PorousConductivity,
    /// Diameter of the pores in m, by which molecules meet walls.
    pub pore_diameter: f64,
    /// Tortuosity τ: gases diffuse by ε/τ.
    pub tortuosity: f64,
    /// Permeability.
    pub permeability: Permeability,
    /// How shells take up room.
    pub size: SizeChange,
    /// Gas that stands in the pores where reactions exchange none, by which they conduct.
    pub standing_gas: Option<StandingGas>,
}

/// Gas in pores that nothing changes.
#[derive(Clone, Debug, PartialEq)]
pub struct StandingGas {
    /// What it is.
    pub model: GasModel,
    /// Mass fraction of each species; empty of a gas of one.
    pub composition: Vec<f64>,
}

impl StandingGas {
    /// Conductivity in W/m/K at a temperature in K.
    pub fn conductivity(&self, temperature: f64) -> f64 {
        self.model.conductivity(temperature, &self.composition)
    }
}

/// What is in the pores of a particle that comes in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoreGas {
    /// Pressure in Pa.
    pub pressure: f64,
    /// Mole fraction of each species; empty without a gas.
    pub fractions: Vec<f64>,
}

/// When a particle has its shells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShellResolution {
    /// It is one shell.
    One,
    /// From the start.
    All,
    /// From where the difference inside is more than one of these.
    Beyond {
        /// Difference of temperature in K.
        temperature: f64,
        /// Difference of the partial pressure of a gas, as a share of the pressure.
        pressure: f64,
    },
}

/// How particles with shells are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialNumerics {
    /// The shells.
    pub grid: ShellGrid,
    /// When particles have them.
    pub resolution: ShellResolution,
    /// Error of the temperature in a step in K, a mean over the particle.
    pub temperature: f64,
    /// Error of what reactions turn over in a step, as a share of the solids of the particle.
    pub conversion: f64,
}

impl RadialNumerics {
    /// So many shells from the start, with default tolerances.
    pub fn new(grid: ShellGrid) -> Self {
        Self {
            grid,
            resolution: ShellResolution::All,
            temperature: 1.0,
            conversion: 1e-3,
        }
    }
}
