// SPDX-License-Identifier: MIT OR Apache-2.0

//! The constructors of the quartic and the quintic.

use std::{ops::Range, sync::Arc};

use pyo3::{PyClass, PyClassInitializer, prelude::*};
use shapespline::monotone::{
    Convexity, Extrapolation, Fairness, MonotoneError, QuarticOptions, QuinticOptions,
    ShapeParameters, Slopes,
};

use super::{
    fits::{Fits, fit_all},
    function::PiecewisePolynomial,
    layout::Layout,
    options::{self, ConvexOption, Given, SlopesOption, column_error},
    spline::MonotoneSpline,
};
use crate::{
    error::{invalid, must},
    input::{Array, array},
    output::FloatArray,
    work::GoOn,
};

/// Data along an axis.
pub(super) struct Data<'py> {
    x: Array<'py>,
    y: Array<'py>,
    layout: Layout,
}

impl<'py> Data<'py> {
    pub(super) fn of(x: &Bound<'py, PyAny>, y: &Bound<'py, PyAny>, axis: isize) -> PyResult<Self> {
        let (x, y) = (array("x", x)?, array("y", y)?);
        let &[n] = x.shape() else {
            return Err(must("x", &[], "have one axis", x.shape()));
        };
        let layout = Layout::of(&y, axis)?;
        let found = y.shape()[layout.axis()];
        if found != n {
            let axis = layout.axis();
            let text =
                format!("y has {found} entries along axis {axis}, x has {n}; they must agree");
            return Err(invalid("y", &[], y.shape(), text));
        }
        Ok(Self { x, y, layout })
    }

    /// The columns one after another: the caller's own numbers if they lie so. If there are none, one column of zeros, so
    /// that x and the options are checked as usual.
    fn columns<'a>(&'a self, copy: &'a mut Vec<f64>) -> &'a [f64] {
        if self.layout.is_empty() {
            *copy = vec![0.0; self.x.values().len()];
            return copy;
        }
        if self.layout.inner.iter().product::<usize>() == 1 {
            return self.y.values();
        }
        *copy = self.layout.split(self.y.values(), self.x.values().len());
        copy
    }

    /// The number of points.
    pub(super) fn points(&self) -> usize {
        self.x.values().len()
    }

    /// Whether y has one axis.
    pub(super) fn is_one(&self) -> bool {
        self.layout.is_one()
    }

    pub(super) fn into_layout(self) -> Layout {
        self.layout
    }

    /// Given slopes, column after column.
    pub(super) fn given(&self, slopes: Option<&Given>) -> PyResult<Option<Vec<f64>>> {
        let Some(slopes) = slopes else { return Ok(None) };
        let (n, columns) = (self.x.values().len(), self.layout.columns().max(1));
        let mut given = slopes.columns(&self.y, [columns, n], |d| self.layout.split(d, n))?;
        if self.layout.is_empty() {
            given.resize(n, 0.0);
        }
        Ok(Some(given))
    }

    /// What is asked of the convexity of every column.
    pub(super) fn convex(&self, convex: &ConvexOption) -> PyResult<Vec<Option<Convexity>>> {
        let (n, columns) = (self.x.values().len(), self.layout.columns().max(1));
        convex.columns(&self.y, self.layout.axis(), [columns, n])
    }

    /// `fit(x, y, own, go_on)` of every column, which has the numbers `own` of all columns.
    pub(super) fn fit<F: Send>(
        &self,
        py: Python<'_>,
        fit: impl Fn(&[f64], &[f64], Range<usize>, GoOn<'_>) -> Result<F, MonotoneError> + Send + Sync,
    ) -> PyResult<Vec<F>> {
        let mut copy = Vec::new();
        let (x, y) = (self.x.values(), self.columns(&mut copy));
        let (n, columns) = (x.len(), self.layout.columns().max(1));
        let one = |k: usize, go_on: GoOn<'_>| {
            let own = k * n..(k + 1) * n;
            fit(x, &y[own.clone()], own, go_on)
        };
        let fits = fit_all(py, y.len(), columns, one)?;
        fits.map_err(|(k, error)| column_error(&error, &self.layout, k))
    }

