// SPDX-License-Identifier: MIT OR Apache-2.0

//! Arc length and samples.

use pyo3::prelude::*;
use shapespline::{
    geometry::{ArcLength, Side},
    polynomial::parallel,
};

use super::SpaceCurve;
use crate::{
    error::input_error,
    options::{self, Spacing},
    output::{FloatArray, filled, room},
    work::{GoOn, interruptible, parts},
};

#[pymethods]
impl SpaceCurve {
    /// Length of the curve between two parameters, in units of the points.
    ///
    /// Parameters
    /// ----------
    /// a, b : float, optional
    ///     Parameters; default the first and the last. With ``a > b`` the length is negative. Outside
    ///     an open curve the end polynomials are measured; a closed curve is gone around.
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If ``a`` or ``b`` is not finite.
    ///
    /// Notes
    /// -----
    /// Adaptive Gauss–Legendre quadrature with ten points, each segment to 1e-13 of the length of its
    /// Bézier polygon. Cost O(n).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> curve = ss.NuSpline([[0, 0], [3, 4], [6, 8]])
    /// >>> round(curve.arc_length(), 12), round(curve.arc_length(5, 0), 12)
    /// (10.0, -5.0)
    #[pyo3(signature = (a=None, b=None))]
    fn arc_length(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = options::a)] a: Option<f64>,
        #[pyo3(from_py_with = options::b)] b: Option<f64>,
    ) -> PyResult<f64> {
        let cubic = self.curve.cubic();
        let knots = cubic.knots();
        let (a, b) = (a.unwrap_or(knots[0]), b.unwrap_or(knots[knots.len() - 1]));
        let of = |go_on: GoOn<'_>| {
            ArcLength::new_with(self.curve.path(), go_on).map(|lengths| lengths.between(a, b))
        };
        // Nothing comes of it only after Ctrl-C, which is an error already.
        Ok(interruptible(py, cubic.segments(), of)?.unwrap_or(f64::NAN))
    }

    /// Points on the curve from its first to its last point, evenly spaced.
    ///
    /// Parameters
    /// ----------
    /// n : int
    ///     Number of points, at least 1.
    /// by : {"parameter", "arc-length"}
    ///     What is even.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n, dim)
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If ``n`` is less than 1 or ``by`` unknown.
    ///
    /// Notes
    /// -----
    /// By arc length, each sample takes a few steps of Newton's method kept in a bracket.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.NuSpline([[0, 0], [3, 4], [6, 8]]).sample(3, by="arc-length").round(12)
    /// array([[0., 0.],
    ///        [3., 4.],
    ///        [6., 8.]])
    #[pyo3(
        signature = (n, by=Spacing::Parameter),
        text_signature = "($self, n, by='parameter')"
    )]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = options::n)] n: usize,
        #[pyo3(from_py_with = options::by)] by: Spacing,
    ) -> PyResult<FloatArray<'py>> {
        let (cubic, path, columns) = (self.curve.cubic(), self.curve.path(), self.columns());
        room(n, columns)?;
        let knots = cubic.knots();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let share = |i: usize| i as f64 / (n - 1).max(1) as f64;
        let by_parameter = |i: usize| {
            if i == n - 1 && i > 0 { last } else { first + share(i) * (last - first) }
        };
        filled(py, &[n, columns], |out| {
            interruptible(py, n.max(cubic.segments()), |go_on| {
                let lengths = match by {
                    Spacing::Parameter => None,
                    Spacing::ArcLength => match ArcLength::new_with(path, go_on) {
                        None => return Ok(()),
                        lengths => lengths,
                    },
                };
                let parameter = |i: usize| match &lengths {
                    // The last point, whatever its share of the length rounds to.
                    Some(lengths) if i < n - 1 || i == 0 => {
                        lengths.parameter(share(i) * lengths.total())
                    }
                    _ => by_parameter(i),
                };
                for part in parts(n) {
                    if go_on().is_break() {
                        break;
                    }
                    let out = &mut out[part.start * columns..part.end * columns];
                    // In parallel only where the pool of this process was entered.
                    let many = match rayon::current_thread_index() {
                        Some(_) if lengths.is_some() => 0,
                        _ => usize::MAX,
                    };
                    let u: Vec<f64> =
                        parallel::map(part.len(), many, |k| parameter(part.start + k));
                    path.evaluate_into(&u, 0, Side::Right, out)?;
                }
                Ok(())
            })?
            .map_err(input_error)
        })
    }
}
