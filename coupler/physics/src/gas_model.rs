//! The gas of a case as the solvers ask for it, whatever it is made of. `composition` is the mass
//! fractions in the order of the mixture's species, and empty for a single gas.

use crate::gas::{GasProperties, REFERENCE_TEMPERATURE};
use crate::thermo::Mixture;

/// What the gas is.
#[derive(Clone, Debug, PartialEq)]
pub enum GasModel {
    /// A single ideal gas with constant heat capacity and Sutherland transport.
    Perfect(GasProperties),
    /// A single fluid of constant properties.
    Constant(ConstantGas),
    /// A mixture of ideal gases.
    Mixture(Mixture),
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
            Self::Mixture(mixture) => mixture.names(),
        }
    }

    /// No gas at all: neither mass nor pressure, and nothing that moves heat or drags.
    pub const VACUUM: Self = Self::Constant(ConstantGas {
        density: 0.0,
        heat_capacity: 0.0,
        viscosity: 0.0,
        conductivity: 0.0,
    });

    /// True where there is no gas.
    pub fn is_vacuum(&self) -> bool {
        *self == Self::VACUUM
    }

    /// True where density follows pressure and temperature.
    pub fn compressible(&self) -> bool {
        !matches!(self, Self::Constant(_))
    }

    /// Lowest and highest temperature in K for which its properties are given: where all polynomials of a mixture hold.
    pub fn temperature_range(&self) -> (f64, f64) {
        match self {
            Self::Perfect(_) | Self::Constant(_) => (0.0, f64::INFINITY),
            Self::Mixture(mixture) => mixture.range(),
        }
    }

    /// Density in kg/m³ at a pressure in Pa and a temperature in K.
    pub fn density(&self, pressure: f64, temperature: f64, composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.density(pressure, temperature),
            Self::Constant(gas) => gas.density,
            Self::Mixture(mixture) => mixture.density(pressure, temperature, composition),
        }
    }

    /// Specific heat capacity c_p in J/kg/K.
    pub fn heat_capacity(&self, temperature: f64, composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.heat_capacity,
            Self::Constant(gas) => gas.heat_capacity,
            Self::Mixture(mixture) => mixture.heat_capacity(temperature, composition),
        }
    }

    /// Sensible enthalpy in J/kg, zero at 298.15 K.
    pub fn enthalpy(&self, temperature: f64, composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.enthalpy(temperature),
            Self::Constant(gas) => gas.heat_capacity * (temperature - REFERENCE_TEMPERATURE),
            Self::Mixture(mixture) => mixture.enthalpy(temperature, composition),
        }
    }

    /// Temperature in K of a sensible enthalpy in J/kg; `guess` in K is near it. Not a number where a
    /// mixture has none between 1 K and 20000 K.
    pub fn temperature(&self, enthalpy: f64, composition: &[f64], guess: f64) -> f64 {
        match self {
            Self::Perfect(gas) => gas.temperature(enthalpy),
            Self::Constant(gas) => REFERENCE_TEMPERATURE + enthalpy / gas.heat_capacity,
            Self::Mixture(mixture) => mixture
                .temperature(enthalpy, composition, guess)
                .unwrap_or(f64::NAN),
        }
    }

    /// Sensible enthalpy of a species in J/kg.
    pub fn species_enthalpy(&self, species: usize, temperature: f64) -> f64 {
        match self {
            Self::Perfect(_) | Self::Constant(_) => self.enthalpy(temperature, &[]),
            Self::Mixture(mixture) => mixture.species_enthalpy(species, temperature),
        }
    }

    /// Enthalpy of formation of a species at 298.15 K in J/kg; zero for a single gas.
    pub fn formation_enthalpy(&self, species: usize) -> f64 {
        match self {
            Self::Perfect(_) | Self::Constant(_) => 0.0,
            Self::Mixture(mixture) => mixture.species()[species].formation_enthalpy(),
        }
    }

    /// Specific heat capacity of a species in J/kg/K.
    pub fn species_heat_capacity(&self, species: usize, temperature: f64) -> f64 {
        match self {
            Self::Perfect(_) | Self::Constant(_) => self.heat_capacity(temperature, &[]),
            Self::Mixture(mixture) => mixture.species()[species].heat_capacity(temperature),
        }
    }

    /// Each element with its mass in a unit mass of each species; empty for a single gas.
    pub fn elements(&self) -> Vec<(String, Vec<f64>)> {
        match self {
            Self::Perfect(_) | Self::Constant(_) => Vec::new(),
            Self::Mixture(mixture) => mixture.elements(),
        }
    }

    /// Speed of sound √(γ R T/M) in m/s at a temperature in K; none of a fluid of constant density.
    pub fn sound_speed(&self, temperature: f64, composition: &[f64]) -> Option<f64> {
        if !self.compressible() {
            return None;
        }
        // p/ρ of an ideal gas is R T/M at any pressure.
        let pressure = 1e5;
        let squared = pressure / self.density(pressure, temperature, composition);
        let capacity = self.heat_capacity(temperature, composition);
        let ratio = capacity / (capacity - squared / temperature);
        Some((ratio * squared).sqrt())
    }

    /// Dynamic viscosity in Pa s.
    pub fn viscosity(&self, temperature: f64, composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.viscosity(temperature),
            Self::Constant(gas) => gas.viscosity,
            Self::Mixture(mixture) => mixture.viscosity(temperature, composition),
        }
    }

    /// Thermal conductivity in W/m/K.
    pub fn conductivity(&self, temperature: f64, composition: &[f64]) -> f64 {
        match self {
            Self::Perfect(gas) => gas.conductivity(temperature),
            Self::Constant(gas) => gas.conductivity,
            Self::Mixture(mixture) => mixture.conductivity(temperature, composition),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn sound_has_its_speed_in_gases_and_none_where_density_is_constant() {
        // Lemmon, Jacobsen, Penoncello and Friend (2000): 347.2 m/s in dry air of 300 K at 1 bar; argon, √(5/3 · 8.314462618 · 300/0.039948).
        let air = GasModel::Mixture(Mixture::new(["O2", "N2", "Ar"]).unwrap());
        let dry = [0.2314, 0.7557, 0.0129];
        let speed = air.sound_speed(300.0, &dry).unwrap();
        assert!((speed / 347.2 - 1.0).abs() < 1e-3, "{speed}");
        let argon = air.sound_speed(300.0, &[0.0, 0.0, 1.0]).unwrap();
        assert!((argon / 322.60 - 1.0).abs() < 1e-3, "{argon}");
        let water = ConstantGas {
            density: 998.0,
            heat_capacity: 4182.0,
            viscosity: 1e-3,
            conductivity: 0.6,
        };
        assert_eq!(GasModel::Constant(water).sound_speed(300.0, &[]), None);
    }
}
