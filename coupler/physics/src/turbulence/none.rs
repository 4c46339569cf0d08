//! Eddies that end at the bed.

use super::bed_eddies::{BedEddies, EddySource};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Eddies end at the bed: there they carry nothing and none are made.
#[derive(Clone, Copy, Debug)]
pub struct NoBedEddies;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn BedEddies> = LawEntry {
    name: "none",
    summary: "Eddies end at the bed: there they carry nothing, and none are made.",
    source: "",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(NoBedEddies),
};

impl BedEddies for NoBedEddies {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn source(&self, _: &LocalGas, _: f64) -> EddySource {
        EddySource::default()
    }
}
