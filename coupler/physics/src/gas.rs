//! Properties of the gas mixture.

/// Universal gas constant in J/mol/K.
pub const GAS_CONSTANT: f64 = 8.314_462_618;
/// Temperature at which the sensible enthalpy is zero, in K.
pub const REFERENCE_TEMPERATURE: f64 = 298.15;

/// An ideal gas with constant heat capacity and Sutherland transport.
///
/// ρ = p M/(R T);  h = c_p (T − 298.15 K);  μ = A_s √T/(1 + T_s/T);
/// κ = μ c_v (1.32 + 1.77 (R/M)/c_v), the modified Eucken form (requirements COR-7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasProperties {
    /// Molar mass M in kg/mol.
    pub molar_mass: f64,
    /// Specific heat capacity c_p in J/kg/K.
    pub heat_capacity: f64,
    /// Sutherland coefficient A_s in kg/m/s/K^½.
    pub sutherland_coefficient: f64,
    /// Sutherland temperature T_s in K.
    pub sutherland_temperature: f64,
}

impl GasProperties {
    /// Specific gas constant R/M in J/kg/K.
    pub fn specific_gas_constant(&self) -> f64 {
        GAS_CONSTANT / self.molar_mass
    }

    /// Density in kg/m³ at a pressure in Pa and a temperature in K.
    pub fn density(&self, pressure: f64, temperature: f64) -> f64 {
        pressure / (self.specific_gas_constant() * temperature)
    }

    /// Sensible enthalpy in J/kg.
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        self.heat_capacity * (temperature - REFERENCE_TEMPERATURE)
    }

    /// Temperature in K of a sensible enthalpy in J/kg.
    pub fn temperature(&self, enthalpy: f64) -> f64 {
        REFERENCE_TEMPERATURE + enthalpy / self.heat_capacity
    }

    /// Dynamic viscosity in Pa s.
    pub fn viscosity(&self, temperature: f64) -> f64 {
        self.sutherland_coefficient * temperature.sqrt()
            / (1.0 + self.sutherland_temperature / temperature)
    }

    /// Thermal conductivity in W/m/K.
    pub fn conductivity(&self, temperature: f64) -> f64 {
        let gas_constant = self.specific_gas_constant();
        let isochoric = self.heat_capacity - gas_constant;
        self.viscosity(temperature) * isochoric * (1.32 + 1.77 * gas_constant / isochoric)
    }
}
