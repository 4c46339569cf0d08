//! Drag of a lone sphere by Schiller and Naumann (1933), apart from Calcine: the limit of Wen and Yu's law.

use std::f64::consts::PI;

/// A sphere in a fluid: diameter in m, densities in kg/m³, viscosity in Pa s.
pub struct Sphere {
    pub diameter: f64,
    pub density: f64,
    pub fluid: f64,
    pub viscosity: f64,
}

impl Sphere {
    /// A sphere in air of 300 K and 1 atm: 28.96 g/mol, Sutherland's viscosity.
    pub fn in_air(diameter: f64, density: f64) -> Self {
        Self {
            diameter,
            density,
            fluid: 101_325.0 * 0.028_96 / (8.314_462_618 * 300.0),
            viscosity: 1.716e-5 * (300.0f64 / 273.15).powf(1.5) * (273.15 + 110.4)
                / (300.0 + 110.4),
        }
    }

    pub fn volume(&self) -> f64 {
        PI / 6.0 * self.diameter.powi(3)
    }

    /// Drag in N over the speed in m/s: 3πμd (1 + 0.15 Re^0.687).
    pub fn resistance(&self, speed: f64) -> f64 {
        let re = self.fluid * speed * self.diameter / self.viscosity;
        3.0 * PI * self.viscosity * self.diameter * (1.0 + 0.15 * re.powf(0.687))
    }

    /// Speed in m/s at which drag holds the buoyant weight, by bisection.
    pub fn terminal(&self) -> f64 {
        let weight = self.volume() * (self.density - self.fluid) * 9.81;
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if self.resistance(middle) * middle < weight {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}
