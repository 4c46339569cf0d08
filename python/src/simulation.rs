//! The class `Simulation`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use calcine::assembly::{GasBackend, ParticleBackend};
use calcine::simulation::{
    BoundaryQuantity, Control, Ending, Simulation, SimulationBuilder, SimulationError,
};
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays;
use crate::error::exception;
use crate::held::HeldSimulation;
use crate::views::{PyGas, PyMesh, PyParticles};

/// A run of a case in the hands of a program, made by `Case.start()`.
///
/// Units are SI, times are process time in s. Fields are those of the last committed window. While a window is
/// computed other threads of Python go on. As a context manager it ends with a checkpoint.
#[pyclass(name = "Simulation", module = "calcine", frozen)]
pub struct PySimulation(Arc<HeldSimulation>);

/// What is given for `gas` and `particles`.
fn backends(builder: SimulationBuilder, gas: &str, particles: &str) -> PyResult<SimulationBuilder> {
    let unknown = |what, name, those| {
        let message = format!("{what} is `{name}`; it must be one of {those}");
        Err(PyValueError::new_err(message))
    };
    let gas = match gas {
        "native" => GasBackend::Native,
        "openfoam" => GasBackend::Openfoam,
        "external" => GasBackend::External,
        _ => return unknown("gas", gas, "native, openfoam, external"),
    };
    let particles = match particles {
        "native" => ParticleBackend::Native,
        "liggghts" => ParticleBackend::Liggghts,
        "openfoam" => ParticleBackend::Openfoam,
        "external" => ParticleBackend::External,
        _ => {
            return unknown(
                "particles",
                particles,
                "native, liggghts, openfoam, external",
            );
        }
    };
    Ok(builder.gas(gas).particles(particles))
}

fn opened(case: PathBuf, changes: Vec<String>) -> SimulationBuilder {
    let builder = Simulation::open(case);
    changes.into_iter().fold(builder, SimulationBuilder::set)
}

/// Checks a case as a run would; gives what `calcine check` tells of its clocks, sizes and flow.
#[pyfunction]
pub fn check(
    py: Python<'_>,
    case: PathBuf,
    changes: Vec<String>,
    gas: &str,
    particles: &str,
) -> PyResult<String> {
    let builder = backends(opened(case, changes), gas, particles)?;
    let report = py.detach(|| builder.check());
    report.map_err(|error| exception(py, &error))
}

/// Writes the page of a results folder, as `calcine report` does; gives its path.
#[pyfunction]
pub fn report(py: Python<'_>, folder: PathBuf) -> PyResult<PathBuf> {
    let written = py.detach(|| calcine::report::write(&folder));
    written.map_err(|error| exception(py, &SimulationError::from(error)))
}

/// Begins a run, or goes on with one.
#[pyfunction]
#[expect(
    clippy::too_many_arguments,
    reason = "called by the class `Case` alone"
)]
pub fn start(
    py: Python<'_>,
    case: PathBuf,
    changes: Vec<String>,
    gas: &str,
    particles: &str,
    out: Option<PathBuf>,
    resume: bool,
    origin: Option<PathBuf>,
) -> PyResult<PySimulation> {
    let mut builder = backends(opened(case, changes), gas, particles)?.resume(resume);
    if let Some(folder) = out {
        builder = builder.out(folder);
    }
    if let Some(folder) = origin {
        builder = builder.from(folder);
    }
    let begun = py.detach(|| builder.start());
    let simulation = begun.map_err(|error| exception(py, &error))?;
    Ok(PySimulation(Arc::new(HeldSimulation::new(simulation))))
}

fn word(ending: &Ending) -> &'static str {
    match ending {
        Ending::Finished => "finished",
        Ending::Checkpointed(_) => "checkpointed",
    }
}

