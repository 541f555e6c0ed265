// SPDX-License-Identifier: MIT OR Apache-2.0

//! `NuSpline`: what is particular to ν-splines.

use pyo3::{PyClassInitializer, prelude::*, types::PyType};
use shapespline::{
    geometry::Repeated,
    nu::{self, Strategy},
};

use crate::{
    curve::SpaceCurve,
    fit::{CurveInput, Request, SearchArguments, build, preserve},
    input::Points,
    options::{self, CriteriaNames, Ends, NodalTension, Parameters},
};

/// ν-spline: a curve with continuous tangent and curvature (G²) through points, with tension.
///
/// Parameters
/// ----------
/// points : array_like, shape (n, 3) or (n, 2)
///     Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
/// parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
///     Parameters of the points: by name, as the exponent e in [0, 1] of ``u[i+1] - u[i] = ‖points[i+1] -
///     points[i]‖**e``, or strictly increasing numbers.
/// boundary : {"zero-curvature", "natural", "periodic", "circular"} or Tangents
///     Zero curvature at both ends (two names); closed data, whose last point is the first; end
///     tangents of the circles through the first and the last three points; or given end tangents.
/// closed : bool
///     Whether the first point is also the last, repeated or not: periodic ends, and no other. Arrays of
///     parameters then have one entry more, for the return to the first point, unless the points repeat
///     it; so have ``points`` and all other attributes.
/// repeated : {"error", "drop"}
///     What becomes of points that equal the one before them, or are given its parameter: they are
///     refused, or left out. Indices and arrays refer to the points as given in either case;
///     ``diagnostics.dropped`` lists the points that were left out, and ``bezier`` and ``knots`` know
///     nothing of them.
/// tension : float or array_like, shape (n,)
///     ν ≥ 0, without unit: 0 gives the C² cubic spline, and growing tension pulls the curve to the
///     polygon. Of closed data, the first and the last entry must agree.
///
/// Raises
/// ------
/// ValueError
///     If an argument holds unusable values: NaN, infinities, wrong shapes, repeated neighbours,
///     parameters that do not increase, negative tension, unknown names. The message says where.
/// TypeError
///     If an argument is of a wrong kind.
///
/// See Also
/// --------
/// NuSpline.shape_preserving : finds the tension that the shape of the points needs.
///
/// Notes
/// -----
/// The tangents q solve the tridiagonal system (3.3)–(3.11) of Karavelas & Kaklis, *Spatial
/// shape-preserving interpolation using ν-splines*, Numer. Algorithms 23 (2000) 217–250, for
/// ``Q''(u+) - Q''(u-) = ν q / sqrt(h h')``. It is strictly diagonally dominant: the curve exists and
/// is unique for every ν ≥ 0. Cost O(n).
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> curve = ss.NuSpline(points, tension=[0, 3, 1, 3, 0])
/// >>> curve
/// <NuSpline: 5 points in space, tension up to 3 at 3 of them; ...>
/// >>> curve(4.0)
/// array([4., 0., 0.])
#[pyclass(module = "shapespline", frozen, extends = SpaceCurve)]
pub(crate) struct NuSpline;

