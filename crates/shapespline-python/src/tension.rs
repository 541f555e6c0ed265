// SPDX-License-Identifier: MIT OR Apache-2.0

//! `TensionSpline`: what is particular to C² tension cubics.

use numpy::PyArray1;
use pyo3::{
    PyClassInitializer,
    prelude::*,
    types::{PyList, PyTuple, PyType},
};
use shapespline::{
    geometry::{self, InputError, InputMap, Repeated, Side},
    search::Interpolant,
    tension::{self, Strategy, TangentScale},
};

use crate::{
    curve::SpaceCurve,
    error::must,
    fit::{CurveInput, Request, SearchArguments, build, preserve},
    input::{Numbers, Points, Query, array, numbers},
    options::{self, CriteriaNames, Ends, Method, Parameters},
};

/// `tangent_scale`: one number, one a point, or a pair of one number or one a segment.
pub(crate) enum Scale {
    Nodes(Numbers),
    Segments([Numbers; 2]),
}

impl<'py> FromPyObject<'_, 'py> for Scale {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        // A pair first: its two arrays may have lengths of their own, and an error for each.
        if (object.cast::<PyTuple>().is_ok() || object.cast::<PyList>().is_ok())
            && object.len()? == 2
        {
            let [first, second] = [("tangent_scale[0]", 0), ("tangent_scale[1]", 1)]
                .map(|(argument, k)| object.get_item(k).and_then(|item| numbers(argument, &item)));
            return Ok(match (first?, second?) {
                // Two numbers are one a point, for two points.
                (Numbers::One(start), Numbers::One(end)) => {
                    Self::Nodes(Numbers::Many(vec![start, end]))
                }
                (start, end) => Self::Segments([start, end]),
            });
        }
        let any = array("tangent_scale", &object)?;
        match any.shape() {
            [] => Ok(Self::Nodes(Numbers::One(any.values()[0]))),
            [_] => Ok(Self::Nodes(Numbers::Many(any.values().to_vec()))),
            [2, n] => {
                let (starts, ends) = any.values().split_at(*n);
                Ok(Self::Segments([starts, ends].map(|values| Numbers::Many(values.to_vec()))))
            }
            shape => {
                let rule = "be a number, one for each point, or a pair of arrays with one for each \
                            segment";
                Err(must("tangent_scale", &[], rule, shape))
            }
        }
    }
}

impl Scale {
    pub(crate) const NONE: Self = Self::Nodes(Numbers::One(1.0));

    /// The scales of the nodes and segments, from those of the points and their segments.
    ///
    /// # Errors
    /// Another number of values.
    fn at_nodes(self, map: &InputMap) -> Result<Self, InputError> {
        if map.is_plain() {
            return Ok(self);
        }
        let of_segments = |argument, numbers| match numbers {
            Numbers::Many(values) => map.segment_values(argument, &values).map(Numbers::Many),
            one => Ok(one),
        };
        Ok(match self {
            Self::Nodes(Numbers::Many(values)) => {
                Self::Nodes(Numbers::Many(map.node_values("tangent_scale", &values)?))
            }
            Self::Segments([starts, ends]) => Self::Segments([
                of_segments("tangent_scale[0]", starts)?,
                of_segments("tangent_scale[1]", ends)?,
            ]),
            one => one,
        })
    }

