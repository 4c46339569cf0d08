//! Finite volumes and linear solvers. Knows nothing of gas or particles.
//!
//! Every sum runs in fixed chunks and a fixed tree, so that results are the same bits on any
//! number of threads.

pub mod aggregate;
pub mod amg;
pub mod convection;
pub mod gradient;
pub mod grid;
pub mod krylov;
pub mod least_squares;
pub mod matrix;
pub mod operators;
pub mod preconditioner;
pub mod sparse;

pub use calcine_coupler::numerics::parallel;
