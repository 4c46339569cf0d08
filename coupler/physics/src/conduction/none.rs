//! No conduction between particles.

use super::{Conduction, Contact};

/// Particles exchange no heat where they touch.
#[derive(Clone, Copy, Debug)]
pub struct NoConduction;

impl Conduction for NoConduction {
    fn name(&self) -> &'static str {
        "none"
    }

    fn conductance(&self, _: &Contact) -> f64 {
        0.0
    }
}
