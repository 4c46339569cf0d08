//! Laws of reactive granular beds as pure functions of local state, one law a file.
#![warn(missing_docs)]

pub mod gas;

/// A vector in space.
pub type Vec3 = nalgebra::Vector3<f64>;
