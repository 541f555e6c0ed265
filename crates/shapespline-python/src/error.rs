// SPDX-License-Identifier: MIT OR Apache-2.0

//! What is refused, as Python exceptions: `shapespline.InputError` says the argument, the index and the
//! value in attributes, so that nobody parses its text.

use std::fmt;

use pyo3::{
    PyErr,
    call::PyCallArgs,
    ffi::c_str,
    prelude::*,
    types::{PyDict, PyTuple},
};
use shapespline::{
    criteria::CurveError,
    geometry::{Coordinates, InputError},
    monotone::MonotoneError,
    nu::FitError,
};

use crate::own;

/// Adds the exceptions to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let names = PyDict::new(module.py());
    names.set_item("__name__", "shapespline")?;
    module.py().run(c_str!(include_str!("exceptions.py")), Some(&names), None)?;
    for name in ["InputError", "ConvergenceError"] {
        module.add(name, names.as_any().get_item(name)?)?;
    }
    Ok(())
}

/// An exception of a class of the module, made of its arguments.
fn raised<'py>(py: Python<'py>, class: &str, arguments: impl PyCallArgs<'py>) -> PyErr {
    match own(py, class).and_then(|class| class.call1(arguments)) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

/// The value that is refused.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Nothing,
    Number(f64),
    Integer(i64),
    /// A name.
    Text(String),
    /// A shape.
    Shape(Vec<usize>),
    Vector(Vec<f64>),
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<i64> for Value {
    fn from(value: i64) -> Self {
        Self::Integer(value)
    }
}

impl From<usize> for Value {
    fn from(value: usize) -> Self {
        i64::try_from(value).map_or(Self::Number(value as f64), Self::Integer)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

impl From<&[usize]> for Value {
    fn from(shape: &[usize]) -> Self {
        Self::Shape(shape.to_vec())
    }
}

impl From<Coordinates> for Value {
    fn from(value: Coordinates) -> Self {
        Self::Vector(value.to_vec())
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("nothing"),
            // `Display` writes 1e300 with all its zeros.
            Self::Number(x) if *x != 0.0 && x.is_finite() && !(1e-5..1e16).contains(&x.abs()) => {
                write!(f, "{x:e}")
            }
            Self::Number(x) => write!(f, "{x}"),
            Self::Integer(n) => write!(f, "{n}"),
            Self::Text(text) => write!(f, "'{text}'"),
            Self::Shape(shape) => write!(f, "shape {}", tuple(shape)),
            Self::Vector(v) => write!(f, "{v:?}"),
        }
    }
}

impl<'py> IntoPyObject<'py> for Value {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        Ok(match self {
            Self::Nothing => py.None().into_bound(py),
            Self::Number(x) => x.into_pyobject(py)?.into_any(),
            Self::Integer(n) => n.into_pyobject(py)?.into_any(),
            Self::Text(text) => text.into_pyobject(py)?.into_any(),
            Self::Shape(shape) => PyTuple::new(py, shape)?.into_any(),
            Self::Vector(v) => PyTuple::new(py, v)?.into_any(),
        })
    }
}

/// A shape or an index as Python writes it.
pub(crate) fn tuple(entries: &[usize]) -> String {
    match entries {
        [n] => format!("({n},)"),
        entries => format!("({})", joined(entries)),
    }
}

pub(crate) fn joined(entries: &[usize]) -> String {
    entries.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

/// Where a value is in its argument: nowhere in particular, at an index, or at several of an array
/// with as many axes.
struct Index(Vec<usize>);

impl<'py> IntoPyObject<'py> for Index {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        Ok(match self.0[..] {
            [] => py.None().into_bound(py),
            [i] => i.into_pyobject(py)?.into_any(),
            _ => PyTuple::new(py, self.0)?.into_any(),
        })
    }
}

/// Unusable input, in words of its own.
pub(crate) fn invalid(
    argument: &str,
    index: &[usize],
    value: impl Into<Value>,
    text: impl Into<String>,
) -> PyErr {
    let index = Index(index.to_vec());
    Python::attach(|py| raised(py, "InputError", (text.into(), argument, index, value.into())))
}

/// Unusable input: `ARGUMENT[INDEX] must RULE, got VALUE`.
pub(crate) fn must(
    argument: &str,
    index: &[usize],
    rule: impl fmt::Display,
    value: impl Into<Value>,
) -> PyErr {
    let value = value.into();
    let place = if index.is_empty() { String::new() } else { format!("[{}]", joined(index)) };
    let text = format!("{argument}{place} must {rule}, got {value}");
    invalid(argument, index, value, text)
}

/// What a crate below refused, as the attributes of the exception.
pub(crate) struct Refused {
    pub(crate) argument: &'static str,
    pub(crate) index: Vec<usize>,
    pub(crate) value: Value,
}

impl Refused {
    fn new(argument: &'static str, index: impl Into<Vec<usize>>, value: impl Into<Value>) -> Self {
        let mut index = index.into();
        // "tangent_scale[1]" is the second of a pair.
        let (argument, side) = argument.split_once('[').unwrap_or((argument, ""));
        if let Ok(side) = side.trim_end_matches(']').parse() {
            index.insert(0, side);
        }
        Self { argument, index, value: value.into() }
    }

    /// The same in one of many: row or curve `k`.
    pub(crate) fn within(mut self, k: usize) -> Self {
        self.index.insert(0, k);
        self
    }

    pub(crate) fn raise(self, text: String) -> PyErr {
        invalid(self.argument, &self.index, self.value, text)
    }
}

