//! Beds that are computed elsewhere, as units of a plant.

use crate::{PlantError, StreamLayout};

/// What a bed is given for a span of time.
#[derive(Clone, Copy, Debug)]
pub struct BedCharge<'a> {
    /// What streams are made of.
    pub layout: &'a StreamLayout,
    /// Name of the unit.
    pub name: &'a str,
    /// Time in s up to which the bed is to be followed.
    pub until: f64,
    /// What waits to be fed, in kg and J by the places of a stream: what flowed in since the exchange before, and what was left.
    pub waiting: &'a [f64],
    /// What each feed of the bed was told beyond what it fed, in kg.
    pub due: &'a [f64],
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct BedExchange {
    /// What still waits, in kg and J.
    pub waiting: Vec<f64>,
    /// What left the bed, in kg and J.
    pub left: Vec<f64>,
    /// What the bed holds now, in kg and J.
    pub held: Vec<f64>,
    /// Heat in J that the bed's particles took from its gas and its walls.
    pub heat: f64,
    /// What each feed was told beyond what it fed, in kg.
    pub due: Vec<f64>,
    /// The kernel of the bed, row by row ([`BedKernel`](crate::units::BedKernel)); empty where none is asked for.
    pub kernel: Vec<f64>,
}

/// A bed that is computed elsewhere, and exchanges with its plant from time to time.
pub trait CoupledBed: Send {
    /// What it holds now, in kg and J by the places of a stream.
    fn content(&self, layout: &StreamLayout, name: &str) -> Result<Vec<f64>, PlantError>;

    /// Feeds what waits, follows the bed up to a time, and tells what came of it.
    fn exchange(&mut self, charge: &BedCharge<'_>) -> Result<BedExchange, PlantError>;
}

/// How a unit is exchanged with the bed that it stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct BedCoupling {
    /// Time in s between two exchanges.
    pub interval: f64,
    /// Feeds of the bed.
    pub feeds: usize,
    /// Diameters in m of its kernel; none where it returns no kernel.
    pub diameters: Vec<f64>,
}

impl BedCoupling {
    /// The first exchange after a time, in s.
    pub fn next(&self, time: f64) -> f64 {
        (self.count(time) + 1.0) * self.interval
    }

    /// True where an exchange falls on this time.
    pub fn falls_on(&self, time: f64) -> bool {
        let count = self.count(time);
        count >= 1.0 && (count * self.interval - time).abs() <= 1e-9 * self.interval
    }

    /// How many exchanges there were up to a time, with that on it.
    fn count(&self, time: f64) -> f64 {
        (time / self.interval + 1e-9).floor()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exchanges_fall_on_multiples_of_the_interval_whatever_the_rounding() {
        let coupling = BedCoupling {
            interval: 0.1,
            feeds: 1,
            diameters: Vec::new(),
        };
        let mut time = 0.0;
        assert!(!coupling.falls_on(time));
        for k in 1..1000 {
            let next = coupling.next(time);
            assert!((next - 0.1 * f64::from(k)).abs() < 1e-12, "{k}: {next}");
            assert!(coupling.falls_on(next));
            assert!(!coupling.falls_on(next - 0.03));
            time = next;
        }
    }
}
