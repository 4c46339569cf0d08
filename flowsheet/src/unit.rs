//! What every unit of a plant is.

use crate::{PlantError, StreamLayout};

/// What a unit sees at a time.
#[derive(Clone, Copy, Debug)]
pub struct UnitView<'a> {
    /// Time in s.
    pub time: f64,
    /// End of the span that is integrated, in s: a step of a schedule at that time does not count yet.
    pub end: f64,
    /// What streams are made of.
    pub layout: &'a StreamLayout,
    /// Name of the unit.
    pub name: &'a str,
    /// Its own unknowns.
    pub state: &'a [f64],
    /// All streams of the plant, and which of them flow into this unit, port by port.
    pub(crate) streams: &'a [f64],
    pub(crate) inlets: &'a [usize],
}

impl<'a> UnitView<'a> {
    /// The stream into a port.
    pub fn inlet(&self, port: usize) -> &'a [f64] {
        let width = self.layout.width();
        let start = self.inlets[port] * width;
        &self.streams[start..start + width]
    }

    /// All streams in, in the order of the ports.
    pub fn all_inlets(&self) -> impl Iterator<Item = &'a [f64]> + '_ {
        (0..self.inlets.len()).map(|port| self.inlet(port))
    }
}

/// One unit of a plant. What flows out follows from what flows in and from the unit's own unknowns; these follow their
/// rates. Whatever goes in comes out, is held, or is converted between phases: the plant's ledger proves it.
pub trait ProcessUnit: Send + Sync {
    /// Names of the ports that streams enter by.
    fn inlets(&self) -> Vec<String>;

    /// Names of the ports that streams leave by.
    fn outlets(&self) -> Vec<String>;

    /// Looks at the unit's numbers and prepares what does not change. `name` is what errors name.
    fn prepare(&mut self, _layout: &StreamLayout, _name: &str) -> Result<(), PlantError> {
        Ok(())
    }

    /// Number of unknowns.
    fn unknowns(&self, _layout: &StreamLayout) -> usize {
        0
    }

    /// The unknowns at the start.
    fn start(&self, _layout: &StreamLayout, _state: &mut [f64]) {}

    /// False where what flows out depends on the unknowns and the time only: such a unit opens a recycle.
    fn passes_through(&self) -> bool {
        true
    }

    /// What flows out, port after port; `out` comes filled with zeros.
    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError>;

    /// Rates of the unknowns, with what flows out; `rates` come filled with zeros.
    fn rates(
        &self,
        _view: &UnitView<'_>,
        _out: &[f64],
        _rates: &mut [f64],
    ) -> Result<(), PlantError> {
        Ok(())
    }

    /// Power that enters otherwise than with streams in W: a drive, a heater.
    fn heat(&self, _view: &UnitView<'_>, _out: &[f64], _rates: &[f64]) -> f64 {
        0.0
    }

    /// Adds what is held, in kg and J.
    fn held(&self, _layout: &StreamLayout, _state: &[f64], _held: &mut [f64]) {}

    /// Error of the unknowns that counts as none, relative to the plant's tolerance: their size.
    fn scales(&self, _layout: &StreamLayout, _scales: &mut [f64]) {}

    /// A bound of how fast small deviations of the unknowns fade, in 1/s, from which stabilised steps have their stages; an
    /// estimate that is too low costs repeated steps.
    fn fastest(&self, _view: &UnitView<'_>, _out: &[f64]) -> f64 {
        0.0
    }

    /// Puts back what the unknowns have to fulfil at any time (a fixed hold-up), after a step of Newton's iteration.
    fn constrain(&self, _layout: &StreamLayout, _state: &mut [f64]) {}

    /// Looks at the unknowns after a step: whether they still are what they mean.
    fn verify(&self, _view: &UnitView<'_>) -> Result<(), PlantError> {
        Ok(())
    }

    /// How many combinations of the unknowns never change: as many eigenvalues are zero.
    fn invariants(&self) -> usize {
        0
    }

    /// The first time after `time` at which something jumps.
    fn next_break(&self, _time: f64) -> Option<f64> {
        None
    }
}
