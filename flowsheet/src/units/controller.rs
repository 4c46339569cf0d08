//! A controller.

use std::sync::Arc;

use crate::{MeasuredPlace, PlantError, ProcessUnit, SignalKind, StreamLayout, UnitView};

/// A number of a stream or of what a unit holds; NaN where there is nothing to measure.
pub type MeasuredField = Arc<dyn Fn(&StreamLayout, &[f64]) -> f64 + Send + Sync>;

/// A controller in proportion and integral (PI) with bounds, whose output other units take as their setting.
///
/// The measurement m is filtered, dx/dt = (m − x)/τ, and with e = w − x, w the set point,
///
/// v = u₀ + K e + I,   u = v within its bounds,   dI/dt = K e/T + (u − v)/T
///
/// The last term keeps the integral from running away while the output stands at a bound. The filter begins at the set point.
///
/// Source: Åström and Hägglund, PID Controllers (1995), sections 3.2 and 3.5 (back calculation).
pub struct Controller {
    /// Stream or unit that is measured.
    pub place: MeasuredPlace,
    /// What of it.
    pub field: MeasuredField,
    /// w in SI.
    pub set_point: f64,
    /// K: change of the output for a change of the measurement in SI.
    pub gain: f64,
    /// T in s; infinite for a controller in proportion alone.
    pub integral_time: f64,
    /// τ in s.
    pub filter_time: f64,
    /// u₀.
    pub start: f64,
    /// Bounds of u.
    pub bounds: [f64; 2],
}

impl Controller {
    /// v and u.
    fn output(&self, state: &[f64]) -> [f64; 2] {
        let wanted = self.start + self.gain * (self.set_point - state[0]) + state[1];
        [wanted, wanted.clamp(self.bounds[0], self.bounds[1])]
    }
}

impl ProcessUnit for Controller {
    fn inlets(&self) -> Vec<String> {
        Vec::new()
    }

    fn outlets(&self) -> Vec<String> {
        Vec::new()
    }

    fn prepare(&mut self, _layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        let [low, high] = self.bounds;
        let some = |value: f64| value > 0.0;
        for (good, quantity, value, allowed) in [
            (
                self.set_point.is_finite(),
                "set point",
                self.set_point,
                "it is finite",
            ),
            (
                self.gain.is_finite() && self.gain != 0.0,
                "gain",
                self.gain,
                "it is finite and not zero",
            ),
            (
                some(self.integral_time),
                "integral time in s",
                self.integral_time,
                "it is above zero",
            ),
            (
                some(self.filter_time) && self.filter_time.is_finite(),
                "filter time in s",
                self.filter_time,
                "it is above zero",
            ),
            (
                low < high && low.is_finite() && high.is_finite(),
                "lower bound",
                low,
                "it is below the upper bound, and both are finite",
            ),
            (
                (low..=high).contains(&self.start),
                "output at the start",
                self.start,
                "it is between the bounds",
            ),
        ] {
            if !good {
                return Err(PlantError::Value {
                    place: format!("controller \"{name}\""),
                    quantity,
                    value,
                    allowed,
                });
            }
        }
        Ok(())
    }

    fn unknowns(&self, _layout: &StreamLayout) -> usize {
        2
    }

    fn start(&self, _layout: &StreamLayout, state: &mut [f64]) {
        state.copy_from_slice(&[self.set_point, 0.0]);
    }

    fn passes_through(&self) -> bool {
        false
    }

    fn produce(&self, _view: &UnitView<'_>, _out: &mut [f64]) -> Result<(), PlantError> {
        Ok(())
    }

    fn rates(
        &self,
        view: &UnitView<'_>,
        _out: &[f64],
        rates: &mut [f64],
    ) -> Result<(), PlantError> {
        let measured = (self.field)(view.layout, view.measured);
        if measured.is_nan() {
            // Nothing flows that could be measured: the controller waits.
            return Ok(());
        }
        let [wanted, output] = self.output(view.state);
        rates[0] = (measured - view.state[0]) / self.filter_time;
        rates[1] =
            (self.gain * (self.set_point - view.state[0]) + output - wanted) / self.integral_time;
        Ok(())
    }

    fn scales(&self, _layout: &StreamLayout, scales: &mut [f64]) {
        let range = self.bounds[1] - self.bounds[0];
        scales.copy_from_slice(&[(range / self.gain).abs(), range]);
    }

    fn fastest(&self, _view: &UnitView<'_>, _out: &[f64]) -> f64 {
        1.0 / self.filter_time + 2.0 / self.integral_time
    }

    fn signals(&self) -> Option<(SignalKind, usize)> {
        Some((SignalKind::Setting, 1))
    }

    fn signal(&self, _layout: &StreamLayout, state: &[f64], out: &mut [f64]) {
        out[0] = self.output(state)[1];
    }

    fn watches(&self) -> Option<&MeasuredPlace> {
        Some(&self.place)
    }
}
