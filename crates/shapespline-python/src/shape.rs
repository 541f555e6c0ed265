// SPDX-License-Identifier: MIT OR Apache-2.0

//! What the package `shapespline` wraps: checks of any curve, inflection counts, shapes of polygons.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::{IntoPyObjectExt, exceptions::PyRuntimeError, prelude::*, types::PyDict};
use shapespline::{
    criteria::{
        CurveError, INTERPOLATION, InflectionCount, Tolerances, curve_inflections_from,
        curve_inflections_with, polygon_inflections_from, polygon_inflections_with, polygon_shape,
    },
    geometry::{
        self, Boundary, Coordinates, DVec3, DVec4, DataPolygon, Dimension, InputPoints,
        Parametrization, Repeated, normalize,
    },
};

use crate::{
    asked::{Asked, Given},
    constraints,
    error::{Value, input_error, invalid, must, plain_error, subject_error},
    fit::CurveInput,
    input::{Numbers, Points, numbers},
    options::{self, CriteriaNames, Ends, Parameters},
    output::{vector, vectors},
    piecewise::PiecewiseBezier,
    report::{ShapeReport, Subject},
    work::{interruptible, without_gil},
};

/// Directions of the curve at its two ends that differ by a smaller sine close it smoothly.
const SMOOTH: f64 = 1e-6;

/// Return the report on points and a curve through them.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn _check_shape(
    py: Python<'_>,
    points: Points,
    curve: &Bound<'_, PiecewiseBezier>,
    parameters: Option<Parameters>,
    boundary: Option<Ends>,
    #[pyo3(from_py_with = options::closed)] closed: bool,
    #[pyo3(from_py_with = options::repeated)] repeated: Repeated,
    criteria: CriteriaNames,
    #[pyo3(from_py_with = options::optional_resolution)] resolution: Option<f64>,
    #[pyo3(from_py_with = options::optional_coplanarity)] coplanarity: Option<f64>,
    #[pyo3(from_py_with = options::optional_collinearity)] collinearity: Option<f64>,
    #[pyo3(from_py_with = options::optional_tolerance)] tolerance: Option<f64>,
    of_fit: bool,
    corners: Option<&Bound<'_, PyAny>>,
    straight: Vec<usize>,
) -> PyResult<ShapeReport> {
    let asked = Given { criteria, resolution, coplanarity, collinearity, tolerance };
    let asked = Asked::default_of(of_fit).with(asked)?;
    let curve = Arc::clone(&curve.get().curve);
    let Points { points, dimension } = points;
    let special = constraints::Given::new(corners, None, None, false, dimension)?;
    if dimension != curve.dimension() {
        let [points, curve] = [dimension, curve.dimension()].map(Dimension::count);
        return Err(subject_error(CurveError::Dimension { points, curve }));
    }
    let given = boundary.map(|ends| ends.of(dimension, closed)).transpose()?;
    let boundary = if closed { Some(given.unwrap_or(Boundary::Periodic)) } else { given };
    let at_breaks = parameters.is_none();
    let input = InputPoints {
        points,
        dimension,
        // Until the points that stay are known, and the breaks held against them.
        parametrization: parameters.map_or(Parametrization::Uniform, |given| given.0),
        boundary: boundary.unwrap_or(Boundary::ZeroCurvature),
        closed,
        repeated,
    };
    let (mut kept, map) = input.kept().map_err(input_error)?;
    if at_breaks {
        kept.parametrization = breaks_as_parameters(&curve, kept.points.len(), closed)?;
    }
    let (count, map) = (kept.points.len(), Arc::new(map));
    let make = || {
        let polygon = |points: Vec<DVec3>, boundary: Boundary| {
            DataPolygon::with_dimension(points, dimension, &kept.parametrization, boundary)
        };
        let boundary = match boundary {
            Some(boundary) => boundary,
            None => {
                // The parameters first: where the curve closes is asked of it at the first and the last.
                let open = polygon(kept.points.clone(), Boundary::ZeroCurvature)?;
                let closed = closes_smoothly(&curve, &kept.points, open.parameters());
                if closed { Boundary::Periodic } else { Boundary::ZeroCurvature }
            }
        };
        polygon(kept.points.clone(), boundary)
    };
    let polygon = without_gil(py, count, make).map_err(|error| input_error(map.in_input(error)))?;
    let special = special.at_nodes(&polygon, &map).and_then(|special| {
        special.validate(&polygon)?;
        Ok(special)
    });
    let corners = special.map_err(input_error)?.corners;
    // Segments of the input, ascending, that are segments of the polygon.
    let segments: Vec<usize> = (0..polygon.segments()).map(|i| map.segment(i)).collect();
    let own = |segment: &usize| segments.binary_search(segment).ok();
    let straight = straight.iter().filter_map(own).collect();
    let interpolation = INTERPOLATION.max(asked.tolerances.zero);
    let polygon = Arc::new(polygon);
    let subject = Subject::Other { polygon, curve, map, interpolation, corners, straight };
    ShapeReport::make(py, subject, asked)
}

