//! A mill.

use crate::mill::MillLaw;
use crate::sums::sum;
use crate::{PlantError, ProcessUnit, StreamLayout, UnitView};

/// A mill: its law moves the solids between classes; liquids and vapours pass; the power drawn becomes heat.
pub struct Mill {
    law: Box<dyn MillLaw>,
}

impl Mill {
    /// A mill by a law.
    pub fn new(law: Box<dyn MillLaw>) -> Self {
        Self { law }
    }
}

impl ProcessUnit for Mill {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into()]
    }

    fn outlets(&self) -> Vec<String> {
        vec!["out".into()]
    }

    fn prepare(&mut self, layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        self.law.prepare(layout.grid(), &format!("mill \"{name}\""))
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let layout = view.layout;
        let feed = view.inlet(0);
        let sizes = layout.by_size(feed);
        if self.law.needs_feed() && sum(&sizes) <= 0.0 {
            return Err(PlantError::IdleMill {
                unit: view.name.to_owned(),
                time: view.time,
            });
        }
        let place = format_args!("mill \"{}\" at {} s", view.name, view.time);
        let moved = self.law.transformation(layout.grid(), &sizes, &place)?;
        moved.apply(layout, feed, out);
        let rest = layout.solids()..layout.width();
        out[rest.clone()].copy_from_slice(&feed[rest]);
        out[layout.enthalpy()] += self.law.power();
        Ok(())
    }

    fn heat(&self, _view: &UnitView<'_>, _out: &[f64], _rates: &[f64]) -> f64 {
        self.law.power()
    }
}
