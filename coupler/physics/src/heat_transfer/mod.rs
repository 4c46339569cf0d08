//! Heat transfer between gas and particle, one law a file.

mod gnielinski;
mod gunn;
mod none;
mod ranz_marshall;
mod wakao;

use std::fmt::Debug;

pub use gnielinski::Gnielinski;
pub use gunn::Gunn;
pub use none::NoHeatTransfer;
pub use ranz_marshall::RanzMarshall;
pub use wakao::Wakao;

use crate::law::LawEntry;
use crate::local::LocalGas;

/// The laws of heat transfer, and by analogy of mass transfer, that a case may choose. A new one is a file beside
/// these, declared above and listed here.
pub static HEAT_TRANSFER_LAWS: &[&LawEntry<dyn HeatTransfer>] = &[
    &gunn::LAW,
    &wakao::LAW,
    &gnielinski::LAW,
    &ranz_marshall::LAW,
    &none::LAW,
];

/// Heat transfer between the gas and the surface of one particle.
pub trait HeatTransfer: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// Nusselt number Nu = h d/κ, such that the heat into the particle is
    /// Q = h π d² (T_gas − T_particle); diameter in m.
    fn nusselt(&self, gas: &LocalGas, diameter: f64) -> f64;
}
