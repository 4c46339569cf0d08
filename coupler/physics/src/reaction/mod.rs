//! Reactions: equations, rate constants, equilibria, and the laws by which particles react.

pub mod arrhenius;
pub mod conversion;
pub mod devolatilisation;
pub mod equation;
pub mod equilibrium;
pub mod evaporation;
pub mod formula;
pub mod layer_diffusivity;
pub mod power_law;
pub mod rate_law;
pub mod shrinking_core;
pub mod wet_entries;

pub use arrhenius::Arrhenius;
pub use conversion::{Conversion, GrainSurface};
pub use devolatilisation::Devolatilisation;
pub use equation::{Equation, EquationError, imbalance};
pub use equilibrium::Equilibrium;
pub use evaporation::Evaporation;
pub use layer_diffusivity::LayerDiffusivity;
pub use power_law::PowerLaw;
pub use rate_law::RateLaw;
pub use shrinking_core::Interface;

use crate::law::LawEntry;

/// The laws by which a case may let particles react.
pub static RATE_LAWS: &[&LawEntry<RateLaw>] = &[
    &shrinking_core::LAW,
    &power_law::LAW,
    &conversion::FIRST_ORDER,
    &conversion::CONTRACTING_AREA,
    &conversion::CONTRACTING_VOLUME,
    &conversion::NUCLEATION,
    &conversion::RANDOM_PORE,
    &conversion::EQUILIBRIUM_PRESSURE,
    &wet_entries::EVAPORATION,
    &wet_entries::WOOD_DRYING,
    &wet_entries::DEVOLATILISATION,
];
