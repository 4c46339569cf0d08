//! Errors as exceptions: one class for each exit code of the command line, with the words that it prints.

use calcine::exit;
use calcine::simulation::SimulationError;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(
    calcine,
    CalcineError,
    PyException,
    "A failure without a class of its own (exit code 1); base of all others. `exit_code` is that of the command line."
);
create_exception!(
    calcine,
    CaseError,
    CalcineError,
    "The case, a results folder or a value that is set is refused (exit code 2)."
);
create_exception!(
    calcine,
    DivergedError,
    CalcineError,
    "A solver diverged, did not converge, or lost particles (exit code 3)."
);
create_exception!(
    calcine,
    SolverError,
    CalcineError,
    "An external solver died, was silent, or could not be started (exit code 4)."
);
create_exception!(
    calcine,
    RunInterruptedError,
    CalcineError,
    "The run was ended at once, inside a window (exit code 130)."
);

/// The exception of an error.
pub fn exception(py: Python<'_>, error: &SimulationError) -> PyErr {
    let (code, words) = (error.exit_code(), error.told());
    let exception = match code {
        exit::CASE => CaseError::new_err(words),
        exit::DIVERGED => DivergedError::new_err(words),
        exit::PEER => SolverError::new_err(words),
        exit::INTERRUPTED => RunInterruptedError::new_err(words),
        _ => CalcineError::new_err(words),
    };
    match exception.value(py).setattr("exit_code", code) {
        Ok(()) => exception,
        Err(failure) => failure,
    }
}
