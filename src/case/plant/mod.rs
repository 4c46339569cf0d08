//! Cases of plants: from a file of kind `flowsheet` to a checked [`PlantCase`].

mod bed;
mod controller;
mod field;
mod granulator;
mod layout;
mod model;
mod quantities;
mod read;
mod solids;
mod streams;
mod tuning;
mod units;
pub(in crate::case) mod words;

pub use bed::{PlantBedFeed, PlantBedSpec};
pub use field::{MOST_CLASSES, class_name, field};
pub use model::{
    ContinuationSpec, PlantCase, PlantMeasure, PlantMeasuredValues, PlantMethod, PlantPlace,
    PlantQuantity, PlantTunedKey, PlantTuningSpec, SteadySpec,
};
#[cfg(test)]
#[cfg(test)]
pub(in crate::case) use read::{Given, plant};
pub use read::{parse_plant, read_plant, read_plant_results, read_plant_with};
pub use words::{LimitField, OverTime, PlantField, SteadyField, SteadyFrom};