    /// Calls `make` with what the crate of the family takes.
    pub(crate) fn with<T>(&self, segments: usize, make: impl FnOnce(TangentScale<'_>) -> T) -> T {
        match self {
            Self::Nodes(Numbers::One(value)) => make(TangentScale::Uniform(*value)),
            Self::Nodes(Numbers::Many(values)) => make(TangentScale::Nodes(values)),
            Self::Segments(pair) => {
                let [starts, ends] = pair.each_ref().map(|values| match values {
                    Numbers::One(value) => vec![*value; segments],
                    Numbers::Many(values) => values.clone(),
                });
                make(TangentScale::Segments(&starts, &ends))
            }
        }
    }
}

/// C² tension cubic: a curve with a continuous second derivative through points, with tension.
///
/// Parameters
/// ----------
/// points : array_like, shape (n, 3) or (n, 2)
///     Points to interpolate, n ≥ 2; neighbours must differ. Planar points give a planar curve.
/// parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
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
/// tangent_scale : float, array_like of shape (n,), or pair of array_like of shape (n - 1,)
///     λ from 1e-65 to 1, without unit: 1 gives the C² cubic spline, and smaller λ pull the curve to the
///     polygon. One number, one per point, or (λ⁰, λ¹): one at the start and one at the end of each
///     segment.
///
/// Raises
/// ------
/// ValueError
///     If an argument holds unusable values: NaN, infinities, wrong shapes, repeated neighbours,
///     parameters that do not increase, λ out of range, unknown names. The message says where.
/// TypeError
///     If an argument is of a wrong kind.
///
/// See Also
/// --------
/// TensionSpline.shape_preserving : finds the λ that the shape of the points needs.
///
/// Notes
/// -----
/// Each segment is a cubic with end legs h λ⁰ T/3 and h λ¹ T'/3, run through in a parameter s that is
/// a monotone cubic of the local one: ``curve(s)`` is twice continuously differentiable in s. The
/// tangents T solve the tridiagonal system (3.7)–(3.8) of Manni, *Parametric shape-preserving spatial
/// interpolation and ν-splines*, Algorithms for Approximation IV (2001), which is strictly diagonally
/// dominant for all λ in (0, 1] (Theorem 3.1); natural ends are this library's. Cost O(n); evaluation
/// solves one monotone cubic a parameter.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import shapespline as ss
/// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
/// >>> curve = ss.TensionSpline(points, tangent_scale=[1, 0.25, 0.5, 0.25, 1])
/// >>> curve
/// <TensionSpline: 5 points in space, tension up to 3 at 3 of them; ...>
/// >>> u = curve.parameters[1:-1]
/// >>> np.allclose(curve(u, 2, side="left"), curve(u, 2, side="right"))
/// True
#[pyclass(module = "shapespline", frozen, extends = SpaceCurve)]
pub(crate) struct TensionSpline;

#[pymethods]
impl TensionSpline {
    #[new]
    #[pyo3(
        signature = (
            points,
            parameters=Parameters::CHORDAL,
            *,
            boundary=Ends::Default,
            closed=false,
            repeated=Repeated::Error,
            tangent_scale=Scale::NONE,
        ),
        text_signature = "(points, parameters='chordal', *, boundary='natural', closed=False, repeated='error', tangent_scale=1.0)"
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
        tangent_scale: Scale,
    ) -> PyResult<PyClassInitializer<Self>> {
        let input = CurveInput::new(points, parameters, boundary, closed, repeated)?;
        let base = build(py, input, |polygon, map| {
            let segments = polygon.segments();
            let scale = tangent_scale.at_nodes(map)?;
            scale.with(segments, |scale| tension::TensionSpline::new(polygon, scale))
        })?;
        Ok(PyClassInitializer::from(base).add_subclass(Self))
    }

