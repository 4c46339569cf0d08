//! Drag laws, one a file.

mod ergun_wen_yu;
mod none;

use std::fmt::Debug;

pub use ergun_wen_yu::ErgunWenYu;
pub use none::NoDrag;

use crate::local::LocalGas;

/// Drag of the gas on one particle.
pub trait Drag: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// Drag coefficient K_A in kg/s, pressure force excluded (requirements DRG-1),
    /// such that the drag on the particle is F = K_A (u − v); diameter in m.
    fn coefficient(&self, gas: &LocalGas, diameter: f64) -> f64;
}
