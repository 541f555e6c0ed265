// SPDX-License-Identifier: MIT OR Apache-2.0

//! Numbers and arrays that come in. Every error names the argument.

use pyo3::{
    exceptions::{PyOverflowError, PyTypeError, PyValueError},
    prelude::*,
    types::{PyFloat, PyInt, PyString},
};
use shapespline::geometry::{DVec3, Dimension};

use crate::error::{Value, invalid, must};

mod array;
mod copy;
mod unusual;

pub(crate) use array::{_floats, Array, array, finite};
use unusual::refuse_masked;

/// Puts an error of a conversion into our words, and keeps it as the cause: one that says that a value or
/// a type is wrong. Others pass as they are: Ctrl-C, no memory, whatever an array computes on demand.
pub(crate) fn reworded(py: Python<'_>, error: PyErr, words: impl FnOnce(&PyErr) -> PyErr) -> PyErr {
    let ours = error.is_instance_of::<PyValueError>(py)
        || error.is_instance_of::<PyTypeError>(py)
        || error.is_instance_of::<PyOverflowError>(py);
    if !ours {
        return error;
    }
    let new = words(&error);
    new.set_cause(py, Some(error));
    new
}

/// Points, which an array `(n, 2)` or `(n, 3)` was copied to while no other thread could change it.
pub(crate) struct Points {
    pub(crate) points: Vec<DVec3>,
    pub(crate) dimension: Dimension,
}

impl<'py> FromPyObject<'_, 'py> for Points {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array = array("points", &object)?;
        let values = array.values();
        let (points, dimension) = match *array.shape() {
            [_, 3] => (bytemuck::cast_slice(values).to_vec(), Dimension::Three),
            [_, 2] => {
                let planar = values.as_chunks().0.iter().map(|&[x, y]| DVec3::new(x, y, 0.0));
                (planar.collect(), Dimension::Two)
            }
            ref shape => {
                return Err(must("points", &[], "have shape (n, 2) or (n, 3)", shape));
            }
        };
        Ok(Self { points, dimension })
    }
}

/// Where the rows of a collection begin, and where the last one ends.
pub(crate) struct Offsets(pub(crate) Vec<usize>);

impl<'py> FromPyObject<'_, 'py> for Offsets {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array = array("offsets", &object)?;
        let [_] = array.shape() else {
            return Err(must("offsets", &[], "have one axis", array.shape()));
        };
        // f64 holds every index of an array that fits into memory.
        let index = |(i, &x): (usize, &f64)| {
            if x >= 0.0 && x.fract() == 0.0 && x < 9e15 {
                return Ok(x as usize);
            }
            Err(must("offsets", &[i], "be an integer from 0", x))
        };
        array.values().iter().enumerate().map(index).collect::<PyResult<_>>().map(Self)
    }
}

/// One number, or an array of them.
pub(crate) enum Numbers {
    One(f64),
    Many(Vec<f64>),
}

/// A number or a one-dimensional array of them.
pub(crate) fn numbers(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<Numbers> {
    if let Ok(value) = object.cast::<PyFloat>() {
        return Ok(Numbers::One(value.value()));
    }
    let array = array(argument, object)?;
    match array.shape() {
        [] => Ok(Numbers::One(array.values()[0])),
        [_] => Ok(Numbers::Many(array.values().to_vec())),
        shape => Err(must(argument, &[], "be a number or have one axis", shape)),
    }
}

/// Parameters at which a curve is asked for something.
pub(crate) enum Query<'py> {
    One(f64),
    Many(Array<'py>),
}

impl<'py> FromPyObject<'_, 'py> for Query<'py> {
    type Error = PyErr;

    #[inline]
    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Self::named("u", &object)
    }
}

impl<'py> Query<'py> {
    /// Of an argument with this name.
    #[inline]
    pub(crate) fn named(argument: &str, object: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Ok(value) = object.cast::<PyFloat>() {
            return Ok(Self::One(value.value()));
        }
        if object.cast::<PyInt>().is_ok() {
            return float(argument, object).map(Self::One);
        }
        let array = array(argument, object)?;
        Ok(if array.shape().is_empty() { Self::One(array.values()[0]) } else { Self::Many(array) })
    }
}

/// A number.
pub(crate) fn float(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<f64> {
    let py = object.py();
    if let Ok(value) = object.cast::<PyFloat>() {
        return Ok(value.value());
    }
    refuse_masked(argument, object)?;
    object.extract::<f64>().map_err(|error| {
        reworded(py, error, |error| {
            if error.is_instance_of::<PyOverflowError>(py) {
                let text = format!("{argument} is too large for a float");
                invalid(argument, &[], Value::Nothing, text)
            } else {
                PyTypeError::new_err(format!("{argument} must be a number, got {}", kind(object)))
            }
        })
    })
}

/// An integer that 64 bits hold.
pub(crate) fn integer(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<i64> {
    let py = object.py();
    object.extract::<i64>().map_err(|error| {
        reworded(py, error, |error| {
            if error.is_instance_of::<PyOverflowError>(py) {
                // Python refuses to write integers of more than 4,300 digits.
                let digits = object.str().map_or_else(|_| String::new(), |text| text.to_string());
                let given = if matches!(digits.len(), 1..=40) { &digits } else { "a longer one" };
                let text = format!("{argument} must be an integer that 64 bits hold, got {given}");
                invalid(argument, &[], given, text)
            } else {
                PyTypeError::new_err(format!("{argument} must be an integer, got {}", kind(object)))
            }
        })
    })
}

/// An integer of at least `least`.
pub(crate) fn count(argument: &str, least: usize, object: &Bound<'_, PyAny>) -> PyResult<usize> {
    let value = integer(argument, object)?;
    usize::try_from(value)
        .ok()
        .filter(|&n| n >= least)
        .ok_or_else(|| must(argument, &[], format_args!("be at least {least}"), value))
}

/// The text of a string argument, or `None`.
pub(crate) fn text(object: &Bound<'_, PyAny>) -> Option<String> {
    object.cast::<PyString>().ok().and_then(|s| s.to_str().ok().map(str::to_owned))
}

/// What an argument of the wrong kind is, for a message.
pub(crate) fn kind(object: &Bound<'_, PyAny>) -> String {
    object.get_type().name().map_or_else(|_| "object".to_owned(), |name| name.to_string())
}
