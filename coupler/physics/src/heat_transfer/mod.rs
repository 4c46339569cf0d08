//! Heat transfer between gas and particle, one law a file.

mod gnielinski;
mod gunn;
mod li_mason;
mod model;
mod none;
mod ranz_marshall;
mod wakao;

pub use gnielinski::Gnielinski;
pub use gunn::Gunn;
pub use li_mason::LiMason;
pub use model::HeatTransfer;
pub use none::NoHeatTransfer;
pub use ranz_marshall::RanzMarshall;
pub use wakao::Wakao;

use crate::law::LawEntry;

/// The laws of heat transfer, and by analogy of mass transfer, that a case may choose. A new one is a file beside
/// these, declared above and listed here.
pub static HEAT_TRANSFER_LAWS: &[&LawEntry<dyn HeatTransfer>] = &[
    &gunn::LAW,
    &wakao::LAW,
    &gnielinski::LAW,
    &ranz_marshall::LAW,
    &li_mason::LAW,
    &none::LAW,
];
