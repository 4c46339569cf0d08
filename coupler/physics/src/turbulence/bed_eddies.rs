//! What the particles of a bed do to the eddies in its pores.

use std::fmt::Debug;

use crate::local::LocalGas;

/// What a law adds to the equations of k and ε of the gas in a bed, per mass of gas:
///
/// Dk/Dt = … + `energy` + `growth` k,   Dε/Dt = … + `dissipation` + C₂ `growth` ε,
///
/// all zero or above; C₂ is that of the k-epsilon model ([`super::KEpsilon::destruction`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EddySource {
    /// Production of k in m²/s³.
    pub energy: f64,
    /// Production of ε in m²/s⁴.
    pub dissipation: f64,
    /// Rate in 1/s at which k, and C₂ times which ε, grow.
    pub growth: f64,
}

/// Eddies that the flow through the pores of a bed makes, for the volume-averaged k-epsilon model.
pub trait BedEddies: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// What the particles add to k and ε at the void fraction and the interstitial slip velocity of a bed, with the
    /// diameter in m of spheres of its surface per volume.
    fn source(&self, gas: &LocalGas, diameter: f64) -> EddySource;
}