impl From<&InputError> for Refused {
    fn from(error: &InputError) -> Self {
        match *error {
            InputError::NotFinite { argument, index, value }
            | InputError::NotIncreasing { argument, index, value, .. }
            | InputError::TooClose { argument, index, spacing: value }
            | InputError::Unequal { argument, last: index, end: value, .. }
            | InputError::OutOfRange { argument, index, value, .. } => {
                Self::new(argument, [index], value)
            }
            InputError::TooFewPoints { argument, found, .. }
            | InputError::Length { argument, found, .. } => Self::new(argument, [], found),
            InputError::RepeatedPoint { index, value }
            | InputError::NotClosed { last: index, end: value, .. } => {
                Self::new("points", [index], value)
            }
            InputError::Scalar { argument, value, .. } => Self::new(argument, [], value),
            InputError::ZeroTangent { value, .. } => Self::new("boundary", [], value),
            InputError::Overflow { index, value, .. } => Self::new("points", [index], value),
            _ => Self::new("points", [], Value::Nothing),
        }
    }
}

impl From<&FitError> for Refused {
    fn from(error: &FitError) -> Self {
        match error {
            FitError::Input(error) => Self::from(error),
            FitError::Solve(_) => Self::new("points", [], Value::Nothing),
        }
    }
}

impl From<&CurveError> for Refused {
    fn from(error: &CurveError) -> Self {
        match *error {
            CurveError::Input(ref error) => Self::from(error),
            CurveError::Domain { index, value, .. } => Self::new("parameters", [index], value),
            CurveError::Mismatch { point, distance, .. } => Self::new("points", [point], distance),
            CurveError::Dimension { curve, .. } => Self::new("curve", [], curve),
            CurveError::Jump { distance, .. } => Self::new("curve", [], distance),
            _ => Self::new("curve", [], Value::Nothing),
        }
    }
}

impl From<&MonotoneError> for Refused {
    fn from(error: &MonotoneError) -> Self {
        match *error {
            MonotoneError::NotFinite { argument, index, value }
            | MonotoneError::OutOfRange { argument, index, value, .. }
            | MonotoneError::Shape { argument, index, value } => {
                Self::new(argument, [index], value)
            }
            MonotoneError::Slope { index, value, .. } => Self::new("slopes", [index], value),
            MonotoneError::HeldSlope { argument, index, value, .. }
            | MonotoneError::Entry { argument, index, value, .. } => {
                Self::new(argument, [index], value)
            }
            MonotoneError::Convex { index, value, .. } => {
                Self::new("convex", [index], i64::from(value))
            }
            MonotoneError::Share { argument, value, .. }
            | MonotoneError::Number { argument, value, .. } => Self::new(argument, [], value),
            MonotoneError::NotIncreasing { index, value, .. } => Self::new("x", [index], value),
            MonotoneError::TooFew { argument, found, .. }
            | MonotoneError::Length { argument, found, .. } => Self::new(argument, [], found),
            MonotoneError::UnknownOption { argument, ref value, .. } => {
                Self::new(argument, [], value.as_str())
            }
            MonotoneError::Residual { value, .. } => Self::new("residual", [], value),
            MonotoneError::Distinct { found } => Self::new("x", [], found),
            MonotoneError::NotThrough { index, distance, .. } => Self::new("y", [index], distance),
            MonotoneError::Jump { x } => Self::new("function", [], x),
            MonotoneError::Domain { from, .. } => Self::new("function", [], from),
            MonotoneError::NotInvertible { index, value } => Self::new("y", [index], value),
            MonotoneError::InRow { row, ref source } => Self::from(&**source).within(row),
            MonotoneError::Offset { index, value, .. } => Self::new("offsets", [index], value),
            _ => Self::new("y", [], Value::Nothing),
        }
    }
}

/// What the caller can do about an error, after a semicolon, or nothing.
fn remedy(error: &InputError) -> &'static str {
    match error {
        InputError::RepeatedPoint { .. } => "; pass repeated='drop' to leave it out",
        InputError::NotIncreasing { argument: "parameters", previous, value, .. }
            if previous == value =>
        {
            "; pass repeated='drop' to leave that point out"
        }
        InputError::NotClosed { .. } => {
            "; pass closed=True where the curve returns to the first point by itself"
        }
        _ => "",
    }
}

/// Unusable input, in the words of the crate that found it, with the remedy where there is one.
pub(crate) fn input_error(error: InputError) -> PyErr {
    Refused::from(&error).raise(format!("{error}{}", remedy(&error)))
}

/// The same for calls without the options that are the remedy.
pub(crate) fn plain_error(error: InputError) -> PyErr {
    Refused::from(&error).raise(error.to_string())
}

/// No curve, in the words of the crate that found it.
pub(crate) fn fit_error(error: FitError) -> PyErr {
    match error {
        FitError::Input(error) => input_error(error),
        other => Refused::from(&other).raise(other.to_string()),
    }
}

/// No curve `k` of many.
pub(crate) fn curve_error(k: usize, error: &FitError) -> PyErr {
    let remedy = if let FitError::Input(error) = error { remedy(error) } else { "" };
    Refused::from(error).within(k).raise(format!("curve {k}: {error}{remedy}"))
}

/// Points and a curve that do not belong together.
pub(crate) fn subject_error(error: CurveError) -> PyErr {
    match error {
        CurveError::Input(error) => input_error(error),
        other => Refused::from(&other).raise(other.to_string()),
    }
}

/// No function, in the words of the crate that found it.
pub(crate) fn monotone_error(error: &MonotoneError) -> PyErr {
    Refused::from(error).raise(error.to_string())
}

/// The search ended early: the exception carries the last curve and the report on it.
pub(crate) fn convergence_error(
    py: Python<'_>,
    message: String,
    curve: Py<PyAny>,
    report: Py<PyAny>,
) -> PyErr {
    raised(py, "ConvergenceError", (message, curve, report))
}
