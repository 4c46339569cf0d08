//! A simulation that Python holds: used by one thread at a time, and gone once it is closed.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use calcine::simulation::{Ending, Simulation, SimulationError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::exception;

/// A simulation until it is closed, and what is known of it after that.
pub struct HeldSimulation {
    simulation: Mutex<Option<Simulation>>,
    folder: PathBuf,
    ending: Mutex<Option<Ending>>,
}

impl HeldSimulation {
    /// Holds a simulation.
    pub fn new(simulation: Simulation) -> Self {
        Self {
            folder: simulation.folder().to_owned(),
            simulation: Mutex::new(Some(simulation)),
            ending: Mutex::default(),
        }
    }

    /// The results folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// How the run ended, if it has.
    pub fn ending(&self, py: Python<'_>) -> Option<Ending> {
        py.detach(|| match self.guard().as_ref() {
            Some(simulation) => simulation.ending().cloned(),
            None => self.kept_ending().clone(),
        })
    }

    fn kept_ending(&self) -> MutexGuard<'_, Option<Ending>> {
        self.ending.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads the simulation; waits where another thread is in the middle of a window.
    pub fn with<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Simulation) -> Result<T, SimulationError> + Send,
    ) -> PyResult<T> {
        let done = py.detach(|| {
            let mut guard = self.guard();
            guard.as_mut().map(act)
        });
        match done {
            Some(done) => done.map_err(|error| exception(py, &error)),
            None => Err(PyValueError::new_err(
                "the simulation is closed: start the case again, with `resume=True` to go on from its checkpoint",
            )),
        }
    }

    /// After a panic it is gone: nobody knows in what state it is.
    fn guard(&self) -> MutexGuard<'_, Option<Simulation>> {
        self.simulation.lock().unwrap_or_else(|poisoned| {
            let mut guard = poisoned.into_inner();
            *guard = None;
            guard
        })
    }

    /// True until it is closed.
    pub fn is_open(&self, py: Python<'_>) -> bool {
        py.detach(|| self.guard().is_some())
    }

    /// Lets go of it.
    pub fn close(&self, py: Python<'_>) {
        py.detach(|| {
            let Some(simulation) = self.guard().take() else {
                return;
            };
            *self.kept_ending() = simulation.ending().cloned();
        });
    }
}
