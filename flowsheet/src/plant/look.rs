//! What others see of a plant: its ends, and what its units hold.

use super::run::PlantRun;
use super::topology::{Plant, PlantUnit};
use crate::SignalKind;

impl PlantUnit {
    /// Names of the ports that streams enter by, and that they leave by.
    pub fn ports(&self) -> [Vec<String>; 2] {
        [self.unit.inlets(), self.unit.outlets()]
    }

    /// Streams that enter, port by port.
    pub fn entering(&self) -> &[usize] {
        &self.inlets
    }

    /// Streams that leave, port by port.
    pub fn leaving(&self) -> std::ops::Range<usize> {
        self.outlets.clone()
    }
}

impl Plant {
    /// The unit that a stream leaves, and the one that it enters.
    pub fn ends_of(&self, stream: usize) -> (usize, usize) {
        self.ends[stream]
    }

    /// Units in the order in which they are computed; those of a recycle with the streams that it is torn at.
    pub fn order(&self) -> impl Iterator<Item = (&[usize], &[usize])> {
        self.blocks.iter().map(|b| (&b.units[..], &b.tears[..]))
    }

    /// True where a unit has unknowns and ports, and so may hold something.
    pub fn holds(&self, unit: usize) -> bool {
        let own = &self.units[unit];
        let has_ports = !own.inlets.is_empty() || !own.outlets.is_empty();
        has_ports && !own.state.is_empty()
    }

    /// True of a controller: a unit that gives others a setting.
    pub fn controls(&self, unit: usize) -> bool {
        let signals = self.units[unit].unit.signals();
        signals.is_some_and(|(kind, _)| kind == SignalKind::Setting)
    }

    /// What a unit holds at the unknowns `y`, in kg and J, by the places of a stream.
    pub fn held_by(&self, unit: usize, y: &[f64]) -> Vec<f64> {
        let mut held = vec![0.0; self.layout.width()];
        let own = &self.units[unit];
        own.unit
            .held(&self.layout, &y[own.state.clone()], &mut held);
        held
    }

    /// The unknowns of a unit among those of the plant.
    pub fn unknowns_of(&self, unit: usize) -> std::ops::Range<usize> {
        self.units[unit].state.clone()
    }
}

impl PlantRun<'_> {
    /// What a controller gives; NaN of another unit.
    pub fn setting(&self, unit: usize) -> f64 {
        if !self.plant.controls(unit) {
            return f64::NAN;
        }
        let mut out = [f64::NAN];
        let own = &self.plant.units[unit];
        own.unit
            .signal(&self.plant.layout, self.unit(unit), &mut out);
        out[0]
    }

    /// What a unit holds, in kg and J, by the places of a stream.
    pub fn held_by(&self, unit: usize) -> Vec<f64> {
        self.plant.held_by(unit, self.unknowns())
    }
}
