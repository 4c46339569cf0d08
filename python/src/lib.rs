//! The native part of the Python package `calcine`: [`calcine::simulation::Simulation`] as a class, and nothing else of
//! the library. What is only Python (cases, results) is in `python/calcine`.

mod arrays;
mod error;
mod held;
mod simulation;
mod views;

use pyo3::prelude::*;

/// Simulations of Calcine and their errors; imported through the package `calcine`.
#[pymodule]
mod _calcine {
    #[pymodule_export]
    use super::error::{CalcineError, CaseError, DivergedError, RunInterruptedError, SolverError};
    #[pymodule_export]
    use super::simulation::{PySimulation, check, report, start};
    #[pymodule_export]
    use super::views::{PyGas, PyMesh, PyParticles};
}
