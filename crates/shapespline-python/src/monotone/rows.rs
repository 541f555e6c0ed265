// SPDX-License-Identifier: MIT OR Apache-2.0

//! Functions of many rows, each with its own knots.

use std::sync::Arc;

use pyo3::{
    IntoPyObjectExt, PyClassInitializer,
    exceptions::{PyIndexError, PyTypeError},
    prelude::*,
};
use shapespline::monotone::{Extrapolation, MonotoneError, MonotoneSpline};

use super::{
    diagnostics::MonotoneDiagnostics,
    fits::{Column, Fits},
    function::PiecewisePolynomial,
    layout::Layout,
    options,
    places::{Arrangement, Places},
    spline::{diagnostics, energies},
};
use crate::{
    error::monotone_error,
    input::Offsets,
    output::{FloatArray, shaped},
    pickle::{self, PickledKind, Reduced},
};

/// Functions of many rows, each with its own knots: the base of `MonotoneRows`.
///
/// Not made directly: derivatives and antiderivatives of what `fit_many_monotone` gives are of this
/// class. A sequence: ``len(f)`` rows, ``f[k]`` the function of one. Immutable; can be pickled, copied
/// and shared between threads.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
/// >>> f.derivative()(1.0)
/// array([1. , 0.5])
#[pyclass(module = "shapespline", frozen, sequence, subclass, weakref)]
pub(crate) struct PiecewiseRows {
    pub(super) fits: Arc<Fits>,
    /// Whether the rows came one after another, with offsets, and not as an array of two axes.
    pub(super) ragged: bool,
}

impl PiecewiseRows {
    pub(crate) fn of(fits: Fits, ragged: bool) -> Self {
        Self { fits: Arc::new(fits), ragged }
    }

    /// One number per point, in the arrangement of the data.
    fn nodal<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(Column<'_>) -> Vec<f64>,
    ) -> PyResult<FloatArray<'py>> {
        let values: Vec<f64> = self.fits.columns().flat_map(of).collect();
        let (rows, total) = (self.fits.len(), values.len());
        if self.ragged {
            shaped(py, values, &[total])
        } else {
            shaped(py, values, &[rows, total / rows])
        }
    }

    /// The object of the class that the fits are of.
    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let pieces = matches!(*self.fits, Fits::Pieces(_));
        let base = PyClassInitializer::from(self);
        Ok(if pieces {
            Py::new(py, base)?.into_any()
        } else {
            Py::new(py, base.add_subclass(MonotoneRows))?.into_any()
        })
    }

    /// `work` on every row at its places, as an array in the arrangement of the places.
    fn each_at<'py>(
        &self,
        py: Python<'py>,
        places: &Places<'_>,
        work: impl Fn(Column<'_>, &[f64], &mut [f64]) -> Result<(), MonotoneError> + Send + Sync,
    ) -> PyResult<FloatArray<'py>> {
        let rows = self.fits.len();
        let (values, arrangement) = (places.values(), &places.arrangement);
        let found = self.fits.each_at(py, |k| arrangement.row(values, k), work)?;
        let found = found.map_err(|(row, source)| {
            monotone_error(&MonotoneError::InRow { row, source: Box::new(source) })
        })?;
        match arrangement {
            Arrangement::One => shaped(py, found, &[rows]),
            Arrangement::Same => shaped(py, found, &[rows, values.len()]),
            Arrangement::Each(n) => shaped(py, found, &[rows, *n]),
            Arrangement::Ragged(_) => shaped(py, found, &[values.len()]),
        }
    }
}

#[pymethods]
impl PiecewiseRows {
    #[new]
    fn new() -> PyResult<Self> {
        Err(PyTypeError::new_err(
            "PiecewiseRows is the base of MonotoneRows: call fit_many_monotone, or take a derivative \
             of what it gives",
        ))
    }