/// The breaks of a curve as the parameters of so many points.
fn breaks_as_parameters(
    curve: &geometry::PiecewiseBezier,
    points: usize,
    closed: bool,
) -> PyResult<Parametrization> {
    let breaks = curve.breaks();
    if breaks.len() == points {
        return Ok(Parametrization::Given(breaks.to_vec()));
    }
    let remedy = if !closed && breaks.len() == points + 1 {
        "; pass closed=True where it returns to the first point"
    } else {
        ""
    };
    let text = format!(
        "parameters must be given: the curve has {} breaks, but there are {points} points{remedy}",
        breaks.len(),
    );
    Err(invalid("parameters", &[], Value::Nothing, text))
}

/// Whether the last point is the first, and the curve goes on there in the direction it began with.
fn closes_smoothly(curve: &geometry::PiecewiseBezier, points: &[DVec3], u: &[f64]) -> bool {
    let n = points.len() - 1;
    if n < 2 || !geometry::ends_agree(points) {
        return false;
    }
    let begins = curve.between([u[0], u[1]], points[0]);
    let ends = curve.between([u[n - 1], u[n]], points[n]);
    let (Some(first), Some(last)) = (begins.first(), ends.last()) else { return false };
    let chord = |i: usize| geometry::length(points[i + 1] - points[i]);
    let start = direction(first.control.iter(), chord(0));
    let end = -direction(last.control.iter().rev(), chord(n - 1));
    start.dot(end) > 0.0 && start.cross(end).length() <= SMOOTH
}

/// Unit vector to the first control point that is not the end itself.
fn direction<'a>(mut control: impl Iterator<Item = &'a DVec4>, chord: f64) -> DVec3 {
    let place = |p: &DVec4| p.truncate() / p.w;
    let Some(start) = control.next().map(place) else { return DVec3::ZERO };
    let legs = control.map(|p| place(p) - start);
    let leg = legs.into_iter().find(|leg| geometry::length(*leg) > 1e-12 * chord);
    leg.map_or(DVec3::ZERO, normalize)
}

/// The size of work that is spread over all threads however few its points.
const ALL: usize = usize::MAX;

/// `direction`: a vector in space, or `None`.
fn view(object: &Bound<'_, PyAny>) -> PyResult<Option<DVec3>> {
    if object.is_none() {
        return Ok(None);
    }
    let given = match numbers("direction", object)? {
        Numbers::Many(v) if v.len() == 3 => DVec3::from_slice(&v),
        Numbers::Many(v) => {
            return Err(must("direction", &[], "have 3 components", v.len()));
        }
        Numbers::One(value) => {
            return Err(must("direction", &[], "be a vector of 3 components", value));
        }
    };
    if let Some(i) = given.to_array().iter().position(|x| !x.is_finite()) {
        return Err(must("direction", &[i], "be finite", given.to_array()[i]));
    }
    if given == DVec3::ZERO {
        let value = Coordinates { vector: given, dimension: Dimension::Three };
        return Err(invalid("direction", &[], value, "direction must not be the zero vector"));
    }
    Ok(Some(given))
}

