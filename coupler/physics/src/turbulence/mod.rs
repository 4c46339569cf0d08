//! Turbulence of the gas, outside beds and in their pores.

mod bed_eddies;
mod k_epsilon;
mod log_law;
mod nakayama_kuwahara;
mod none;
mod pedras_de_lemos;

pub use bed_eddies::{BedEddies, EddySource};
pub use k_epsilon::{KEpsilon, energy_of_intensity};
pub use log_law::LogLaw;
pub use nakayama_kuwahara::NakayamaKuwahara;
pub use none::NoBedEddies;
pub use pedras_de_lemos::PedrasDeLemos;

use crate::law::LawEntry;

/// The laws of eddies in the bed that a case may choose. A new one is a file beside these, declared above and listed
/// here.
pub static BED_EDDY_LAWS: &[&LawEntry<dyn BedEddies>] =
    &[&nakayama_kuwahara::LAW, &pedras_de_lemos::LAW, &none::LAW];