    /// Abscissae of the data of all rows, in their arrangement: of shape (rows, n), or with offsets one row
    /// after another; of derivatives and antiderivatives knots, as a list of arrays where the rows have
    /// knots between their data. Fresh arrays.
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if !self.ragged && !self.fits.agree() {
            return self.knots(py)?.into_bound_py_any(py);
        }
        Ok(self.nodal(py, |f| f.x().to_vec())?.into_any())
    }

    /// Knots between which the rows are polynomials: a list of one fresh array per row.
    #[getter]
    fn knots<'py>(&self, py: Python<'py>) -> PyResult<Vec<FloatArray<'py>>> {
        let of = |c: Column<'_>| shaped(py, c.knots().to_vec(), &[c.knots().len()]);
        self.fits.columns().map(of).collect()
    }

    /// What all rows are outside their knots, as `PiecewisePolynomial.extrapolate`.
    #[getter]
    fn extrapolate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        options::extrapolation_name(py, self.fits.column(0).extrapolation())
    }

    /// Evaluate every row, or a derivative.
    ///
    /// Parameters
    /// ----------
    /// x : array_like
    ///     A number or one axis: the same places for every row. Two axes: row k of ``x`` for row k.
    ///     With ``offsets`` one axis: the places of all rows one after another.
    /// nu : int
    ///     Order of the derivative.
    /// extrapolate : {None, "linear", "clip", "periodic", True, False} or pair of them
    ///     As for a call of `MonotoneQuintic`.
    /// offsets : array_like of int, shape (rows + 1,), optional
    ///     Row k is evaluated at ``x[offsets[k]:offsets[k + 1]]``.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (rows,), (rows, places) or, with offsets, that of x
    ///     One row a row.
    ///
    /// Raises
    /// ------
    /// ValueError, TypeError
    ///     If ``x`` or ``offsets`` do not fit the rows, or an argument is of a wrong kind.
    ///
    /// Notes
    /// -----
    /// Cost O(log n) a place; many run on all threads.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    /// >>> f([[0.5, 1.5], [1, 3]])
    /// array([[0.5, 1.5],
    ///        [0.5, 1.5]])
    /// >>> f([0.5, 1, 2, 3], offsets=[0, 1, 4])
    /// array([0.5, 0.5, 1. , 1.5])
    #[pyo3(signature = (x, nu=0, extrapolate=None, *, offsets=None))]
    fn _call<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = options::nu)] nu: usize,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
        offsets: Option<Offsets>,
    ) -> PyResult<FloatArray<'py>> {
        let places = Places::of("x", x, offsets, self.fits.len())?;
        self.each_at(py, &places, |f, x, out| {
            f.evaluate_into(x, nu, extrapolate, out);
            Ok(())
        })
    }

    fn __len__(&self) -> usize {
        self.fits.len()
    }

    fn __getitem__(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = options::row)] row: isize,
    ) -> PyResult<Py<PyAny>> {
        let rows = self.fits.len();
        let k = if row < 0 { row.checked_add_unsigned(rows) } else { Some(row) };
        match k.and_then(|k| usize::try_from(k).ok()).filter(|k| *k < rows) {
            Some(k) => {
                PiecewisePolynomial::of(self.fits.only(k), &Arc::new(Layout::ONE)).into_python(py)
            }
            None => Err(PyIndexError::new_err(format!("row {row} of {rows} rows"))),
        }
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let fits = &slf.get().fits;
        let degree = fits.column(0).degree();
        Ok(format!("<{}: {} rows, degree {degree}>", slf.get_type().name()?, fits.len()))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickle::reduce(py, PickledKind::Rows, |bytes| {
            postcard::to_extend(&(self.ragged, self.fits.as_ref()), bytes)
        })
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

/// Monotone interpolants of many rows, each with its own x: what `fit_many_monotone` gives.
///
/// A sequence: ``len(f)`` rows, ``f[k]`` the interpolant of one. A call evaluates row by row.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
/// >>> len(f), f(1.0), f[1](1.0)
/// (2, array([1. , 0.5]), 0.5)
#[pyclass(module = "shapespline", frozen, extends = PiecewiseRows)]
pub(crate) struct MonotoneRows;

impl MonotoneRows {
    fn nodal<'py>(
        slf: &Bound<'py, Self>,
        of: impl Fn(&MonotoneSpline) -> Vec<f64>,
    ) -> PyResult<FloatArray<'py>> {
        slf.as_super().get().nodal(slf.py(), |column| match column {
            Column::Spline(f) => of(f),
            Column::Pieces(_) => Vec::new(),
        })
    }
}

#[pymethods]
impl MonotoneRows {
    #[new]
    fn new() -> PyResult<PyClassInitializer<Self>> {
        Err(PyTypeError::new_err("MonotoneRows is what fit_many_monotone gives: call that"))
    }

    /// The data, in their arrangement; a fresh array.
    #[getter]
    fn y<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        Self::nodal(slf, |f| f.y().to_vec())
    }

    /// Slopes at the knots, in the arrangement of the data; a fresh array.
    #[getter]
    fn slopes<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        Self::nodal(slf, MonotoneSpline::slopes)
    }

    /// Second derivatives at the knots, as `MonotoneSpline.second_derivatives`, in the arrangement of the
    /// data; a fresh array.
    #[getter]
    fn second_derivatives<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        Self::nodal(slf, MonotoneSpline::second_derivatives)
    }

    /// What the quintics minimise: ``"bending"`` or ``"parametric"``; None of quartics.
    #[getter]
    fn energy(slf: &Bound<'_, Self>) -> Option<&'static str> {
        slf.as_super().get().fits.fairness().map(options::energy_name)
    }

    /// Evaluate the inverse functions: in every row the x with f(x) = y.
    ///
    /// Parameters
    /// ----------
    /// y : array_like
    ///     Values, arranged as the places of a call. NaN gives NaN; outside a row's range as
    ///     `MonotoneSpline.inverse`.
    /// offsets : array_like of int, shape (rows + 1,), optional
    ///     As for a call.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     In the shape that a call would give. Of distribution functions: their quantiles.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the data of a row are not strictly monotone; the message names it.
    ///
    /// Notes
    /// -----
    /// Exact to a residual of some units in the last place. Cost O(log n) a value; many run on all
    /// threads.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    /// >>> f.inverse([0.5, 1.0])
    /// array([[0.5, 1. ],
    ///        [1. , 2. ]])
    #[pyo3(signature = (y, *, offsets=None))]
    fn inverse<'py>(
        slf: &Bound<'py, Self>,
        y: &Bound<'py, PyAny>,
        offsets: Option<Offsets>,
    ) -> PyResult<FloatArray<'py>> {
        let base = slf.as_super().get();
        let places = Places::of("y", y, offsets, base.fits.len())?;
        base.each_at(slf.py(), &places, |f, y, out| match f {
            Column::Spline(f) => f.inverse_into(y, out),
            Column::Pieces(_) => Ok(()),
        })
    }

    /// Bending energy ``∫ f''² dx`` of every row; a fresh array.
    #[getter]
    fn bending_energy<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        let fits = &slf.as_super().get().fits;
        shaped(slf.py(), energies(fits), &[fits.len()])
    }

    /// How the fit of every row went: a list of `MonotoneDiagnostics`.
    #[getter]
    fn diagnostics(slf: &Bound<'_, Self>) -> Vec<MonotoneDiagnostics> {
        diagnostics(&slf.as_super().get().fits)
    }
}
