//! Arc length and samples.

use pyo3::prelude::*;
use rayon::prelude::*;
use shapespline::geometry::{ArcLength, Side};

use super::SpaceCurve;
use crate::{
    error::input_error,
    options::{self, Spacing},
    output::{FloatArray, room, shaped, zeros},
    work::detached,
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
    ) -> f64 {
        let cubic = self.curve.cubic();
        let knots = cubic.knots();
        let (a, b) = (a.unwrap_or(knots[0]), b.unwrap_or(knots[knots.len() - 1]));
        detached(py, cubic.segments(), || ArcLength::new(self.curve.path()).between(a, b))
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
        let (cubic, columns) = (self.curve.cubic(), self.columns());
        room(n, columns)?;
        let mut u = zeros(n, 1)?;
        let values = detached(py, n.max(cubic.segments()), || {
            let knots = cubic.knots();
            let (first, last) = (knots[0], knots[knots.len() - 1]);
            let part = |i: usize| i as f64 / (n - 1).max(1) as f64;
            let end = n - 1;
            match by {
                Spacing::Parameter => u.iter_mut().enumerate().for_each(|(i, u)| {
                    *u = if i == end && i > 0 { last } else { first + part(i) * (last - first) };
                }),
                Spacing::ArcLength => {
                    let lengths = ArcLength::new(self.curve.path());
                    let total = lengths.total();
                    let of = |(i, u): (usize, &mut f64)| *u = lengths.parameter(part(i) * total);
                    if n < 1024 {
                        u.iter_mut().enumerate().for_each(of);
                    } else {
                        // In parallel only where the pool of this process was entered.
                        match rayon::current_thread_index() {
                            Some(_) => u.par_iter_mut().enumerate().for_each(of),
                            None => u.iter_mut().enumerate().for_each(of),
                        }
                    }
                }
            }
            self.curve.path().evaluate_many(&u, 0, Side::Right)
        })
        .map_err(input_error)?;
        shaped(py, values, &[n, columns])
    }
}
