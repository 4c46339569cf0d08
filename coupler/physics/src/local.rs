//! The gas that one particle sees.

use crate::numbers::VoidFraction;

/// Local state of the gas around a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalGas {
    /// Void fraction ε.
    pub void_fraction: VoidFraction,
    /// Gas density ρ in kg/m³.
    pub density: f64,
    /// Dynamic viscosity μ in Pa s.
    pub viscosity: f64,
    /// Thermal conductivity κ in W/m/K.
    pub conductivity: f64,
    /// Specific heat capacity c_p in J/kg/K.
    pub heat_capacity: f64,
    /// Magnitude of the interstitial slip |u − v| in m/s.
    pub slip: f64,
}

impl LocalGas {
    /// Reynolds number on the interstitial slip, ρ |u − v| d/μ; diameter in m.
    pub fn interstitial_reynolds(&self, diameter: f64) -> f64 {
        self.density * self.slip * diameter / self.viscosity
    }

    /// Reynolds number on the superficial slip, ρ ε |u − v| d/μ; diameter in m.
    pub fn superficial_reynolds(&self, diameter: f64) -> f64 {
        self.void_fraction.value() * self.interstitial_reynolds(diameter)
    }

    /// Prandtl number c_p μ/κ.
    pub fn prandtl(&self) -> f64 {
        self.heat_capacity * self.viscosity / self.conductivity
    }

    /// Schmidt number μ/(ρ D); diffusivity D of the species in m²/s.
    pub fn schmidt(&self, diffusivity: f64) -> f64 {
        self.viscosity / (self.density * diffusivity)
    }
}

#[cfg(test)]
impl LocalGas {
    /// Air of 1.2 kg/m³ and 1.82e-5 Pa s, as the independent values of the drag laws assume.
    pub(crate) fn air(void_fraction: f64, slip: f64) -> Self {
        Self {
            void_fraction: VoidFraction::new(void_fraction).unwrap(),
            density: 1.2,
            viscosity: 1.82e-5,
            conductivity: 0.026,
            heat_capacity: 1006.0,
            slip,
        }
    }

    /// Gas that has the slip as its interstitial Reynolds number at a sphere of 1 m.
    pub(crate) fn of_numbers(void_fraction: f64, reynolds: f64, prandtl: f64) -> Self {
        Self {
            void_fraction: VoidFraction::new(void_fraction).unwrap(),
            density: 1.0,
            viscosity: 1.0,
            conductivity: 1.0,
            heat_capacity: prandtl,
            slip: reynolds,
        }
    }
}
