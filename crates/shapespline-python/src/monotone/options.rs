// SPDX-License-Identifier: MIT OR Apache-2.0

//! Options of the monotone schemes by name, and errors with the place in y.

use pyo3::{
    IntoPyObjectExt,
    exceptions::{PyIndexError, PyOverflowError, PyTypeError},
    prelude::*,
    types::{PyList, PyTuple},
};
use shapespline::monotone::{
    Continuation, Convexity, Ends, Extrapolation, Fairness, MonotoneError, ShapeParameters,
};

use super::layout::Layout;
use crate::{
    error::{Refused, invalid, joined, must, tuple},
    input::{Array, Numbers, array, count, float, integer, kind, numbers, reworded, text},
    options::{choose, unknown},
};

/// What it refused in column k of y.
pub(crate) fn column_error(error: &MonotoneError, layout: &Layout, k: usize) -> PyErr {
    let mut refused = Refused::from(error);
    if layout.is_one() {
        return refused.raise(error.to_string());
    }
    if let (&[i], "y" | "slopes" | "convex") = (&refused.index[..], refused.argument) {
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
        MonotoneError::Slope { value, rule, .. } => {
            format!("slopes[{place}] {rule}, got {value}; clip=True limits such slopes")
        }
        MonotoneError::Convex { value, rule, .. } => format!("convex[{place}] is {value}, {rule}"),
        MonotoneError::HeldSlope { argument: "slopes", value, rule, .. } => {
            format!("slopes[{place}] {rule}, got {value}")
        }
        MonotoneError::NotIncreasing { .. }
        | MonotoneError::TooFew { .. }
        | MonotoneError::Shape { .. }
        | MonotoneError::Share { .. }
        | MonotoneError::NotFinite { .. } => error.to_string(),
        _ => format!("y{}: {error}", layout.column(k)),
    };
    refused.raise(text)
}

const CONTINUATIONS: &str =
    "'linear', 'clip', 'periodic', True, False, a pair (below, above) of them";

/// `extrapolate`: `None` leaves it to the object, or to the default.
pub(crate) fn extrapolate(object: &Bound<'_, PyAny>) -> PyResult<Option<Extrapolation>> {
    if object.is_none() {
        return Ok(None);
    }
    if object.is_instance_of::<PyTuple>() || object.is_instance_of::<PyList>() {
        let length = object.len()?;
        if length != 2 {
            let text = format!("extrapolate must be one of {CONTINUATIONS}; got {length} entries");
            return Err(invalid("extrapolate", &[], length, text));
        }
        let side = |k: usize| continuation(&object.get_item(k)?);
        return Ok(Some(Extrapolation { below: side(0)?, above: side(1)? }));
    }
    continuation(object).map(|both| Some(both.into()))
}

fn continuation(object: &Bound<'_, PyAny>) -> PyResult<Continuation> {
    if let Some(name) = text(object) {
        return match name.as_str() {
            "linear" => Ok(Continuation::Taylor(1)),
            "clip" => Ok(Continuation::Taylor(0)),
            "periodic" => Ok(Continuation::Periodic(0)),
            _ => Err(unknown("extrapolate", &name, CONTINUATIONS)),
        };
    }
    // NumPy's own bool is none of Python's.
    let truth = object.extract::<bool>().map_err(|error| {
        reworded(object.py(), error, |_| {
            PyTypeError::new_err(format!(
                "extrapolate must be one of {CONTINUATIONS}, got {}",
                kind(object)
            ))
        })
    })?;
    Ok(if truth { Continuation::Polynomial } else { Continuation::Nan })
}

/// An extrapolation as Python gives it; those of derivatives and antiderivatives have names of their own.
pub(crate) fn extrapolation_name(
    py: Python<'_>,
    Extrapolation { below, above }: Extrapolation,
) -> PyResult<Bound<'_, PyAny>> {
    let name = |side| match side {
        Continuation::Polynomial => true.into_bound_py_any(py),
        Continuation::Nan => false.into_bound_py_any(py),
        Continuation::Zero => "zero".into_bound_py_any(py),
        Continuation::Taylor(0) => "clip".into_bound_py_any(py),
        Continuation::Taylor(1) => "linear".into_bound_py_any(py),
        Continuation::Taylor(k) => format!("taylor-{k}").into_bound_py_any(py),
        Continuation::Periodic(0) => "periodic".into_bound_py_any(py),
        Continuation::Periodic(k) => format!("periodic-{k}").into_bound_py_any(py),
    };
    if below == above { name(below) } else { (name(below)?, name(above)?).into_bound_py_any(py) }
}

