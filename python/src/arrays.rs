//! NumPy arrays of committed fields: copies that cannot be written and stay as they are when the run goes on.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

/// One value each.
pub fn scalars<'py, T: Element>(
    py: Python<'py>,
    values: &[T],
) -> PyResult<Bound<'py, PyArray1<T>>> {
    let array = PyArray1::from_slice(py, values);
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

/// Rows of `columns` values each.
pub fn rows<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    columns: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let count = values.len().checked_div(columns).unwrap_or(0);
    let array = PyArray1::from_vec(py, values).reshape([count, columns])?;
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

/// Three components each.
pub fn vectors<'py, V: std::ops::Index<usize, Output = f64>>(
    py: Python<'py>,
    values: &[V],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat = values.iter().flat_map(|one| [one[0], one[1], one[2]]);
    rows(py, flat.collect(), 3)
}
