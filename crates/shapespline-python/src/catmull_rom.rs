// SPDX-License-Identifier: MIT OR Apache-2.0

//! `CatmullRom`: what is particular to Catmull–Rom curves.

use pyo3::{PyClassInitializer, prelude::*, types::PyType};
use shapespline::{
    catmull_rom::{self, Continuity, Directions, HandleOptions},
    criteria::Criteria,
    geometry::Repeated,
};

use crate::{
    curve::SpaceCurve,
    fit::{CurveInput, Request, build, preserve},
    input::Points,
    options::{self, CriteriaNames, Ends, NodalTension, Parameters, tolerances},
};

/// Catmull–Rom curve: local cubic interpolation whose tangents lie between the chords.
///
/// Parameters
/// ----------
/// points : array_like, shape (n, 3) or (n, 2)
///     Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
/// parameters : {"centripetal", "chordal", "uniform"}, float or array_like, shape (n,)
///     Parameters of the points: by name, as the exponent e in [0, 1] of ``u[i+1] - u[i] = ‖points[i+1] -
///     points[i]‖**e``, or strictly increasing numbers.
/// boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
///     No second derivative at both ends (two names); closed data, whose last point is the first; end
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
///     Cardinal tension in [0, 1), without unit: the part by which the handles at a point are
///     shortened. 0 gives the Catmull–Rom curve, 1 would give the polygon. Of closed data, the first
///     and the last entry must agree.
/// continuity : {"C1", "G1"}
///     Whether both handles at a point have one scale (the derivative is continuous), or only one
///     direction. Without ``shape_preserving`` both give the same curve.
///
/// Raises
/// ------
/// ValueError
///     If an argument holds unusable values: NaN, infinities, wrong shapes, repeated neighbours,
///     parameters that do not increase, tension outside [0, 1), unknown names. The message says where.
/// TypeError
///     If an argument is of a wrong kind.
///
/// See Also
/// --------
/// CatmullRom.shape_preserving : finds the handles that the shape of the points needs.
///
/// Notes
/// -----
/// The tangent at a point is that of the parabola through it and its neighbours, at their parameters.
/// A point moves the curve over two segments to either side. Of the shape criteria, torsion and
/// coplanarity without inflection hold for every such curve: Gautam, *Shape preservation behavior of
/// spline curves*, section 14. Cost O(n), on all threads for long curves.
///
/// Examples
/// --------
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> curve = ss.CatmullRom(points, tension=0.25)
/// >>> curve
/// <CatmullRom: 5 points in space, tension up to 0.25 at 5 of them; ...>
/// >>> ss.CatmullRom([[0, 0], [1, 2], [4, 4]], "uniform").tangents[1]
/// array([2., 2.])
#[pyclass(module = "shapespline", frozen, extends = SpaceCurve)]
pub(crate) struct CatmullRom;

