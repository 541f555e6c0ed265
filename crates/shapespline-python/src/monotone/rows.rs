//! Many data sets with their own x in one call: `fit_many_monotone`.

use std::{ops::ControlFlow, sync::Arc};

use pyo3::{
    exceptions::{PyIndexError, PyValueError},
    prelude::*,
    types::PyBytes,
};
use rayon::prelude::*;
use shapespline::monotone::{
    self, Extrapolation, Fairness, MonotoneError, QuarticOptions, QuinticOptions, Shape, Slopes,
};

use super::{
    diagnostics::MonotoneDiagnostics,
    fits::{Fits, PARALLEL},
    function::{PiecewisePolynomial, damaged, read},
    layout::Layout,
    options::{self, SlopesOption, monotone_error},
    spline::{diagnostics, energies},
};
use crate::{
    input::{Array, Query, array, count, kind, text},
    options::choose,
    output::{FloatArray, shaped},
    work::{detached, interruptible},
};

/// Rows that are fitted between two looks for Ctrl-C.
const BATCH: usize = 4096;

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
#[pyclass(module = "shapespline", frozen, sequence)]
pub(crate) struct MonotoneRows {
    fits: Arc<Fits>,
}

#[pymethods]
impl MonotoneRows {
    /// Evaluate every row, or a derivative.
    ///
    /// Parameters
    /// ----------
    /// x : array_like
    ///     A number or one axis: the same places for every row. Two axes: row k of ``x`` for row k.
    /// nu : int
    ///     Order of the derivative.
    /// extrapolate : {None, True, False, "linear", "clip"}
    ///     As for a call of `MonotoneQuintic`.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (rows,) or (rows, places)
    ///     One row a row. Many run on all threads.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> f = ss.fit_many_monotone([[0, 1, 2], [0, 2, 4]], [[0, 1, 2], [0, 1, 2]])
    /// >>> f([[0.5, 1.5], [1, 3]])
    /// array([[0.5, 1.5],
    ///        [0.5, 1.5]])
    #[pyo3(signature = (x, nu=0, extrapolate=None))]
    fn _call<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = options::nu)] nu: usize,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<FloatArray<'py>> {
        let rows = self.fits.len();
        match Query::named("x", x)? {
            Query::One(x) => {
                let query = [x];
                let values = self.fits.evaluate(py, 1, |_| &query[..], nu, extrapolate)?;
                shaped(py, values, &[rows])
            }
            Query::Many(x) => {
                let q = x.values();
                let values = match x.shape() {
                    [n] => self.fits.evaluate(py, *n, |_| q, nu, extrapolate)?,
                    [m, n] if *m == rows => {
                        let row = |k: usize| &q[k * n..(k + 1) * n];
                        self.fits.evaluate(py, *n, row, nu, extrapolate)?
                    }
                    _ => {
                        return Err(PyValueError::new_err(format!(
                            "x must be a number, have one axis, or be of shape ({rows}, n): a row \
                             for each; got shape {}",
                            x.shape_text()
                        )));
                    }
                };
                shaped(py, values, &[rows, x.shape()[x.shape().len() - 1]])
            }
        }
    }

    fn __len__(&self) -> usize {
        self.fits.len()
    }

    fn __getitem__(&self, py: Python<'_>, row: isize) -> PyResult<Py<PyAny>> {
        let rows = self.fits.len();
        let k = if row < 0 { row.checked_add_unsigned(rows) } else { Some(row) };
        match k.and_then(|k| usize::try_from(k).ok()).filter(|k| *k < rows) {
            Some(k) => {
                PiecewisePolynomial::of(self.fits.only(k), &Arc::new(Layout::ONE)).into_python(py)
            }
            None => Err(PyIndexError::new_err(format!("row {row} of {rows} rows"))),
        }
    }

    /// Bending energy ``∫ f''² dx`` of every row; a fresh array.
    #[getter]
    fn bending_energy<'py>(&self, py: Python<'py>) -> PyResult<FloatArray<'py>> {
        shaped(py, energies(&self.fits), &[self.fits.len()])
    }

    /// How the fit of every row went: a list of `MonotoneDiagnostics`.
    #[getter]
    fn diagnostics(&self) -> Vec<MonotoneDiagnostics> {
        diagnostics(&self.fits)
    }

    fn __repr__(&self) -> String {
        let degree = self.fits.column(0).degree();
        format!("<MonotoneRows: {} rows, degree {degree}>", self.fits.len())
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let make = py.import("shapespline._core")?.getattr("_rows_from_bytes")?;
        let bytes = detached(py, 0, || postcard::to_extend(self.fits.as_ref(), vec![1]))
            .map_err(damaged)?;
        Ok((make, (PyBytes::new(py, &bytes),)))
    }

    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }
}

