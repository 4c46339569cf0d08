//! A dryer.

use crate::{PlantError, ProcessUnit, StreamLayout, UnitView};

/// Dries solids with gas to a given moisture. Solids and gas leave at one temperature, that which closes the enthalpy; of the
/// volatile liquids the same share evaporates.
#[derive(Clone, Copy, Debug)]
pub struct Dryer {
    /// Volatile liquid left in kg per kg of solids.
    pub moisture: f64,
}

impl ProcessUnit for Dryer {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into(), "gas".into()]
    }

    fn outlets(&self) -> Vec<String> {
        vec!["out".into(), "exhaust".into()]
    }

    fn prepare(&mut self, _layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        if self.moisture >= 0.0 && self.moisture.is_finite() {
            return Ok(());
        }
        Err(PlantError::Value {
            place: format!("dryer \"{name}\""),
            quantity: "moisture",
            value: self.moisture,
            allowed: "it is finite and not negative",
        })
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let layout = view.layout;
        let (feed, gas) = (view.inlet(0), view.inlet(1));
        let (dried, exhaust) = out.split_at_mut(layout.width());
        for place in 0..layout.solids() {
            dried[place] = feed[place] + gas[place];
        }
        let volatile = |k: &usize| layout.compounds()[*k].volatile;
        let compounds = 0..layout.compounds().len();
        let liquid = |k| feed[layout.liquid(k)] + gas[layout.liquid(k)];
        let all: f64 = compounds.clone().filter(volatile).map(liquid).sum();
        let wanted = self.moisture * layout.solid_flow(dried);
        // What is drier than asked for stays so.
        let kept = if all > wanted { wanted / all } else { 1.0 };
        for k in compounds {
            let share = if volatile(&k) { kept } else { 1.0 };
            dried[layout.liquid(k)] = share * liquid(k);
            let place = layout.vapour(k);
            exhaust[place] = feed[place] + gas[place] + (1.0 - share) * liquid(k);
        }
        let enthalpy = feed[layout.enthalpy()] + gas[layout.enthalpy()];
        let (solid, solid_latent) = layout.heat_capacity(dried);
        let (vapour, latent) = layout.heat_capacity(exhaust);
        if solid + vapour > 0.0 {
            let sensible = (enthalpy - latent - solid_latent) / (solid + vapour);
            dried[layout.enthalpy()] = solid_latent + solid * sensible;
            exhaust[layout.enthalpy()] = enthalpy - dried[layout.enthalpy()];
        }
        Ok(())
    }
}
