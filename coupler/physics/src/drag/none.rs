//! No drag.

use super::Drag;
use crate::local::LocalGas;

/// No drag: K_A = 0.
#[derive(Clone, Copy, Debug)]
pub struct NoDrag;

impl Drag for NoDrag {
    fn name(&self) -> &'static str {
        "none"
    }

    fn coefficient(&self, _: &LocalGas, _: f64) -> f64 {
        0.0
    }
}
