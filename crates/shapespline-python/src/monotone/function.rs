// SPDX-License-Identifier: MIT OR Apache-2.0

//! `PiecewisePolynomial`: what every function of one variable is and can do.

use std::sync::Arc;

use pyo3::{IntoPyObjectExt, PyClassInitializer, exceptions::PyTypeError, prelude::*};
use shapespline::monotone::Extrapolation;

use super::{
    cubic::MonotoneCubic,
    families::{MonotoneQuartic, MonotoneQuintic},
    fits::Fits,
    layout::Layout,
    options,
    spline::MonotoneSpline,
};
use crate::{
    input::Query,
    output::{FloatArray, shaped},
    pickle::{self, PickledKind, Reduced},
};

/// A piecewise polynomial in one variable, on increasing knots: the base of the monotone interpolants.
///
/// Not made directly: derivatives and antiderivatives of `MonotoneCubic`, `MonotoneQuintic` and
/// `MonotoneQuartic` are of this class. Immutable; compares and hashes by identity; can be pickled, copied and shared
/// between threads.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> slope = ss.MonotoneQuintic([0, 1, 2], [0, 1, 2]).derivative()
/// >>> type(slope).__name__, slope(0.5)
/// ('PiecewisePolynomial', 1.0)
#[pyclass(module = "shapespline", frozen, subclass, weakref)]
pub(crate) struct PiecewisePolynomial {
    /// One fit per column, or a single fit of zeros if there are no columns.
    pub(crate) fits: Arc<Fits>,
    pub(crate) layout: Arc<Layout>,
}

impl PiecewisePolynomial {
    pub(crate) fn of(fits: Fits, layout: &Arc<Layout>) -> Self {
        Self { fits: Arc::new(fits), layout: Arc::clone(layout) }
    }

    /// The object of the class that the fits are of.
    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let kind = Arc::clone(&self.fits);
        let base = PyClassInitializer::from(self);
        Ok(match *kind {
            Fits::Pieces(_) => Py::new(py, base)?.into_any(),
            Fits::Cubic(_) => {
                let spline = base.add_subclass(MonotoneSpline);
                Py::new(py, spline.add_subclass(MonotoneCubic))?.into_any()
            }
            Fits::Quartic(_) => {
                let spline = base.add_subclass(MonotoneSpline);
                Py::new(py, spline.add_subclass(MonotoneQuartic))?.into_any()
            }
            Fits::Quintic(_) => {
                let spline = base.add_subclass(MonotoneSpline);
                Py::new(py, spline.add_subclass(MonotoneQuintic))?.into_any()
            }
        })
    }

    /// One number a column: a float, or an array of the shape of y without its axis.
    pub(crate) fn each<'py>(
        &self,
        py: Python<'py>,
        mut values: Vec<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if self.layout.is_empty() {
            values.clear();
        }
        match values[..] {
            [value] if self.layout.is_one() => value.into_bound_py_any(py),
            _ => Ok(shaped(py, values, &self.layout.shape(&[]))?.into_any()),
        }
    }

    /// As many numbers a column: an array of the shape of y with its axis replaced by these.
    pub(crate) fn along<'py>(
        &self,
        py: Python<'py>,
        values: Vec<f64>,
        middle: &[usize],
    ) -> PyResult<FloatArray<'py>> {
        let values = self.layout.join(values, middle.iter().product());
        shaped(py, values, &self.layout.shape(middle))
    }
}

#[pymethods]
impl PiecewisePolynomial {
    #[new]
    fn new() -> PyResult<Self> {
        Err(PyTypeError::new_err(
            "PiecewisePolynomial is the base of the functions: make a MonotoneCubic, a MonotoneQuintic or \
             a MonotoneQuartic, or take a derivative of one",
        ))
    }

