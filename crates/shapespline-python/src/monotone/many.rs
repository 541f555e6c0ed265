//! Many data sets with their own x in one call: `fit_many_monotone`.

use pyo3::{exceptions::PyTypeError, prelude::*};
use shapespline::monotone::{
    self, Extrapolation, Fairness, MonotoneError, QuarticOptions, QuinticOptions, Shape, Slopes,
};

use super::{
    fits::{Fits, fit_all},
    options::{self, SlopesOption},
    places::check_offsets,
    rows::PiecewiseRows,
};
use crate::{
    error::{Value, invalid, monotone_error, must},
    input::{Array, Offsets, array, kind, text},
    options::choose,
    work::GoOn,
};

/// Where the rows start, and where the last one ends.
fn offsets_of(x: &Array<'_>, y: &Array<'_>, offsets: Option<Offsets>) -> PyResult<Vec<usize>> {
    if x.shape() != y.shape() {
        let [of_x, of_y] = [x, y].map(Array::shape_text);
        let text = format!("x and y must have the same shape, got {of_x} and {of_y}");
        return Err(invalid("y", &[], y.shape(), text));
    }
    let bounds = match (x.shape(), offsets) {
        (&[rows, n], None) => (0..=rows).map(|k| k * n).collect(),
        ([_], Some(Offsets(bounds))) => bounds,
        (_, None) => {
            let text = format!(
                "x and y must have two axes, or one and offsets; got shape {}",
                x.shape_text()
            );
            return Err(invalid("x", &[], x.shape(), text));
        }
        (_, Some(_)) => {
            let text =
                format!("with offsets, x and y must have one axis; got shape {}", x.shape_text());
            return Err(invalid("x", &[], x.shape(), text));
        }
    };
    check_offsets(&bounds, x.values().len())?;
    if bounds.len() < 2 {
        return Err(invalid("x", &[], Value::Nothing, "there must be at least one row, got none"));
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
        PyTypeError::new_err(format!("kind must be a string, got {}", kind(object)))
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
    offsets: Option<Offsets>,
    #[pyo3(from_py_with = slopes)] slopes: Option<SlopesOption>,
    #[pyo3(from_py_with = options::fairness)] fairness: Fairness,
    #[pyo3(from_py_with = options::shape)] shape: Shape,
    #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
) -> PyResult<Py<PyAny>> {
    let (x, y) = (array("x", x)?, array("y", y)?);
    let bounds = offsets_of(&x, &y, offsets)?;
    if let Some(SlopesOption::Given { shape, .. }) = &slopes
        && shape != y.shape()
    {
        let rule = format!("have the shape of y, {}", y.shape_text());
        return Err(must("slopes", &[], rule, &shape[..]));
    }
    let (x, y) = (x.values(), y.values());
    let of = |from: usize, to: usize| match (&slopes, kind) {
        (Some(SlopesOption::Given { values, .. }), _) => Slopes::Given(values[from..to].to_vec()),
        (Some(SlopesOption::Optimal), _) | (None, Kind::Quintic) => Slopes::Optimal,
        _ => Slopes::FritschButland,
    };
    let extrapolate = extrapolate.unwrap_or_default();
    let fits = match kind {
        Kind::Quintic => Fits::Quintic(fit_rows(py, &bounds, |from, to, go_on| {
            let options = QuinticOptions { slopes: of(from, to), fairness, extrapolate };
            monotone::MonotoneQuintic::new_with(&x[from..to], &y[from..to], &options, go_on)
        })?),
        Kind::Quartic => Fits::Quartic(fit_rows(py, &bounds, |from, to, _| {
            let slopes = of(from, to);
            let options = QuarticOptions { slopes, shape: shape.clone(), extrapolate };
            monotone::MonotoneQuartic::new(&x[from..to], &y[from..to], &options)
        })?),
    };
    PiecewiseRows::of(fits).into_python(py)
}

fn fit_rows<F: Send>(
    py: Python<'_>,
    bounds: &[usize],
    fit: impl Fn(usize, usize, GoOn<'_>) -> Result<F, MonotoneError> + Send + Sync,
) -> PyResult<Vec<F>> {
    let (rows, size) = (bounds.len() - 1, bounds[bounds.len() - 1]);
    fit_all(py, size, rows, |k, go_on| fit(bounds[k], bounds[k + 1], go_on))?.map_err(
        |(row, source)| monotone_error(&MonotoneError::InRow { row, source: Box::new(source) }),
    )
}
