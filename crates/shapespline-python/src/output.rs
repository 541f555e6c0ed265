// SPDX-License-Identifier: MIT OR Apache-2.0

//! Results as fresh arrays, without a copy where they are large.

use numpy::{PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::{exceptions::PyMemoryError, prelude::*, sync::PyOnceLock, types::PyTuple};
use shapespline::geometry::{DVec3, Dimension};

pub(crate) type FloatArray<'py> = Bound<'py, PyArrayDyn<f64>>;

/// `MemoryError` where so many numbers have no room: a size that a user asks for must not end the
/// process.
pub(crate) fn room(count: usize, columns: usize) -> PyResult<usize> {
    let total = count.checked_mul(columns).filter(|n| *n <= isize::MAX as usize / 16);
    let reserved = total.and_then(|n| Vec::<f64>::new().try_reserve_exact(n).ok().map(|()| n));
    reserved
        .ok_or_else(|| PyMemoryError::new_err(format!("no room for {count} × {columns} numbers")))
}

/// Zeros to be filled, where there is room.
pub(crate) fn zeros(count: usize, columns: usize) -> PyResult<Vec<f64>> {
    Ok(vec![0.0; room(count, columns)?])
}

/// One vector: shape (dim,).
#[inline]
pub(crate) fn vector(py: Python<'_>, v: DVec3, columns: usize) -> FloatArray<'_> {
    PyArray1::from_slice(py, &v.to_array()[..columns]).to_dyn().clone()
}

/// A fresh array of a shape, filled in place.
///
/// NumPy asks for its memory itself: it has large arrays in huge pages, whose first touch costs a
/// fraction of what it does in memory that Rust asked for.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    shape: &[usize],
    fill: impl FnOnce(&mut [f64]) -> PyResult<()>,
) -> PyResult<FloatArray<'py>> {
    static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let empty = EMPTY.import(py, "numpy", "empty")?;
    let array = empty.call1((PyTuple::new(py, shape)?,))?.cast_into::<PyArrayDyn<f64>>()?;
    fill(array.try_readwrite()?.as_slice_mut()?)?;
    Ok(array)
}

/// Values in C order as an array of a shape.
pub(crate) fn shaped<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    shape: &[usize],
) -> PyResult<FloatArray<'py>> {
    let array = PyArray1::from_vec(py, values);
    if let [_] = shape { Ok(array.to_dyn().clone()) } else { array.reshape(shape) }
}

/// Vectors as an array of shape (n, dim).
pub(crate) fn vectors<'py>(
    py: Python<'py>,
    vectors: &[DVec3],
    dimension: Dimension,
) -> PyResult<FloatArray<'py>> {
    let columns = dimension.count();
    let mut values = Vec::with_capacity(vectors.len() * columns);
    for v in vectors {
        values.extend_from_slice(&v.to_array()[..columns]);
    }
    shaped(py, values, &[vectors.len(), columns])
}
