//! What others see of a plant: its ends, and what its units hold.

use super::run::PlantRun;
use super::topology::{Plant, PlantUnit};

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

    /// True where a unit has unknowns, and so may hold something.
    pub fn holds(&self, unit: usize) -> bool {
        !self.units[unit].state.is_empty()
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
    /// What a unit holds, in kg and J, by the places of a stream.
    pub fn held_by(&self, unit: usize) -> Vec<f64> {
        self.plant.held_by(unit, self.unknowns())
    }
}
