//! Numbers and arrays that come in. Every error names the argument.

use std::borrow::Cow;

use numpy::{
    PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::{
    exceptions::{PyOverflowError, PyTypeError},
    intern,
    prelude::*,
    types::{IntoPyDict, PyFloat, PyInt, PyString},
};
use rayon::prelude::*;
use shapespline::geometry::{DVec3, Dimension};

use crate::{
    error::{Value, invalid, must, tuple},
    work::detached,
};

/// An array of f64 in C order: the caller's own where it is that already, else a copy.
pub(crate) struct Array<'py>(PyReadonlyArrayDyn<'py, f64>);

impl<'py> Array<'py> {
    pub(crate) fn values(&self) -> &[f64] {
        // C order and alignment were seen to by `array`.
        self.0.as_slice().unwrap_or_default()
    }

    pub(crate) fn shape(&self) -> &[usize] {
        self.0.shape()
    }

    /// The shape as Python writes it.
    pub(crate) fn shape_text(&self) -> String {
        tuple(self.shape())
    }
}

/// Converts anything that `numpy.asarray` takes.
///
/// # Errors
/// `TypeError` for what is not real numbers, `ValueError` (naming the argument) for what is no array.
pub(crate) fn array<'py>(argument: &str, object: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
    if let Ok(array) = object.cast::<PyArrayDyn<f64>>()
        && let Some(array) = in_c_order(array)
    {
        return Ok(array);
    }
    let py = object.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    let any = numpy.getattr(intern!(py, "asarray"))?.call1((object,)).map_err(|error| {
        // Rows of different lengths, for example.
        let text = format!("{argument} must be an array of numbers: {}", error.value(py));
        invalid(argument, &[], Value::Nothing, text)
    })?;
    let dtype = any.cast::<PyUntypedArray>()?.dtype();
    if !matches!(dtype.kind(), b'b' | b'i' | b'u' | b'f') {
        let given = if any.is(object) { "an array" } else { "a value" };
        return Err(PyTypeError::new_err(format!(
            "{argument} must hold real numbers, got {given} of type {} with dtype {}",
            kind(object),
            dtype.str()?,
        )));
    }
    let options = [("dtype", "float64"), ("order", "C")].into_py_dict(py)?;
    let copy = numpy.getattr(intern!(py, "array"))?.call((any,), Some(&options))?;
    in_c_order(copy.cast::<PyArrayDyn<f64>>()?).ok_or_else(|| {
        invalid(argument, &[], Value::Nothing, format!("{argument} cannot be read: it is in use"))
    })
}

fn in_c_order<'py>(array: &Bound<'py, PyArrayDyn<f64>>) -> Option<Array<'py>> {
    if !array.is_c_contiguous() {
        return None;
    }
    let array = array.try_readonly().ok()?;
    array.as_slice().is_ok().then_some(Array(array))
}

/// Sees to it that an array holds neither NaN nor infinity.
///
/// # Errors
/// `ValueError` with the full index of the first such value.
pub(crate) fn finite(argument: &str, array: &Array<'_>) -> PyResult<()> {
    let Some(mut flat) = array.values().iter().position(|x| !x.is_finite()) else { return Ok(()) };
    let value = array.values()[flat];
    let mut index: Vec<usize> = Vec::new();
    for &length in array.shape().iter().rev() {
        index.push(flat % length);
        flat /= length;
    }
    index.reverse();
    Err(must(argument, &index, "be finite", value))
}

/// The points of rows of coordinates, on all threads where there are many: of a large copy the first touch
/// of its memory takes longest.
fn made<const N: usize>(
    py: Python<'_>,
    rows: &[[f64; N]],
    make: impl Fn(&[f64; N]) -> DVec3 + Sync + Send,
) -> Vec<DVec3> {
    const MANY: usize = 32_768;
    if rows.len() < 2 * MANY {
        return rows.iter().map(make).collect();
    }
    detached(py, rows.len(), || rows.par_iter().with_min_len(MANY).map(make).collect())
}

/// An array of points, `(n, 2)` or `(n, 3)`: the caller's own where that is f64 in C order.
pub(crate) struct PointArray<'py> {
    array: Array<'py>,
    pub(crate) dimension: Dimension,
}

impl PointArray<'_> {
    /// The points, copied only where they lack the third coordinate.
    pub(crate) fn points(&self, py: Python<'_>) -> Cow<'_, [DVec3]> {
        match self.dimension {
            Dimension::Three => Cow::Borrowed(bytemuck::cast_slice(self.array.values())),
            Dimension::Two => Cow::Owned(self.to_vec(py)),
        }
    }

    fn to_vec(&self, py: Python<'_>) -> Vec<DVec3> {
        let values = self.array.values();
        match self.dimension {
            Dimension::Three => made(py, values.as_chunks().0, |&row| DVec3::from_array(row)),
            Dimension::Two => made(py, values.as_chunks().0, |&[x, y]| DVec3::new(x, y, 0.0)),
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for PointArray<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array = array("points", &object)?;
        let dimension = match *array.shape() {
            [_, 3] => Dimension::Three,
            [_, 2] => Dimension::Two,
            ref shape => {
                return Err(must("points", &[], "have shape (n, 2) or (n, 3)", shape));
            }
        };
        Ok(Self { array, dimension })
    }
}

/// Points of their own, which an array was copied to.
pub(crate) struct Points {
    pub(crate) points: Vec<DVec3>,
    pub(crate) dimension: Dimension,
}

impl<'py> FromPyObject<'_, 'py> for Points {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array: PointArray<'_> = object.extract()?;
        Ok(Self { points: array.to_vec(object.py()), dimension: array.dimension })
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
    object.extract::<f64>().map_err(|error| {
        if error.is_instance_of::<PyOverflowError>(object.py()) {
            let text = format!("{argument} is too large for a float");
            invalid(argument, &[], Value::Nothing, text)
        } else {
            PyTypeError::new_err(format!("{argument} must be a number, got {}", kind(object)))
        }
    })
}

/// An integer of at least `least`.
pub(crate) fn count(argument: &str, least: usize, object: &Bound<'_, PyAny>) -> PyResult<usize> {
    let value = integer(argument, object)?;
    let count = usize::try_from(value).ok().filter(|&n| n >= least);
    count.ok_or_else(|| must(argument, &[], format_args!("be at least {least}"), value))
}

/// An integer.
pub(crate) fn integer(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<i64> {
    match object.extract::<i64>() {
        Ok(value) => Ok(value),
        Err(error) if error.is_instance_of::<PyOverflowError>(object.py()) => {
            // Python refuses to write integers of more than 4,300 digits.
            let digits = object.str().map_or_else(|_| String::new(), |text| text.to_string());
            let given = if matches!(digits.len(), 1..=40) { &digits } else { "a longer one" };
            let text = format!("{argument} must be an integer that 64 bits hold, got {given}");
            Err(invalid(argument, &[], given, text))
        }
        Err(_) => {
            let text = format!("{argument} must be an integer, got {}", kind(object));
            Err(PyTypeError::new_err(text))
        }
    }
}

/// The text of a string argument, or `None`.
pub(crate) fn text(object: &Bound<'_, PyAny>) -> Option<String> {
    object.cast::<PyString>().ok().and_then(|s| s.to_str().ok().map(str::to_owned))
}

/// What an argument of the wrong kind is, for a message.
pub(crate) fn kind(object: &Bound<'_, PyAny>) -> String {
    object.get_type().name().map_or_else(|_| "object".to_owned(), |name| name.to_string())
}
