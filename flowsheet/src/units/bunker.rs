//! A bunker.

use crate::{PlantError, ProcessUnit, SignalKind, StreamLayout, Timetable, UnitView};

/// How a bunker empties.
#[derive(Clone, Debug, PartialEq)]
pub enum Discharge {
    /// What enters pushes out as much: the mass stays.
    Level,
    /// Mass divided by a residence time in s.
    Residence(f64),
    /// What enters times (2 m/(m + m_target))²: less where there is less than the target, up to four times as much where there is
    /// more. The target in kg.
    ///
    /// Source: the unit "Solids bunker" of Dyssol, model "Adaptive" (SoftwareX 12 (2020) 100572,
    /// doi 10.1016/j.softx.2020.100572).
    Adaptive(f64),
    /// A mass flow in kg/s over time. It ends when the bunker is empty: by an error, as a rate needs something to move.
    Rate(Timetable),
    /// A mass flow in kg/s that a controller sets, while there is something to move.
    Controlled(String),
}

/// A well-mixed store.
#[derive(Clone, Debug)]
pub struct Bunker {
    /// What it holds at the start, in kg and J.
    pub content: Vec<f64>,
    /// How it empties.
    pub discharge: Discharge,
}

impl Bunker {
    fn flow(&self, view: &UnitView<'_>) -> Result<f64, PlantError> {
        let mass = view.layout.mass_flow(view.state);
        Ok(match &self.discharge {
            Discharge::Level => view.layout.mass_flow(view.inlet(0)) / mass,
            Discharge::Residence(time) => 1.0 / time,
            Discharge::Adaptive(target) => {
                let level = 2.0 * mass / (mass + target);
                view.layout.mass_flow(view.inlet(0)) * level * level / mass
            }
            Discharge::Controlled(_) => match mass > 0.0 {
                true => view.signal(0)[0].max(0.0) / mass,
                false => 0.0,
            },
            Discharge::Rate(rate) => {
                if mass <= 0.0 {
                    return Err(PlantError::Value {
                        place: format!("bunker \"{}\" at {} s", view.name, view.time),
                        quantity: "mass in kg",
                        value: mass,
                        allowed: "it is empty: lower its discharge, or let `residence` empty it",
                    });
                }
                rate.within(view.time, view.end) / mass
            }
        })
    }
}

impl ProcessUnit for Bunker {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into()]
    }

    fn outlets(&self) -> Vec<String> {
        vec!["out".into()]
    }

    fn prepare(&mut self, layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let refuse = |quantity, value, allowed| PlantError::Value {
            place: format!("bunker \"{name}\""),
            quantity,
            value,
            allowed,
        };
        if self.content.len() != layout.width() {
            let value = self.content.len() as f64;
            return Err(refuse(
                "length of the content",
                value,
                "it is that of the plant's layout",
            ));
        }
        let mass = layout.mass_flow(&self.content);
        if !(mass >= 0.0 && mass.is_finite()) {
            return Err(refuse("mass in kg", mass, "it is finite and not negative"));
        }
        match &self.discharge {
            Discharge::Level | Discharge::Adaptive(_) if mass == 0.0 => Err(refuse(
                "mass in kg",
                mass,
                "`level` and `adaptive` need a content",
            )),
            Discharge::Adaptive(target) if !(*target > 0.0 && target.is_finite()) => {
                Err(refuse("target mass in kg", *target, "it is above zero"))
            }
            Discharge::Residence(time) if !(*time > 0.0 && time.is_finite()) => {
                Err(refuse("residence time in s", *time, "it is above zero"))
            }
            _ => Ok(()),
        }
    }

    fn unknowns(&self, layout: &StreamLayout) -> usize {
        layout.width()
    }

    fn start(&self, _layout: &StreamLayout, state: &mut [f64]) {
        state.copy_from_slice(&self.content);
    }

    fn passes_through(&self) -> bool {
        matches!(self.discharge, Discharge::Level | Discharge::Adaptive(_))
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let flow = self.flow(view)?;
        out.iter_mut()
            .zip(view.state)
            .for_each(|(o, held)| *o = flow * held);
        Ok(())
    }

    fn rates(&self, view: &UnitView<'_>, out: &[f64], rates: &mut [f64]) -> Result<(), PlantError> {
        for ((rate, enters), leaves) in rates.iter_mut().zip(view.inlet(0)).zip(out) {
            *rate = enters - leaves;
        }
        Ok(())
    }

    fn held(&self, _layout: &StreamLayout, state: &[f64], held: &mut [f64]) {
        held.iter_mut().zip(state).for_each(|(h, s)| *h += s);
    }

    fn scales(&self, layout: &StreamLayout, scales: &mut [f64]) {
        scales.fill(layout.mass_flow(&self.content).max(1.0));
        scales[layout.enthalpy()] *= 1e5;
    }

    fn fastest(&self, view: &UnitView<'_>, _out: &[f64]) -> f64 {
        self.flow(view).unwrap_or(0.0)
    }

    fn listens_to(&self) -> Vec<(String, SignalKind)> {
        match &self.discharge {
            Discharge::Controlled(name) => vec![(name.clone(), SignalKind::Setting)],
            _ => Vec::new(),
        }
    }

    fn next_break(&self, time: f64) -> Option<f64> {
        match &self.discharge {
            Discharge::Rate(rate) => rate.next_break(time),
            _ => None,
        }
    }
}