pub(crate) fn energy(object: &Bound<'_, PyAny>) -> PyResult<Fairness> {
    let name = text(object).ok_or_else(|| {
        PyTypeError::new_err(format!("energy must be a string, got {}", kind(object)))
    })?;
    let energies = [("bending", Fairness::Bending), ("parametric", Fairness::Parametric)];
    choose("energy", &name, &energies)
}

pub(crate) fn energy_name(energy: Fairness) -> &'static str {
    match energy {
        Fairness::Bending => "bending",
        Fairness::Parametric => "parametric",
    }
}

/// Numbers in the shape of y or of one column.
pub(crate) struct Given {
    values: Vec<f64>,
    shape: Vec<usize>,
}

impl Given {
    /// Given slopes, column after column: one vector of `n` slopes is repeated for all `columns`.
    pub(crate) fn columns(
        &self,
        y: &Array<'_>,
        [columns, n]: [usize; 2],
        split: impl Fn(&[f64]) -> Vec<f64>,
    ) -> PyResult<Vec<f64>> {
        let Self { values, shape } = self;
        if shape == y.shape() {
            return Ok(split(values));
        }
        if *shape == [n] {
            return Ok(values.repeat(columns));
        }
        let rule = format!("have the shape of y, {}, or {}", y.shape_text(), tuple(&[n]));
        Err(must("slopes", &[], rule, &shape[..]))
    }
}

/// `slopes`: a name, or numbers.
pub(crate) enum SlopesOption {
    FritschButland,
    Optimal,
    Given(Given),
}

impl SlopesOption {
    /// The numbers.
    pub(crate) fn given(&self) -> Option<&Given> {
        if let Self::Given(given) = self { Some(given) } else { None }
    }
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
    numbers_of_y(object).map(SlopesOption::Given)
}

fn numbers_of_y(object: &Bound<'_, PyAny>) -> PyResult<Given> {
    let given = array("slopes", object)?;
    Ok(Given { values: given.values().to_vec(), shape: given.shape().to_vec() })
}

/// `slopes` of the cubic: numbers, NaN where they are free.
pub(crate) fn given_slopes(object: &Bound<'_, PyAny>) -> PyResult<Option<Given>> {
    if object.is_none() {
        return Ok(None);
    }
    if let Some(name) = text(object) {
        return Err(unknown(
            "slopes",
            &name,
            "None, an array of slopes with NaN where they are free",
        ));
    }
    numbers_of_y(object).map(Some)
}

/// `convex`: nothing, where the data are, or signs per interval.
#[derive(Clone)]
pub(crate) enum ConvexOption {
    Nowhere,
    Data,
    Signs { values: Vec<i8>, shape: Vec<usize> },
}

impl ConvexOption {
    /// What is asked of each of the `columns` of `n` points; one vector of signs is for all.
    pub(crate) fn columns(
        &self,
        y: &Array<'_>,
        axis: usize,
        [columns, n]: [usize; 2],
    ) -> PyResult<Vec<Option<Convexity>>> {
        let Self::Signs { values, shape } = self else {
            let one = matches!(self, Self::Data).then_some(Convexity::Data);
            return Ok(vec![one; columns]);
        };
        let m = n.saturating_sub(1);
        if *shape == [m] {
            return Ok(vec![Some(Convexity::Signs(values.clone())); columns]);
        }
        let mut own = y.shape().to_vec();
        own[axis] = m;
        if *shape != own {
            let one = tuple(&[m]);
            let rule = match tuple(&own) {
                all if all == one => format!("have one sign per interval: shape {one}"),
                all => format!("have one sign per interval: shape {one} or {all}"),
            };
            return Err(must("convex", &[], rule, &shape[..]));
        }
        let inner: usize = own[axis + 1..].iter().product();
        let sign = |k: usize, i: usize| values[(k / inner * m + i) * inner + k % inner];
        let column = |k: usize| Convexity::Signs((0..m).map(|i| sign(k, i)).collect());
        Ok((0..columns).map(|k| Some(column(k))).collect())
    }
}

