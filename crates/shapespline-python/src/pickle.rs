// SPDX-License-Identifier: MIT OR Apache-2.0

//! Pickles: kind, version, what is pickled in postcard's form, and a checksum. Floats keep every bit.

use std::sync::Arc;

use pyo3::{IntoPyObjectExt, PyClass, prelude::*, types::PyBytes};
use serde::{Serialize, de::DeserializeOwned};
use shapespline::geometry::{
    self, Boundary, DVec3, DVec4, DataPolygon, Dimension, InputMap, Parametrization, Repeated,
};
use shapespline::prelude::{CatmullRom, FairSpline, NuSpline, TensionSpline};

use crate::{
    curve::{Family, Fitted, SpaceCurve},
    diagnostics::{Diagnostics, Search, SearchStep},
    error::{Value, invalid},
    fair_diagnostics::{FairDiagnostics, FairStep},
    fairness::Fairness,
    monotone::{
        Fits, Layout, MonotoneDiagnostics, MonotoneRecord, MonotoneReport, MonotoneSmoothing,
        PiecewisePolynomial, PiecewiseRows,
    },
    own,
    piecewise::PiecewiseBezier,
    report::{NodeRecord, OscillationRecord, ShapeRecord, ShapeReport, Subject, UndecidedRecord},
    tangents::Tangents,
    work::without_gil,
};

/// Raised whenever the layout changes; bytes of other versions are refused, not guessed at.
const VERSION: u8 = 12;

/// Length of the checksum, a CRC-32 of everything before it.
const CHECKSUM: usize = 4;

/// What a pickle holds, by the number in its first byte: append only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PickledKind {
    Curve,
    Report,
    PiecewiseBezier,
    Function,
    Rows,
    Tangents,
    ShapeRecord,
    Diagnostics,
    SearchStep,
    MonotoneDiagnostics,
    Fairness,
    FairDiagnostics,
    FairStep,
    MonotoneSmoothing,
    UndecidedRecord,
    NodeRecord,
    OscillationRecord,
    MonotoneRecord,
    MonotoneReport,
}

impl PickledKind {
    const ALL: [(Self, &'static str); 19] = [
        (Self::Curve, "a curve"),
        (Self::Report, "a ShapeReport"),
        (Self::PiecewiseBezier, "a PiecewiseBezier"),
        (Self::Function, "a function"),
        (Self::Rows, "functions of many rows"),
        (Self::Tangents, "Tangents"),
        (Self::ShapeRecord, "a ShapeRecord"),
        (Self::Diagnostics, "Diagnostics"),
        (Self::SearchStep, "a SearchStep"),
        (Self::MonotoneDiagnostics, "MonotoneDiagnostics"),
        (Self::Fairness, "Fairness"),
        (Self::FairDiagnostics, "FairDiagnostics"),
        (Self::FairStep, "a FairStep"),
        (Self::MonotoneSmoothing, "a MonotoneSmoothing"),
        (Self::UndecidedRecord, "an UndecidedRecord"),
        (Self::NodeRecord, "a NodeRecord"),
        (Self::OscillationRecord, "an OscillationRecord"),
        (Self::MonotoneRecord, "a MonotoneRecord"),
        (Self::MonotoneReport, "a MonotoneReport"),
    ];
}

fn refused(text: String) -> PyErr {
    invalid("data", &[], Value::Nothing, text)
}

fn damaged(what: impl std::fmt::Display) -> PyErr {
    refused(format!("the pickle is damaged: {what}"))
}

/// What `__reduce__` returns: the function that makes the object again, and the bytes it takes.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyBytes>,));

/// The pickle of an object, whose parts `write` appends in postcard's form.
pub(crate) fn reduce<'py>(
    py: Python<'py>,
    kind: PickledKind,
    write: impl FnOnce(Vec<u8>) -> Result<Vec<u8>, postcard::Error> + Send,
) -> PyResult<Reduced<'py>> {
    let make = own(py, "_from_bytes")?;
    let sealed = || {
        let mut bytes = write(vec![kind as u8, VERSION])?;
        let checksum = crc32fast::hash(&bytes);
        bytes.extend_from_slice(&checksum.to_le_bytes());
        Ok(bytes)
    };
    let bytes = without_gil(py, 0, sealed).map_err(|error: postcard::Error| {
        refused(format!("the object cannot be pickled: {error}"))
    })?;
    Ok((make, (PyBytes::new(py, &bytes),)))
}

/// The pickle of an object that serde knows as a whole.
pub(crate) fn reduce_whole<'py, C>(
    object: &Bound<'py, C>,
    kind: PickledKind,
) -> PyResult<Reduced<'py>>
where
    C: PyClass<Frozen = pyo3::pyclass::boolean_struct::True> + Serialize + Sync,
{
    let whole = object.get();
    reduce(object.py(), kind, |bytes| postcard::to_extend(whole, bytes))
}

