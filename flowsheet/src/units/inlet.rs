//! What enters a plant.

use crate::{PlantError, ProcessUnit, SignalKind, StreamLayout, Timetable, UnitView};

/// Material that enters the plant: one stream times a schedule.
#[derive(Clone, Debug)]
pub struct PlantInlet {
    stream: Vec<f64>,
    factor: Timetable,
    controller: Option<String>,
}

impl PlantInlet {
    /// A stream in the layout of the plant, times a factor over time.
    pub fn new(stream: Vec<f64>, factor: Timetable) -> Self {
        Self {
            stream,
            factor,
            controller: None,
        }
    }

    /// The same times the output of a controller.
    pub fn with_controller(mut self, controller: String) -> Self {
        self.controller = Some(controller);
        self
    }
}

impl ProcessUnit for PlantInlet {
    fn inlets(&self) -> Vec<String> {
        Vec::new()
    }

    fn outlets(&self) -> Vec<String> {
        vec!["out".into()]
    }

    fn prepare(&mut self, layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let refuse = |quantity, value, allowed| PlantError::Value {
            place: format!("inlet \"{name}\""),
            quantity,
            value,
            allowed,
        };
        if self.stream.len() != layout.width() {
            let value = self.stream.len() as f64;
            return Err(refuse(
                "length of the stream",
                value,
                "it is that of the plant's layout",
            ));
        }
        let masses = &self.stream[..layout.enthalpy()];
        match masses
            .iter()
            .find(|flow| !(flow.is_finite() && **flow >= 0.0))
        {
            Some(flow) => Err(refuse("mass flow", *flow, "it is finite and not negative")),
            None => Ok(()),
        }
    }

    fn passes_through(&self) -> bool {
        false
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let mut factor = self.factor.within(view.time, view.end);
        if self.controller.is_some() {
            factor *= view.signal(0)[0];
        }
        out.iter_mut()
            .zip(&self.stream)
            .for_each(|(o, s)| *o = factor * s);
        Ok(())
    }

    fn listens_to(&self) -> Vec<(String, SignalKind)> {
        let name = self.controller.iter();
        name.map(|name| (name.clone(), SignalKind::Setting))
            .collect()
    }

    fn next_break(&self, time: f64) -> Option<f64> {
        self.factor.next_break(time)
    }
}
