//! No heat transfer.

use super::model::HeatTransfer;
use crate::law::LawEntry;
use crate::local::LocalGas;

/// No heat transfer: Nu = 0.
#[derive(Clone, Copy, Debug)]
pub struct NoHeatTransfer;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "none",
    summary: "No transfer.",
    source: "",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(NoHeatTransfer),
};

impl HeatTransfer for NoHeatTransfer {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn nusselt(&self, _: &LocalGas, _: f64) -> f64 {
        0.0
    }
}
