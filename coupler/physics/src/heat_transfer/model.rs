//! What a law of heat transfer gives.

use std::fmt::Debug;

use crate::flow_range::FlowRange;
use crate::local::LocalGas;

/// Heat transfer between the gas and the surface of one particle.
pub trait HeatTransfer: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// Nusselt number Nu = h d/κ, such that the heat into the particle is
    /// Q = h π d² (T_gas − T_particle); diameter in m.
    fn nusselt(&self, gas: &LocalGas, diameter: f64) -> f64;

    /// The flow that its source states it for.
    fn range(&self) -> FlowRange {
        FlowRange::UNSTATED
    }
}
