//! A time delay.

use crate::{PlantError, ProcessUnit, StreamLayout, UnitView};

/// A conveyor or a pipe: what enters leaves after a time, in stages that are each well mixed.
///
/// dm_k/dt = ṁ_(k−1) − ṁ_k,   ṁ_k = m_k n/τ
///
/// The mean of the residence times is τ, their variance τ²/n: with one stage it is a stirred tank, with many a plug. All that
/// is on the way is held, so that the ledger closes. It opens a recycle.
///
/// Source: Levenspiel, Chemical Reaction Engineering (1999), chapter 14 (tanks in series).
#[derive(Clone, Debug, PartialEq)]
pub struct TimeDelay {
    /// τ in s.
    pub time: f64,
    /// Number of stages n.
    pub stages: usize,
    /// What is on the way at the start, in kg and J; empty for nothing.
    pub content: Vec<f64>,
}

impl TimeDelay {
    fn rate(&self) -> f64 {
        self.stages as f64 / self.time
    }
}

impl ProcessUnit for TimeDelay {
    fn inlets(&self) -> Vec<String> {
        vec!["in".into()]
    }

    fn outlets(&self) -> Vec<String> {
        vec!["out".into()]
    }

    fn prepare(&mut self, layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let refuse = |quantity, value, allowed| {
            Err(PlantError::Value {
                place: format!("delay \"{name}\""),
                quantity,
                value,
                allowed,
            })
        };
        if !(self.time.is_finite() && self.time > 0.0) {
            return refuse("time in s", self.time, "it is above zero");
        }
        if self.stages == 0 {
            return refuse("number of stages", 0.0, "it is 1 or more");
        }
        if self.content.is_empty() {
            self.content = vec![0.0; layout.width()];
        }
        if self.content.len() != layout.width() {
            let value = self.content.len() as f64;
            let allowed = "it is that of the plant's layout";
            return refuse("length of the content", value, allowed);
        }
        Ok(())
    }

    fn unknowns(&self, layout: &StreamLayout) -> usize {
        self.stages * layout.width()
    }

    fn start(&self, layout: &StreamLayout, state: &mut [f64]) {
        for stage in state.chunks_exact_mut(layout.width()) {
            for (held, all) in stage.iter_mut().zip(&self.content) {
                *held = all / self.stages as f64;
            }
        }
    }

    fn passes_through(&self) -> bool {
        false
    }

    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        let last = &view.state[view.state.len() - view.layout.width()..];
        let rate = self.rate();
        out.iter_mut()
            .zip(last)
            .for_each(|(o, held)| *o = rate * held);
        Ok(())
    }

    fn rates(
        &self,
        view: &UnitView<'_>,
        _out: &[f64],
        rates: &mut [f64],
    ) -> Result<(), PlantError> {
        let (width, rate) = (view.layout.width(), self.rate());
        for (place, own) in view.state.iter().enumerate() {
            let enters = match place.checked_sub(width) {
                Some(before) => rate * view.state[before],
                None => view.inlet(0)[place],
            };
            rates[place] = enters - rate * own;
        }
        Ok(())
    }

    fn held(&self, layout: &StreamLayout, state: &[f64], held: &mut [f64]) {
        for stage in state.chunks_exact(layout.width()) {
            held.iter_mut().zip(stage).for_each(|(h, s)| *h += s);
        }
    }

    fn scales(&self, layout: &StreamLayout, scales: &mut [f64]) {
        let size = layout.mass_flow(&self.content).max(1.0) / self.stages as f64;
        scales.fill(size);
        for stage in scales.chunks_exact_mut(layout.width()) {
            stage[layout.enthalpy()] *= 1e5;
        }
    }

    fn fastest(&self, _view: &UnitView<'_>, _out: &[f64]) -> f64 {
        2.0 * self.rate()
    }
}