/// The rows of a pickle.
#[pyfunction]
pub(crate) fn _rows_from_bytes(data: &[u8]) -> PyResult<MonotoneRows> {
    let fits: Fits = read(data)?;
    if !fits.is_sound() {
        return Err(damaged("lengths do not agree"));
    }
    Ok(MonotoneRows { fits: Arc::new(fits) })
}

/// Where the rows start, and where the last one ends.
fn offsets_of(
    x: &Array<'_>,
    y: &Array<'_>,
    offsets: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<usize>> {
    if x.shape() != y.shape() {
        return Err(PyValueError::new_err(format!(
            "x and y must have the same shape, got {} and {}",
            x.shape_text(),
            y.shape_text()
        )));
    }
    let bounds = match (x.shape(), offsets) {
        (&[rows, n], None) => (0..=rows).map(|k| k * n).collect(),
        ([_], Some(offsets)) => offsets
            .try_iter()?
            .map(|item| count("offsets", 0, &item?))
            .collect::<PyResult<Vec<usize>>>()?,
        (_, None) => {
            return Err(PyValueError::new_err(format!(
                "x and y must have two axes, or one and offsets; got shape {}",
                x.shape_text()
            )));
        }
        (_, Some(_)) => {
            return Err(PyValueError::new_err(format!(
                "with offsets, x and y must have one axis; got shape {}",
                x.shape_text()
            )));
        }
    };
    let length = x.values().len();
    let wrong = (0..bounds.len()).find(|&i| {
        let (first, last) = (i == 0, i + 1 == bounds.len());
        first && bounds[i] != 0
            || !first && bounds[i] < bounds[i - 1]
            || last && bounds[i] != length
    });
    if let Some(index) = wrong {
        let error = MonotoneError::Offset { index, value: bounds[index], length };
        return Err(monotone_error(&error));
    }
    if bounds.len() < 2 {
        return Err(PyValueError::new_err("there must be at least one row, got none"));
    }
    Ok(bounds)
}

/// `kind`.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Quartic,
    Quintic,
}

fn family(object: &Bound<'_, PyAny>) -> PyResult<Kind> {
    let name = text(object).ok_or_else(|| {
        pyo3::exceptions::PyTypeError::new_err(format!(
            "kind must be a string, got {}",
            kind(object)
        ))
    })?;
    choose("kind", &name, &[("quintic", Kind::Quintic), ("quartic", Kind::Quartic)])
}

fn slopes(object: &Bound<'_, PyAny>) -> PyResult<Option<SlopesOption>> {
    if object.is_none() { Ok(None) } else { options::slopes(object).map(Some) }
}

