// SPDX-License-Identifier: MIT OR Apache-2.0

//! Derivatives, integrals and solutions.

use numpy::PyArray1;
use pyo3::{prelude::*, types::PyTuple};
use shapespline::monotone::Extrapolation;

use super::{fits::Column, function::PiecewisePolynomial, options};

#[pymethods]
impl PiecewisePolynomial {
    /// Return the derivative as a function.
    ///
    /// Parameters
    /// ----------
    /// nu : int
    ///     Its order.
    ///
    /// Returns
    /// -------
    /// PiecewisePolynomial
    ///     Outside the knots the derivative of what the function is there. Cost O(n).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.MonotoneQuintic([0, 1, 2], [0, 2, 4]).derivative()(1.5)
    /// 2.0
    #[pyo3(signature = (nu=1))]
    fn derivative(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = options::nu)] nu: usize,
    ) -> PyResult<Py<PyAny>> {
        Self::of(self.fits.derivative(py, nu), &self.layout).into_python(py)
    }

    /// Return an antiderivative as a function: zero at the first knot.
    ///
    /// Parameters
    /// ----------
    /// nu : int
    ///     How often to integrate; at most 100.
    ///
    /// Returns
    /// -------
    /// PiecewisePolynomial
    ///     Of a degree that is ``nu`` higher. Cost O(n).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> area = ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).antiderivative()
    /// >>> round(area(2.0), 12)
    /// 2.0
    #[pyo3(signature = (nu=1))]
    fn antiderivative(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = options::integrals)] nu: usize,
    ) -> PyResult<Py<PyAny>> {
        Self::of(self.fits.antiderivative(py, nu), &self.layout).into_python(py)
    }

    /// Return the definite integral from a to b.
    ///
    /// Parameters
    /// ----------
    /// a, b : float
    ///     The ends, in any order, also outside the knots. NaN gives NaN; ±∞ gives the limit, NaN where
    ///     there is none.
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     As for a call.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     One number a column. Cost O(log n) after a first call of O(n).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).integrate(0, 2)
    /// 2.0
    #[pyo3(signature = (a, b, extrapolate=None))]
    fn integrate<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = options::a)] a: f64,
        #[pyo3(from_py_with = options::b)] b: f64,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let values = self.fits.map(py, |_, c| c.integrate(a, b, extrapolate));
        self.each(py, values)
    }

    /// All x with f(x) = 0: `solve` for zero.
    ///
    /// Parameters
    /// ----------
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     As for a call: roots beyond the knots count where the function is defined there; of one
    ///     that repeats, those on the knots.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     As of `solve`.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.MonotoneQuintic([0, 1, 2], [-1, 0, 1]).roots(extrapolate=False)
    /// array([1.])
    #[pyo3(signature = (extrapolate=None))]
    fn roots<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.solutions(py, 0.0, extrapolate)
    }

    /// All x with f(x) = y.
    ///
    /// Parameters
    /// ----------
    /// y : float
    ///     A finite value.
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     As for a call: solutions beyond the knots count where the function is defined there; of one
    ///     that repeats, those on the knots.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Increasing, each once. Where f equals y on a whole segment: its start, then NaN, as SciPy
    ///     does; where it does so on a half line beyond the knots, the end knot alone. For many columns an
    ///     array of such arrays (dtype object).
    ///
    /// Notes
    /// -----
    /// Every solution is verified: there f is y to some units in the last place of its values, or passes
    /// y between the neighbouring floating-point numbers. Cost O(n); a segment is searched only where
    /// its ends do not exclude y.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.MonotoneQuintic([0, 1, 2, 3], [0, 1, 1, 2]).solve(1.0, extrapolate=False)
    /// array([ 1., nan])
    #[pyo3(signature = (y, extrapolate=None))]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = options::y)] y: f64,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.solutions(py, y, extrapolate)
    }
}

impl PiecewisePolynomial {
    fn solutions<'py>(
        &self,
        py: Python<'py>,
        y: f64,
        mode: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut found = self.fits.map(py, |_, c: Column<'_>| c.solve(y, mode));
        if self.layout.is_one() {
            let only = found.pop().unwrap_or_default();
            return Ok(PyArray1::from_vec(py, only).into_any());
        }
        if self.layout.is_empty() {
            found.clear();
        }
        arrays(py, found, &self.layout.shape(&[]))
    }
}

/// An array of arrays.
pub(super) fn arrays<'py>(
    py: Python<'py>,
    values: Vec<Vec<f64>>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let out = py.import("numpy")?.call_method1("empty", (PyTuple::new(py, shape)?, "O"))?;
    let flat = out.getattr("flat")?;
    for (k, x) in values.into_iter().enumerate() {
        flat.set_item(k, PyArray1::from_vec(py, x))?;
    }
    Ok(out)
}
