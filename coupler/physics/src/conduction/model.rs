//! What a law of conduction through contacts is told, and gives.

use std::f64::consts::PI;
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

    /// Area in m² of the circle in which the spheres cut each other; zero where they do not.
    pub fn intersection(&self) -> f64 {
        let [own, other] = self.radius;
        if other.is_infinite() {
            // A plane cuts the sphere: r² = R² − (R − δ)².
            let area = PI * self.overlap * (2.0 * own - self.overlap);
            return area.max(0.0);
        }
        let d = own + other - self.overlap;
        // Heron: 16 times the square of the triangle of both radii and the distance is 4 d² r².
        let product = (own + other - d) * (d + own - other) * (d - own + other) * (d + own + other);
        PI * product.max(0.0) / (4.0 * d * d)
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
