// SPDX-License-Identifier: MIT OR Apache-2.0

//! The same function as SciPy's objects.

use std::borrow::Cow;

use pyo3::{
    prelude::*,
    types::{IntoPyDict, PyDict},
};
use shapespline::monotone::{BSpline, Extrapolation};

use super::{fits::Fits, function::PiecewisePolynomial};
use crate::output::{FloatArray, shaped};

impl PiecewisePolynomial {
    /// The columns between knots that all have.
    fn on_common_knots(&self) -> Cow<'_, Fits> {
        if self.fits.share_knots() {
            Cow::Borrowed(&self.fits)
        } else {
            Cow::Owned(self.fits.refined())
        }
    }

    fn scipy_options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mode = self.fits.column(0).extrapolation();
        if mode == Extrapolation::PERIODIC {
            return [("extrapolate", "periodic")].into_py_dict(py);
        }
        [("extrapolate", mode == Extrapolation::POLYNOMIAL)].into_py_dict(py)
    }
}

#[pymethods]
impl PiecewisePolynomial {
    /// Bernstein coefficients with SciPy's two axes (degree + 1, segments) in place of ours.
    fn _bernstein<'py>(&self, py: Python<'py>) -> PyResult<FloatArray<'py>> {
        let fits = self.on_common_knots();
        let first = fits.column(0);
        let (order, segments) = (first.degree() + 1, first.knots().len() - 1);
        let mut values = vec![0.0; fits.len() * order * segments];
        for (column, out) in fits.columns().zip(values.chunks_exact_mut(order * segments)) {
            for (i, piece) in column.coefficients().chunks_exact(order).enumerate() {
                for (k, c) in piece.iter().enumerate() {
                    out[k * segments + i] = *c;
                }
            }
        }
        let values = self.layout.join(values, order * segments);
        shaped(py, values, &self.layout.shape(&[order, segments]))
    }

    /// Return the function as a piecewise polynomial of SciPy in Bernstein form.
    ///
    /// Returns
    /// -------
    /// scipy.interpolate.BPoly
    ///     With the same ``axis``. Outside the knots it is the end polynomial, or repeats, where the
    ///     function does so on both sides, else NaN: SciPy knows no tangent line and no end value.
    ///
    /// Raises
    /// ------
    /// ModuleNotFoundError
    ///     If SciPy is not installed (``pip install "shapespline[scipy]"``).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> float(ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).to_bpoly()(1.5))
    /// 1.5
    fn to_bpoly<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let class = py.import("scipy.interpolate")?.getattr("BPoly")?;
        let options = self.scipy_options(py)?;
        options.set_item("axis", self.layout.axis())?;
        let x = self.on_common_knots().column(0).knots().to_vec();
        let n = x.len();
        class.call((self._bernstein(py)?, shaped(py, x, &[n])?), Some(&options))
    }

    /// Return the function as a piecewise polynomial of SciPy in the power basis.
    ///
    /// Returns
    /// -------
    /// scipy.interpolate.PPoly
    ///     Converted by SciPy from `to_bpoly`.
    ///
    /// Raises
    /// ------
    /// ModuleNotFoundError
    ///     If SciPy is not installed (``pip install "shapespline[scipy]"``).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> float(ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).to_ppoly()(1.5))
    /// 1.5
    fn to_ppoly<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let class = py.import("scipy.interpolate")?.getattr("PPoly")?;
        let options = self.scipy_options(py)?;
        class.call_method("from_bernstein_basis", (self.to_bpoly(py)?,), Some(&options))
    }

    /// Return the function as a B-spline of SciPy.
    ///
    /// Returns
    /// -------
    /// scipy.interpolate.BSpline
    ///     With the same ``axis``; of one cubic with simple knots (double ones where its second derivative
    ///     jumps: without layers, and at given slopes), of quartics and quintics with triple ones. Outside
    ///     the knots as `to_bpoly`.
    ///
    /// Raises
    /// ------
    /// ModuleNotFoundError
    ///     If SciPy is not installed (``pip install "shapespline[scipy]"``).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> float(ss.MonotoneCubic([0, 1, 2], [0, 1, 2]).to_bspline()(1.5))
    /// 1.5
    fn to_bspline<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let class = py.import("scipy.interpolate")?.getattr("BSpline")?;
        let mut all: Vec<BSpline> = self.fits.columns().map(|c| c.to_bspline()).collect();
        if all.iter().any(|b| b.knots != all[0].knots) {
            // Columns with knots of their own: pieces between the knots of all of them.
            all = self.fits.refined().columns().map(|c| c.to_bspline()).collect();
        }
        let (knots, degree) = (all[0].knots.clone(), all[0].degree);
        let n = all[0].coefficients.len();
        let values: Vec<f64> = all.into_iter().flat_map(|b| b.coefficients).collect();
        let values = self.layout.join(values, n);
        let coefficients = shaped(py, values, &self.layout.shape(&[n]))?;
        let options = self.scipy_options(py)?;
        options.set_item("axis", self.layout.axis())?;
        let count = knots.len();
        class.call((shaped(py, knots, &[count])?, coefficients, degree), Some(&options))
    }
}