    /// Of an interpolant the abscissae of its data, shape (n,); of a derivative or an antiderivative its
    /// knots. A fresh array.
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if let Fits::Pieces(_) = *self.fits {
            return self.knots(py);
        }
        let x = self.fits.column(0).x().to_vec();
        let n = x.len();
        Ok(shaped(py, x, &[n])?.into_any())
    }

    /// Knots between which it is a polynomial, shape (m,); a fresh array. Cubics have knots between their
    /// data: where those of several columns differ, a list of one array per column.
    #[getter]
    fn knots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let of = |knots: &[f64]| shaped(py, knots.to_vec(), &[knots.len()]);
        if self.fits.share_knots() {
            return Ok(of(self.fits.column(0).knots())?.into_any());
        }
        let all = self.fits.columns().map(|c| of(c.knots())).collect::<PyResult<Vec<_>>>()?;
        all.into_bound_py_any(py)
    }

    /// The axis of y along which it interpolates, from 0 on.
    #[getter]
    fn axis(&self) -> usize {
        self.layout.axis()
    }

    /// Degree of the pieces.
    #[getter]
    fn degree(&self) -> usize {
        self.fits.column(0).degree()
    }

    /// What it is outside the knots, as the constructors take it. Derivatives and antiderivatives continue
    /// what they are made of: ``"zero"`` is the derivative of a constant, ``"taylor-2"`` the antiderivative
    /// of a line, ``"periodic-1"`` that of a repeating function.
    #[getter]
    fn extrapolate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        options::extrapolation_name(py, self.fits.column(0).extrapolation())
    }

    /// Evaluate the function or a derivative.
    ///
    /// Parameters
    /// ----------
    /// x : array_like
    ///     Where, of any shape. NaN gives NaN; ±∞ gives the limit, NaN where there is none.
    /// nu : int
    ///     Order of the derivative; 0 gives values.
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     What it is outside the knots: the tangent line, the end value, the function repeated, the end
    ///     polynomial, NaN; of a pair the first below, the second above. None is what the function was
    ///     made with.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Of the shape of y with the axis of interpolation replaced by the shape of ``x``; a float
    ///     where that is no axis at all.
    ///
    /// Raises
    /// ------
    /// ValueError, TypeError
    ///     If ``nu`` is negative, ``extrapolate`` unknown, or ``x`` does not hold real numbers.
    ///
    /// Notes
    /// -----
    /// Cost O(log n) for one place, O(1) expected each for many; many run on all threads.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.MonotoneQuintic([0, 1, 2], [[0, 0], [1, 2], [2, 4]])
    /// >>> f([0.5, 1.5])
    /// array([[0.5, 1. ],
    ///        [1.5, 3. ]])
    /// >>> f(3.0, extrapolate="clip")
    /// array([2., 4.])
    #[pyo3(signature = (x, nu=0, extrapolate=None))]
    fn _call<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = options::nu)] nu: usize,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<Bound<'py, PyAny>> {
        match Query::named("x", x)? {
            Query::One(x) if self.layout.is_one() => {
                self.fits.column(0).evaluate(x, nu, extrapolate).into_bound_py_any(py)
            }
            Query::One(x) => {
                let query = [x];
                let values = self.fits.evaluate(py, 1, |_| &query[..], nu, extrapolate)?;
                self.each(py, values)
            }
            Query::Many(x) => {
                let q = x.values();
                let values = self.fits.evaluate(py, q.len(), |_| q, nu, extrapolate)?;
                Ok(self.along(py, values, x.shape())?.into_any())
            }
        }
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let this = slf.get();
        let column = this.fits.column(0);
        let (x, n) = (column.knots(), column.knots().len());
        let columns = match this.layout.columns() {
            1 => String::new(),
            many => format!(", {many} columns"),
        };
        Ok(format!(
            "<{}: {n} knots from {} to {}, degree {}{columns}>",
            slf.get_type().name()?,
            x[0],
            x[n - 1],
            column.degree(),
        ))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickle::reduce(py, PickledKind::Function, |bytes| {
            postcard::to_extend(&(self.layout.as_ref(), self.fits.as_ref()), bytes)
        })
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}
