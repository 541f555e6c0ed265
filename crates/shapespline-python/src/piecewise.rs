// SPDX-License-Identifier: MIT OR Apache-2.0

//! `PiecewiseBezier`: a curve made elsewhere, as its Bézier pieces.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::{prelude::*, types::PyType};
use shapespline::geometry::{self, DVec3, Dimension};

use crate::{
    error::{input_error, must, tuple},
    input::{Array, Query, array, finite},
    options,
    output::{FloatArray, shaped, vector, zeros},
    pickle::{self, PickledKind, Reduced},
};

/// A curve of any degree, polynomial or rational, given by the Bézier points of its pieces.
///
/// The form in which `check_shape` and `inflection_count` take curves that were not made here: SciPy's
/// are converted to it, and NURBS enter by it, with their weights.
///
/// Parameters
/// ----------
/// control : array_like, shape (pieces, degree + 1, dim)
///     Bézier points of each piece, in the plane or in space; degree from 1 to 18.
/// breaks : array_like, shape (pieces + 1,)
///     Strictly increasing parameters: piece i is run through linearly from ``breaks[i]`` to
///     ``breaks[i + 1]``.
/// weights : array_like, shape (pieces, degree + 1), optional
///     Positive weights of the Bézier points: the curve is rational.
///
/// Raises
/// ------
/// ValueError
///     If shapes do not belong together, breaks do not increase, a number is not finite or a weight
///     not positive.
/// TypeError
///     If an argument does not hold real numbers.
///
/// See Also
/// --------
/// check_shape : does the curve keep the shape of points?
///
/// Notes
/// -----
/// Nothing is asked of how pieces meet. Objects are immutable and picklable.
///
/// Examples
/// --------
/// A quarter of a circle, as a rational parabola:
///
/// >>> import numpy as np
/// >>> import shapespline as ss
/// >>> arc = ss.PiecewiseBezier([[[1, 0], [1, 1], [0, 1]]], [0, 1], weights=[[1, 0.5**0.5, 1]])
/// >>> arc
/// <PiecewiseBezier: 1 rational piece of degree 2 in the plane, u from 0 to 1>
/// >>> bool(np.allclose(np.hypot(*arc(np.linspace(0, 1, 9)).T), 1))
/// True
#[pyclass(module = "shapespline", frozen, weakref)]
pub(crate) struct PiecewiseBezier {
    pub(crate) curve: Arc<geometry::PiecewiseBezier>,
}

/// Rows of 2 or 3 coordinates as vectors.
pub(crate) fn rows(values: &[f64], columns: usize) -> Vec<DVec3> {
    values.chunks_exact(columns).map(row).collect()
}

/// A point of two or three coordinates.
#[inline]
fn row(p: &[f64]) -> DVec3 {
    DVec3::new(p[0], p[1], if p.len() == 3 { p[2] } else { 0.0 })
}

fn dimension(argument: &str, given: &Array<'_>, columns: usize) -> PyResult<Dimension> {
    match columns {
        2 => Ok(Dimension::Two),
        3 => Ok(Dimension::Three),
        _ => {
            let rule = "hold points of 2 or 3 coordinates along its last axis";
            Err(must(argument, &[], rule, given.shape()))
        }
    }
}

/// An array with as many axes as there are words for them.
fn with_axes<'py>(
    argument: &str,
    object: &Bound<'py, PyAny>,
    axes: &[&str],
) -> PyResult<Array<'py>> {
    let array = array(argument, object)?;
    if array.shape().len() != axes.len() {
        let end = if axes.len() == 1 { "," } else { "" };
        let rule = format!("have shape ({}{end})", axes.join(", "));
        return Err(must(argument, &[], rule, array.shape()));
    }
    finite(argument, &array)?;
    Ok(array)
}

fn weights_of(object: Option<&Bound<'_, PyAny>>, shape: &[usize]) -> PyResult<Option<Vec<f64>>> {
    let Some(object) = object.filter(|o| !o.is_none()) else { return Ok(None) };
    let weights = array("weights", object)?;
    if weights.shape() != shape {
        let rule = format!("have shape {}, one for each control point", tuple(shape));
        return Err(must("weights", &[], rule, weights.shape()));
    }
    Ok(Some(weights.values().to_vec()))
}