/// The quantities of a boundary that a call names, in the order of the signature.
fn quantities(values: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<BoundaryQuantity>> {
    let mut found = Vec::new();
    for (name, value) in values.into_iter().flatten() {
        let name: String = name.extract()?;
        let make = match name.as_str() {
            "composition" => {
                found.push(BoundaryQuantity::Composition(value.extract()?));
                continue;
            }
            "temperature" => BoundaryQuantity::Temperature,
            "superficial_velocity" => BoundaryQuantity::SuperficialVelocity,
            "mass_flow" => BoundaryQuantity::MassFlow,
            "pressure" => BoundaryQuantity::Pressure,
            "heat_flux" => BoundaryQuantity::HeatFlux,
            "heat_transfer_coefficient" => BoundaryQuantity::HeatTransferCoefficient,
            "ambient" => BoundaryQuantity::Ambient,
            _ => {
                let message = format!(
                    "set_boundary() has no `{name}`; it has temperature, superficial_velocity, mass_flow, composition, \
                     pressure, heat_flux, heat_transfer_coefficient, ambient"
                );
                return Err(PyTypeError::new_err(message));
            }
        };
        found.push(make(value.extract()?));
    }
    Ok(found)
}

impl PySimulation {
    /// Reads or changes the simulation.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Simulation) -> Result<T, SimulationError> + Send,
    ) -> PyResult<T> {
        self.0.with(py, act)
    }

    fn read<T: Send>(
        &self,
        py: Python<'_>,
        look: impl FnOnce(&Simulation) -> T + Send,
    ) -> PyResult<T> {
        self.with(py, |simulation| Ok(look(simulation)))
    }

    /// Steps until `done`; between two windows signals are handled and `progress` is told.
    fn steps(
        &self,
        py: Python<'_>,
        until: f64,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Option<&'static str>> {
        loop {
            py.check_signals()?;
            let stepped = self.with(py, |simulation| {
                if simulation.time() >= until {
                    return Ok(None);
                }
                let ending = simulation.step()?;
                let end = simulation.case().time.end.seconds();
                Ok(Some((ending, simulation.time(), end)))
            })?;
            let Some((ending, time, end)) = stepped else {
                return Ok(None);
            };
            if let Some(progress) = progress {
                progress.call1((time, end))?;
            }
            if let Some(ending) = ending {
                return Ok(Some(word(&ending)));
            }
        }
    }
}

#[pymethods]
impl PySimulation {
    /// One window. `None` while the run goes on, "finished" at the end of the case.
    fn step(&self, py: Python<'_>) -> PyResult<Option<&'static str>> {
        py.check_signals()?;
        let ending = self.with(py, Simulation::step)?;
        py.check_signals()?;
        Ok(ending.as_ref().map(word))
    }

    /// Steps until the process time `time` in s is reached or passed, or the run ends; no window is cut short for it.
    ///
    /// Ctrl-C raises `KeyboardInterrupt` between two windows; the run can go on from there.
    #[pyo3(signature = (time, progress=None))]
    fn advance_to(
        &self,
        py: Python<'_>,
        time: f64,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Option<&'static str>> {
        self.steps(py, time, progress)
    }

    /// Steps to the end of the case; `progress(time, end)` is called after each window, in s of process time.
    ///
    /// Ctrl-C, or an exception of `progress`, writes a checkpoint and ends the run before it is raised.
    #[pyo3(signature = (progress=None))]
    fn run(&self, py: Python<'_>, progress: Option<&Bound<'_, PyAny>>) -> PyResult<&'static str> {
        match self.steps(py, f64::INFINITY, progress) {
            Ok(ending) => Ok(ending.unwrap_or("finished")),
            Err(raised) => {
                // After a failure of the run itself there is nothing to write.
                if !raised.is_instance_of::<crate::error::CalcineError>(py) {
                    self.with(py, Simulation::stop)?;
                }
                Err(raised)
            }
        }
    }