#[pymethods]
impl CatmullRom {
    #[new]
    #[pyo3(
        signature = (
            points,
            parameters=Parameters::CENTRIPETAL,
            *,
            boundary=Ends::Default,
            closed=false,
            repeated=Repeated::Error,
            tension=NodalTension::NONE,
            continuity=Continuity::C1,
        ),
        text_signature = "(points, parameters='centripetal', *, boundary='natural', closed=False, repeated='error', tension=0.0, \
                          continuity='C1')"
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
        #[pyo3(from_py_with = options::continuity)] continuity: Continuity,
    ) -> PyResult<PyClassInitializer<Self>> {
        let input = CurveInput::new(points, parameters, boundary, closed, repeated)?;
        let base = build(py, input, |polygon, map| {
            let tension = tension.at_nodes(map)?;
            catmull_rom::CatmullRom::new(polygon, tension.tension(), continuity)
        })?;
        Ok(PyClassInitializer::from(base).add_subclass(Self))
    }

    /// Fit the Catmull–Rom curve with the largest handles that keep the shape of the points.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (n, 3) or (n, 2)
    ///     Points to interpolate, as for `CatmullRom`.
    /// parameters : {"centripetal", "chordal", "uniform"}, float or array_like, shape (n,)
    ///     Parameters of the points, as for `CatmullRom`.
    /// boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
    ///     End conditions, as for `CatmullRom`.
    /// closed, repeated
    ///     As for `CatmullRom`.
    /// criteria : str or iterable of str, optional
    ///     What to keep: any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``,
    ///     ``"coplanarity"``, ``"collinearity"``, ``"global-convexity"``, which follows from the first,
    ///     and ``"regular"``; default all but the last two.
    /// safety : float
    ///     The part, in (0, 1), of each bound that a handle may reach.
    /// continuity : {"C1", "G1"}
    ///     ``"C1"`` takes the smaller of the two scales at a point for both handles, ``"G1"`` lets each
    ///     segment have its own.
    /// directions : {"balanced", "parametrization"}
    ///     ``"balanced"`` splits the turning angle at each point so that the two angles of a segment with
    ///     its chord become alike, which keeps handles long; ``"parametrization"`` takes the tangents of
    ///     the curve without tension, and is local.
    /// resolution : float
    ///     Accuracy of the points, in their units: what a move of the points by that much could undo is not
    ///     asked for. Default 0.
    /// coplanarity, collinearity, tolerance : float
    ///     As for the method ``check``.
    ///
    /// Returns
    /// -------
    /// CatmullRom
    ///     A curve that was checked completely and keeps every criterion. Its ``diagnostics`` count one
    ///     iteration where the closed forms were enough.
    ///
    /// Raises
    /// ------
    /// ConvergenceError
    ///     If what closed forms leave open (planes known only to the tolerance) is not met within 200
    ///     checks; it carries the last curve and its report.
    /// ValueError, TypeError
    ///     As for `CatmullRom`, and for options outside their ranges.
    ///
    /// Notes
    /// -----
    /// Gautam, *Shape preservation behavior of spline curves*, section 14, shows that every direction
    /// strictly between the chords will do; the balanced ones and the largest magnitudes, in closed form,
    /// are this library's. Torsion holds for handles of any length. Cost O(n), on all threads for long
    /// curves; balanced directions take some ten tridiagonal systems.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    /// >>> ss.CatmullRom(points, "uniform").check().counts()["convexity"]
    /// (2, 2)
    /// >>> curve = ss.CatmullRom.shape_preserving(points, "uniform")
    /// >>> curve.check().ok
    /// True
    #[classmethod]
    #[pyo3(
        signature = (
            points,
            parameters=Parameters::CENTRIPETAL,
            *,
            boundary=Ends::Default,
            closed=false,
            repeated=Repeated::Error,
            criteria=CriteriaNames::DEFAULT,
            safety=0.9,
            continuity=Continuity::C1,
            directions=Directions::Balanced,
            resolution=0.0,
            coplanarity=0.2,
            collinearity=0.2,
            tolerance=1e-9,
        ),
        text_signature = "($type, points, parameters='centripetal', *, boundary='natural', closed=False, repeated='error', criteria=None, safety=0.9, continuity='C1', directions='balanced', resolution=0.0, coplanarity=0.2, \
                          collinearity=0.2, tolerance=1e-9)"
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
        #[pyo3(from_py_with = options::safety)] safety: f64,
        #[pyo3(from_py_with = options::continuity)] continuity: Continuity,
        #[pyo3(from_py_with = options::directions)] directions: Directions,
        #[pyo3(from_py_with = options::resolution)] resolution: f64,
        #[pyo3(from_py_with = options::coplanarity)] coplanarity: f64,
        #[pyo3(from_py_with = options::collinearity)] collinearity: f64,
        #[pyo3(from_py_with = options::tolerance)] tolerance: f64,
    ) -> PyResult<Py<PyAny>> {
        let input = CurveInput::new(points, parameters, boundary, closed, repeated)?;
        let (criteria, tolerances) = (
            criteria.or(Criteria::OF_FITS),
            tolerances(resolution, coplanarity, collinearity, tolerance)?,
        );
        let options = HandleOptions { criteria, tolerances, safety, continuity, directions };
        preserve(
            class.py(),
            input,
            &Request::without_strategy(criteria, tolerances),
            |polygon, go_on| {
                catmull_rom::CatmullRom::shape_preserving_with(polygon, &options, &mut |_| go_on())
            },
        )
    }

    /// What is continuous at the points besides the direction: ``"C1"`` or ``"G1"``.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.CatmullRom([[0, 0], [1, 2], [4, 4]]).continuity
    /// 'C1'
    #[getter]
    fn continuity(slf: &Bound<'_, Self>) -> &'static str {
        let curve = slf.as_super().get().curve.as_any();
        let curve = curve.downcast_ref::<catmull_rom::CatmullRom>();
        options::continuity_name(curve.map(catmull_rom::CatmullRom::continuity).unwrap_or_default())
    }
}
