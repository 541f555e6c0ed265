//! Options of the monotone schemes by name, and errors with the place in y.

use pyo3::{
    exceptions::{PyIndexError, PyOverflowError, PyTypeError},
    prelude::*,
    types::PyBool,
};
use shapespline::monotone::{Extrapolation, Fairness, MonotoneError, Shape};

use super::layout::Layout;
use crate::{
    error::{Refused, invalid, joined, must},
    input::{Numbers, array, count, float, integer, kind, numbers, text},
    options::{choose, unknown},
};

/// What it refused in column k of y.
pub(crate) fn column_error(error: &MonotoneError, layout: &Layout, k: usize) -> PyErr {
    let mut refused = Refused::from(error);
    if layout.is_one() {
        return refused.raise(error.to_string());
    }
    if let (&[i], "y" | "slopes") = (&refused.index[..], refused.argument) {
        refused.index = layout.index(k, i);
    }
    let place = joined(&refused.index);
    let text = match error {
        MonotoneError::NotFinite { argument: argument @ ("y" | "slopes"), value, .. } => {
            format!("{argument}[{place}] is {value}; every entry must be finite")
        }
        MonotoneError::OutOfRange { quantity, argument: "y", value, .. } => format!(
            "the {quantity} at y[{place}] = {value} is out of the range of double precision; rescale the data"
        ),
        MonotoneError::NotIncreasing { .. }
        | MonotoneError::TooFew { .. }
        | MonotoneError::Shape { .. }
        | MonotoneError::NotFinite { .. } => error.to_string(),
        _ => format!("y{}: {error}", layout.column(k)),
    };
    refused.raise(text)
}

/// `extrapolate`: `None` leaves it to the object.
pub(crate) fn extrapolate(object: &Bound<'_, PyAny>) -> PyResult<Option<Extrapolation>> {
    if object.is_none() {
        return Ok(None);
    }
    let truth = |value| if value { Extrapolation::Polynomial } else { Extrapolation::Nan };
    if let Ok(value) = object.cast::<PyBool>() {
        return Ok(Some(truth(value.is_true())));
    }
    if let Some(name) = text(object) {
        let modes = [("linear", Extrapolation::LINEAR), ("clip", Extrapolation::CLIP)];
        return modes
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, m)| Some(*m))
            .ok_or_else(|| unknown("extrapolate", &name, "None, True, False, 'linear', 'clip'"));
    }
    // NumPy's own bool is none of Python's.
    match object.extract::<bool>() {
        Ok(value) => Ok(Some(truth(value))),
        Err(_) => Err(PyTypeError::new_err(format!(
            "extrapolate must be None, True, False, 'linear' or 'clip', got {}",
            kind(object)
        ))),
    }
}

pub(crate) fn fairness(object: &Bound<'_, PyAny>) -> PyResult<Fairness> {
    let name = text(object).ok_or_else(|| {
        PyTypeError::new_err(format!("fairness must be a string, got {}", kind(object)))
    })?;
    let energies = [("bending", Fairness::Bending), ("parametric", Fairness::Parametric)];
    choose("fairness", &name, &energies)
}

/// `slopes`: a name, or the numbers in the shape of y.
pub(crate) enum SlopesOption {
    FritschButland,
    Optimal,
    Given { values: Vec<f64>, shape: Vec<usize> },
}

pub(crate) fn slopes(object: &Bound<'_, PyAny>) -> PyResult<SlopesOption> {
    if let Some(name) = text(object) {
        return match name.as_str() {
            "fritsch-butland" => Ok(SlopesOption::FritschButland),
            "optimal" => Ok(SlopesOption::Optimal),
            _ => Err(unknown(
                "slopes",
                &name,
                "'optimal' (quintic only), 'fritsch-butland', or an array of slopes",
            )),
        };
    }
    let given = array("slopes", object)?;
    Ok(SlopesOption::Given { values: given.values().to_vec(), shape: given.shape().to_vec() })
}

/// `shape`: α = β, or the two arrays.
pub(crate) fn shape(object: &Bound<'_, PyAny>) -> PyResult<Shape> {
    // A pair: two numbers, or two arrays of one entry a segment.
    if let Ok(length) = object.len() {
        if length != 2 {
            let text =
                format!("shape must be a number or a pair (alpha, beta), got {length} entries");
            return Err(invalid("shape", &[], length, text));
        }
        let side = |k: usize, name| numbers(name, &object.get_item(k)?);
        return match (side(0, "shape[0]")?, side(1, "shape[1]")?) {
            (Numbers::Many(alpha), Numbers::Many(beta)) => Ok(Shape::Segments { alpha, beta }),
            _ => Err(PyTypeError::new_err(
                "shape must be a number or a pair of arrays (alpha, beta), one entry a segment",
            )),
        };
    }
    float("shape", object).map(Shape::Uniform)
}

pub(crate) fn nu(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("nu", 0, object)
}

/// The order of an antiderivative: its pieces' degree grows with it, so not without end.
pub(crate) fn integrals(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    /// Binomial coefficients of higher degrees leave double precision.
    const MOST: usize = 100;
    match count("nu", 0, object)? {
        nu if nu <= MOST => Ok(nu),
        nu => Err(must("nu", &[], format_args!("be at most {MOST}"), nu)),
    }
}

pub(crate) fn finite(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<f64> {
    let value = float(argument, object)?;
    if value.is_finite() {
        return Ok(value);
    }
    Err(must(argument, &[], "be finite", value))
}
pub(crate) fn a(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    finite("a", object)
}
pub(crate) fn b(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    finite("b", object)
}
pub(crate) fn y(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    finite("y", object)
}
pub(crate) fn axis(object: &Bound<'_, PyAny>) -> PyResult<isize> {
    integer("axis", object).map(|axis| axis as isize)
}

/// The index of a row, which is beyond all of them where 64 bits do not hold it.
pub(crate) fn row(object: &Bound<'_, PyAny>) -> PyResult<isize> {
    object.extract::<isize>().map_err(|error| {
        if error.is_instance_of::<PyOverflowError>(object.py()) {
            return PyIndexError::new_err("row out of range");
        }
        PyTypeError::new_err(format!("row must be an integer, got {}", kind(object)))
    })
}
