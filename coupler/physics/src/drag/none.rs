//! No drag.

use super::model::Drag;
use crate::law::LawEntry;
use crate::local::LocalGas;

/// No drag: K_A = 0.
#[derive(Clone, Copy, Debug)]
pub struct NoDrag;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "none",
    summary: "No drag.",
    source: "",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(NoDrag),
};

impl Drag for NoDrag {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, _: &LocalGas, _: f64) -> f64 {
        0.0
    }
}
