//! What leaves a plant.

use crate::{PlantError, ProcessUnit, UnitView};

/// Where material leaves the plant.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlantOutlet;

impl ProcessUnit for PlantOutlet {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into()]
    }

    fn outlets(&self) -> Vec<String> {
        Vec::new()
    }

    fn produce(&self, _view: &UnitView<'_>, _out: &mut [f64]) -> Result<(), PlantError> {
        Ok(())
    }
}
