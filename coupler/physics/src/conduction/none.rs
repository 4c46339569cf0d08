//! No conduction between particles.

use super::model::{Conduction, SphereContact};
use crate::law::LawEntry;

/// Particles exchange no heat where they touch.
#[derive(Clone, Copy, Debug)]
pub struct NoConduction;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Conduction> = LawEntry {
    name: "none",
    summary: "No conduction through contacts.",
    source: "",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(NoConduction),
};

impl Conduction for NoConduction {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn conductance(&self, _: &SphereContact) -> f64 {
        0.0
    }
}
