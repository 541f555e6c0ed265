// SPDX-License-Identifier: MIT OR Apache-2.0

//! `smooth_monotone`, and the record of how it smoothed.

use pyo3::{exceptions::PyTypeError, prelude::*};
use shapespline::monotone::{self, PenaltyChoice, SmoothOptions};

use super::{
    cubic::MonotoneCubic,
    families::{Data, object},
    fits::Fits,
    options::{self, ConvexOption},
};
use crate::{
    error::{invalid, must},
    input::{array, float, kind, reworded, text},
    options::unknown,
    pickle::{self, PickledKind, Reduced},
};

/// How noisy data were smoothed.
///
/// Attributes
/// ----------
/// penalty : float
///     The penalty λ; infinite for a straight line.
/// residual : float
///     The weighted sum of squares Σw(y − f)².
/// degrees_of_freedom : float
///     Trace of the derivative of the values with respect to the data, where active constraints stay
///     active.
/// increasing : bool
///     Whether the function increases.
/// steps : int
///     Linear systems solved for the final penalty.
/// converged : bool
///     Whether the optimum was reached.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> how = ss.smooth_monotone([0, 1, 2, 3], [0, 1, 2, 3], penalty=1.0).smoothing
/// >>> how.converged, how.increasing, how.steps
/// (True, True, 1)
#[pyclass(module = "shapespline", frozen, get_all, eq, weakref)]
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct MonotoneSmoothing {
    /// The penalty λ; infinite for a straight line.
    penalty: f64,
    /// The weighted sum of squares Σw(y − f)².
    residual: f64,
    /// Trace of the derivative of the values with respect to the data.
    degrees_of_freedom: f64,
    /// Whether the function increases, or decreases.
    increasing: bool,
    /// Linear systems solved for the final penalty.
    steps: usize,
    /// Whether the optimum was reached.
    converged: bool,
}

impl MonotoneSmoothing {
    pub(super) fn of(how: &monotone::Smoothing) -> Self {
        Self {
            penalty: how.penalty,
            residual: how.residual,
            degrees_of_freedom: how.degrees_of_freedom,
            increasing: how.increasing,
            steps: how.steps,
            converged: how.converged,
        }
    }
}

