//! The gas of a case as the solvers ask for it, whatever it is made of. `composition` is the mass
//! fractions in the order of the mixture's species, and empty for a single gas.

use crate::gas::GasProperties;

/// What the gas is.
#[derive(Clone, Debug, PartialEq)]
pub enum GasModel {
    /// A single ideal gas with constant heat capacity and Sutherland transport.
    Perfect(GasProperties),
    /// A single fluid of constant properties.
    Constant(ConstantGas),
}

/// A fluid of constant properties; its enthalpy is c_p (T − 298.15 K).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantGas {
    /// Density in kg/m³.
    pub density: f64,
    /// Specific heat capacity c_p in J/kg/K.
    pub heat_capacity: f64,
    /// Dynamic viscosity in Pa s.
    pub viscosity: f64,
    /// Thermal conductivity in W/m/K.
    pub conductivity: f64,
}

impl From<GasProperties> for GasModel {
    fn from(gas: GasProperties) -> Self {
        Self::Perfect(gas)
    }
}

impl GasModel {
    /// Names of the species; empty for a single gas.
    pub fn species(&self) -> &[String] {
        match self {
            Self::Perfect(_) | Self::Constant(_) => &[],
        }
    }

    /// True where density follows pressure and temperature.
    pub fn compressible(&self) -> bool {
        !matches!(self, Self::Constant(_))
    }

    /// Density in kg/m³ at a pressure in Pa and a temperature in K.
    pub fn density(&self, pressure: f64, temperature: f64, _composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.density(pressure, temperature),
            Self::Constant(gas) => gas.density,
        }
    }

    /// Specific heat capacity c_p in J/kg/K.
    pub fn heat_capacity(&self, _temperature: f64, _composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.heat_capacity,
            Self::Constant(gas) => gas.heat_capacity,
        }
    }

    /// Sensible enthalpy in J/kg, zero at 298.15 K.
    pub fn enthalpy(&self, temperature: f64, _composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.enthalpy(temperature),
            Self::Constant(gas) => {
                gas.heat_capacity * (temperature - crate::gas::REFERENCE_TEMPERATURE)
            }
        }
    }

    /// Temperature in K of a sensible enthalpy in J/kg; `guess` in K is near it.
    pub fn temperature(&self, enthalpy: f64, _composition: &[f64], _guess: f64) -> f64 {
        match self {
            Self::Perfect(gas) => gas.temperature(enthalpy),
            Self::Constant(gas) => crate::gas::REFERENCE_TEMPERATURE + enthalpy / gas.heat_capacity,
        }
    }

    /// Sensible enthalpy of a species in J/kg.
    pub fn species_enthalpy(&self, _species: usize, temperature: f64) -> f64 {
        self.enthalpy(temperature, &[])
    }

    /// Dynamic viscosity in Pa s.
    pub fn viscosity(&self, temperature: f64, _composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.viscosity(temperature),
            Self::Constant(gas) => gas.viscosity,
        }
    }

    /// Thermal conductivity in W/m/K.
    pub fn conductivity(&self, temperature: f64, _composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.conductivity(temperature),
            Self::Constant(gas) => gas.conductivity,
        }
    }
}
