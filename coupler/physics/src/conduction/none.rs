//! No conduction between particles.

use super::{Conduction, SphereContact};

/// Particles exchange no heat where they touch.
#[derive(Clone, Copy, Debug)]
pub struct NoConduction;

impl Conduction for NoConduction {
    fn name(&self) -> &'static str {
        "none"
    }

    fn conductance(&self, _: &SphereContact) -> f64 {
        0.0
    }
}
