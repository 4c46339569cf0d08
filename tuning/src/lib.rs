//! Tuning of models to measured or computed curves.
//!
//! Knows neither cases nor solvers. Equations and sources: docs/theory.md, TUN-1 to TUN-14.
//!
//! - [`TemperatureProgramme`], [`law`], [`model`]: models of a sample that is heated;
//! - [`ParameterSpace`], [`TuningProblem`]: what is tuned, and against what;
//! - [`nsga`]: search for the best compromises between several objectives;
//! - [`least_squares`]: fits, weighted by what is left of each objective;
//! - [`search`]: fits from many starts, fronts by evolution;
//! - [`interval`]: how well parameters are known;
//! - [`information`]: comparison of models;
//! - [`analysis`]: energies from several heating rates without a law.

pub mod analysis;
mod error;
pub mod information;
pub mod interval;
pub mod law;
pub mod least_squares;
pub mod model;
pub mod nsga;
mod problem;
pub mod programme;
mod random;
pub mod search;
mod space;
mod target;

pub use error::TuningError;
pub use problem::{TuningProblem, objectives_at, sum_of_squares};
pub use programme::TemperatureProgramme;
pub use random::SearchRandom;
pub use space::{ParameterSpace, TunedParameter};
pub use target::{ComparedQuantity, DifferenceForm, SampleProblem, TargetCurve, WholeLoss};
