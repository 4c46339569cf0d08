//! Properties of the gas mixture.

/// Universal gas constant in J/mol/K.
pub const GAS_CONSTANT: f64 = 8.314_462_618;
/// Temperature at which the sensible enthalpy is zero, in K.
pub const REFERENCE_TEMPERATURE: f64 = 298.15;

/// An ideal gas with constant heat capacity and Sutherland transport.
///
/// ρ = p M/(R T);  h = c_p (T − 298.15 K);  μ = A_s √T/(1 + T_s/T);
/// κ = μ c_v (1.32 + 1.77 (R/M)/c_v), the modified Eucken form (docs/theory.md, COR-7).
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
    /// Dry air: M = 28.96 g/mol (US Standard Atmosphere 1976: 28.9644); c_p = 1007 J/kg/K, the
    /// mean of 1006.4 at 300 K and 1013.5 at 400 K weighted towards room temperature (Incropera,
    /// Fundamentals of Heat and Mass Transfer, table A.4); Sutherland's constants as in
    /// docs/theory.md, COR-7.
    pub fn air() -> Self {
        Self {
            molar_mass: 28.96e-3,
            heat_capacity: 1007.0,
            sutherland_coefficient: 1.4792e-6,
            sutherland_temperature: 116.0,
        }
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_at_300_k_has_the_properties_of_the_tables() {
        let air = GasProperties::air();
        // Incropera, table A.4 at 300 K and 1 atm: ρ 1.1614 kg/m³ (at 1.0033 atm … 1.1766 by the
        // ideal gas at 101325 Pa), μ 184.6e-7 Pa s, κ 26.3e-3 W/m/K (modified Eucken: 2.5 % more).
        assert!((air.density(101_325.0, 300.0) - 1.17640).abs() < 1e-4);
        assert!((air.viscosity(300.0) - 184.6e-7).abs() < 0.01 * 184.6e-7);
        assert!((air.conductivity(300.0) - 26.3e-3).abs() < 0.03 * 26.3e-3);
    }

    #[test]
    fn transport_agrees_with_an_independent_evaluation_at_400_k() {
        // In Python: 1.4792e-6·20/(1 + 0.29) and μ c_v (1.32 + 1.77 R/c_v), R = 287.1016.
        let air = GasProperties::air();
        assert!((air.viscosity(400.0) / 2.293_333_333e-5 - 1.0).abs() < 1e-9);
        assert!((air.conductivity(400.0) / 3.344679261e-02 - 1.0).abs() < 1e-7);
    }

    #[test]
    fn enthalpy_and_temperature_are_inverse() {
        let air = GasProperties::air();
        assert!((air.temperature(air.enthalpy(777.0)) - 777.0).abs() < 1e-10);
        assert_eq!(air.enthalpy(298.15), 0.0);
    }
}