/// Kind and parts of a pickle that is whole.
fn opened(data: &[u8]) -> PyResult<(PickledKind, &[u8])> {
    let Some((kind, name)) =
        data.first().and_then(|&k| PickledKind::ALL.get(usize::from(k)).copied())
    else {
        return Err(refused("these bytes are no pickle of shapespline".to_owned()));
    };
    if let Some(version) = data.get(1).filter(|version| **version != VERSION) {
        return Err(refused(format!(
            "the pickle of {name} is of version {version}, this shapespline reads version {VERSION}"
        )));
    }
    match data.split_last_chunk::<CHECKSUM>() {
        Some((sealed, checksum)) if crc32fast::hash(sealed).to_le_bytes() == *checksum => {
            Ok((kind, sealed.get(2..).unwrap_or_default()))
        }
        _ => Err(refused(format!(
            "the pickle of {name} is damaged: its checksum does not match its {} bytes",
            data.len()
        ))),
    }
}

fn take<T: DeserializeOwned>(bytes: &mut &[u8]) -> PyResult<T> {
    let (value, rest) = postcard::take_from_bytes(bytes).map_err(damaged)?;
    *bytes = rest;
    Ok(value)
}

fn whole<T: DeserializeOwned>(mut bytes: &[u8]) -> PyResult<T> {
    let value = take(&mut bytes)?;
    if bytes.is_empty() { Ok(value) } else { Err(damaged("it goes on behind its end")) }
}

/// Make the object of a pickle.
#[pyfunction]
pub(crate) fn _from_bytes<'py>(py: Python<'py>, data: &[u8]) -> PyResult<Bound<'py, PyAny>> {
    let (kind, mut bytes) = without_gil(py, 0, || opened(data))?;
    let size = bytes.len();
    match kind {
        PickledKind::Curve => {
            let (curve, search) = without_gil(py, size, || read_curve(&mut bytes))?;
            Ok(SpaceCurve::of(curve, search).into_python(py)?.into_bound(py))
        }
        PickledKind::Report => {
            let subject = without_gil(py, size, || read_subject(&mut bytes))?;
            let (report, asked) = whole(bytes)?;
            ShapeReport::of(report, subject, asked).into_bound_py_any(py)
        }
        PickledKind::PiecewiseBezier => {
            let curve = without_gil(py, size, || assemble(whole(bytes)?))?;
            PiecewiseBezier::of(curve).into_bound_py_any(py)
        }
        PickledKind::Function => {
            let (layout, fits): (Layout, Fits) = without_gil(py, size, || whole(bytes))?;
            if !(fits.is_sound() && fits.agree() && layout.is_of(fits.len())) {
                return Err(damaged("lengths do not agree"));
            }
            let function = PiecewisePolynomial::of(fits, &Arc::new(layout));
            Ok(function.into_python(py)?.into_bound(py))
        }
        PickledKind::Rows => {
            let (ragged, fits): (bool, Fits) = without_gil(py, size, || whole(bytes))?;
            if !(fits.is_sound() && (ragged || fits.agree())) {
                return Err(damaged("lengths do not agree"));
            }
            Ok(PiecewiseRows::of(fits, ragged).into_python(py)?.into_bound(py))
        }
        PickledKind::Tangents => whole::<Tangents>(bytes)?.into_bound_py_any(py),
        PickledKind::ShapeRecord => whole::<ShapeRecord>(bytes)?.into_bound_py_any(py),
        PickledKind::Diagnostics => whole::<Diagnostics>(bytes)?.into_bound_py_any(py),
        PickledKind::SearchStep => whole::<SearchStep>(bytes)?.into_bound_py_any(py),
        PickledKind::MonotoneDiagnostics => {
            whole::<MonotoneDiagnostics>(bytes)?.into_bound_py_any(py)
        }
        PickledKind::Fairness => whole::<Fairness>(bytes)?.into_bound_py_any(py),
        PickledKind::FairDiagnostics => whole::<FairDiagnostics>(bytes)?.into_bound_py_any(py),
        PickledKind::FairStep => whole::<FairStep>(bytes)?.into_bound_py_any(py),
        PickledKind::MonotoneSmoothing => whole::<MonotoneSmoothing>(bytes)?.into_bound_py_any(py),
        PickledKind::UndecidedRecord => whole::<UndecidedRecord>(bytes)?.into_bound_py_any(py),
        PickledKind::NodeRecord => whole::<NodeRecord>(bytes)?.into_bound_py_any(py),
        PickledKind::OscillationRecord => whole::<OscillationRecord>(bytes)?.into_bound_py_any(py),
        PickledKind::MonotoneRecord => whole::<MonotoneRecord>(bytes)?.into_bound_py_any(py),
        PickledKind::MonotoneReport => whole::<MonotoneReport>(bytes)?.into_bound_py_any(py),
    }
}

