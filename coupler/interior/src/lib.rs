//! What happens inside and between particles.

mod model;
mod network;
mod thin;

pub use model::ParticleModel;
pub use network::{Network, Touch};
pub use thin::Thin;
