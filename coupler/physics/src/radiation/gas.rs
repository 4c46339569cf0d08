//! What the gas between particles does to radiation.

use std::fmt::Debug;

use crate::local::LocalGas;

/// Radiation of the gas phase: how strongly gas absorbs, and by Kirchhoff's law emits.
pub trait GasRadiation: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// Absorption coefficient κ in 1/m: of radiation along a path of length s, 1 − exp(−κ s) is absorbed.
    fn absorption(&self, gas: &LocalGas) -> f64;
}

/// The gas neither absorbs nor emits: κ = 0. Good for air, nitrogen and other gases of two equal atoms; over
/// the few millimetres between particles a good approximation for flue gas too (CO2 and H2O at 1 atm
/// together: κ of order 1/m).
#[derive(Clone, Copy, Debug)]
pub struct TransparentGas;

impl GasRadiation for TransparentGas {
    fn name(&self) -> &'static str {
        "none"
    }

    fn absorption(&self, _: &LocalGas) -> f64 {
        0.0
    }
}
