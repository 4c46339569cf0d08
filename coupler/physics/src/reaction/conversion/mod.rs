//! How the rate of a reaction in the whole of a porous solid follows what is left of the solid (docs/theory.md, XDP-9).
//!
//! Such a law is a function f(w) of the share w of the solid that is left, one where nothing has reacted, of the rate
//! r = k(T) n₀ f(w) Π c_i^n_i in mol/s, n₀ the amount at the start. Below a share of [`TRACE`] each ends along a line through
//! zero, so that the implicit steps of a particle find the end.

mod choice;
mod contracting_area;
mod contracting_volume;
mod conversion_law;
mod entries;
mod equilibrium_pressure;
mod first_order;
mod nucleation;
mod random_pore;

pub use choice::Conversion;
pub use contracting_area::ContractingArea;
pub use contracting_volume::ContractingVolume;
pub use conversion_law::{ConversionLaw, TRACE};
pub use entries::{
    CONTRACTING_AREA, CONTRACTING_VOLUME, EQUILIBRIUM_PRESSURE, FIRST_ORDER, NUCLEATION,
    RANDOM_PORE,
};
pub use equilibrium_pressure::GrainSurface;
pub use first_order::FirstOrder;
pub use nucleation::Nucleation;
pub use random_pore::RandomPore;
