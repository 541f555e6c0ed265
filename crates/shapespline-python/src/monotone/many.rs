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
    error::{Value, invalid, monotone_error},
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

impl Kind {
    /// Options that the kind lacks are refused, not ignored.
    fn check(
        self,
        slopes: Option<&SlopesOption>,
        fairness: bool,
        clip: bool,
        shape: bool,
    ) -> PyResult<()> {
        let refuse = |argument: &str, what: &str, own: &str, other: &str| {
            let text = format!("{what} is for kind '{own}', got it with kind '{other}'");
            Err(invalid(argument, &[], Value::Nothing, text))
        };
        match self {
            Self::Quintic if shape => refuse("shape", "shape", "quartic", "quintic"),
            Self::Quartic if clip => refuse("clip", "clip=True", "quintic", "quartic"),
            Self::Quartic if fairness => refuse("fairness", "fairness", "quintic", "quartic"),
            Self::Quartic if matches!(slopes, Some(SlopesOption::Optimal)) => {
                refuse("slopes", "slopes='optimal'", "quintic", "quartic")
            }
            _ => Ok(()),
        }
    }
}

/// An option that may be left to the kind.
fn optional<T>(
    object: &Bound<'_, PyAny>,
    read: impl Fn(&Bound<'_, PyAny>) -> PyResult<T>,
) -> PyResult<Option<T>> {
    if object.is_none() { Ok(None) } else { read(object).map(Some) }
}

fn slopes(object: &Bound<'_, PyAny>) -> PyResult<Option<SlopesOption>> {
    optional(object, options::slopes)
}

fn fairness(object: &Bound<'_, PyAny>) -> PyResult<Option<Fairness>> {
    optional(object, options::fairness)
}

fn shape(object: &Bound<'_, PyAny>) -> PyResult<Option<Shape>> {
    optional(object, options::shape)
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
/// slopes : {"optimal", "fritsch-butland"} or array_like, optional
///     As for the kind, with one slope per entry of ``y``; None is its own default. Where x and y have
///     two axes, slopes of shape (n,) are for every row.
/// fairness : {"bending", "parametric"}, optional
///     For the quintic alone; None is "bending".
/// clip : bool
///     For the quintic alone: limit given slopes that no monotone function has, instead of refusing them.
/// shape : float or pair of array_like, optional
///     For the quartic alone; None is 1.
/// extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
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
///     As for the kind, where the message names the row; and for an option that the kind lacks.
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
    signature = (x, y, kind=Kind::Quintic, *, offsets=None, slopes=None, fairness=None,
                 clip=false, shape=None, extrapolate=Some(Extrapolation::LINEAR)),
    text_signature = "(x, y, kind='quintic', *, offsets=None, slopes=None, fairness=None, \
                      clip=False, shape=None, extrapolate='linear')"
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
    #[pyo3(from_py_with = fairness)] fairness: Option<Fairness>,
    clip: bool,
    #[pyo3(from_py_with = shape)] shape: Option<Shape>,
    #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
) -> PyResult<Py<PyAny>> {
    let (x, y) = (array("x", x)?, array("y", y)?);
    let ragged = offsets.is_some();
    let bounds = offsets_of(&x, &y, offsets)?;
    kind.check(slopes.as_ref(), fairness.is_some(), clip, shape.is_some())?;
    let given = match &slopes {
        // Rows of two axes may have their slopes in common.
        Some(slopes) if !ragged => {
            slopes.given(&y, [bounds.len() - 1, bounds[1]], <[f64]>::to_vec)?
        }
        Some(slopes) => slopes.given(&y, [1, y.values().len()], <[f64]>::to_vec)?,
        None => None,
    };
    let (x, y) = (x.values(), y.values());
    let of = |from: usize, to: usize| match (&slopes, &given, kind) {
        (_, Some(given), _) => Slopes::Given(given[from..to].to_vec()),
        (Some(SlopesOption::Optimal), ..) | (None, _, Kind::Quintic) => Slopes::Optimal,
        _ => Slopes::FritschButland,
    };
    let extrapolate = extrapolate.unwrap_or_default();
    let fits = match kind {
        Kind::Quintic => Fits::Quintic(fit_rows(py, &bounds, |from, to, go_on| {
            let fairness = fairness.unwrap_or_default();
            let options = QuinticOptions { slopes: of(from, to), fairness, clip, extrapolate };
            monotone::MonotoneQuintic::new_with(&x[from..to], &y[from..to], &options, go_on)
        })?),
        Kind::Quartic => Fits::Quartic(fit_rows(py, &bounds, |from, to, _| {
            let (slopes, shape) = (of(from, to), shape.clone().unwrap_or_default());
            let options = QuarticOptions { slopes, shape, extrapolate };
            monotone::MonotoneQuartic::new(&x[from..to], &y[from..to], &options)
        })?),
    };
    PiecewiseRows::of(fits, ragged).into_python(py)
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