/// Count, direction, whether it is certain.
type Counted<'py> = (usize, Bound<'py, PyAny>, bool);

fn counted(py: Python<'_>, count: InflectionCount) -> Counted<'_> {
    (count.count, vector(py, count.direction, 3).into_any(), count.exact)
}

#[pyfunction]
pub(crate) fn _polygon_inflections<'py>(
    py: Python<'py>,
    points: Points,
    #[pyo3(from_py_with = view)] direction: Option<DVec3>,
) -> PyResult<Counted<'py>> {
    let Points { points, dimension } = points;
    let count = match direction {
        Some(direction) => without_gil(py, points.len(), || {
            polygon_inflections_from(&points, dimension, direction).map(Some)
        }),
        None => {
            interruptible(py, ALL, |go_on| polygon_inflections_with(&points, dimension, go_on))?
        }
    };
    finished(py, count.map_err(plain_error)?)
}

#[pyfunction]
pub(crate) fn _curve_inflections<'py>(
    py: Python<'py>,
    curve: &Bound<'py, PiecewiseBezier>,
    #[pyo3(from_py_with = view)] direction: Option<DVec3>,
) -> PyResult<Counted<'py>> {
    let curve = &curve.get().curve;
    let count = match direction {
        Some(direction) => {
            without_gil(py, curve.pieces(), || curve_inflections_from(curve, direction).map(Some))
        }
        None => interruptible(py, ALL, |go_on| Ok(curve_inflections_with(curve, go_on)))?,
    };
    finished(py, count.map_err(plain_error)?)
}

/// A count that was broken off came with an exception, which is raised before this.
fn finished(py: Python<'_>, count: Option<InflectionCount>) -> PyResult<Counted<'_>> {
    let broken_off = || PyRuntimeError::new_err("the count was broken off");
    count.map(|count| counted(py, count)).ok_or_else(broken_off)
}

/// Return the discrete shape of points, by the names of its parts.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn _polygon_shape<'py>(
    py: Python<'py>,
    points: Points,
    parameters: Parameters,
    boundary: Option<Ends>,
    #[pyo3(from_py_with = options::closed)] closed: bool,
    #[pyo3(from_py_with = options::repeated)] repeated: Repeated,
    #[pyo3(from_py_with = options::resolution)] resolution: f64,
    #[pyo3(from_py_with = options::tolerance)] tolerance: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let CurveInput(input) =
        CurveInput::new(points, parameters, boundary.unwrap_or(Ends::Default), closed, repeated)?;
    let tolerances = Tolerances { zero: tolerance, resolution, ..Tolerances::default() };
    let tolerances = tolerances.validate().map_err(input_error)?;
    let dimension = input.dimension;
    let made = without_gil(py, input.points.len(), || {
        let (polygon, map) = input.polygon()?;
        Ok((polygon_shape(&polygon, &tolerances), polygon, map))
    });
    let (shape, polygon, map) = made.map_err(input_error)?;
    let calls = shape.required.iter().map(|criteria| criteria.iter().map(|c| c.name()).collect());
    let calls: Vec<Vec<&str>> = calls.collect();
    let floats = |values| PyArray1::from_vec(py, values);
    let parts = PyDict::new(py);
    parts.set_item("points", vectors(py, &map.points(polygon.points()), dimension)?)?;
    parts.set_item("parameters", floats(map.spread(polygon.parameters())))?;
    parts.set_item("extent", shape.affine_dimension.name())?;
    let chords = map.spread_segments(&shape.chords, &DVec3::ZERO);
    parts.set_item("chords", vectors(py, &chords, dimension)?)?;
    let binormals = map.spread(&shape.binormals);
    parts.set_item("binormals", vectors(py, &binormals, Dimension::Three)?)?;
    parts.set_item("turning_angles", floats(map.spread(&shape.turning_angles)))?;
    parts.set_item("torsion", floats(map.spread_segments(&shape.torsion, &f64::NAN)))?;
    parts.set_item("calls", map.spread_segments(&calls, &Vec::new()).into_bound_py_any(py)?)?;
    Ok(parts)
}
