//! A mixer.

use crate::{PlantError, ProcessUnit, UnitView};

/// Brings several streams together: everything adds, the enthalpy too.
#[derive(Clone, Copy, Debug)]
pub struct Mixer {
    /// How many streams enter, by ports "in1", "in2", …
    pub inlets: usize,
}

impl ProcessUnit for Mixer {
    fn inlets(&self) -> Vec<String> {
        (1..=self.inlets).map(|k| format!("in{k}")).collect()
    }

    fn outlets(&self) -> Vec<String> {
        vec!["out".into()]
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        for stream in view.all_inlets() {
            out.iter_mut().zip(stream).for_each(|(o, s)| *o += s);
        }
        Ok(())
    }
}
