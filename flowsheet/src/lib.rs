//! Plants: streams of solids with distributions, units, population balances, recycles, their dynamics and steady states.
//!
//! Knows neither cases nor solvers. Equations and sources: docs/theory.md, FLS-1 to FLS-6 and PBM-1 to PBM-7.
//!
//! - [`StreamLayout`], [`SizeGrid`], [`distribution`]: what streams are made of;
//! - [`screen`], [`mill`], [`cyclone`]: laws, one a file;
//! - [`population`]: growth, aggregation, breakage over size classes;
//! - [`ProcessUnit`], [`units`]: what stands in a plant;
//! - [`CoupledBed`]: beds that are computed elsewhere, as units;
//! - [`Plant`]: units and streams, with recycles solved through tear streams; [`PlantRun`] follows it in time.

mod coupled_bed;
pub mod cyclone;
pub mod distribution;
mod error;
mod grid;
mod layout;
mod measured_place;
pub mod mill;
mod plant;
pub mod population;
pub mod screen;
mod signal;
mod sums;
mod timetable;
mod transformation;
mod unit;
pub mod units;

pub use coupled_bed::{BedCharge, BedCoupling, BedExchange, CoupledBed};
pub use error::PlantError;
pub use grid::SizeGrid;
pub use layout::{Attribute, Compound, REFERENCE_TEMPERATURE, StreamLayout};
pub use measured_place::MeasuredPlace;
pub use plant::*;
pub use signal::SignalKind;
pub use timetable::Timetable;
pub use transformation::Transformation;
pub use unit::{ProcessUnit, UnitView};
