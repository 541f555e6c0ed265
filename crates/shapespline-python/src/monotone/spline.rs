// SPDX-License-Identifier: MIT OR Apache-2.0

//! `MonotoneSpline`: what both families of interpolants have beyond a piecewise polynomial.

use pyo3::{IntoPyObjectExt, PyClassInitializer, exceptions::PyTypeError, prelude::*};
use shapespline::monotone;

use super::{
    diagnostics::MonotoneDiagnostics,
    fits::{Column, Fits},
    function::PiecewisePolynomial,
};
use crate::{
    error::{invalid, monotone_error},
    input::Query,
    output::{FloatArray, room, shaped},
    work::in_parts,
};

/// A monotone interpolant: the base of `MonotoneCubic`, `MonotoneQuintic` and `MonotoneQuartic`.
///
/// Not made directly. Every segment is monotone: increasing where its data increase, decreasing where
/// they decrease, constant where they are.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> isinstance(ss.MonotoneQuartic([0, 1, 2], [0, 1, 4]), ss.MonotoneSpline)
/// True
#[pyclass(module = "shapespline", frozen, subclass, extends = PiecewisePolynomial)]
pub(crate) struct MonotoneSpline;

impl MonotoneSpline {
    fn nodal<'py>(
        slf: &Bound<'py, Self>,
        of: impl Fn(&monotone::MonotoneSpline) -> Vec<f64>,
    ) -> PyResult<FloatArray<'py>> {
        let base = slf.as_super().get();
        let mut values = Vec::new();
        for column in base.fits.columns() {
            if let Column::Spline(f) = column {
                values.extend(of(f));
            }
        }
        let n = values.len() / base.fits.len();
        base.along(slf.py(), values, &[n])
    }
}

#[pymethods]
impl MonotoneSpline {
    #[new]
    fn new() -> PyResult<PyClassInitializer<Self>> {
        Err(PyTypeError::new_err(
            "MonotoneSpline is the base of the interpolants: make a MonotoneCubic, a MonotoneQuintic or \
             a MonotoneQuartic",
        ))
    }

    /// The data, in their shape; a fresh array.
    #[getter]
    fn y<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        Self::nodal(slf, |f| f.y().to_vec())
    }

    /// Slopes at the points, in the shape of y; a fresh array.
    #[getter]
    fn slopes<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        Self::nodal(slf, monotone::MonotoneSpline::slopes)
    }

    /// Second derivatives at the points, in the shape of y (where they jump, as those of the quartic do, from
    /// the right, at the last point from the left); a fresh array.
    #[getter]
    fn second_derivatives<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        Self::nodal(slf, monotone::MonotoneSpline::second_derivatives)
    }

    /// Bending energy ``∫ f''² dx`` over the knots: a float, or one a column.
    #[getter]
    fn bending_energy<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let base = slf.as_super().get();
        base.each(slf.py(), energies(&base.fits))
    }

    /// How the fit went: `MonotoneDiagnostics`, or a list of them in the order of the columns.
    #[getter]
    fn diagnostics<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let base = slf.as_super().get();
        let mut all = diagnostics(&base.fits);
        if base.layout.is_empty() {
            all.clear();
        }
        match all.pop() {
            Some(only) if base.layout.is_one() => only.into_bound_py_any(slf.py()),
            last => {
                all.extend(last);
                all.into_bound_py_any(slf.py())
            }
        }
    }

    /// Evaluate the inverse function: the x with f(x) = y.
    ///
    /// Parameters
    /// ----------
    /// y : array_like
    ///     Values, of any shape. NaN gives NaN. Outside the data's range what ``extrapolate`` of the
    ///     function says for that end: of the tangent line its inverse (NaN where it is level), with
    ///     ``"clip"`` the end knot, of a phase (``ends="periodic"`` with a rise) the place in the period
    ///     that has the value, else NaN.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Of the shape of ``y``. Of a cumulative distribution function: its quantiles.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the data have several columns, or are not strictly monotone.
    ///
    /// Notes
    /// -----
    /// Exact to a residual of some units in the last place. Cost O(log n) a value; many run on all
    /// threads.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> cdf = ss.MonotoneQuintic([0, 1, 3], [0, 0.5, 1], extrapolate=False)
    /// >>> cdf.inverse([0.0, 0.5, 1.0, 1.5])
    /// array([ 0.,  1.,  3., nan])
    #[pyo3(signature = (y))]
    fn inverse<'py>(slf: &Bound<'py, Self>, y: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (py, base) = (slf.py(), slf.as_super().get());
        let Column::Spline(f) = base.fits.column(0) else {
            return Err(PyTypeError::new_err("inverse is for interpolants"));
        };
        if !base.layout.is_one() {
            let columns = base.layout.columns();
            let text = format!(
                "inverse needs data with one axis; y has {} and {columns} columns",
                base.layout.outer.len() + base.layout.inner.len() + 1,
            );
            return Err(invalid("y", &[], columns, text));
        }
        match Query::named("y", y)? {
            Query::One(y) => f.inverse(y).map_err(|e| monotone_error(&e))?.into_bound_py_any(py),
            Query::Many(y) => {
                let values = y.values();
                let size = room(values.len(), 1)?;
                let out = in_parts(py, size, |part| f.inverse_many(&values[part]))?
                    .map_err(|e| monotone_error(&e))?;
                Ok(shaped(py, out, y.shape())?.into_any())
            }
        }
    }
}

/// Bending energy of every column.
pub(crate) fn energies(fits: &Fits) -> Vec<f64> {
    match fits {
        Fits::Cubic(fits) => fits.iter().map(|f| f.bending_energy()).collect(),
        Fits::Quartic(fits) => fits.iter().map(|f| f.bending_energy()).collect(),
        Fits::Quintic(fits) => fits.iter().map(|f| f.bending_energy()).collect(),
        Fits::Pieces(_) => Vec::new(),
    }
}

/// How the fit of every column went.
pub(crate) fn diagnostics(fits: &Fits) -> Vec<MonotoneDiagnostics> {
    match fits {
        Fits::Cubic(fits) => {
            fits.iter().map(|f| MonotoneDiagnostics::of(f.diagnostics())).collect()
        }
        Fits::Quartic(fits) => fits.iter().map(MonotoneDiagnostics::quartic).collect(),
        Fits::Quintic(fits) => {
            fits.iter().map(|f| MonotoneDiagnostics::of(f.diagnostics())).collect()
        }
        Fits::Pieces(_) => Vec::new(),
    }
}
