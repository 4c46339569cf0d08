//! Calcine: reactive granular beds, gas and particles coupled.

pub mod assembly;
pub mod case;
pub mod commands;
pub mod compare;
mod error_chain;
pub mod exit;
mod fortran;
mod hex;
pub mod laws;
pub mod mechanism;
pub mod plant;
mod progress;
pub mod report;
pub mod results;
pub mod simulation;
mod standard_error;
pub mod tuning;
pub mod valid;
mod vtk_xml;
pub mod watch;
