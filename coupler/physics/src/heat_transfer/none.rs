//! No heat transfer.

use super::HeatTransfer;
use crate::local::LocalGas;

/// No heat transfer: Nu = 0.
#[derive(Clone, Copy, Debug)]
pub struct NoHeatTransfer;

impl HeatTransfer for NoHeatTransfer {
    fn name(&self) -> &'static str {
        "none"
    }

    fn nusselt(&self, _: &LocalGas, _: f64) -> f64 {
        0.0
    }
}
