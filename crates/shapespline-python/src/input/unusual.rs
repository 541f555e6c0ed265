// SPDX-License-Identifier: MIT OR Apache-2.0

//! Arrays of unusual things: masked values, dates, Python objects.

use numpy::{PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::{
    exceptions::{PyOverflowError, PyTypeError},
    intern,
    prelude::*,
    sync::PyOnceLock,
    types::{PyBytes, PyComplex, PyFloat, PyInt, PyList, PyString, PyTuple},
};

use super::{
    copy::{copied, index_of, wrong_kind},
    kind, reworded,
};
use crate::error::{Value, invalid, joined};

/// Refuses masked values: what hides under a mask may be anything, and would be used without a word.
///
/// # Errors
/// `ValueError` with the index of the first masked value.
pub(crate) fn refuse_masked(argument: &str, object: &Bound<'_, PyAny>) -> PyResult<()> {
    // The usual case: an array of NumPy's own class knows no mask.
    if object.is_exact_instance_of::<PyUntypedArray>() {
        return Ok(());
    }
    match masked(object, 0)? {
        None => Ok(()),
        Some(index) => {
            let place =
                if index.is_empty() { String::new() } else { format!(" at [{}]", joined(&index)) };
            let text = format!("{argument} is masked{place}; fill or drop it first");
            let value = Value::Text("--".to_owned());
            Err(invalid(argument, &index, value, text))
        }
    }
}

/// Lists in lists that are looked into: no array has more axes. (A list may hold itself.)
const MAX_AXES: usize = 64;

/// The index of the first masked value of an array, or of the arrays in lists.
fn masked(object: &Bound<'_, PyAny>, depth: usize) -> PyResult<Option<Vec<usize>>> {
    static CLASS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = object.py();
    let plain = object.is_exact_instance_of::<PyFloat>() || object.is_exact_instance_of::<PyInt>();
    if plain || depth > MAX_AXES {
        return Ok(None);
    }
    if let Ok(list) = object.cast::<PyList>() {
        return masked_item(list.iter(), depth);
    }
    if let Ok(tuple) = object.cast::<PyTuple>() {
        return masked_item(tuple.iter(), depth);
    }
    if object.is_exact_instance_of::<PyUntypedArray>()
        || !object.is_instance(CLASS.import(py, "numpy.ma", "MaskedArray")?)?
    {
        return Ok(None);
    }
    let numpy = py.import(intern!(py, "numpy"))?;
    let mask = py.import("numpy.ma")?.call_method1("getmaskarray", (object,))?;
    if !mask.call_method0("any")?.extract::<bool>()? {
        return Ok(None);
    }
    let flat = numpy.call_method1("argmax", (&mask,))?.extract()?;
    Ok(Some(index_of(flat, mask.cast::<PyUntypedArray>()?.shape())))
}

fn masked_item<'py>(
    items: impl Iterator<Item = Bound<'py, PyAny>>,
    depth: usize,
) -> PyResult<Option<Vec<usize>>> {
    for (i, item) in items.enumerate() {
        if let Some(mut index) = masked(&item, depth + 1)? {
            index.insert(0, i);
            return Ok(Some(index));
        }
    }
    Ok(None)
}

/// Refuses arrays of dates and durations, and says how they become seconds.
///
/// # Errors
/// `TypeError` where the letter of the dtype is that of such an array.
pub(super) fn refuse_dates(
    argument: &str,
    object: &Bound<'_, PyAny>,
    letter: u8,
    dtype: &str,
) -> PyResult<()> {
    let what = match letter {
        b'M' => "datetime64",
        b'm' => "timedelta64",
        _ => return Ok(()),
    };
    let array = if object.hasattr(intern!(object.py(), "astype"))? {
        argument.to_owned()
    } else {
        format!("np.asarray({argument})")
    };
    let unit = dtype.split_once('[').map_or("", |(_, unit)| unit.trim_end_matches(']'));
    let seconds = match unit {
        "s" => format!("{array}.astype('int64')"),
        "ms" => format!("{array}.astype('int64') / 1e3"),
        "us" => format!("{array}.astype('int64') / 1e6"),
        "ns" => format!("{array}.astype('int64') / 1e9"),
        _ => format!("{array}.astype('{what}[s]').astype('int64')"),
    };
    Err(PyTypeError::new_err(format!(
        "{argument} must hold real numbers, got {what}[{unit}]; pass seconds: {seconds}"
    )))
}

/// Floats from an array of Python objects, such as `Decimal` or a column of pandas: all that NumPy turns
/// into floats, but no text and no complex numbers.
pub(super) fn of_objects<'py>(
    argument: &str,
    object: &Bound<'py, PyAny>,
    any: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let py = any.py();
    let shape = any.cast::<PyUntypedArray>()?.shape().to_vec();
    let items: Bound<'_, PyList> =
        any.call_method0(intern!(py, "ravel"))?.call_method0(intern!(py, "tolist"))?.cast_into()?;
    if shape.is_empty() && items.get_item(0)?.is_none() {
        return Err(wrong_kind(argument, object, any)?);
    }
    let no_number = |item: &Bound<'_, PyAny>| {
        item.is_instance_of::<PyString>()
            || item.is_instance_of::<PyBytes>()
            || item.is_instance_of::<PyComplex>()
    };
    if let Some(flat) = items.iter().position(|item| no_number(&item)) {
        return Err(no_real_number(argument, &index_of(flat, &shape), &items.get_item(flat)?));
    }
    copied(any).map_err(|error| {
        reworded(py, error, |error| {
            let failed = |item: Bound<'_, PyAny>| !item.is_none() && item.extract::<f64>().is_err();
            let flat = items.iter().position(failed).unwrap_or(0);
            let index = index_of(flat, &shape);
            match items.get_item(flat) {
                Ok(_) if error.is_instance_of::<PyOverflowError>(py) => {
                    let text = format!("{} is too large for a float", place(argument, &index));
                    invalid(argument, &index, Value::Nothing, text)
                }
                Ok(item) => no_real_number(argument, &index, &item),
                Err(error) => error,
            }
        })
    })
}

fn place(argument: &str, index: &[usize]) -> String {
    if index.is_empty() { argument.to_owned() } else { format!("{argument}[{}]", joined(index)) }
}

/// The error about an object that is no real number, with the way to seconds for a date.
fn no_real_number(argument: &str, index: &[usize], item: &Bound<'_, PyAny>) -> PyErr {
    let each = |call: &str| match index {
        [] => format!("; pass {argument}.{call}"),
        _ => format!("; pass [t.{call} for t in {argument}]"),
    };
    let has = |name: &str| item.hasattr(name).unwrap_or(false);
    let remedy = if has("timestamp") {
        each("timestamp()")
    } else if has("total_seconds") {
        each("total_seconds()")
    } else if has("toordinal") {
        each("toordinal()")
    } else {
        String::new()
    };
    let place = place(argument, index);
    PyTypeError::new_err(format!("{place} must be a real number, got {}{remedy}", kind(item)))
}
