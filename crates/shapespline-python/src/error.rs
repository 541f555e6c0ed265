//! Errors of the crates below as Python exceptions.

use pyo3::{PyErr, PyTypeInfo, exceptions::PyValueError, prelude::*};
use shapespline::{geometry::InputError, nu::FitError};

pyo3::import_exception!(shapespline._errors, ConvergenceError);

/// Unusable input: `ValueError`, in the words of the crate that found it.
pub(crate) fn input_error(error: InputError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// No curve: `ValueError`, in the words of the crate that found it.
pub(crate) fn fit_error(error: FitError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// No curve `k` of many.
pub(crate) fn curve_error(k: usize, error: &FitError) -> PyErr {
    PyValueError::new_err(format!("curve {k}: {error}"))
}

/// The search ended early: the exception carries the last curve and the report on it.
pub(crate) fn convergence_error(
    py: Python<'_>,
    message: String,
    curve: Py<PyAny>,
    report: Py<PyAny>,
) -> PyErr {
    match ConvergenceError::type_object(py).call1((message, curve, report)) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}
