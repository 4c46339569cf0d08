//! Numerical methods that know nothing of gas or particles.
//!
//! - [`number`]: numbers that carry exact derivatives;
//! - [`linear`]: LU factors of dense and of block-tridiagonal matrices;
//! - [`rosenbrock`]: one integrator for stiff systems, with the tangent of what it integrates;
//! - [`batch`]: many systems on threads, in fixed chunks;
//! - [`parallel`]: loops and sums on threads;
//! - [`anderson`]: fixed points, accelerated.

pub mod anderson;
pub mod batch;
pub mod linear;
pub mod number;
pub mod parallel;
pub mod rosenbrock;

pub use anderson::Anderson;
pub use linear::{BlockTridiagonal, DenseMatrix, LinearAlgebra};
pub use number::{Dual, Number};
pub use rosenbrock::{
    IntegrationStalled, IntegrationStatistics, Rosenbrock, RosenbrockTableau, StiffSystem,
};
