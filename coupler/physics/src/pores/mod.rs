//! Transport in the pores of a solid, and through it.

pub mod conductivity;
pub mod dusty_gas;
pub mod knudsen;
pub mod permeability;

pub use conductivity::{CONDUCTIVITY_LAWS, PorousConductivity};
pub use dusty_gas::DustyGas;
pub use permeability::{PERMEABILITY_LAWS, Permeability};
