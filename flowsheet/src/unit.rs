//! What every unit of a plant is.

use std::ops::Range;

use crate::coupled_bed::{BedCoupling, BedExchange};
use crate::measured_place::MeasuredPlace;
use crate::signal::SignalKind;
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
    /// Signals of all units, and where those stand that this unit takes.
    pub(crate) signals: &'a [f64],
    pub(crate) heard: &'a [Range<usize>],
    /// What it measures: a stream, or what another unit holds; empty for others.
    pub measured: &'a [f64],
}

impl<'a> UnitView<'a> {
    /// The stream into a port.
    pub fn inlet(&self, port: usize) -> &'a [f64] {
        let width = self.layout.width();
        let start = self.inlets[port] * width;
        &self.streams[start..start + width]
    }

    /// The signals of a unit that this one takes, in the order of [`ProcessUnit::listens_to`].
    pub fn signal(&self, place: usize) -> &'a [f64] {
        &self.signals[self.heard[place].clone()]
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

    /// What its signals are, and how many: numbers that other units take from it. They follow from its unknowns alone.
    fn signals(&self) -> Option<(SignalKind, usize)> {
        None
    }

    /// Its signals.
    fn signal(&self, _layout: &StreamLayout, _state: &[f64], _out: &mut [f64]) {}

    /// Names of the units whose signals it takes, each with what it needs.
    fn listens_to(&self) -> Vec<(String, SignalKind)> {
        Vec::new()
    }

    /// The stream that it measures, or the unit whose content it measures; its rates see it.
    fn watches(&self) -> Option<&MeasuredPlace> {
        None
    }

    /// Of a unit that stands for a bed that is computed elsewhere: how it is exchanged.
    fn coupling(&self) -> Option<BedCoupling> {
        None
    }

    /// Of such a unit: what waits to be fed in kg and J, and what each feed owes in kg.
    fn waiting(&self, _layout: &StreamLayout, _state: &[f64]) -> [Vec<f64>; 2] {
        [Vec::new(), Vec::new()]
    }

    /// Of such a unit: takes what the bed holds at the start.
    fn fill(&self, _layout: &StreamLayout, _content: &[f64], _state: &mut [f64]) {}

    /// Of such a unit: takes what came of an exchange.
    fn exchanged(&self, _layout: &StreamLayout, _done: &BedExchange, _state: &mut [f64]) {}
}
