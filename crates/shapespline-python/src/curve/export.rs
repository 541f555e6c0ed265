// SPDX-License-Identifier: MIT OR Apache-2.0

//! The same curve in other forms: Bézier points, SciPy's B-spline and piecewise polynomial.

use numpy::PyArray1;
use pyo3::{
    prelude::*,
    types::{IntoPyDict, PyDict},
};
use shapespline::geometry::{DVec3, Domain};

use super::SpaceCurve;
use crate::output::{FloatArray, shaped};

impl SpaceCurve {
    /// Bézier points of each segment. First and last are the points exactly.
    fn control_points(&self) -> impl Iterator<Item = [DVec3; 4]> + '_ {
        let cubic = self.curve.cubic();
        cubic
            .points()
            .windows(2)
            .zip(cubic.legs())
            .map(|(p, [a, c])| [p[0], p[0] + *a, p[1] - *c, p[1]])
    }

    fn extrapolate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        match self.curve.cubic().domain() {
            Domain::Closed => [("extrapolate", "periodic")].into_py_dict(py),
            Domain::Open => [("extrapolate", true)].into_py_dict(py),
        }
    }
}

#[pymethods]
impl SpaceCurve {
    /// Bézier points of the segments, shape (segments, 4, dim); a fresh array.
    ///
    /// Each segment is run through linearly in its interval of the parameter, except by a
    /// `TensionSpline`, which has a parameter of its own: see its ``image_parameter``.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 6]]).bezier
    /// array([[[0., 0.],
    ///         [1., 2.],
    ///         [2., 4.],
    ///         [3., 6.]]])
    #[getter]
    fn bezier<'py>(&self, py: Python<'py>) -> PyResult<FloatArray<'py>> {
        let columns = self.columns();
        let segments = self.curve.cubic().segments();
        let mut values = Vec::with_capacity(segments * 4 * columns);
        for point in self.control_points().flatten() {
            values.extend_from_slice(&point.to_array()[..columns]);
        }
        shaped(py, values, &[segments, 4, columns])
    }

    /// Return the curve as a B-spline of SciPy.
    ///
    /// Returns
    /// -------
    /// scipy.interpolate.BSpline
    ///     Cubic, with triple interior knots, whose coefficients are the Bézier points: the same curve
    ///     to the last rounding. Closed curves extrapolate periodically. Of a `TensionSpline` it is
    ///     the same image, but the parameter is that of its ``image_parameter``. A `FairSpline` gives
    ///     simple knots.
    ///
    /// Raises
    /// ------
    /// ModuleNotFoundError
    ///     If SciPy is not installed (``pip install "shapespline[scipy]"``).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
    /// >>> curve.to_bspline()(2.5)
    /// array([1.5, 2. ])
    fn to_bspline<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let class = py.import("scipy.interpolate")?.getattr("BSpline")?;
        let (knots, columns) = (self.curve.cubic().knots(), self.columns());
        let n = knots.len();
        let mut t = Vec::with_capacity(3 * n + 2);
        t.push(knots[0]);
        t.extend(knots.iter().flat_map(|&u| [u; 3]));
        t.push(knots[n - 1]);
        let mut values = Vec::with_capacity((3 * n - 2) * columns);
        for [b0, b1, b2, _] in self.control_points() {
            for point in [b0, b1, b2] {
                values.extend_from_slice(&point.to_array()[..columns]);
            }
        }
        values.extend_from_slice(&self.curve.cubic().points()[n - 1].to_array()[..columns]);
        let coefficients = shaped(py, values, &[3 * n - 2, columns])?;
        class.call((PyArray1::from_vec(py, t), coefficients, 3), Some(&self.extrapolate(py)?))
    }

    /// Return the curve as a piecewise polynomial of SciPy.
    ///
    /// Returns
    /// -------
    /// scipy.interpolate.PPoly
    ///     Cubic, converted by SciPy from the Bézier points. Closed curves extrapolate periodically.
    ///     Of a `TensionSpline` it is the same image, but the parameter is that of its
    ///     ``image_parameter``.
    ///
    /// Raises
    /// ------
    /// ModuleNotFoundError
    ///     If SciPy is not installed (``pip install "shapespline[scipy]"``).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
    /// >>> curve.to_ppoly()(5.0, 1)
    /// array([0.6, 0.8])
    fn to_ppoly<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let scipy = py.import("scipy.interpolate")?;
        let (columns, segments) = (self.columns(), self.curve.cubic().segments());
        let mut values = vec![0.0; 4 * segments * columns];
        for (i, control) in self.control_points().enumerate() {
            for (k, point) in control.iter().enumerate() {
                let at = (k * segments + i) * columns;
                values[at..at + columns].copy_from_slice(&point.to_array()[..columns]);
            }
        }
        let coefficients = shaped(py, values, &[4, segments, columns])?;
        let knots = PyArray1::from_slice(py, self.curve.cubic().knots());
        let options = self.extrapolate(py)?;
        let bernstein = scipy.getattr("BPoly")?.call((coefficients, knots), Some(&options))?;
        scipy.getattr("PPoly")?.call_method("from_bernstein_basis", (bernstein,), Some(&options))
    }
}