    /// [`Self::fit`] with what `option` says of slopes.
    fn fit_slopes<F: Send>(
        &self,
        py: Python<'_>,
        option: &SlopesOption,
        fit: impl Fn(&[f64], &[f64], Slopes, GoOn<'_>) -> Result<F, MonotoneError> + Send + Sync,
    ) -> PyResult<Vec<F>> {
        let given = self.given(option.given())?;
        self.fit(py, |x, y, own, go_on| {
            let slopes = match (option, &given) {
                (SlopesOption::Optimal, _) => Slopes::Optimal,
                (_, Some(given)) => Slopes::Given(given[own].to_vec()),
                _ => Slopes::FritschButland,
            };
            fit(x, y, slopes, go_on)
        })
    }
}

/// The object's parts.
pub(super) fn object<S>(fits: Fits, layout: Layout, class: S) -> PyClassInitializer<S>
where
    S: PyClass<BaseType = MonotoneSpline>,
{
    let base = PiecewisePolynomial::of(fits, &Arc::new(layout));
    PyClassInitializer::from(base).add_subclass(MonotoneSpline).add_subclass(class)
}

/// The paper's α or β: one number per segment.
fn shape_parameters<'py>(
    slf: &Bound<'py, PiecewisePolynomial>,
    beta: bool,
) -> PyResult<FloatArray<'py>> {
    let base = slf.get();
    let values: Vec<f64> = match base.fits.as_ref() {
        Fits::Quartic(fits) => {
            fits.iter().flat_map(|f| if beta { f.beta() } else { f.alpha() }).collect()
        }
        Fits::Quintic(fits) => {
            fits.iter().flat_map(|f| if beta { f.beta() } else { f.alpha() }).collect()
        }
        Fits::Cubic(_) | Fits::Pieces(_) => Vec::new(),
    };
    let n = values.len() / base.fits.len();
    base.along(slf.py(), values, &[n])
}

/// C¹ monotone quartic interpolation: local, one pass.
///
/// Parameters
/// ----------
/// x : array_like, shape (n,)
///     Strictly increasing, n ≥ 2.
/// y : array_like
///     Data of any shape with n entries along ``axis``; every column is fitted, in parallel.
/// axis : int
///     The axis of y that goes with x.
/// slopes : {"fritsch-butland"} or array_like
///     Slopes at the knots: Fritsch and Butland's harmonic means, or given ones (in the shape of ``y``, or
///     (n,) for every column), which are limited to 0 ≤ d ≤ 2Δ with Δ the smaller neighbouring secant slope.
/// shape : float or pair of array_like, shape (n - 1,)
///     Starting value of α = β, or (α, β) of every segment; from 0 to 1e300. They are scaled by the
///     largest λ in [0, 1] that keeps the segment monotone. With 1 cubics with exact slopes are
///     reproduced, and the error is of order 3; the paper's 3 bends more and is of order 2.
/// extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
///     Outside the knots: the tangent line at the end (then the function is C¹ and monotone everywhere),
///     the end value, the function repeated, the end polynomial, NaN; of a pair the first below the
///     knots, the second above. None is "linear".
///
/// Raises
/// ------
/// ValueError
///     If an argument holds unusable values: NaN, infinities, x that does not increase, lengths that
///     differ, unknown names. The message says where.
/// TypeError
///     If an argument is of a wrong kind.
///
/// Notes
/// -----
/// Equations (3) and (15), conditions (12)–(13) and the four cases of Ng, Kong and Ong, *A class of
/// Bézier-like splines in smooth monotone interpolation* (paper 003); slopes after Fritsch and
/// Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300–304; at an end beside a turn or a flat that of the
/// parabola through three points, as PCHIP has it. Data that are not monotone are fitted piecewise;
/// flats stay flat. Cost O(n), and a point moves at most four segments.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.MonotoneQuartic([0, 1, 2, 4], [0, 0, 1, 5])
/// >>> f([0.5, 2.0, 4.0])
/// array([0., 1., 5.])
/// >>> f.alpha.shape
/// (3,)
#[pyclass(module = "shapespline", frozen, extends = MonotoneSpline)]
pub(crate) struct MonotoneQuartic;

#[pymethods]
impl MonotoneQuartic {
    #[new]
    #[pyo3(
        signature = (x, y, axis=0, *, slopes=SlopesOption::FritschButland,
                     shape=ShapeParameters::Uniform(1.0), extrapolate=Some(Extrapolation::LINEAR)),
        text_signature = "(x, y, axis=0, *, slopes='fritsch-butland', shape=1.0, \
                          extrapolate='linear')"
    )]
    fn new(
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = options::axis)] axis: isize,
        #[pyo3(from_py_with = options::slopes)] slopes: SlopesOption,
        #[pyo3(from_py_with = options::shape)] shape: ShapeParameters,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<PyClassInitializer<Self>> {
        if matches!(slopes, SlopesOption::Optimal) {
            let text = "slopes must be 'fritsch-butland' or an array of slopes; got 'optimal', \
                        which is for MonotoneQuintic";
            return Err(invalid("slopes", &[], "optimal", text));
        }
        let data = Data::of(x, y, axis)?;
        let extrapolate = extrapolate.unwrap_or_default();
        let fits = data.fit_slopes(x.py(), &slopes, |x, y, slopes, _| {
            let options = QuarticOptions { slopes, shape: shape.clone(), extrapolate };
            shapespline::monotone::MonotoneQuartic::new(x, y, &options)
        })?;
        Ok(object(Fits::Quartic(fits), data.layout, Self))
    }

    /// The paper's shape parameter α of every segment.
    #[getter]
    fn alpha<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        shape_parameters(slf.as_super().as_super(), false)
    }

    /// The paper's shape parameter β of every segment.
    #[getter]
    fn beta<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        shape_parameters(slf.as_super().as_super(), true)
    }
}

