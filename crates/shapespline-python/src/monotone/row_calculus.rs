// SPDX-License-Identifier: MIT OR Apache-2.0

//! Derivatives, integrals and solutions of many rows.

use pyo3::prelude::*;
use shapespline::monotone::Extrapolation;

use super::{calculus::arrays, options, places::per_row, rows::PiecewiseRows};
use crate::{
    error::must,
    output::{FloatArray, shaped},
};

#[pymethods]
impl PiecewiseRows {
    /// Return the derivatives of all rows as functions.
    ///
    /// Parameters
    /// ----------
    /// nu : int
    ///     Their order.
    ///
    /// Returns
    /// -------
    /// PiecewiseRows
    ///     Row by row what `PiecewisePolynomial.derivative` gives. Cost O(total).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    /// >>> f.derivative()([0.5, 1.5])
    /// array([[1. , 1. ],
    ///        [0.5, 0.5]])
    #[pyo3(signature = (nu=1))]
    fn derivative(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = options::nu)] nu: usize,
    ) -> PyResult<Py<PyAny>> {
        Self::of(self.fits.derivative(py, nu), self.ragged).into_python(py)
    }

    /// Antiderivatives of all rows as functions: zero at their first knots.
    ///
    /// Parameters
    /// ----------
    /// nu : int
    ///     How often to integrate; at most 100.
    ///
    /// Returns
    /// -------
    /// PiecewiseRows
    ///     Row by row what `PiecewisePolynomial.antiderivative` gives. Cost O(total).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    /// >>> f.antiderivative()(2.0).round(12)
    /// array([2., 1.])
    #[pyo3(signature = (nu=1))]
    fn antiderivative(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = options::integrals)] nu: usize,
    ) -> PyResult<Py<PyAny>> {
        Self::of(self.fits.antiderivative(py, nu), self.ragged).into_python(py)
    }

    /// Return the definite integral of every row.
    ///
    /// Parameters
    /// ----------
    /// a, b : float or array_like, shape (rows,)
    ///     The ends, in any order, also outside the knots: for all rows, or one per row. NaN gives NaN;
    ///     ±∞ gives the limit, NaN where there is none.
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     As for a call.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (rows,)
    ///     One number per row. Cost O(log n) a row after a first call of O(n).
    ///
    /// Raises
    /// ------
    /// ValueError, TypeError
    ///     If there are neither one nor as many ends as rows.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    /// >>> f.integrate(0, [2, 4]).round(12)
    /// array([2., 4.])
    #[pyo3(signature = (a, b, extrapolate=None))]
    fn integrate<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, PyAny>,
        b: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<FloatArray<'py>> {
        let rows = self.fits.len();
        let (a, b) = (per_row("a", a, rows)?, per_row("b", b, rows)?);
        let values = self.fits.map(py, |k, f| f.integrate(a[k], b[k], extrapolate));
        shaped(py, values, &[rows])
    }

    /// All x with f(x) = 0 of every row: `solve` for zero.
    ///
    /// Parameters
    /// ----------
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     As for `PiecewisePolynomial.roots`.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (rows,)
    ///     As of `solve`.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[-1, 0, 1], [-1, 1, 3]])
    /// >>> f.roots()
    /// array([array([1.]), array([1.])], dtype=object)
    #[pyo3(signature = (extrapolate=None))]
    fn roots<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.solutions(py, &vec![0.0; self.fits.len()], extrapolate)
    }

    /// All x with f(x) = y of every row.
    ///
    /// Parameters
    /// ----------
    /// y : float or array_like, shape (rows,)
    ///     Finite values: one for all rows, or one per row.
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     As for `PiecewisePolynomial.solve`.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (rows,)
    ///     Of dtype object: row by row the array that `PiecewisePolynomial.solve` gives. Cost O(total).
    ///
    /// Raises
    /// ------
    /// ValueError, TypeError
    ///     If a value is not finite, or there are neither one nor as many values as rows.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[-1, 0, 1], [-1, 1, 3]])
    /// >>> f.solve([0.5, 2])
    /// array([array([1.5]), array([3.])], dtype=object)
    #[pyo3(signature = (y, extrapolate=None))]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        y: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let y = per_row("y", y, self.fits.len())?;
        if let Some(row) = y.iter().position(|y| !y.is_finite()) {
            return Err(must("y", &[row], "be finite", y[row]));
        }
        self.solutions(py, &y, extrapolate)
    }
}

impl PiecewiseRows {
    fn solutions<'py>(
        &self,
        py: Python<'py>,
        y: &[f64],
        mode: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        arrays(py, self.fits.map(py, |k, f| f.solve(y[k], mode)), &[self.fits.len()])
    }
}
