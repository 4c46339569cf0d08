//! Units, one a file.

mod bed;
mod bunker;
mod controller;
mod cyclone;
mod delay;
mod dryer;
mod granulator;
mod inlet;
mod mill;
mod mixer;
mod outlet;
mod screen;
mod splitter;

pub use bed::CoupledBedUnit;
pub use bunker::{Bunker, Discharge};
pub use controller::{Controller, MeasuredField};
pub use cyclone::Cyclone;
pub use delay::TimeDelay;
pub use dryer::Dryer;
pub use granulator::{BedHeat, BedKernel, BedLevel, Granulator, Overspray};
pub use inlet::PlantInlet;
pub use mill::Mill;
pub use mixer::Mixer;
pub use outlet::PlantOutlet;
pub use screen::Screen;
pub use splitter::Splitter;
