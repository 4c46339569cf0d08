//! A cyclone.

use crate::cyclone::{CycloneFlow, MuschelknautzCyclone};
use crate::distribution::quantile;
use crate::{PlantError, ProcessUnit, StreamLayout, Transformation, UnitView};

/// A cyclone: solids that are separated leave by "solids" and take liquids in proportion, all others by "gas". Both have the
/// temperature of the feed.
#[derive(Clone, Copy, Debug)]
pub struct Cyclone {
    /// Geometry and law.
    pub law: MuschelknautzCyclone,
    /// Density of the gas in kg/m³.
    pub gas_density: f64,
    /// Viscosity of the gas in Pa s.
    pub viscosity: f64,
    /// Density of particles in kg/m³.
    pub solid_density: f64,
}

impl ProcessUnit for Cyclone {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into()]
    }

    fn outlets(&self) -> Vec<String> {
        vec!["solids".into(), "gas".into()]
    }

    fn prepare(&mut self, _layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let place = format!("cyclone \"{name}\"");
        self.law.check(&place)?;
        for (quantity, value) in [
            ("density of the gas", self.gas_density),
            ("viscosity of the gas", self.viscosity),
            (
                "density of particles less that of the gas",
                self.solid_density - self.gas_density,
            ),
        ] {
            if !(value.is_finite() && value > 0.0) {
                let allowed = "it is above zero";
                return Err(PlantError::Value {
                    place,
                    quantity,
                    value,
                    allowed,
                });
            }
        }
        Ok(())
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let layout = view.layout;
        let feed = view.inlet(0);
        let (solids, rest) = out.split_at_mut(layout.width());
        let masses = layout.by_size(feed);
        let all: f64 = masses.iter().sum();
        let gas: f64 = (0..layout.compounds().len())
            .map(|k| feed[layout.vapour(k)])
            .sum();
        let median = quantile(layout.grid(), &masses, 0.5);
        // Without gas all solids fall down; without solids there is nothing to separate.
        let shares: Vec<f64> = match median {
            Some(median) if gas > 0.0 => {
                let flow = CycloneFlow {
                    gas: gas / self.gas_density,
                    gas_density: self.gas_density,
                    viscosity: self.viscosity,
                    solid_density: self.solid_density,
                    load: all / gas,
                    median,
                };
                let state = self.law.state(&flow);
                layout
                    .grid()
                    .diameters()
                    .iter()
                    .map(|d| state.separated(*d))
                    .collect()
            }
            _ => vec![1.0; masses.len()],
        };
        let others = shares.iter().map(|share| 1.0 - share).collect();
        Transformation::Diagonal(shares).apply(layout, feed, solids);
        Transformation::Diagonal(others).apply(layout, feed, rest);
        let share = if all == 0.0 {
            0.0
        } else {
            layout.solid_flow(solids) / all
        };
        for k in 0..layout.compounds().len() {
            let place = layout.liquid(k);
            solids[place] = share * feed[place];
            rest[place] = feed[place] - solids[place];
            rest[layout.vapour(k)] = feed[layout.vapour(k)];
        }
        if let Some(temperature) = layout.temperature(feed) {
            layout.set_temperature(solids, temperature);
            let place = layout.enthalpy();
            rest[place] = feed[place] - solids[place];
        }
        Ok(())
    }
}
