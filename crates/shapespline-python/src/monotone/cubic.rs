// SPDX-License-Identifier: MIT OR Apache-2.0

//! `MonotoneCubic`, and the least energy that it has.

use pyo3::{IntoPyObjectExt, PyClassInitializer, prelude::*};
use shapespline::monotone::{self, CubicOptions, Ends, Extrapolation};

use super::{
    families::{Data, object},
    fits::Fits,
    options::{self, ConvexOption, Given},
    smooth::MonotoneSmoothing,
    spline::MonotoneSpline,
};
use crate::output::shaped;

/// C² monotone cubic interpolation: of all monotone functions the one with the least bending energy.
///
/// Parameters
/// ----------
/// x : array_like, shape (n,)
///     Strictly increasing, n ≥ 2.
/// y : array_like
///     Data of any shape with n entries along ``axis``; every column is fitted, in parallel.
/// axis : int
///     The axis of y that goes with x.
/// convex : {"data"} or array_like of int, optional
///     Where the function is to be convex or concave as well: ``"data"``, wherever the data are; or per
///     interval 1 (convex), -1 (concave) or 0 (not asked), of shape (n - 1,) or as y with n - 1 entries
///     along its axis. 1 beside -1 makes the point between them one of inflection. Where the data are
///     neither convex nor concave throughout, intervals get up to eight knots.
/// slopes : array_like, optional
///     Slopes at the points, NaN where they are free (in the shape of ``y``, or (n,) for every column).
///     A slope against the data is refused; the second derivative jumps at given slopes.
/// ends : {"estimated", "natural", "periodic"} or pair of float or None
///     ``"estimated"``: the slope of the cubic through the four points at the end, so that smooth data
///     are followed to order four. ``"natural"``: free, the least energy. ``"periodic"``: f(x + T) =
///     f(x) + D with the width T and the rise D of the data. A pair of slopes, None where free.
/// layer : float
///     Share of an interval beside a turn or a flat in which the second derivative falls to its value
///     there, from 0 to 0.25. With 0 the energy is the least, and the function C¹ at turns and flats;
///     with more it is C² everywhere, for at most ``(1 - layer)**-2`` times the energy.
/// min_slope : float
///     Share of the smallest secant slope of an interval and its neighbours below which the derivative
///     never falls there where the data are strictly monotone, from 0 to less than 1.
/// extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
///     Outside the data: the tangent line at the end, which is the monotone continuation of least
///     energy; the end value, the function repeated (with ``ends="periodic"`` up to the rise over a
///     period), the end polynomial, NaN; of a pair the first below the data, the second above. None is
///     "linear".
///
/// Raises
/// ------
/// ValueError
///     If an argument holds unusable values: NaN, infinities, x that does not increase, lengths that
///     differ, a slope that no monotone function through the data has, unknown names. The message says
///     where.
/// TypeError
///     If an argument is of a wrong kind.
///
/// See Also
/// --------
/// minimal_bending : the least energy that any monotone function through the data has.
///
/// Notes
/// -----
/// Between two points the function is one cubic, or a parabola of slope that falls to zero, a level
/// part and one that rises: at most two knots more per interval. The slopes at the points are the only
/// unknowns of a convex problem, which Newton's method on a tridiagonal system solves to rounding in
/// three to eight steps; ``lower_bound`` and ``interval_gaps`` prove it (Fenchel duality). Data that
/// are not monotone are fitted piecewise; flats stay flat. Andersson and Elfving, *Interpolation and
/// approximation by monotone cubic splines*, J. Approx. Theory 66 (1991) 302–333,
/// doi:10.1016/0021-9045(91)90033-7, have the theory of this functional. Cost O(n).
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.MonotoneCubic([0, 1, 2, 4], [0, 0, 1, 5])
/// >>> f([0.5, 2.0, 4.0])
/// array([0., 1., 5.])
/// >>> f.bending_energy <= ss.MonotoneQuintic([0, 1, 2, 4], [0, 0, 1, 5]).bending_energy
/// True
#[pyclass(module = "shapespline", frozen, extends = MonotoneSpline)]
pub(crate) struct MonotoneCubic;

