//! What happens inside and between particles.

mod model;
mod thin;

pub use model::ParticleModel;
pub use thin::Thin;
