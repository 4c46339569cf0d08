//! What can be looked at of a simulation: the gas, the particles, the mesh.

use std::sync::Arc;

use calcine::simulation::Simulation;
use numpy::{Element, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::held::HeldSimulation;

type Scalars<'py, T> = PyResult<Bound<'py, PyArray1<T>>>;
type Vectors<'py> = PyResult<Bound<'py, PyArray2<f64>>>;

/// A field of one value each, copied while the run stands still.
fn scalars<'py, T: Element + Copy>(
    py: Python<'py>,
    of: &Arc<HeldSimulation>,
    field: impl FnOnce(&Simulation) -> &[T] + Send,
) -> Scalars<'py, T> {
    let copy = of.with(py, |simulation| Ok(field(simulation).to_vec()))?;
    arrays::scalars(py, &copy)
}

/// A field of three components each.
fn vectors<'py, V: std::ops::Index<usize, Output = f64> + Copy + Send>(
    py: Python<'py>,
    of: &Arc<HeldSimulation>,
    field: impl FnOnce(&Simulation) -> &[V] + Send,
) -> Vectors<'py> {
    let copy = of.with(py, |simulation| Ok(field(simulation).to_vec()))?;
    arrays::vectors(py, &copy)
}

/// Fields of the gas after the last committed window, one row a cell: read-only copies.
#[pyclass(name = "Gas", module = "calcine", frozen)]
pub struct PyGas(pub Arc<HeldSimulation>);

#[pymethods]
impl PyGas {
    /// Temperature in K.
    #[getter]
    fn temperature<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, |simulation| simulation.gas().temperature)
    }

    /// Absolute pressure in Pa.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, |simulation| simulation.gas().pressure)
    }

    /// Density of the gas itself in kg/m³.
    #[getter]
    fn density<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, |simulation| simulation.gas().density)
    }

    /// Interstitial velocity in m/s, three components.
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Vectors<'py> {
        vectors(py, &self.0, |simulation| simulation.gas().velocity)
    }

    /// Names of the species, in the order of the columns of `mass_fractions`.
    #[getter]
    fn species(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let names =
            |simulation: &mut Simulation| Ok(simulation.case().gas.properties.species().to_vec());
        self.0.with(py, names)
    }

    /// Mass fractions, one column a species; without columns for a single gas.
    #[getter]
    fn mass_fractions<'py>(&self, py: Python<'py>) -> Vectors<'py> {
        let (table, cells) = self.0.with(py, |simulation| {
            let gas = simulation.gas();
            Ok((gas.composition.to_vec(), gas.temperature.len()))
        })?;
        let columns = table.len().checked_div(cells).unwrap_or(0);
        arrays::rows(py, table, columns)
    }
}

/// The particles after the last committed window, in ascending id: read-only copies.
#[pyclass(name = "Particles", module = "calcine", frozen)]
pub struct PyParticles(pub Arc<HeldSimulation>);

#[pymethods]
impl PyParticles {
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.0
            .with(py, |simulation| Ok(simulation.particles().len()))
    }

    /// Ids, never reused.
    #[getter]
    fn id<'py>(&self, py: Python<'py>) -> Scalars<'py, u64> {
        scalars(py, &self.0, |simulation| simulation.particles().id)
    }

    /// Index of the population in the case.
    #[getter]
    fn population<'py>(&self, py: Python<'py>) -> Scalars<'py, u32> {
        scalars(py, &self.0, |simulation| simulation.particles().population)
    }

    /// Centres in m.
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Vectors<'py> {
        vectors(py, &self.0, |simulation| simulation.particles().position)
    }

    /// Velocities in m/s of motion time.
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Vectors<'py> {
        vectors(py, &self.0, |simulation| simulation.particles().velocity)
    }

    /// Angular velocities in rad/s of motion time; without rows where the solver has none.
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> Vectors<'py> {
        vectors(py, &self.0, |simulation| {
            simulation.particles().angular_velocity
        })
    }

    /// Statistical weights: how many real particles each stands for.
    #[getter]
    fn weight<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        let weights = self.0.with(py, |simulation| {
            let particles = simulation.particles();
            let rows = 0..particles.len();
            Ok(rows.map(|row| particles.weight_of(row)).collect::<Vec<_>>())
        })?;
        arrays::scalars(py, &weights)
    }

    /// What is inside the particles, by the names that snapshots with `output.particles = ["inside"]` have: such as the mass
    /// fraction of each solid. One value a particle, NaN of those that have none; of what has several values a particle, such as
    /// those of shells, one column each, NaN beyond the last.
    #[getter]
    fn inside<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = self
            .0
            .with(py, |simulation| Ok(simulation.state().models.shown("")))?;
        let found = PyDict::new(py);
        for one in &columns {
            let name = &one.column.name;
            match one.scalars() {
                Some(values) => found.set_item(name, arrays::scalars(py, &values)?)?,
                None => {
                    let most = one.values.lengths().max().unwrap_or(0);
                    let places: Vec<_> = (0..most).map(|place| one.nth(place)).collect();
                    let rows = 0..one.values.rows();
                    let table = rows.flat_map(|row| places.iter().map(move |of| of[row]));
                    found.set_item(name, arrays::rows(py, table.collect(), most)?)?;
                }
            }
        }
        Ok(found)
    }

    /// Radii in m.
    #[getter]
    fn radius<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, |simulation| simulation.particles().radius)
    }

    /// Masses in kg, of one real particle each.
    #[getter]
    fn mass<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, |simulation| simulation.state().particle_mass)
    }

    /// Surface temperatures in K.
    #[getter]
    fn temperature<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, Simulation::particle_temperature)
    }

    /// Mean heat flow into each over the last window in W.
    #[getter]
    fn heat<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, |simulation| simulation.state().particle_heat)
    }
}

/// The gas mesh: read-only copies, one row a cell.
#[pyclass(name = "Mesh", module = "calcine", frozen)]
pub struct PyMesh(pub Arc<HeldSimulation>);

#[pymethods]
impl PyMesh {
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.0.with(py, |simulation| Ok(simulation.mesh().cells()))
    }

    /// Centres of the cells in m.
    #[getter]
    fn cell_centre<'py>(&self, py: Python<'py>) -> Vectors<'py> {
        vectors(py, &self.0, |simulation| simulation.mesh().cell_centre())
    }

    /// Volumes of the cells in m³.
    #[getter]
    fn cell_volume<'py>(&self, py: Python<'py>) -> Scalars<'py, f64> {
        scalars(py, &self.0, |simulation| simulation.mesh().cell_volume())
    }

    /// Names of the patches.
    #[getter]
    fn patches(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.0.with(py, |simulation| {
            let patches = simulation.mesh().patches().iter();
            Ok(patches.map(|patch| patch.name.clone()).collect())
        })
    }
}