/// Appends a curve, and how it was found.
pub(crate) fn write_curve(
    curve: &Fitted,
    search: Option<&Search>,
    bytes: Vec<u8>,
) -> Result<Vec<u8>, postcard::Error> {
    let beside = (curve.family(), search, &curve.map, curve.repeated);
    curve.write(postcard::to_extend(&beside, bytes)?)
}

fn read_curve(bytes: &mut &[u8]) -> PyResult<(Arc<Fitted>, Option<Search>)> {
    type Beside = (Family, Option<Search>, InputMap, Repeated);
    let (family, search, map, repeated): Beside = take(bytes)?;
    let curve = match family {
        Family::Nu => Fitted::new(take::<NuSpline>(bytes)?, map, repeated),
        Family::Tension => Fitted::new(take::<TensionSpline>(bytes)?, map, repeated),
        Family::CatmullRom => Fitted::new(take::<CatmullRom>(bytes)?, map, repeated),
        Family::Fair => Fitted::new(take::<FairSpline>(bytes)?, map, repeated),
    };
    // What no constructor makes would panic later.
    let points = curve.cubic().points().len();
    let tension = if family == Family::Fair { points } else { curve.tension().len() };
    let lengths = [curve.cubic().knots().len(), curve.cubic().segments() + 1, tension];
    let agree = lengths.iter().all(|&length| length == points) && curve.map.fits(curve.count());
    if points < 2 || !agree || !curve.is_sound() {
        return Err(damaged("lengths do not agree"));
    }
    Ok((Arc::new(curve), search))
}

/// Appends a report, and the curve that it is about.
pub(crate) fn write_report(
    report: &ShapeReport,
    bytes: Vec<u8>,
) -> Result<Vec<u8>, postcard::Error> {
    let own = matches!(report.subject, Subject::Own(_));
    let bytes = postcard::to_extend(&own, bytes)?;
    let bytes = match &report.subject {
        Subject::Own(curve) => write_curve(curve, None, bytes)?,
        Subject::Other { polygon, curve, map, interpolation, corners, straight } => {
            let polygon =
                (polygon.points(), polygon.parameters(), polygon.boundary(), polygon.dimension());
            let special = (corners, straight);
            let other = (polygon, parts(curve), map.as_ref(), interpolation, special);
            postcard::to_extend(&other, bytes)?
        }
    };
    postcard::to_extend(&(&report.report, report.asked), bytes)
}

fn read_subject(bytes: &mut &[u8]) -> PyResult<Subject> {
    if take(bytes)? {
        return Ok(Subject::Own(read_curve(bytes)?.0));
    }
    type Polygon = (Vec<DVec3>, Vec<f64>, Boundary, Dimension);
    type Special = (Vec<usize>, Vec<usize>);
    let (polygon, curve, map, interpolation, (corners, straight)): (
        Polygon,
        Parts,
        InputMap,
        f64,
        Special,
    ) = take(bytes)?;
    let (points, parameters, boundary, dimension) = polygon;
    let parameters = Parametrization::Given(parameters);
    let polygon = DataPolygon::with_dimension(points, dimension, &parameters, boundary);
    let polygon = Arc::new(polygon.map_err(damaged)?);
    let beyond = |k: &usize| *k >= polygon.segments();
    if !map.fits(polygon.points().len()) || corners.iter().chain(&straight).any(beyond) {
        return Err(damaged("lengths do not agree"));
    }
    let (curve, map) = (Arc::new(assemble(curve)?), Arc::new(map));
    Ok(Subject::Other { polygon, curve, map, interpolation, corners, straight })
}

/// A piecewise Bézier curve: breaks, homogeneous control points, degree, rational, dimension.
type Parts = (Vec<f64>, Vec<DVec4>, usize, bool, Dimension);

fn parts(curve: &geometry::PiecewiseBezier) -> Parts {
    let control = (0..curve.pieces()).flat_map(|i| curve.piece(i)).copied().collect();
    let breaks = curve.breaks().to_vec();
    (breaks, control, curve.degree(), curve.is_rational(), curve.dimension())
}

fn assemble(parts: Parts) -> PyResult<geometry::PiecewiseBezier> {
    let (breaks, control, degree, rational, dimension) = parts;
    geometry::PiecewiseBezier::homogeneous(breaks, control, degree, dimension, rational)
        .map_err(damaged)
}

/// Appends a piecewise Bézier curve.
pub(crate) fn write_piecewise(
    curve: &geometry::PiecewiseBezier,
    bytes: Vec<u8>,
) -> Result<Vec<u8>, postcard::Error> {
    postcard::to_extend(&parts(curve), bytes)
}
