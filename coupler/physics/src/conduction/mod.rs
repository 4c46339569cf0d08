//! Heat conduction between particles that touch, one law a file.

mod batchelor_obrien;
mod lens;
mod none;

use std::fmt::Debug;

pub use batchelor_obrien::BatchelorObrien;
pub use lens::Lens;
pub use none::NoConduction;

/// Two spheres that overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Radii in m.
    pub radius: [f64; 2],
    /// Overlap δ in m: the sum of the radii less the distance of the centres, positive.
    pub overlap: f64,
    /// Conductivities in W/m/K.
    pub conductivity: [f64; 2],
}

impl Contact {
    /// Harmonic mean of the conductivities in W/m/K.
    pub fn conductivity(&self) -> f64 {
        let [own, other] = self.conductivity;
        2.0 * own * other / (own + other)
    }

    /// Reduced radius R* = R₁R₂/(R₁ + R₂) in m.
    pub fn reduced_radius(&self) -> f64 {
        let [own, other] = self.radius;
        own * other / (own + other)
    }
}

/// Conduction through the contact of two particles.
pub trait Conduction: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// Conductance G in W/K: the heat from the second to the first particle is G (T₂ − T₁).
    fn conductance(&self, contact: &Contact) -> f64;
}
