//! Turbulence of the gas outside beds.

mod k_epsilon;
mod log_law;

pub use k_epsilon::{KEpsilon, energy_of_intensity};
pub use log_law::LogLaw;
