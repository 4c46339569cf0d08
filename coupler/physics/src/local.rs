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
}
