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
mod model;
mod none;
mod rong_horio;

pub use area::{ContactArea, ElasticLaw, Stiffness};
pub use batchelor_obrien::BatchelorObrien;
pub use cheng::Cheng;
pub use conductivity::Conductivity;
pub use gap::{GasGap, NoGap, SphereGap};
pub use lens::Lens;
pub use model::{Conduction, SphereContact};
pub use none::NoConduction;
pub use rong_horio::RongHorio;

use crate::law::LawEntry;

/// The laws of contacts that a case may choose. A new one is a file beside these, declared above and listed here.
pub static CONDUCTION_LAWS: &[&LawEntry<dyn Conduction>] =
    &[&batchelor_obrien::LAW, &lens::LAW, &none::LAW];

/// The laws of the gas between surfaces that a case may choose.
pub static GAP_LAWS: &[&LawEntry<dyn GasGap>] = &[&rong_horio::LAW, &cheng::LAW, &gap::NO_GAP];
