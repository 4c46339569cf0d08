//! Effective conductivity of packed beds of spheres in still gas, one correlation a file: what the particles
//! of a run are compared with.

mod yagi_kunii;
mod zehner_bauer_schluender;

pub use yagi_kunii::YagiKunii;
pub use zehner_bauer_schluender::ZehnerBauerSchluender;

/// A packed bed at one temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackedBed {
    /// Void fraction ε.
    pub void_fraction: f64,
    /// Diameter of the spheres in m.
    pub diameter: f64,
    /// Conductivity of the solid in W/m/K.
    pub solid_conductivity: f64,
    /// Conductivity of the gas in W/m/K.
    pub gas_conductivity: f64,
    /// Emissivity of the surfaces.
    pub emissivity: f64,
    /// Temperature in K.
    pub temperature: f64,
}

/// A correlation.
pub trait BedConductivity {
    /// Effective conductivity in W/m/K, radiation included.
    fn conductivity(&self, bed: &PackedBed) -> f64;
}
