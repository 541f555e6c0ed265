//! Bytes for pickles: a version, then what is pickled in postcard's form. Floats keep every bit.

use std::sync::Arc;

use pyo3::{exceptions::PyValueError, prelude::*};
use serde::{Serialize, de::DeserializeOwned};
use shapespline::prelude::{CatmullRom, NuSpline, TensionSpline};

use crate::{
    curve::{Curve, Family, SpaceCurve},
    diagnostics::Search,
    report::ShapeReport,
};

/// Raised whenever the layout changes; bytes of other versions are refused, not guessed at.
const VERSION: u8 = 1;

fn damaged(what: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(format!("these bytes hold no curve of this version: {what}"))
}

fn put<T: Serialize + ?Sized>(bytes: Vec<u8>, value: &T) -> PyResult<Vec<u8>> {
    postcard::to_extend(value, bytes).map_err(damaged)
}

fn take<T: DeserializeOwned>(bytes: &mut &[u8]) -> PyResult<T> {
    let (value, rest) = postcard::take_from_bytes(bytes).map_err(damaged)?;
    *bytes = rest;
    Ok(value)
}

/// A curve, and how it was found, as bytes.
pub(crate) fn write_curve(curve: &dyn Curve, search: Option<&Search>) -> PyResult<Vec<u8>> {
    let bytes = put(vec![VERSION], &(curve.family(), search))?;
    curve.write(bytes).map_err(damaged)
}

fn read_curve(bytes: &mut &[u8]) -> PyResult<(Arc<dyn Curve>, Option<Search>)> {
    match bytes.split_first() {
        Some((&VERSION, rest)) => *bytes = rest,
        Some((version, _)) => return Err(damaged(format!("version {version}"))),
        None => return Err(damaged("they are empty")),
    }
    let (family, search): (Family, Option<Search>) = take(bytes)?;
    let curve: Arc<dyn Curve> = match family {
        Family::Nu => Arc::new(take::<NuSpline>(bytes)?),
        Family::Tension => Arc::new(take::<TensionSpline>(bytes)?),
        Family::CatmullRom => Arc::new(take::<CatmullRom>(bytes)?),
    };
    // What no constructor makes would panic later.
    let points = curve.cubic().points().len();
    let lengths =
        [curve.cubic().knots().len(), curve.cubic().segments() + 1, curve.tension().len()];
    if points < 2 || lengths.iter().any(|&length| length != points) || !curve.is_sound() {
        return Err(damaged("lengths do not agree"));
    }
    Ok((curve, search))
}

/// A report, and the curve that it is about, as bytes.
pub(crate) fn write_report(report: &ShapeReport) -> PyResult<Vec<u8>> {
    let bytes = write_curve(report.curve.as_ref(), None)?;
    put(bytes, &(&report.report, report.criteria, report.tolerances))
}

/// The curve of a pickle.
#[pyfunction]
pub(crate) fn _curve_from_bytes(py: Python<'_>, mut data: &[u8]) -> PyResult<Py<PyAny>> {
    let (curve, search) = read_curve(&mut data)?;
    SpaceCurve::of(curve, search).into_python(py)
}

/// The report of a pickle.
#[pyfunction]
pub(crate) fn _report_from_bytes(mut data: &[u8]) -> PyResult<ShapeReport> {
    let (curve, _) = read_curve(&mut data)?;
    let (report, criteria, tolerances) = take(&mut data)?;
    Ok(ShapeReport::of(report, curve, criteria, tolerances))
}