#[pymethods]
impl NuSpline {
    #[new]
    #[pyo3(
        signature = (
            points,
            parameters=Parameters::CHORDAL,
            *,
            boundary=Ends::Default,
            closed=false,
            repeated=Repeated::Error,
            tension=NodalTension::NONE,
        ),
        text_signature = "(points, parameters='chordal', *, boundary='zero-curvature', closed=False, repeated='error', tension=0.0)"
    )]
    // One argument a keyword: this is the signature that users see.
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        points: Points,
        parameters: Parameters,
        boundary: Ends,
        #[pyo3(from_py_with = options::closed)] closed: bool,
        #[pyo3(from_py_with = options::repeated)] repeated: Repeated,
        tension: NodalTension,
    ) -> PyResult<PyClassInitializer<Self>> {
        let input = CurveInput::new(points, parameters, boundary, closed, repeated)?;
        let base = build(py, input, |polygon, map| {
            nu::NuSpline::new(polygon, tension.at_nodes(map)?.tension())
        })?;
        Ok(PyClassInitializer::from(base).add_subclass(Self))
    }

    /// Fit the ν-spline whose tension keeps the shape of the points.
    ///
    /// Tension is raised at the nodes around each violation until no criterion fails; then, by
    /// default, it is lowered again as far as the criteria allow.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (n, 3) or (n, 2)
    ///     Points to interpolate, as for `NuSpline`.
    /// parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
    ///     Parameters of the points, as for `NuSpline`.
    /// boundary : {"zero-curvature", "natural", "periodic", "circular"} or Tangents
    ///     End conditions, as for `NuSpline`.
    /// closed, repeated
    ///     As for `NuSpline`.
    /// criteria : str or iterable of str, optional
    ///     What to keep: any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``,
    ///     ``"coplanarity"``, ``"collinearity"``, ``"global-convexity"`` and ``"regular"``; default all
    ///     but the last two.
    /// strategy : {"fairest", "growth", "nussp", "reduction"}
    ///     ``"nussp"`` adds ``step`` (the published algorithm); ``"growth"`` doubles the tension;
    ///     ``"fairest"`` doubles and then lowers every tension by itself until none can be lowered by
    ///     more than some per cent without breaking a criterion or making the curve bend more;
    ///     ``"reduction"`` multiplies 1/(1 + ν) by ``step``.
    /// step : float
    ///     What ``"nussp"`` adds, and what doubling starts from; positive.
    /// resolution : float
    ///     Accuracy of the points, in their units: what a move of the points by that much could undo is not
    ///     asked for. Default 0.
    /// coplanarity, collinearity, tolerance : float
    ///     As for the method ``check``.
    /// max_iterations : int, optional
    ///     Largest number of checks while tension is raised; by default there is no limit as long as
    ///     tension can rise at every segment that violates a criterion. It rises to 1e60 and, by
    ///     default, to what 10000 raises of a node add up to with ``"nussp"`` and ``"reduction"``.
    ///
    /// Returns
    /// -------
    /// NuSpline
    ///     A curve that was checked completely and keeps every criterion; its ``diagnostics`` and
    ///     ``history`` tell how it was found.
    ///
    /// Raises
    /// ------
    /// ConvergenceError
    ///     If ``max_iterations`` is reached first, or if tension can rise no further where a criterion
    ///     is violated; it carries the last curve and its report.
    /// ValueError, TypeError
    ///     As for `NuSpline`, and for options outside their ranges.
    /// KeyboardInterrupt
    ///     If Ctrl-C is pressed meanwhile.
    ///
    /// Notes
    /// -----
    /// Algorithm NUSSP, section 5.2 of Karavelas & Kaklis, Numer. Algorithms 23 (2000) 217–250, with
    /// the index in (5.61)–(5.62) corrected; the growth and the lowering are this library's. Cost: one
    /// complete solve and check, O(n), and then what the violations need.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    /// >>> curve = ss.NuSpline.shape_preserving(points, "uniform", strategy="nussp")
    /// >>> curve.check().ok
    /// True
    /// >>> curve.tension
    /// array([9.5, 9.5, 9.5, 9.5, 8. ])
    #[classmethod]
    #[pyo3(
        signature = (
            points,
            parameters=Parameters::CHORDAL,
            *,
            boundary=Ends::Default,
            closed=false,
            repeated=Repeated::Error,
            criteria=CriteriaNames::DEFAULT,
            strategy=Strategy::Fairest,
            step=0.5,
            resolution=0.0,
            coplanarity=0.2,
            collinearity=0.2,
            tolerance=1e-9,
            max_iterations=None,
        ),
        text_signature = "($type, points, parameters='chordal', *, boundary='zero-curvature', closed=False, repeated='error', criteria=None, strategy='fairest', step=0.5, resolution=0.0, coplanarity=0.2, \
                          collinearity=0.2, tolerance=1e-9, max_iterations=None)"
    )]
    // One argument a keyword: this is the signature that users see.
    #[allow(clippy::too_many_arguments)]
    fn shape_preserving(
        class: &Bound<'_, PyType>,
        points: Points,
        parameters: Parameters,
        boundary: Ends,
        #[pyo3(from_py_with = options::closed)] closed: bool,
        #[pyo3(from_py_with = options::repeated)] repeated: Repeated,
        criteria: CriteriaNames,
        #[pyo3(from_py_with = options::strategy)] strategy: Strategy,
        #[pyo3(from_py_with = options::step)] step: f64,
        #[pyo3(from_py_with = options::resolution)] resolution: f64,
        #[pyo3(from_py_with = options::coplanarity)] coplanarity: f64,
        #[pyo3(from_py_with = options::collinearity)] collinearity: f64,
        #[pyo3(from_py_with = options::tolerance)] tolerance: f64,
        #[pyo3(from_py_with = options::max_iterations)] max_iterations: Option<usize>,
    ) -> PyResult<Py<PyAny>> {
        let input = CurveInput::new(points, parameters, boundary, closed, repeated)?;
        let search = SearchArguments { criteria, strategy, step, max_iterations }.options(
            resolution,
            coplanarity,
            collinearity,
            tolerance,
        )?;
        preserve(class.py(), input, &Request::from(&search), |polygon, go_on| {
            nu::NuSpline::shape_preserving_with(polygon, &search, &mut |_| go_on())
        })
    }
}