impl ConvexOption {
    /// The signs of the intervals between `points` points; a number is for all.
    pub(crate) fn of_one(self, points: usize) -> PyResult<Option<Vec<i8>>> {
        let m = points.saturating_sub(1);
        match self {
            Self::Signs { values, shape } if shape.is_empty() => Ok(Some(vec![values[0]; m])),
            Self::Signs { values, shape } if shape == [m] => Ok(Some(values)),
            Self::Signs { shape, .. } => {
                let rule = format!("be one sign or one per interval: shape {}", tuple(&[m]));
                Err(must("convex", &[], rule, &shape[..]))
            }
            Self::Nowhere | Self::Data => Ok(None),
        }
    }
}

pub(crate) fn convex(object: &Bound<'_, PyAny>) -> PyResult<ConvexOption> {
    if object.is_none() {
        return Ok(ConvexOption::Nowhere);
    }
    if let Some(name) = text(object) {
        return match name.as_str() {
            "data" => Ok(ConvexOption::Data),
            _ => Err(unknown("convex", &name, "None, 'data', an array of signs per interval")),
        };
    }
    let given = array("convex", object)?;
    let mut values = Vec::with_capacity(given.values().len());
    for (i, &v) in given.values().iter().enumerate() {
        values.push(match v {
            1.0 => 1,
            -1.0 => -1,
            0.0 => 0,
            _ => return Err(must("convex", &[i], "be -1, 0 or 1", v)),
        });
    }
    Ok(ConvexOption::Signs { values, shape: given.shape().to_vec() })
}

/// `ends`: a name, or a pair of slopes, None where they are free.
pub(crate) fn ends(object: &Bound<'_, PyAny>) -> PyResult<Ends> {
    const EXPECTED: &str = "'estimated', 'natural', 'periodic', or a pair of slopes (None: free)";
    if let Some(name) = text(object) {
        return match name.as_str() {
            "estimated" => Ok(Ends::Estimated),
            "natural" => Ok(Ends::Natural),
            "periodic" => Ok(Ends::Periodic),
            _ => Err(unknown("ends", &name, EXPECTED)),
        };
    }
    let length = object.len().map_err(|error| {
        reworded(object.py(), error, |_| {
            PyTypeError::new_err(format!("ends must be {EXPECTED}, got {}", kind(object)))
        })
    })?;
    if length != 2 {
        let text = format!("ends must be {EXPECTED}, got {length} entries");
        return Err(invalid("ends", &[], length, text));
    }
    let side = |k: usize| {
        let item = object.get_item(k)?;
        if item.is_none() { Ok(None) } else { finite(["ends[0]", "ends[1]"][k], &item).map(Some) }
    };
    Ok(Ends::Slopes([side(0)?, side(1)?]))
}

pub(crate) fn layer(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    finite("layer", object)
}
pub(crate) fn min_slope(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    finite("min_slope", object)
}

/// `shape`: α = β, or the two arrays.
pub(crate) fn shape(object: &Bound<'_, PyAny>) -> PyResult<ShapeParameters> {
    // A pair: two numbers, or two arrays of one entry a segment.
    let length = match object.len() {
        Ok(length) => Some(length),
        Err(error) if error.is_instance_of::<PyTypeError>(object.py()) => None,
        Err(error) => return Err(error),
    };
    if let Some(length) = length {
        if length != 2 {
            let text =
                format!("shape must be a number or a pair (alpha, beta), got {length} entries");
            return Err(invalid("shape", &[], length, text));
        }
        let side = |k: usize, name| numbers(name, &object.get_item(k)?);
        return match (side(0, "shape[0]")?, side(1, "shape[1]")?) {
            (Numbers::Many(alpha), Numbers::Many(beta)) => {
                Ok(ShapeParameters::Segments { alpha, beta })
            }
            _ => Err(PyTypeError::new_err(
                "shape must be a number or a pair of arrays (alpha, beta), one entry a segment",
            )),
        };
    }
    float("shape", object).map(ShapeParameters::Uniform)
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
    float("a", object)
}
pub(crate) fn b(object: &Bound<'_, PyAny>) -> PyResult<f64> {
    float("b", object)
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
        reworded(object.py(), error, |_| {
            PyTypeError::new_err(format!("row must be an integer, got {}", kind(object)))
        })
    })
}
