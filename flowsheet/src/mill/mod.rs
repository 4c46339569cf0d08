//! Laws of mills: the distribution that comes out. One law a file.

mod bimodal;
mod bond;
mod bond_normal;
mod cone;
mod constant;
mod model;

pub use bimodal::BondBimodal;
pub use bond::{BondLaw, BondLength};
pub use bond_normal::BondNormal;
pub use cone::ConeMill;
pub use constant::ConstantMill;
pub use model::MillLaw;

use calcine_physics::law::LawEntry;

/// The laws of mills that a case may choose. A new one is a file beside these, declared above and listed here.
pub static MILL_LAWS: &[&LawEntry<dyn MillLaw>] = &[
    &bond_normal::LAW,
    &bond_normal::IN_MILLIMETRES,
    &bimodal::LAW,
    &bimodal::IN_MILLIMETRES,
    &cone::LAW,
    &constant::LAW,
];
