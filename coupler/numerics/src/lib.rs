//! Numerical methods that know nothing of gas or particles.
//!
//! - [`number`]: numbers that carry exact derivatives;
//! - [`lanes`]: numbers side by side, for several systems at once in vector registers;
//! - [`linear`]: LU factors of dense and of block-tridiagonal matrices;
//! - [`rosenbrock`]: one integrator for stiff systems, with the tangent of what it integrates;
//! - [`batch`]: many systems on threads, in fixed chunks;
//! - [`parallel`]: loops and sums on threads;
//! - [`anderson`]: fixed points, accelerated.

pub mod anderson;
pub mod batch;
pub mod lanes;
pub mod linear;
pub mod number;
pub mod parallel;
pub mod rosenbrock;

pub use anderson::Anderson;
pub use lanes::Lanes;
pub use linear::{BlockTridiagonal, DenseMatrix, LaneTridiagonal, LinearAlgebra};
pub use number::{Dual, Number};
pub use rosenbrock::{
    IntegrationStalled, IntegrationStatistics, Rosenbrock, RosenbrockTableau, StiffSystem,
};