    /// Writes a checkpoint and goes on.
    fn checkpoint(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, Simulation::checkpoint)
    }

    /// Ends the run where it stands, with a checkpoint from which `resume=True` goes on.
    fn stop(&self, py: Python<'_>) -> PyResult<&'static str> {
        self.with(py, |simulation| Ok(word(&simulation.stop()?)))
    }

    /// Lets go of solvers, memory and results folder, without a checkpoint.
    fn close(&self, py: Python<'_>) {
        self.0.close(py);
    }

    fn __enter__(this: Py<Self>) -> Py<Self> {
        this
    }

    /// Stops with a checkpoint unless the run has ended or failed, and closes.
    fn __exit__(
        &self,
        py: Python<'_>,
        kind: &Bound<'_, PyAny>,
        _raised: &Bound<'_, PyAny>,
        _trace: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let open = self.0.is_open(py);
        let stopped = match open {
            true => self.with(py, Simulation::stop).map(drop),
            false => Ok(()),
        };
        self.close(py);
        // The exception that left the block is the one to be seen.
        if kind.is_none() { stopped } else { Ok(()) }
    }

    /// Sets conditions of the gas at a patch from the start of the next window on.
    ///
    /// temperature and ambient in K, superficial_velocity in m/s, mass_flow in kg/s, composition in mass fractions,
    /// pressure (absolute) in Pa, heat_flux in W/m², heat_transfer_coefficient in W/m²/K.
    #[pyo3(signature = (patch, **values))]
    fn set_boundary(
        &self,
        py: Python<'_>,
        patch: &str,
        values: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let quantities = quantities(values)?;
        if quantities.is_empty() {
            return Err(PyTypeError::new_err(
                "set_boundary() needs a quantity, for example temperature=400.0",
            ));
        }
        self.with(py, |simulation| {
            let mut each = quantities.into_iter();
            each.try_for_each(|quantity| simulation.set_boundary(patch, quantity))
        })
    }

    /// Sets the mass flow of a feed in kg/s and the temperature in K with which its particles come in.
    #[pyo3(signature = (feed, *, rate=None, temperature=None))]
    fn set_feed(
        &self,
        py: Python<'_>,
        feed: &str,
        rate: Option<f64>,
        temperature: Option<f64>,
    ) -> PyResult<()> {
        self.with(py, |simulation| {
            if let Some(rate) = rate {
                simulation.set_feed_rate(feed, rate)?;
            }
            temperature.map_or(Ok(()), |temperature| {
                let feed = feed.to_owned();
                simulation.set(Control::FeedTemperature { feed, temperature })
            })
        })
    }

    /// Sets the mass flow of a discharge in kg/s at most; `math.inf` takes all that is in its zone.
    fn set_outlet_rate(&self, py: Python<'_>, outlet: &str, rate: f64) -> PyResult<()> {
        self.with(py, |simulation| simulation.set_outlet_rate(outlet, rate))
    }

    /// Values of the case's quantities by their names, as a row of `series.csv` has them; NaN where nothing is known yet.
    #[getter]
    fn quantities(&self, py: Python<'_>) -> PyResult<BTreeMap<String, f64>> {
        self.read(py, |simulation| {
            let values = simulation.quantities().into_iter();
            values
                .map(|(name, value)| (name.to_owned(), value))
                .collect()
        })
    }

    /// Names of the populations, in the order of `particles.population`.
    #[getter]
    fn populations(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.read(py, |simulation| {
            let populations = simulation.case().particles.iter();
            populations.map(|one| one.name.clone()).collect()
        })
    }

    /// Process time in s.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.read(py, Simulation::time)
    }

    /// Motion time in s.
    #[getter]
    fn motion_time(&self, py: Python<'_>) -> PyResult<f64> {
        self.read(py, Simulation::motion_time)
    }

    /// Process time in s at which the case ends.
    #[getter]
    fn end(&self, py: Python<'_>) -> PyResult<f64> {
        self.read(py, |simulation| simulation.case().time.end.seconds())
    }

    /// Windows committed so far.
    #[getter]
    fn windows(&self, py: Python<'_>) -> PyResult<u64> {
        self.read(py, Simulation::windows)
    }

    /// The results folder.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.0.folder().to_owned()
    }

    /// `None`, "finished" or "checkpointed"; after the end of a `with` block too.
    #[getter]
    fn ending(&self, py: Python<'_>) -> Option<&'static str> {
        self.0.ending(py).as_ref().map(word)
    }

    /// What is to be told of the start, such as a damaged checkpoint and the older one used in its place.
    #[getter]
    fn notes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, self.read(py, |simulation| simulation.notes().to_vec())?)
    }

    /// Fields of the gas.
    #[getter]
    fn gas(&self) -> PyGas {
        PyGas(self.0.clone())
    }

    /// The particles, in ascending id.
    #[getter]
    fn particles(&self) -> PyParticles {
        PyParticles(self.0.clone())
    }

    /// The gas mesh.
    #[getter]
    fn mesh(&self) -> PyMesh {
        PyMesh(self.0.clone())
    }

    /// Void fraction of each cell, mapped and smoothed.
    #[getter]
    fn void_fraction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        arrays::scalars(
            py,
            &self.read(py, |simulation| simulation.void_fraction().to_vec())?,
        )
    }
}
