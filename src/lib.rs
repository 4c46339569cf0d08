//! Calcine: reactive granular beds, gas and grains coupled.

pub mod case;
pub mod compare;
pub mod report;
pub mod results;
