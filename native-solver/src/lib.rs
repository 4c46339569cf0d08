//! Native gas and particle solvers of Calcine, in pure Rust.
#![warn(missing_docs)]

pub mod gas;
pub mod numerics;
pub mod parcels;
pub mod particles;
mod pushed_drag;
