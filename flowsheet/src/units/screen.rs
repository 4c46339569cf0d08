//! A screen.

use crate::screen::ScreenLaw;
use crate::{PlantError, ProcessUnit, StreamLayout, Transformation, UnitView};

/// A screen: solids go to "coarse" or "fine" by their size, class by class; liquids go with the solids in proportion to
/// mass, vapours to the fine side. Both sides have the temperature of the feed.
pub struct Screen {
    law: Box<dyn ScreenLaw>,
    coarse: Transformation,
    fine: Transformation,
}

impl Screen {
    /// A screen by a law.
    pub fn new(law: Box<dyn ScreenLaw>) -> Self {
        let none = Transformation::Diagonal(Vec::new());
        Self {
            law,
            coarse: none.clone(),
            fine: none,
        }
    }
}

impl ProcessUnit for Screen {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into()]
    }

    fn outlets(&self) -> Vec<String> {
        vec!["coarse".into(), "fine".into()]
    }

    fn prepare(&mut self, layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        if let Some((quantity, value, allowed)) = self.law.refused() {
            return Err(PlantError::Value {
                place: format!("screen \"{name}\""),
                quantity,
                value,
                allowed,
            });
        }
        let diameters = layout.grid().diameters().iter();
        let shares: Vec<f64> = diameters.map(|d| self.law.coarse_share(*d)).collect();
        self.fine = Transformation::Diagonal(shares.iter().map(|share| 1.0 - share).collect());
        self.coarse = Transformation::Diagonal(shares);
        Ok(())
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let layout = view.layout;
        let feed = view.inlet(0);
        let (coarse, fine) = out.split_at_mut(layout.width());
        self.coarse.apply(layout, feed, coarse);
        self.fine.apply(layout, feed, fine);
        let all = layout.solid_flow(feed);
        let share = if all == 0.0 {
            0.0
        } else {
            layout.solid_flow(coarse) / all
        };
        for compound in 0..layout.compounds().len() {
            let place = layout.liquid(compound);
            coarse[place] = share * feed[place];
            fine[place] = feed[place] - coarse[place];
            let place = layout.vapour(compound);
            fine[place] = feed[place];
        }
        if let Some(temperature) = layout.temperature(feed) {
            layout.set_temperature(coarse, temperature);
            let place = layout.enthalpy();
            fine[place] = feed[place] - coarse[place];
        }
        Ok(())
    }
}