impl PiecewiseBezier {
    pub(crate) fn of(curve: geometry::PiecewiseBezier) -> Self {
        Self { curve: Arc::new(curve) }
    }

    fn columns(&self) -> usize {
        self.curve.dimension().count()
    }
}

#[pymethods]
impl PiecewiseBezier {
    #[new]
    #[pyo3(signature = (control, breaks, *, weights=None))]
    fn new(
        control: &Bound<'_, PyAny>,
        breaks: &Bound<'_, PyAny>,
        weights: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let control = with_axes("control", control, &["pieces", "degree + 1", "dim"])?;
        let breaks = with_axes("breaks", breaks, &["pieces + 1"])?.values().to_vec();
        let [pieces, order, columns] = [0, 1, 2].map(|axis| control.shape()[axis]);
        let dimension = dimension("control", &control, columns)?;
        if breaks.len() != pieces + 1 {
            let rule = format!("have length {} (one more than control has pieces)", pieces + 1);
            return Err(must("breaks", &[], rule, breaks.len()));
        }
        let points = rows(control.values(), columns);
        let degree = order.saturating_sub(1);
        let curve = match weights_of(weights, &[pieces, order])? {
            None => geometry::PiecewiseBezier::new(breaks, &points, degree, dimension),
            Some(w) => geometry::PiecewiseBezier::rational(breaks, &points, &w, degree, dimension),
        };
        curve.map(Self::of).map_err(input_error)
    }