/// C² monotone quintic interpolation with the least bending energy.
///
/// Parameters
/// ----------
/// x : array_like, shape (n,)
///     Strictly increasing, n ≥ 2.
/// y : array_like
///     Data of any shape with n entries along ``axis``; every column is fitted, in parallel.
/// axis : int
///     The axis of y that goes with x.
/// slopes : {"optimal", "fritsch-butland"} or array_like
///     Slopes at the knots: chosen together with the second derivatives; Fritsch and Butland's
///     harmonic means, with the paper's program; or given ones (in the shape of ``y``, or (n,) for every
///     column). Those that a C² monotone quintic can have are taken as they are, up to nine times the
///     secant at one end of a segment or six times at both; others are refused.
/// energy : {"bending", "parametric"}
///     What is least: ``∫ f''² dx``, or the paper's sum (20) over the segments' own parameters.
/// clip : bool
///     Limit given slopes that no C² monotone quintic has, instead of refusing them;
///     ``diagnostics.limited`` says where.
/// extrapolate : {"linear", "clip", "periodic", True, False} or pair of them
///     Outside the knots: the tangent line at the end (then the function is C¹ and monotone everywhere),
///     the end value, the function repeated, the end polynomial, NaN; of a pair the first below the
///     knots, the second above. None is "linear".
///
/// Raises
/// ------
/// ValueError
///     If an argument holds unusable values: NaN, infinities, x that does not increase, lengths that
///     differ, unknown names. The message says where.
/// TypeError
///     If an argument is of a wrong kind.
///
/// Notes
/// -----
/// Equation (16), and the program (17), (20), (22), (23) of Ng, Kong and Ong, *A class of Bézier-like
/// splines in smooth monotone interpolation* (paper 003), as a strictly convex box program in the
/// second derivatives: that is ``slopes="fritsch-butland"`` alone. Its conditions α, β ≥ 0 are more than
/// monotonicity asks, and make second derivatives about three times too large on smooth data (order
/// two). Optimal and given slopes have all second derivatives that are monotone to choose from (order
/// four, if given slopes are the function's): an interior-point method on the exact cone, within 0.5 %
/// of the least energy, small segments beside large ones included; the result does not jump
/// as the data move. Data that are not monotone are fitted piecewise; flats stay flat. Cost O(n).
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> f = ss.MonotoneQuintic([0, 1, 2, 4], [0, 0, 1, 5])
/// >>> f([0.5, 2.0, 4.0])
/// array([0., 1., 5.])
/// >>> paper = ss.MonotoneQuintic([0, 1, 2, 4], [0, 0, 1, 5], slopes="fritsch-butland")
/// >>> f.bending_energy <= paper.bending_energy
/// True
#[pyclass(module = "shapespline", frozen, extends = MonotoneSpline)]
pub(crate) struct MonotoneQuintic;

#[pymethods]
impl MonotoneQuintic {
    #[new]
    #[pyo3(
        signature = (x, y, axis=0, *, slopes=SlopesOption::Optimal, energy=Fairness::Bending,
                     clip=false, extrapolate=Some(Extrapolation::LINEAR)),
        text_signature = "(x, y, axis=0, *, slopes='optimal', energy='bending', \
                          clip=False, extrapolate='linear')"
    )]
    // One argument a keyword: this is the signature that users see.
    #[allow(clippy::too_many_arguments)]
    fn new(
        x: &Bound<'_, PyAny>,
        y: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = options::axis)] axis: isize,
        #[pyo3(from_py_with = options::slopes)] slopes: SlopesOption,
        #[pyo3(from_py_with = options::energy)] energy: Fairness,
        clip: bool,
        #[pyo3(from_py_with = options::extrapolate)] extrapolate: Option<Extrapolation>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let data = Data::of(x, y, axis)?;
        let extrapolate = extrapolate.unwrap_or_default();
        let fits = data.fit_slopes(x.py(), &slopes, |x, y, slopes, go_on| {
            let options = QuinticOptions { slopes, fairness: energy, clip, extrapolate };
            shapespline::monotone::MonotoneQuintic::new_with(x, y, &options, go_on)
        })?;
        Ok(object(Fits::Quintic(fits), data.layout, Self))
    }

    /// The paper's shape parameter α of every segment. With slope 0 at the segment's
    /// start: ±∞, or 0 where any would do.
    #[getter]
    fn alpha<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        shape_parameters(slf.as_super().as_super(), false)
    }

    /// The paper's shape parameter β of every segment. With slope 0 at the segment's
    /// end: ±∞, or 0 where any would do.
    #[getter]
    fn beta<'py>(slf: &Bound<'py, Self>) -> PyResult<FloatArray<'py>> {
        shape_parameters(slf.as_super().as_super(), true)
    }

    /// What was least: ``"bending"`` or ``"parametric"``.
    #[getter]
    fn energy(slf: &Bound<'_, Self>) -> &'static str {
        options::energy_name(slf.as_super().as_super().get().fits.fairness().unwrap_or_default())
    }
}