#[pymethods]
impl MonotoneCubic {
    #[new]
    #[pyo3(
        signature = (x, y, axis=0, *, convex=ConvexOption::Nowhere, slopes=None, ends=Ends::Estimated, layer=1.0 / 16.0,
                     min_slope=0.0, extrapolate=Some(Extrapolation::LINEAR)),
        text_signature = "(x, y, axis=0, *, convex=None, slopes=None, ends='estimated', layer=0.0625, \
                          min_slope=0.0, extrapolate='linear')"
    )]
    // One argument per keyword: this is the signature that users see.
    #[allow(clippy::too_many_arguments)]
    fn new(
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = options::axis)] axis: isize,
        #[pyo3(from_py_with = options::convex)] convex: ConvexOption,
        #[pyo3(from_py_with = options::given_slopes)] slopes: Option<Given>,
        #[pyo3(from_py_with = options::ends)] ends: Ends,
        #[pyo3(from_py_with = options::layer)] layer: f64,
        #[pyo3(from_py_with = options::min_slope)] min_slope: f64,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let data = Data::of(x, y, axis)?;
        let slopes = data.given(slopes.as_ref())?;
        let convex = data.convex(&convex)?;
        let extrapolate = extrapolate.unwrap_or_default();
        let fits = data.fit(x.py(), |x, y, own, go_on| {
            let convex = convex[own.start / x.len().max(1)].clone();
            let slopes = slopes.as_ref().map(|slopes| slopes[own].to_vec());
            let ends = ends.clone();
            let options = CubicOptions { ends, slopes, layer, min_slope, convex, extrapolate };
            monotone::MonotoneCubic::new_with(x, y, &options, go_on)
        })?;
        Ok(object(Fits::Cubic(fits), data.into_layout(), Self))
    }

    /// Intervals in which the function is level between two parabolas of slope: their indices, increasing;
    /// of many columns a list of such arrays.
    #[getter]
    fn level_pieces<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let base = slf.as_super().as_super().get();
        let py = slf.py();
        let one = |f: &monotone::MonotoneCubic| {
            numpy::PyArray1::from_iter(py, f.level_pieces().iter().map(|i| *i as i64))
        };
        let Fits::Cubic(fits) = base.fits.as_ref() else { return py.None().into_bound_py_any(py) };
        if base.layout.is_one() {
            return one(&fits[0]).into_bound_py_any(py);
        }
        let columns = if base.layout.is_empty() { &[][..] } else { &fits[..] };
        columns.iter().map(one).collect::<Vec<_>>().into_bound_py_any(py)
    }

    /// A bound from below of the bending energy of every monotone function through the data with the same
    /// ends and given slopes, without layers; with ``ends="natural"`` of every monotone function.
    #[getter]
    fn lower_bound<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let base = slf.as_super().as_super().get();
        let Fits::Cubic(fits) = base.fits.as_ref() else { return base.each(slf.py(), Vec::new()) };
        base.each(slf.py(), fits.iter().map(monotone::MonotoneCubic::lower_bound).collect())
    }

    /// How noisy data were smoothed: `MonotoneSmoothing` for the result of `smooth_monotone`, None otherwise.
    #[getter]
    fn smoothing(slf: &Bound<'_, Self>) -> Option<MonotoneSmoothing> {
        let Fits::Cubic(fits) = slf.as_super().as_super().get().fits.as_ref() else { return None };
        fits[0].smoothing().map(MonotoneSmoothing::of)
    }

    /// By how much the energy of every interval exceeds its part of ``lower_bound`` at most, without layers:
    /// in the shape of y with n - 1 entries along its axis.
    #[getter]
    fn interval_gaps<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let base = slf.as_super().as_super().get();
        let Fits::Cubic(fits) = base.fits.as_ref() else { return base.each(slf.py(), Vec::new()) };
        let values: Vec<f64> = fits.iter().flat_map(|f| f.interval_gaps().to_vec()).collect();
        let n = values.len() / fits.len();
        Ok(base.along(slf.py(), values, &[n])?.into_any())
    }
}

/// Return the least bending energy ``∫ f''² dx`` of any monotone function through the data.
///
/// Parameters
/// ----------
/// x : array_like, shape (n,)
///     Strictly increasing, n ≥ 2.
/// y : array_like
///     Data with n entries along the first axis; the functions are monotone wherever the data are.
///
/// Returns
/// -------
/// float or numpy.ndarray
///     Infinite where it overflows; one number per column. No interpolant that is monotone has less,
///     whatever its kind: what a fit has more is what it could do better.
///
/// Raises
/// ------
/// ValueError, TypeError
///     As for `MonotoneCubic`.
///
/// Notes
/// -----
/// The energy of ``MonotoneCubic(x, y, ends="natural", layer=0)``, see there. Cost O(n).
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> ss.minimal_bending([0, 1, 2], [0, 1, 2])
/// 0.0
#[pyfunction]
pub(crate) fn minimal_bending<'py>(
    x: &Bound<'py, PyAny>,
    y: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = x.py();
    let data = Data::of(x, y, 0)?;
    let options = CubicOptions { ends: Ends::Natural, layer: 0.0, ..CubicOptions::default() };
    let fits = data.fit(py, |x, y, _, go_on| {
        monotone::MonotoneCubic::new_with(x, y, &options, go_on).map(|f| f.bending_energy())
    })?;
    let layout = data.into_layout();
    if layout.is_one() {
        return fits[0].into_bound_py_any(py);
    }
    let fits = if layout.is_empty() { Vec::new() } else { fits };
    Ok(shaped(py, fits, &layout.shape(&[]))?.into_any())
}
