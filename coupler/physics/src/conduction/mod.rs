//! Heat conduction between particles that touch, or nearly so, one law a file.
//!
//! Three things add up to the conductance of a pair: through the contact (trait [`Conduction`]), whose
//! overlap may be that of the real, stiffer material ([`ContactArea`]), and through the gas between the
//! surfaces around it (trait [`GasGap`]).

mod area;
mod batchelor_obrien;
mod cheng;
mod conductivity;
mod gap;
mod lens;
mod none;
mod rong_horio;

use std::fmt::Debug;

pub use area::{ContactArea, ElasticLaw, Stiffness};
pub use batchelor_obrien::BatchelorObrien;
pub use cheng::Cheng;
pub use conductivity::Conductivity;
pub use gap::{GasGap, NoGap, SphereGap};
pub use lens::Lens;
pub use none::NoConduction;
pub use rong_horio::RongHorio;

use crate::law::LawEntry;

/// The laws of contacts that a case may choose. A new one is a file beside these, declared above and listed here.
pub static CONDUCTION_LAWS: &[&LawEntry<dyn Conduction>] =
    &[&batchelor_obrien::LAW, &lens::LAW, &none::LAW];

/// The laws of the gas between surfaces that a case may choose.
pub static GAP_LAWS: &[&LawEntry<dyn GasGap>] = &[&rong_horio::LAW, &cheng::LAW, &gap::NO_GAP];

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
fn reduced([own, other]: [f64; 2]) -> f64 {
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
