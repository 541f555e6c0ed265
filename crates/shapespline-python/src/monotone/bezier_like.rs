// SPDX-License-Identifier: MIT OR Apache-2.0

//! The paper's curves themselves.

use pyo3::prelude::*;
use shapespline::monotone::BezierLike;

use super::options;
use crate::{
    error::{invalid, monotone_error, must},
    input::{Query, array, count},
    output::{FloatArray, shaped},
};

fn degree(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    count("degree", 0, object)
}

fn alpha(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { options::finite("alpha", object).map(Some) }
}
fn beta(object: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if object.is_none() { Ok(None) } else { options::finite("beta", object).map(Some) }
}

/// Evaluate a cubic, quartic or quintic Bézier-like curve, or a derivative of it.
///
/// Parameters
/// ----------
/// degree : {3, 4, 5}
///     The degree of the curve.
/// control : array_like, shape (4, dim) or (4,)
///     Control points V₀ … V₃ in any dimension; the curve runs from V₀ to V₃.
/// t : array_like
///     Parameters, of any shape; the curve proper is 0 ≤ t ≤ 1.
/// a, b : float
///     The end derivatives are a(V₁ - V₀) and b(V₃ - V₂): the paper's a, and its b of the cubic, q of
///     the quartic, g of the quintic.
/// alpha, beta : float
///     Shape parameters of the quartic and the quintic: growing ones pull the curve towards V₁ (α) and
///     V₂ (β) in a nested family.
/// nu : int
///     Order of the derivative.
///
/// Returns
/// -------
/// numpy.ndarray, shape (*t.shape, dim)
///     Points, or derivatives with respect to t; for ``control`` of shape (4,) without the last axis.
///
/// Raises
/// ------
/// ValueError, TypeError
///     If an argument is of a wrong kind or shape, not finite, or of no meaning for the degree.
///
/// Notes
/// -----
/// Equations (1), (3) and (7) of Ng, Kong and Ong (paper 003), with the corrected p = a/2, q = g/2 in
/// (7). The curve lies in the convex hull of its control points while the parameters a, b (and αa, βb)
/// of the cubics it mixes are in [0, 3]; a = b = 3 of the cubic is the Bézier curve. Cost O(1) a point.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> square = [[0, 0], [0, 1], [1, 1], [1, 0]]
/// >>> ss.bezier_like(3, square, 0.5)
/// array([0.5 , 0.75])
/// >>> ss.bezier_like(5, square, [0.0, 1.0], a=2, alpha=0.5)
/// array([[0., 0.],
///        [1., 0.]])
#[pyfunction]
#[pyo3(
    signature = (degree, control, t, *, a=3.0, b=3.0, alpha=None, beta=None, nu=0),
    text_signature = "(degree, control, t, *, a=3.0, b=3.0, alpha=None, beta=None, nu=0)"
)]
// One argument a keyword: this is the signature that users see.
#[allow(clippy::too_many_arguments)]
pub(crate) fn bezier_like<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = degree)] degree: usize,
    control: &Bound<'py, PyAny>,
    t: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = options::a)] a: f64,
    #[pyo3(from_py_with = options::b)] b: f64,
    #[pyo3(from_py_with = alpha)] alpha: Option<f64>,
    #[pyo3(from_py_with = beta)] beta: Option<f64>,
    #[pyo3(from_py_with = options::nu)] nu: usize,
) -> PyResult<FloatArray<'py>> {
    let curve = match degree {
        3 if alpha.or(beta).is_some() => {
            let given = if alpha.is_some() { "alpha" } else { "beta" };
            let text = "alpha and beta are for degree 4 and 5, got degree 3";
            return Err(invalid(given, &[], alpha.or(beta).unwrap_or_default(), text));
        }
        3 => BezierLike::Cubic { a, b },
        4 | 5 => {
            let (alpha, beta) = (alpha.unwrap_or(1.0), beta.unwrap_or(1.0));
            if degree == 4 {
                BezierLike::Quartic { a, q: b, alpha, beta }
            } else {
                BezierLike::Quintic { a, g: b, alpha, beta }
            }
        }
        _ => {
            return Err(must("degree", &[], "be 3, 4 or 5", degree));
        }
    };
    let control = array("control", control)?;
    let columns: &[usize] = match control.shape() {
        [4] => &[],
        [4, dim] if *dim > 0 => &control.shape()[1..],
        shape => return Err(must("control", &[], "have shape (4, dim) or (4,)", shape)),
    };
    let evaluate = |t: &[f64]| {
        curve.evaluate(control.values(), t, nu.min(6)).map_err(|error| monotone_error(&error))
    };
    match Query::named("t", t)? {
        Query::One(t) => shaped(py, evaluate(&[t])?, columns),
        Query::Many(t) => shaped(py, evaluate(t.values())?, &[t.shape(), columns].concat()),
    }
}