/// Fit monotone interpolants to many rows, each with its own x, in parallel.
///
/// Parameters
/// ----------
/// x, y : array_like, shape (rows, n) or (total,)
///     Row by row; or all rows one after another, with ``offsets``.
/// kind : {"quintic", "quartic"}
///     `MonotoneQuintic` or `MonotoneQuartic`.
/// offsets : array_like of int, shape (rows + 1,), optional
///     Row k is ``x[offsets[k]:offsets[k + 1]]``, and so for y.
/// slopes : {"optimal", "fritsch-butland"} or array_like, in the shape of y, optional
///     As for the kind; None is its own default.
/// fairness : {"bending", "parametric"}
///     Of the quintic.
/// shape : float
///     Of the quartic.
/// extrapolate : {None, True, False, "linear", "clip"}
///     As for `MonotoneQuintic`.
///
/// Returns
/// -------
/// MonotoneRows
///     Evaluates row by row; indexing gives the interpolant of a row.
///
/// Raises
/// ------
/// ValueError, TypeError
///     As for the kind; the message names the row.
///
/// Notes
/// -----
/// Paper 003, see `MonotoneQuintic` and `MonotoneQuartic`. Cost O(total), on all threads.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.fit_many_monotone([0, 1, 2, 0, 3], [0, 1, 2, 0, 6], offsets=[0, 3, 5])
/// >>> f(1.0)
/// array([1., 2.])
#[pyfunction]
#[pyo3(
    signature = (x, y, kind=Kind::Quintic, *, offsets=None, slopes=None,
                 fairness=Fairness::Bending, shape=Shape::Uniform(3.0), extrapolate=None),
    text_signature = "(x, y, kind='quintic', *, offsets=None, slopes=None, fairness='bending', \
                      shape=3.0, extrapolate=None)"
)]
// One argument a keyword: this is the signature that users see.
#[allow(clippy::too_many_arguments)]
pub(crate) fn fit_many_monotone(
    py: Python<'_>,
    x: &Bound<'_, PyAny>,
    y: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = family)] kind: Kind,
    offsets: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = slopes)] slopes: Option<SlopesOption>,
    #[pyo3(from_py_with = options::fairness)] fairness: Fairness,
    #[pyo3(from_py_with = options::shape)] shape: Shape,
    #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
) -> PyResult<MonotoneRows> {
    let (x, y) = (array("x", x)?, array("y", y)?);
    let bounds = offsets_of(&x, &y, offsets)?;
    if let Some(SlopesOption::Given { shape, .. }) = &slopes
        && shape != y.shape()
    {
        return Err(PyValueError::new_err(format!(
            "slopes must have the shape of y, {}, got {shape:?}",
            y.shape_text()
        )));
    }
    let (x, y) = (x.values(), y.values());
    let of = |from: usize, to: usize| match (&slopes, kind) {
        (Some(SlopesOption::Given { values, .. }), _) => Slopes::Given(values[from..to].to_vec()),
        (Some(SlopesOption::Optimal), _) | (None, Kind::Quintic) => Slopes::Optimal,
        _ => Slopes::FritschButland,
    };
    let extrapolate = extrapolate.unwrap_or_default();
    let fits = match kind {
        Kind::Quintic => Fits::Quintic(fit_rows(py, &bounds, |from, to| {
            let options = QuinticOptions { slopes: of(from, to), fairness, extrapolate };
            monotone::MonotoneQuintic::new(&x[from..to], &y[from..to], &options)
        })?),
        Kind::Quartic => Fits::Quartic(fit_rows(py, &bounds, |from, to| {
            let slopes = of(from, to);
            let options = QuarticOptions { slopes, shape: shape.clone(), extrapolate };
            monotone::MonotoneQuartic::new(&x[from..to], &y[from..to], &options)
        })?),
    };
    Ok(MonotoneRows { fits: Arc::new(fits) })
}

fn fit_rows<F: Send>(
    py: Python<'_>,
    bounds: &[usize],
    fit: impl Fn(usize, usize) -> Result<F, MonotoneError> + Send + Sync,
) -> PyResult<Vec<F>> {
    let (rows, size) = (bounds.len() - 1, bounds[bounds.len() - 1]);
    let one = |k: usize| {
        fit(bounds[k], bounds[k + 1])
            .map_err(|source| MonotoneError::InRow { row: k, source: Box::new(source) })
    };
    interruptible(py, size, |monitor| {
        let mut fits = Vec::with_capacity(rows);
        for start in (0..rows).step_by(BATCH) {
            let batch = start..rows.min(start + BATCH);
            let some: Result<Vec<F>, MonotoneError> = if size < PARALLEL {
                batch.map(&one).collect()
            } else {
                batch.into_par_iter().map(&one).collect()
            };
            fits.extend(some?);
            if monitor() == ControlFlow::Break(()) {
                break;
            }
        }
        Ok(fits)
    })?
    .map_err(|error| monotone_error(&error))
}
