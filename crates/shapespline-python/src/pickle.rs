//! Bytes for pickles: a version, then what is pickled in postcard's form. Floats keep every bit.

use std::sync::Arc;

use pyo3::{exceptions::PyValueError, prelude::*};
use serde::{Serialize, de::DeserializeOwned};
use shapespline::geometry::{
    Boundary, DVec3, DVec4, DataPolygon, Dimension, Parametrization, PiecewiseBezier,
};
use shapespline::prelude::{CatmullRom, NuSpline, TensionSpline};

use crate::{
    curve::{Curve, Family, SpaceCurve},
    diagnostics::Search,
    report::{ShapeReport, Subject},
    work::detached,
};

/// Raised whenever the layout changes; bytes of other versions are refused, not guessed at.
const VERSION: u8 = 2;

/// What a report is about.
const OWN: u8 = 0;
const OTHER: u8 = 1;

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

fn read_version(bytes: &mut &[u8]) -> PyResult<()> {
    match bytes.split_first() {
        Some((&VERSION, rest)) => *bytes = rest,
        Some((version, _)) => return Err(damaged(format!("version {version}"))),
        None => return Err(damaged("they are empty")),
    }
    Ok(())
}

fn read_curve(bytes: &mut &[u8]) -> PyResult<(Arc<dyn Curve>, Option<Search>)> {
    read_version(bytes)?;
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
    let bytes = match &report.subject {
        Subject::Own(curve) => {
            let mut bytes = vec![OWN];
            bytes.extend(write_curve(curve.as_ref(), None)?);
            bytes
        }
        Subject::Other { polygon, curve, interpolation } => {
            let polygon =
                (polygon.points(), polygon.parameters(), polygon.boundary(), polygon.dimension());
            put(vec![OTHER, VERSION], &(polygon, parts(curve), interpolation))?
        }
    };
    put(bytes, &(&report.report, report.criteria, report.tolerances))
}

fn read_subject(bytes: &mut &[u8]) -> PyResult<Subject> {
    let kind = bytes.split_first();
    match kind {
        Some((&OWN, rest)) => {
            *bytes = rest;
            Ok(Subject::Own(read_curve(bytes)?.0))
        }
        Some((&OTHER, rest)) => {
            *bytes = rest;
            read_version(bytes)?;
            type Polygon = (Vec<DVec3>, Vec<f64>, Boundary, Dimension);
            let (polygon, curve, interpolation): (Polygon, Parts, f64) = take(bytes)?;
            let (points, parameters, boundary, dimension) = polygon;
            let parameters = Parametrization::Given(parameters);
            let polygon = DataPolygon::with_dimension(points, dimension, &parameters, boundary);
            let polygon = Arc::new(polygon.map_err(damaged)?);
            Ok(Subject::Other { polygon, curve: Arc::new(assemble(curve)?), interpolation })
        }
        _ => Err(damaged("they are of no known kind")),
    }
}

/// A piecewise Bézier curve: breaks, homogeneous control points, degree, rational, dimension.
type Parts = (Vec<f64>, Vec<DVec4>, usize, bool, Dimension);

fn parts(curve: &PiecewiseBezier) -> Parts {
    let control = (0..curve.pieces()).flat_map(|i| curve.piece(i)).copied().collect();
    let breaks = curve.breaks().to_vec();
    (breaks, control, curve.degree(), curve.is_rational(), curve.dimension())
}

fn assemble((breaks, control, degree, rational, dimension): Parts) -> PyResult<PiecewiseBezier> {
    PiecewiseBezier::homogeneous(breaks, control, degree, dimension, rational).map_err(damaged)
}

/// A piecewise Bézier curve as bytes.
pub(crate) fn write_piecewise(curve: &PiecewiseBezier) -> PyResult<Vec<u8>> {
    put(vec![VERSION], &parts(curve))
}

/// The piecewise Bézier curve of a pickle.
#[pyfunction]
pub(crate) fn _piecewise_from_bytes(
    mut data: &[u8],
) -> PyResult<crate::piecewise::PiecewiseBezier> {
    read_version(&mut data)?;
    assemble(take(&mut data)?).map(crate::piecewise::PiecewiseBezier::of)
}

/// The curve of a pickle.
#[pyfunction]
pub(crate) fn _curve_from_bytes(py: Python<'_>, mut data: &[u8]) -> PyResult<Py<PyAny>> {
    let (curve, search) = detached(py, data.len(), || read_curve(&mut data))?;
    SpaceCurve::of(curve, search).into_python(py)
}

/// The report of a pickle.
#[pyfunction]
pub(crate) fn _report_from_bytes(py: Python<'_>, mut data: &[u8]) -> PyResult<ShapeReport> {
    let subject = detached(py, data.len(), || read_subject(&mut data))?;
    let (report, criteria, tolerances) = take(&mut data)?;
    Ok(ShapeReport::of(report, subject, criteria, tolerances))
}
