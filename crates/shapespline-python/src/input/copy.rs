// SPDX-License-Identifier: MIT OR Apache-2.0

//! Copies of arrays, and the places and kinds of what they cannot hold.

use numpy::{PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::{intern, prelude::*, types::IntoPyDict};

use super::kind;

/// A copy of an array as f64 in C order, which nobody else has.
pub(super) fn copied<'py>(array: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let py = array.py();
    let options = [("dtype", "float64"), ("order", "C")].into_py_dict(py)?;
    let make = py.import(intern!(py, "numpy"))?.getattr(intern!(py, "array"))?;
    Ok(make.call((array,), Some(&options))?.cast_into()?)
}

/// The error about something that does not hold real numbers, whose array is `any`.
pub(super) fn wrong_kind(
    argument: &str,
    object: &Bound<'_, PyAny>,
    any: &Bound<'_, PyAny>,
) -> PyResult<PyErr> {
    let given = if any.is(object) { "an array" } else { "a value" };
    Ok(pyo3::exceptions::PyTypeError::new_err(format!(
        "{argument} must hold real numbers, got {given} of type {} with dtype {}",
        kind(object),
        any.cast::<PyUntypedArray>()?.dtype().str()?,
    )))
}

/// The index of an entry of an array in C order.
pub(super) fn index_of(mut flat: usize, shape: &[usize]) -> Vec<usize> {
    let mut index: Vec<usize> = Vec::with_capacity(shape.len());
    for &length in shape.iter().rev() {
        index.push(flat % length.max(1));
        flat /= length.max(1);
    }
    index.reverse();
    index
}