    /// Make the curve of a B-spline, or of a NURBS curve, on its base interval.
    ///
    /// Parameters
    /// ----------
    /// knots : array_like, shape (n + degree + 1,)
    ///     Knots that do not decrease.
    /// control : array_like, shape (n, dim)
    ///     Control points.
    /// degree : int
    ///     From 1 to 18.
    /// weights : array_like, shape (n,), optional
    ///     Positive weights of the control points (NURBS).
    ///
    /// Returns
    /// -------
    /// PiecewiseBezier
    ///     From ``knots[degree]`` to ``knots[n]``, taken apart by Boehm's knot insertion.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If lengths do not belong together, knots decrease, a number is not finite or a weight not
    ///     positive.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> knots, control = [0, 0, 0, 1, 2, 2, 2], [[0, 0], [1, 2], [3, 2], [4, 0]]
    /// >>> ss.PiecewiseBezier.from_bspline(knots, control, 2, weights=[1, 2, 2, 1])
    /// <PiecewiseBezier: 2 rational pieces of degree 2 in the plane, u from 0 to 2>
    #[classmethod]
    #[pyo3(signature = (knots, control, degree, *, weights=None))]
    fn from_bspline(
        _class: &Bound<'_, PyType>,
        knots: &Bound<'_, PyAny>,
        control: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = options::degree)] degree: usize,
        weights: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let knots = with_axes("knots", knots, &["n + degree + 1"])?;
        let control = with_axes("control", control, &["n", "dim"])?;
        let [count, columns] = [0, 1].map(|axis| control.shape()[axis]);
        let dimension = dimension("control", &control, columns)?;
        let (knots, points) = (knots.values(), rows(control.values(), columns));
        let curve = match weights_of(weights, &[count])? {
            None => geometry::PiecewiseBezier::from_bspline(knots, &points, degree, dimension),
            Some(w) => geometry::PiecewiseBezier::from_nurbs(knots, &points, &w, degree, dimension),
        };
        curve.map(Self::of).map_err(input_error)
    }

    /// Make the curve of a piecewise polynomial in powers, as SciPy's ``PPoly`` holds it.
    ///
    /// Parameters
    /// ----------
    /// coefficients : array_like, shape (degree + 1, pieces, dim)
    ///     Highest power first: piece i is the sum of ``coefficients[k, i] * (u - breaks[i])**(degree
    ///     - k)``.
    /// breaks : array_like, shape (pieces + 1,)
    ///     Strictly increasing parameters.
    ///
    /// Returns
    /// -------
    /// PiecewiseBezier
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If shapes do not belong together, breaks do not increase or a number is not finite.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> line = ss.PiecewiseBezier.from_power([[[1, 2]], [[3, 4]]], [0, 2])
    /// >>> line.control
    /// array([[[3., 4.],
    ///         [5., 8.]]])
    #[classmethod]
    fn from_power(
        _class: &Bound<'_, PyType>,
        py: Python<'_>,
        coefficients: &Bound<'_, PyAny>,
        breaks: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let axes = ["degree + 1", "pieces", "dim"];
        let coefficients = with_axes("coefficients", coefficients, &axes)?;
        let breaks = with_axes("breaks", breaks, &["pieces + 1"])?.values().to_vec();
        let [order, pieces, columns] = [0, 1, 2].map(|axis| coefficients.shape()[axis]);
        let dimension = dimension("coefficients", &coefficients, columns)?;
        if breaks.len() != pieces + 1 {
            let rule =
                format!("have length {} (one more than coefficients has pieces)", pieces + 1);
            return Err(must("breaks", &[], rule, breaks.len()));
        }
        let degree = order.saturating_sub(1);
        let values = coefficients.values();
        let curve = py.detach(|| {
            geometry::PiecewiseBezier::from_power_with(breaks, degree, dimension, |i, k| {
                let at = (k * pieces + i) * columns;
                row(&values[at..at + columns])
            })
        });
        curve.map(Self::of).map_err(input_error)
    }

    /// Bézier points of the pieces, shape (pieces, degree + 1, dim); a fresh array.
    #[getter]
    fn control<'py>(&self, py: Python<'py>) -> PyResult<FloatArray<'py>> {
        let columns = self.columns();
        let pieces = self.curve.pieces();
        let mut values = Vec::new();
        for p in (0..pieces).flat_map(|i| self.curve.piece(i)) {
            let point = if self.curve.is_rational() { p.truncate() / p.w } else { p.truncate() };
            values.extend_from_slice(&point.to_array()[..columns]);
        }
        shaped(py, values, &[pieces, self.curve.degree() + 1, columns])
    }

    /// Weights of the Bézier points, shape (pieces, degree + 1), a fresh array; ``None`` for a curve
    /// that is not rational.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Option<FloatArray<'py>>> {
        if !self.curve.is_rational() {
            return Ok(None);
        }
        let pieces = self.curve.pieces();
        let weights = (0..pieces).flat_map(|i| self.curve.piece(i)).map(|p| p.w).collect();
        shaped(py, weights, &[pieces, self.curve.degree() + 1]).map(Some)
    }

    /// The parameters at the ends of the pieces, strictly increasing; a fresh array.
    #[getter]
    fn breaks<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.curve.breaks())
    }

    /// The degree of the pieces.
    #[getter]
    fn degree(&self) -> usize {
        self.curve.degree()
    }

    /// Evaluate the curve.
    ///
    /// Parameters
    /// ----------
    /// u : array_like
    ///     Parameters, of any shape. Outside the breaks the end pieces go on. NaN gives NaN.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (*u.shape, dim)
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If ``u`` does not hold real numbers.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.PiecewiseBezier([[[0, 0], [2, 4]]], [0, 1])(0.5)
    /// array([1., 2.])
    fn _call<'py>(&self, py: Python<'py>, u: Query<'py>) -> PyResult<FloatArray<'py>> {
        let columns = self.columns();
        let u = match &u {
            Query::One(u) => return Ok(vector(py, self.curve.position(*u), columns)),
            Query::Many(u) => u,
        };
        let mut values = zeros(u.values().len(), columns)?;
        let (curve, parameters) = (&self.curve, u.values());
        py.detach(|| {
            for (&u, row) in parameters.iter().zip(values.chunks_exact_mut(columns)) {
                row.copy_from_slice(&curve.position(u).to_array()[..columns]);
            }
        });
        let shape: Vec<usize> = u.shape().iter().copied().chain([columns]).collect();
        shaped(py, values, &shape)
    }

    fn __repr__(&self) -> String {
        let curve = &self.curve;
        let (pieces, breaks) = (curve.pieces(), curve.breaks());
        format!(
            "<PiecewiseBezier: {pieces} {}{} of degree {} in {}, u from {} to {}>",
            if curve.is_rational() { "rational " } else { "" },
            if pieces == 1 { "piece" } else { "pieces" },
            curve.degree(),
            if self.columns() == 2 { "the plane" } else { "space" },
            breaks[0],
            breaks[breaks.len() - 1],
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let write = |bytes| pickle::write_piecewise(&self.curve, bytes);
        pickle::reduce(py, PickledKind::PiecewiseBezier, write)
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}
