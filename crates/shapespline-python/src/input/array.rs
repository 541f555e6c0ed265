// SPDX-License-Identifier: MIT OR Apache-2.0

//! Arrays of f64 that nobody else can change the shape of.

use numpy::{
    PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::{intern, prelude::*};

use super::{
    copy::{copied, index_of, wrong_kind},
    reworded,
    unusual::{of_objects, refuse_dates, refuse_masked},
};
use crate::{
    error::{Value, invalid, must, tuple},
    output::shaped,
};

/// Values up to which a copy costs no more than a view.
const SMALL: usize = 4096;

/// An array of f64 in C order.
///
/// While other threads run, they may give the caller's array another shape, other strides or another
/// type: so it is read through a view that they do not know, or copied.
pub(crate) struct Array<'py> {
    values: Values<'py>,
    shape: Vec<usize>,
}

enum Values<'py> {
    Copy(Vec<f64>),
    View(PyReadonlyArrayDyn<'py, f64>),
}

impl<'py> Array<'py> {
    /// A copy of a small array, a view of a large one; `None` if it is not in C order or not aligned.
    fn of(array: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<Option<Self>> {
        if !array.is_c_contiguous() {
            return Ok(None);
        }
        let shape = array.shape().to_vec();
        if array.len() <= SMALL {
            let Ok(borrowed) = array.try_readonly() else { return Ok(None) };
            let copy = borrowed.as_slice().map(<[f64]>::to_vec);
            return Ok(copy.ok().map(|copy| Self { values: Values::Copy(copy), shape }));
        }
        let py = array.py();
        let plain = py.get_type::<PyUntypedArray>();
        let view = plain.call_method1(intern!(py, "view"), (array, &plain))?;
        let view = view.cast_into::<PyArrayDyn<f64>>()?;
        Ok(Self::own(&view, shape))
    }

    /// Reads an array that nobody else has.
    fn own(array: &Bound<'py, PyArrayDyn<f64>>, shape: Vec<usize>) -> Option<Self> {
        let array = array.try_readonly().ok()?;
        let readable = array.as_slice().is_ok();
        readable.then_some(Self { values: Values::View(array), shape })
    }

    pub(crate) fn values(&self) -> &[f64] {
        match &self.values {
            Values::Copy(values) => values,
            // `own` has made sure that it can be read.
            Values::View(array) => array.as_slice().unwrap_or_default(),
        }
    }

    pub(crate) fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// The shape as Python writes it.
    pub(crate) fn shape_text(&self) -> String {
        tuple(self.shape())
    }
}

/// Converts anything that `numpy.asarray` takes.
///
/// # Errors
/// `TypeError` for what is not real numbers, `ValueError` (naming the argument) for what is no array or
/// has masked values.
pub(crate) fn array<'py>(argument: &str, object: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
    if let Ok(array) = object.cast::<PyArrayDyn<f64>>() {
        refuse_masked(argument, object)?;
        if let Some(array) = Array::of(array)? {
            return Ok(array);
        }
    } else {
        refuse_masked(argument, object)?;
    }
    let py = object.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    let any = numpy.getattr(intern!(py, "asarray"))?.call1((object,)).map_err(|error| {
        reworded(py, error, |error| {
            // Rows of different lengths, for example.
            let text = format!("{argument} must be an array of numbers: {}", error.value(py));
            invalid(argument, &[], Value::Nothing, text)
        })
    })?;
    let dtype = any.cast::<PyUntypedArray>()?.dtype();
    let copy = match dtype.kind() {
        b'b' | b'i' | b'u' | b'f' => copied(&any)?,
        b'O' => of_objects(argument, object, &any)?,
        letter => {
            refuse_dates(argument, object, letter, &dtype.str()?.to_string())?;
            return Err(wrong_kind(argument, object, &any)?);
        }
    };
    let shape = copy.shape().to_vec();
    Array::own(&copy, shape).ok_or_else(|| {
        invalid(argument, &[], Value::Nothing, format!("{argument} cannot be read: it is in use"))
    })
}

/// Refuses an array that holds NaN or infinity.
///
/// # Errors
/// `ValueError` with the full index of the first such value.
pub(crate) fn finite(argument: &str, array: &Array<'_>) -> PyResult<()> {
    let Some(flat) = array.values().iter().position(|x| !x.is_finite()) else { return Ok(()) };
    Err(must(argument, &index_of(flat, array.shape()), "be finite", array.values()[flat]))
}

/// Return an array of f64 for the Python side of the package, with the same refusals.
#[pyfunction]
pub(crate) fn _floats<'py>(
    argument: &str,
    values: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = values.py();
    match array(argument, values)? {
        Array { values: Values::View(view), .. } => Ok(view.as_any().clone()),
        Array { values: Values::Copy(values), shape } => Ok(shaped(py, values, &shape)?.into_any()),
    }
}
