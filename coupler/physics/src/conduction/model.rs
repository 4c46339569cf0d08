//! What a law of conduction through contacts is told, and gives.

use std::fmt::Debug;

/// Two spheres that overlap; a flat wall is one of endless radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereContact {
    /// Radii in m.
    pub radius: [f64; 2],
    /// Overlap δ in m: the sum of the radii less the distance of the centres, positive.
    pub overlap: f64,
    /// Conductivities in W/m/K.
    pub conductivity: [f64; 2],
}

impl SphereContact {
    /// Harmonic mean of the conductivities in W/m/K.
    pub fn conductivity(&self) -> f64 {
        let [own, other] = self.conductivity;
        2.0 * own * other / (own + other)
    }

    /// Reduced radius R* in m, 1/R* = 1/R₁ + 1/R₂.
    pub fn reduced_radius(&self) -> f64 {
        reduced(self.radius)
    }
}

/// R* in m of two radii, of which one may be endless.
pub(super) fn reduced([own, other]: [f64; 2]) -> f64 {
    if other.is_infinite() {
        own
    } else if own.is_infinite() {
        other
    } else {
        own * other / (own + other)
    }
}

/// Conduction through the contact of two particles.
pub trait Conduction: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// Conductance G in W/K: the heat from the second to the first particle is G (T₂ − T₁).
    fn conductance(&self, contact: &SphereContact) -> f64;
}
