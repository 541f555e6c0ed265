// SPDX-License-Identifier: MIT OR Apache-2.0

//! Many data sets with their own x in one call: `fit_many_monotone`.

use pyo3::{exceptions::PyTypeError, prelude::*};
use shapespline::monotone::{
    self, CubicOptions, Ends, Extrapolation, Fairness, MonotoneError, QuarticOptions,
    QuinticOptions, ShapeParameters, Slopes,
};

use super::{
    fits::{Fits, fit_all},
    options::{self, ConvexOption, SlopesOption},
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
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum MonotoneKind {
    Cubic,
    Quartic,
    Quintic,
}

const KINDS: [(&str, MonotoneKind); 3] = [
    ("cubic", MonotoneKind::Cubic),
    ("quintic", MonotoneKind::Quintic),
    ("quartic", MonotoneKind::Quartic),
];

fn family(object: &Bound<'_, PyAny>) -> PyResult<MonotoneKind> {
    let name = text(object).ok_or_else(|| {
        PyTypeError::new_err(format!("kind must be a string, got {}", kind(object)))
    })?;
    choose("kind", &name, &KINDS)
}

impl MonotoneKind {
    /// Refuse an option that the kind lacks, instead of ignoring it, where it is `given`.
    fn allows(self, argument: &str, what: &str, given: bool, kinds: &[Self]) -> PyResult<()> {
        if !given || kinds.contains(&self) {
            return Ok(());
        }
        let name = |kind: Self| KINDS.iter().find(|(_, k)| *k == kind).map_or("", |(name, _)| name);
        let own: Vec<String> = kinds.iter().map(|k| format!("'{}'", name(*k))).collect();
        let (own, other) = (own.join(" and "), name(self));
        let text = format!("{what} is for kind {own}, got it with kind '{other}'");
        Err(invalid(argument, &[], Value::Nothing, text))
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

fn energy(object: &Bound<'_, PyAny>) -> PyResult<Option<Fairness>> {
    optional(object, options::energy)
}

fn shape(object: &Bound<'_, PyAny>) -> PyResult<Option<ShapeParameters>> {
    optional(object, options::shape)
}

fn ends(object: &Bound<'_, PyAny>) -> PyResult<Option<Ends>> {
    optional(object, options::ends)
}

fn layer(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    optional(object, options::layer)
}

fn min_slope(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    optional(object, options::min_slope)
}

/// Fit monotone interpolants to many rows, each with its own x, in parallel.
///
/// Parameters
/// ----------
/// x, y : array_like, shape (rows, n) or (total,)
///     Row by row; or all rows one after another, with ``offsets``.
/// kind : {"cubic", "quintic", "quartic"}
///     `MonotoneCubic`, `MonotoneQuintic` or `MonotoneQuartic`.
/// offsets : array_like of int, shape (rows + 1,), optional
///     Row k is ``x[offsets[k]:offsets[k + 1]]``, and so for y.
/// slopes : {"optimal", "fritsch-butland"} or array_like, optional
///     As for the kind, with one slope per entry of ``y``; None is its own default. Where x and y have
///     two axes, slopes of shape (n,) are for every row. The cubic takes numbers alone, NaN where free.
/// convex, ends, layer, min_slope
///     For the cubic alone, as for `MonotoneCubic`; None is its own default. Signs of ``convex`` are of
///     shape (n - 1,) or (rows, n - 1); with offsets there are none.
/// energy : {"bending", "parametric"}, optional
///     For the quintic alone; None is "bending".
/// clip : bool
///     For the quintic alone: limit given slopes that no monotone function has, instead of refusing them.
/// shape : float or pair of array_like, optional
///     For the quartic alone; None is 1.
/// extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
///     As for `MonotoneCubic`.
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
/// See `MonotoneCubic`, `MonotoneQuintic` and `MonotoneQuartic`. Cost O(total), on all threads.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.fit_many_monotone([0, 1, 2, 0, 3], [0, 1, 2, 0, 6], offsets=[0, 3, 5])
/// >>> f(1.0)
/// array([1., 2.])
#[pyfunction]
#[pyo3(
    signature = (x, y, *, kind=MonotoneKind::Cubic, offsets=None, convex=ConvexOption::Nowhere, slopes=None,
                 ends=None, layer=None,
                 min_slope=None, energy=None, clip=false, shape=None,
                 extrapolate=Some(Extrapolation::LINEAR)),
    text_signature = "(x, y, *, kind='cubic', offsets=None, convex=None, slopes=None, ends=None, layer=None, \
                      min_slope=None, energy=None, clip=False, shape=None, \
                      extrapolate='linear')"
)]
// One argument per keyword: this is the signature that users see.
#[allow(clippy::too_many_arguments)]
pub(crate) fn fit_many_monotone(
    py: Python<'_>,
    x: &Bound<'_, PyAny>,
    y: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = family)] kind: MonotoneKind,
    offsets: Option<Offsets>,
    #[pyo3(from_py_with = options::convex)] convex: ConvexOption,
    #[pyo3(from_py_with = slopes)] slopes: Option<SlopesOption>,
    #[pyo3(from_py_with = ends)] ends: Option<Ends>,
    #[pyo3(from_py_with = layer)] layer: Option<f64>,
    #[pyo3(from_py_with = min_slope)] min_slope: Option<f64>,
    #[pyo3(from_py_with = energy)] energy: Option<Fairness>,
    clip: bool,
    #[pyo3(from_py_with = shape)] shape: Option<ShapeParameters>,
    #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
) -> PyResult<Py<PyAny>> {
    let (x, y) = (array("x", x)?, array("y", y)?);
    let ragged = offsets.is_some();
    let bounds = offsets_of(&x, &y, offsets)?;
    let (cubic, quintic) = (&[MonotoneKind::Cubic][..], &[MonotoneKind::Quintic][..]);
    kind.allows("convex", "convex", !matches!(convex, ConvexOption::Nowhere), cubic)?;
    kind.allows("ends", "ends", ends.is_some(), cubic)?;
    kind.allows("layer", "layer", layer.is_some(), cubic)?;
    kind.allows("min_slope", "min_slope", min_slope.is_some(), cubic)?;
    kind.allows("energy", "energy", energy.is_some(), quintic)?;
    kind.allows("clip", "clip=True", clip, quintic)?;
    kind.allows("shape", "shape", shape.is_some(), &[MonotoneKind::Quartic])?;
    let optimal = matches!(slopes, Some(SlopesOption::Optimal));
    kind.allows("slopes", "slopes='optimal'", optimal, quintic)?;
    let named = matches!(slopes, Some(SlopesOption::FritschButland));
    let paper = [MonotoneKind::Quintic, MonotoneKind::Quartic];
    kind.allows("slopes", "slopes='fritsch-butland'", named, &paper)?;
    let given = match slopes.as_ref().and_then(SlopesOption::given) {
        // Rows of two axes may have their slopes in common.
        Some(slopes) if !ragged => {
            Some(slopes.columns(&y, [bounds.len() - 1, bounds[1]], <[f64]>::to_vec)?)
        }
        Some(slopes) => Some(slopes.columns(&y, [1, y.values().len()], <[f64]>::to_vec)?),
        None => None,
    };
    let rows = bounds.len() - 1;
    let convex = if !ragged {
        convex.columns(&y, 1, [rows, bounds[1]])?
    } else if let ConvexOption::Signs { shape, .. } = &convex {
        return Err(must("convex", &[], "be None or 'data' where there are offsets", &shape[..]));
    } else {
        convex.columns(&y, 0, [rows, 2])?
    };
    let (x, y) = (x.values(), y.values());
    let of = |from: usize, to: usize| match (&slopes, &given, kind) {
        (_, Some(given), _) => Slopes::Given(given[from..to].to_vec()),
        (Some(SlopesOption::Optimal), ..) | (None, _, MonotoneKind::Quintic) => Slopes::Optimal,
        _ => Slopes::FritschButland,
    };
    let extrapolate = extrapolate.unwrap_or_default();
    let fits = match kind {
        MonotoneKind::Cubic => Fits::Cubic(fit_rows(py, &bounds, |k, [from, to], go_on| {
            let default = CubicOptions::default();
            let options = CubicOptions {
                ends: ends.clone().unwrap_or(default.ends),
                slopes: given.as_ref().map(|given| given[from..to].to_vec()),
                layer: layer.unwrap_or(default.layer),
                min_slope: min_slope.unwrap_or(default.min_slope),
                convex: convex[k].clone(),
                extrapolate,
            };
            monotone::MonotoneCubic::new_with(&x[from..to], &y[from..to], &options, go_on)
        })?),
        MonotoneKind::Quintic => Fits::Quintic(fit_rows(py, &bounds, |_, [from, to], go_on| {
            let fairness = energy.unwrap_or_default();
            let options = QuinticOptions { slopes: of(from, to), fairness, clip, extrapolate };
            monotone::MonotoneQuintic::new_with(&x[from..to], &y[from..to], &options, go_on)
        })?),
        MonotoneKind::Quartic => Fits::Quartic(fit_rows(py, &bounds, |_, [from, to], _| {
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
    fit: impl Fn(usize, [usize; 2], GoOn<'_>) -> Result<F, MonotoneError> + Send + Sync,
) -> PyResult<Vec<F>> {
    let (rows, size) = (bounds.len() - 1, bounds[bounds.len() - 1]);
    fit_all(py, size, rows, |k, go_on| fit(k, [bounds[k], bounds[k + 1]], go_on))?.map_err(
        |(row, source)| monotone_error(&MonotoneError::InRow { row, source: Box::new(source) }),
    )
}
