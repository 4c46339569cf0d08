//! Beds that are computed elsewhere, within a run.

use super::run::PlantRun;
use crate::{BedCharge, CoupledBed, PlantError};

impl PlantRun<'_> {
    /// Takes the beds that units stand for, in the order of [`Plant::coupled_beds`](crate::Plant::coupled_beds), with what
    /// they hold now. At the start of a run, or before it is resumed.
    pub fn couple(&mut self, beds: Vec<Box<dyn CoupledBed>>) -> Result<(), PlantError> {
        let plant = self.plant;
        for (index, bed) in plant.coupled_beds().into_iter().zip(&beds) {
            let unit = &plant.units[index];
            let content = bed.content(&plant.layout, &unit.name)?;
            let state = &mut self.now.y[unit.state.clone()];
            unit.unit.fill(&plant.layout, &content, state);
        }
        self.held = plant.held(&self.now.y);
        self.beds = beds;
        self.settle()
    }

    /// Exchanges with the beds whose time has come.
    pub(super) fn exchange(&mut self) -> Result<(), PlantError> {
        let plant = self.plant;
        let heats = plant.names.len() * (plant.layout.compounds().len() + 1);
        for (place, index) in plant.coupled_beds().into_iter().enumerate() {
            let unit = &plant.units[index];
            let due = unit.unit.coupling().filter(|c| c.falls_on(self.time));
            if due.is_none() {
                continue;
            }
            let Some(bed) = self.beds.get_mut(place) else {
                let what = "nothing computes it here";
                return plant.refuse_beds(what);
            };
            let state = &mut self.now.y[unit.state.clone()];
            let [waiting, due] = unit.unit.waiting(&plant.layout, state);
            let done = bed.exchange(&BedCharge {
                layout: &plant.layout,
                name: &unit.name,
                until: self.time,
                waiting: &waiting,
                due: &due,
            })?;
            unit.unit.exchanged(&plant.layout, &done, state);
            self.now.totals[heats + index] += done.heat;
        }
        Ok(())
    }
}