    /// Fit the C² tension cubic whose λ keep the shape of the points.
    ///
    /// λ is lowered at the nodes around each violation until no criterion fails, both λ of a node
    /// together; then, by default, it is raised again as far as the criteria allow.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (n, 3) or (n, 2)
    ///     Points to interpolate, as for `TensionSpline`.
    /// parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,)
    ///     Parameters of the points, as for `TensionSpline`.
    /// boundary : {"natural", "zero-curvature", "periodic", "circular"} or Tangents
    ///     End conditions, as for `TensionSpline`.
    /// closed, repeated
    ///     As for `TensionSpline`.
    /// criteria : str or iterable of str, optional
    ///     What to keep: any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``,
    ///     ``"coplanarity"``, ``"collinearity"``, ``"global-convexity"`` and ``"regular"``; default all
    ///     but the last two.
    /// strategy : {"fairest", "growth", "reduction", "nussp"}
    ///     ``"reduction"`` multiplies λ by ``step`` (the published algorithm); ``"growth"`` doubles
    ///     1/λ − 1; ``"fairest"`` doubles and then lowers every tension, on both sides of a point, by
    ///     itself until none can be lowered by more than some per cent without breaking a criterion or
    ///     making the curve bend more; ``"nussp"`` adds ``step`` to 1/λ − 1.
    /// step : float, optional
    ///     ρ in (0, 1) of ``"reduction"``, default 0.5; else what doubling starts from or what is added
    ///     to 1/λ − 1, default 0.25.
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
    /// TensionSpline
    ///     A curve that was checked completely and keeps every criterion; its ``diagnostics`` and
    ///     ``history`` tell how it was found.
    ///
    /// Raises
    /// ------
    /// ConvergenceError
    ///     If ``max_iterations`` is reached first, or if tension can rise no further where a criterion
    ///     is violated; it carries the last curve and its report.
    /// ValueError, TypeError
    ///     As for `TensionSpline`, and for options outside their ranges.
    /// KeyboardInterrupt
    ///     If Ctrl-C is pressed meanwhile.
    ///
    /// Notes
    /// -----
    /// Section 4 of Manni 2001: near λ = 0 every criterion holds (Lemmas 4.1–4.3). The growth and the
    /// lowering are this library's. Cost: one complete solve and check, O(n), and then what the
    /// violations need.
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    /// >>> ss.TensionSpline(points, "uniform").check().ok
    /// False
    /// >>> curve = ss.TensionSpline.shape_preserving(points, "uniform", strategy="reduction")
    /// >>> curve.check().ok
    /// True
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
            step=None,
            resolution=0.0,
            coplanarity=0.2,
            collinearity=0.2,
            tolerance=1e-9,
            max_iterations=None,
        ),
        text_signature = "($type, points, parameters='chordal', *, boundary='natural', closed=False, repeated='error', criteria=None, strategy='fairest', step=None, resolution=0.0, coplanarity=0.2, \
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
        #[pyo3(from_py_with = options::optional_step)] step: Option<f64>,
        #[pyo3(from_py_with = options::resolution)] resolution: f64,
        #[pyo3(from_py_with = options::coplanarity)] coplanarity: f64,
        #[pyo3(from_py_with = options::collinearity)] collinearity: f64,
        #[pyo3(from_py_with = options::tolerance)] tolerance: f64,
        #[pyo3(from_py_with = options::max_iterations)] max_iterations: Option<usize>,
    ) -> PyResult<Py<PyAny>> {
        let input = CurveInput::new(points, parameters, boundary, closed, repeated)?;
        let step = step.unwrap_or_else(|| Method::Tension.default_step(strategy));
        let search = SearchArguments { criteria, strategy, step, max_iterations }.options(
            resolution,
            coplanarity,
            collinearity,
            tolerance,
        )?;
        preserve(class.py(), input, &Request::from(&search), |polygon, go_on| {
            tension::TensionSpline::shape_preserving_with(polygon, &search, &mut |_| go_on())
        })
    }

    /// (λ⁰, λ¹): the scale of the tangents at the start and at the end of each segment, two fresh
    /// arrays of shape (segments,).
    ///
    /// Examples
    /// --------
    /// >>> import shapespline as ss
    /// >>> ss.TensionSpline([[0, 0], [3, 4], [3, 5]], tangent_scale=[1, 0.5, 1]).tangent_scale
    /// (array([1. , 0.5]), array([0.5, 1. ]))
    #[getter]
    #[allow(clippy::type_complexity)]
    fn tangent_scale<'py>(
        slf: &Bound<'py, Self>,
    ) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>) {
        let base = slf.as_super().get();
        let curve = base.curve.as_any().downcast_ref::<tension::TensionSpline>();
        let pairs = curve.map_or(&[][..], |spline| spline.curve().slopes());
        let pairs = base.curve.map.spread_segments(pairs, &[f64::NAN; 2]);
        let side = |k: usize| PyArray1::from_iter(slf.py(), pairs.iter().map(|pair| pair[k]));
        (side(0), side(1))
    }

    /// Return the parameter of ``bezier``, ``to_bspline()`` and ``to_ppoly()`` at that of the curve.
    ///
    /// The parameter s in which the curve is C² is no polynomial's: the local parameter t of a segment
    /// is found from the monotone cubic s(t). The image is a piecewise cubic in t, which those three
    /// run through linearly: they agree with the curve at the points, and elsewhere
    /// ``curve(u) = curve.to_ppoly()(curve.image_parameter(u))``. With λ = 1 both parameters are the
    /// same.
    ///
    /// Parameters
    /// ----------
    /// u : array_like
    ///     Parameters of the curve, of any shape.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray, shape u.shape
    ///
    /// Notes
    /// -----
    /// Manni 2001, (3.3). A guarded Newton iteration that never leaves the segment; exact at the
    /// points.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> import shapespline as ss
    /// >>> curve = ss.TensionSpline([[0, 0], [3, 4], [3, 5]], tangent_scale=[1, 0.25, 1])
    /// >>> u = np.linspace(0, 6, 100)
    /// >>> np.allclose(curve(u), curve.to_ppoly()(curve.image_parameter(u)))
    /// True
    fn image_parameter<'py>(slf: &Bound<'py, Self>, u: Query<'py>) -> PyResult<Bound<'py, PyAny>> {
        slf.as_super().get().scalar(slf.py(), &u, |curve, u| {
            let (segment, t) = curve.path().locate(u, Side::Right);
            geometry::Curve::parameter(curve.cubic(), segment, t)
        })
    }
}
