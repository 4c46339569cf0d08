//! How well parameters are known.

mod bootstrap;
mod correlation;
mod profile;
mod quantile;

pub use bootstrap::{BootstrapSettings, bootstrap};
pub use correlation::{CORRELATED, ParameterPair, correlated, correlations, lag_one};
pub use profile::{IntervalEnd, ParameterProfile, profile};
pub use quantile::{normal_quantile, student_quantile};