#[pymethods]
impl MonotoneSmoothing {
    fn __repr__(&self) -> String {
        let truth = |value| if value { "True" } else { "False" };
        format!(
            "MonotoneSmoothing(penalty={:e}, residual={:e}, degrees_of_freedom={}, \
             increasing={}, steps={}, converged={})",
            self.penalty,
            self.residual,
            self.degrees_of_freedom,
            truth(self.increasing),
            self.steps,
            truth(self.converged),
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        pickle::reduce_whole(slf, PickledKind::MonotoneSmoothing)
    }
}

/// Smooth noisy data with a monotone cubic.
///
/// Parameters
/// ----------
/// x : array_like, shape (n,)
///     Not decreasing, with at least two distinct values. Equal and nearly equal abscissae (within 1e-9
///     of their range) are merged: weights add up, values are averaged.
/// y : array_like, shape (n,)
///     Noisy data.
/// weights : array_like, shape (n,), optional
///     Positive weights; 1 by default. Where the noise is known, the inverse of its variance.
/// residual : float, optional
///     The largest sum of squares Σw(y − f)² to leave; the penalty follows from it.
/// penalty : {"gcv"} or float
///     The penalty λ of the bending energy. ``"gcv"`` minimises the generalized cross-validation score,
///     counting only degrees of freedom that no constraint holds. 0 is the isotonic regression, which
///     interpolates monotone data. Give a number or ``residual``, not both.
/// increasing : bool or None
///     Whether the function increases. None takes the sign of the weighted regression line;
///     ``smoothing.increasing`` says which.
/// convex : {-1, 0, 1} or array_like of int, shape (n - 1,), optional
///     Where the function is to be convex (1) or concave (-1) as well: everywhere, or per interval
///     between the x, 0 where it may bend either way.
/// bounds : pair of float or None, optional
///     Lower and upper bound of the function, None where there is none. The data may lie outside.
///
/// Returns
/// -------
/// MonotoneCubic
///     The function of least ``Σ w (y − f(x))² + λ ∫ f''² dx`` among all monotone functions, with
///     ``convex`` among those that are convex and concave as well where that is asked. Its attribute
///     ``smoothing`` is a `MonotoneSmoothing`; its ``x`` and ``y`` are the (merged) abscissae and its own
///     values there.
///
/// Raises
/// ------
/// ValueError
///     If an argument holds unusable values: NaN, infinities, x that decreases or is constant, weights
///     that are not positive, both a residual and a penalty, a residual below the least possible one
///     (that of the isotonic regression), a lower bound that is not below the upper one, signs other than
///     -1, 0 and 1, no penalty with ``convex`` (the function would have kinks). The message says where.
/// TypeError
///     If an argument is of a wrong kind.
///
/// See Also
/// --------
/// MonotoneCubic : interpolation, for data without noise.
///
/// Notes
/// -----
/// The objective is jointly convex in the first value, the rises and the slopes; an interior-point
/// method and Newton's method solve it to rounding, in O(n) per step of some 20. Where monotonicity is
/// no constraint, the function equals SciPy's ``make_smoothing_spline(x, y, w, lam)``. The second
/// derivative is continuous but where intervals of which convexity is asked differently meet, at points
/// of slope 0 beside such intervals, and at the ends of constant parts.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.smooth_monotone([0, 1, 2, 3, 4], [0.1, 0.0, 0.6, 1.1, 0.9], penalty=0.1)
/// >>> bool((f.slopes >= 0).all()), f.smoothing.converged
/// (True, True)
#[pyfunction]
#[pyo3(
    signature = (x, y, *, weights=None, residual=None, penalty=None, increasing=Some(true), convex=None,
                 bounds=None),
    text_signature = "(x, y, *, weights=None, residual=None, penalty='gcv', increasing=True, \
                      convex=None, bounds=None)"
)]
#[allow(clippy::too_many_arguments)]
pub(crate) fn smooth_monotone<'py>(
    x: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = weights)] weights: Option<Vec<f64>>,
    #[pyo3(from_py_with = residual)] residual: Option<f64>,
    #[pyo3(from_py_with = penalty)] penalty: Option<f64>,
    #[pyo3(from_py_with = increasing)] increasing: Option<bool>,
    #[pyo3(from_py_with = convex)] convex: Option<ConvexOption>,
    #[pyo3(from_py_with = bounds)] bounds: Option<[f64; 2]>,
) -> PyResult<Bound<'py, MonotoneCubic>> {
    let choice = match (residual, penalty) {
        (Some(_), Some(penalty)) => {
            let text = "penalty must be left out where residual is given; pass one of them";
            return Err(invalid("penalty", &[], penalty, text));
        }
        (Some(residual), None) => PenaltyChoice::FromResidual(residual),
        (None, Some(penalty)) => PenaltyChoice::Fixed(penalty),
        (None, None) => PenaltyChoice::CrossValidated,
    };
    let data = Data::of(x, y, 0)?;
    if !data.is_one() {
        return Err(must("y", &[], "have one axis", array("y", y)?.shape()));
    }
    let convex = convex.map(|convex| convex.of_one(data.points())).transpose()?.flatten();
    let options = SmoothOptions {
        weights,
        penalty: choice,
        increasing,
        convex,
        bounds,
        ..SmoothOptions::default()
    };
    let fits =
        data.fit(x.py(), |x, y, _, go_on| monotone::smooth_monotone_with(x, y, &options, go_on))?;
    Bound::new(x.py(), object(Fits::Cubic(fits), data.into_layout(), MonotoneCubic))
}

fn weights(object: &Bound<'_, PyAny>) -> PyResult<Option<Vec<f64>>> {
    if object.is_none() {
        return Ok(None);
    }
    let weights = array("weights", object)?;
    match weights.shape() {
        [_] => Ok(Some(weights.values().to_vec())),
        shape => Err(must("weights", &[], "have one axis", shape)),
    }
}

fn residual(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { options::finite("residual", object).map(Some) }
}

/// A number, or `None` for cross-validation.
fn penalty(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    match text(object) {
        Some(name) if name == "gcv" => Ok(None),
        Some(name) => Err(unknown("penalty", &name, "'gcv', a number")),
        None => options::finite("penalty", object).map(Some),
    }
}

fn increasing(object: &Bound<'_, PyAny>) -> PyResult<Option<bool>> {
    if object.is_none() {
        return Ok(None);
    }
    object.extract::<bool>().map(Some).map_err(|error| {
        reworded(object.py(), error, |_| {
            let text = format!("increasing must be True, False or None, got {}", kind(object));
            PyTypeError::new_err(text)
        })
    })
}

/// Signs: one for all intervals or one each. What noisy data are says nothing of the function.
fn convex(object: &Bound<'_, PyAny>) -> PyResult<Option<ConvexOption>> {
    match text(object) {
        Some(name) => {
            let expected =
                "None, 1, -1, an array of signs per interval (noisy data bend both ways)";
            Err(unknown("convex", &name, expected))
        }
        None => options::convex(object).map(Some),
    }
}

fn bounds(object: &Bound<'_, PyAny>) -> PyResult<Option<[f64; 2]>> {
    if object.is_none() {
        return Ok(None);
    }
    let length = object.len()?;
    if length != 2 {
        return Err(must("bounds", &[], "be a pair", length));
    }
    let side = |k: usize, none: f64| {
        let item = object.get_item(k)?;
        if item.is_none() { Ok(none) } else { float(["bounds[0]", "bounds[1]"][k], &item) }
    };
    Ok(Some([side(0, f64::NEG_INFINITY)?, side(1, f64::INFINITY)?]))
}
