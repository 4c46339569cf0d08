//! What a drag law gives.

use std::fmt::Debug;

use crate::flow_range::FlowRange;
use crate::local::LocalGas;

/// Drag of the gas on one particle.
pub trait Drag: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// Drag coefficient K_A in kg/s, pressure force excluded (docs/theory.md, DRG-1),
    /// such that the drag on the particle is F = K_A (u − v); diameter in m.
    fn coefficient(&self, gas: &LocalGas, diameter: f64) -> f64;

    /// The flow that its source states it for.
    fn range(&self) -> FlowRange {
        FlowRange::UNSTATED
    }
}
