# SPDX-License-Identifier: MIT OR Apache-2.0

"""Checks of any curve against points, and inflection counts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from shapespline import _core
from shapespline._convert import _is_array, piecewise
from shapespline._core import FairSpline, InputError, SpaceCurve, TensionSpline
from shapespline._pickling import sealed

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from shapespline._core import (
        Fairness,
        ShapeReport,
        Tangents,
        _Boundary,
        _Criterion,
        _Parametrization,
    )

    Floats = NDArray[np.float64]

__all__ = ["InflectionCount", "check_shape", "fairness", "inflection_count"]


def check_shape(
    points: ArrayLike,
    curve: Any,
    *,
    parameters: _Parametrization | float | ArrayLike | None = None,
    boundary: _Boundary | Tangents | None = None,
    closed: bool = False,
    repeated: Literal["error", "drop"] = "error",
    criteria: _Criterion | Iterable[_Criterion] | None = None,
    resolution: float | None = None,
    coplanarity: float | None = None,
    collinearity: float | None = None,
    tolerance: float | None = None,
    corners: Sequence[int] | float | None = None,
) -> ShapeReport:
    """Check whether a curve, whoever made it, keeps the shape of the points it passes through.

    Parameters
    ----------
    points : array_like, shape (n, 3) or (n, 2)
        The points, n ≥ 2; neighbours must differ.
    curve : SpaceCurve, BSpline, PPoly, BPoly, PiecewiseBezier or array_like
        A shapespline curve; a SciPy ``BSpline``, ``PPoly`` (``CubicSpline``, ``PchipInterpolator``,
        ``Akima1DInterpolator`` …) or ``BPoly`` of degree 1 to 18, or any object with the same
        attributes; a `PiecewiseBezier`, which also takes NURBS; or Bézier control points, shape
        (segments, degree + 1, dim), one piece between two points. A function of one variable stands
        for its graph, whose points are (x, y).
    parameters : {"chordal", "centripetal", "uniform"}, float or array_like, shape (n,), optional
        At which parameters the curve passes through the points; default its breaks (knots), where
        their number is that of the points. For an array of control points it must be given.
    boundary : {"zero-curvature", "natural", "periodic", "circular"} or Tangents, optional
        What stands in for the missing chord before the first and after the last point. Default: a
        curve of this module through its own points keeps its own; another is periodic where the
        last point is the first and the curve goes on there in the direction it began with, and else
        has zero curvature, so that the ends ask for neither convexity nor inflection.
    closed : bool
        Whether the first point is also the last, repeated or not: periodic ends, and no other.
        Arrays of parameters then have one entry more, for the return to the first point, unless the
        points repeat it.
    repeated : {"error", "drop"}
        What becomes of points that equal the one before them, or are given its parameter: they are
        refused, or left out. Indices and arrays refer to the points as given in either case.
    criteria : str or iterable of str, optional
        Any of ``"convexity"``, ``"inflection"``, ``"turning"``, ``"torsion"``, ``"coplanarity"``,
        ``"collinearity"``, ``"global-convexity"`` and ``"regular"``; default all but the last two.
        Whether the curve is regular, γ' ≠ 0, is asked in any case, and listed where it is not.
    resolution : float, optional
        Accuracy of the points, in their units: what a move of the points by that much could
        undo is not asked for. Default 0.
    coplanarity, collinearity : float, optional
        ε₁ and ε₀ in (0, 1]: sine of the largest angle between binormal and plane normal where four
        points lie in a plane, and between tangent and line where three lie on a line. Default 0.2.
    tolerance : float, optional
        In [0, 1): points whose turning angle has a smaller sine count as collinear, and four whose
        unit chords span a smaller volume as coplanar. The curve may pass the points at this
        distance over their extent (1e-9 at least). Default 1e-9. A shape-preserving curve of this
        module through its own points has its own defaults: the options that it was fitted with.
    corners : sequence of int or float, optional
        Points at which the curve is to have corners, as for `FairSpline`: nothing is asked there.
        Default none; of a `FairSpline` its own.

    Returns
    -------
    ShapeReport
        The violations, what stays undecided, counts, and margins of all segments.

    Raises
    ------
    ValueError
        If the curve does not pass through the points (the message names the first point, its
        parameter and the distance) or jumps; if points and curve do not belong together (dimension,
        domain, number of parameters); if parameters do not increase, a number is not finite,
        neighbouring points are equal, or an option is unknown or out of range.
    TypeError
        If an argument is of a wrong kind.

    See Also
    --------
    polygon_shape : what the points alone require.
    inflection_count : how often a curve changes the sense in which it turns.

    Notes
    -----
    Segments that are single cubics are decided exactly, in closed form (Karavelas & Kaklis, Numer.
    Algorithms 23 (2000), Problem (P) and (5.34)–(5.57), with inflection added; Gautam, *Shape
    preservation behavior of spline curves*, Definitions 3.1, 3.16, 6.1, 8.2, 9.2 and 10.1). Others
    are taken apart into Bézier pieces, rational or not, and the sign questions on γ'×γ'' and
    det[γ', γ'', γ'''] are decided by certified subdivision of their Bernstein form; nothing is
    sampled. What rounding leaves open is ``undecided`` with its interval; the report is ``ok`` if
    nothing is violated. Cost O(n), on all threads for long curves.

    Examples
    --------
    What SciPy's cubic spline invents on two nearly straight runs:

    >>> import numpy as np
    >>> import shapespline as ss
    >>> from scipy.interpolate import CubicSpline, make_interp_spline
    >>> points = np.array([[0, 0, 0], [2, 0, 0.1], [4, 0.1, 0.1], [4.5, 0.4, 0.2], [4.6, 3, 0.2]])
    >>> u = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    >>> report = ss.check_shape(points, CubicSpline(u, points, bc_type="natural"))
    >>> report.ok, report.counts()["convexity"]
    (False, (1, 2))

    A quartic has fewer breaks than points, so the parameters are given:

    >>> ss.check_shape(points, make_interp_spline(u, points, k=4), parameters=u).undecided
    []
    """
    points = _core._floats("points", points)
    if not (parameters is None or isinstance(parameters, (str, float, int))):
        parameters = _core._floats("parameters", parameters)
    chosen: Any = parameters
    ours = isinstance(curve, SpaceCurve) and boundary is None and corners is None
    if ours and _is_own(points, curve, parameters, closed):
        report: ShapeReport = curve.check(
            criteria,
            resolution=resolution,
            coplanarity=coplanarity,
            collinearity=collinearity,
            tolerance=tolerance,
        )
        return report
    if isinstance(curve, TensionSpline):
        _at_its_points(curve, parameters)
    straight: tuple[int, ...] = ()
    if isinstance(curve, FairSpline) and corners is None and _is_at(points, curve, closed):
        corners, straight = curve.corners, curve.straight
    if _is_array(curve):
        curve = _core._floats("curve", curve)
        chosen = _breaks(points, curve, parameters, closed)
        curve = _core.PiecewiseBezier(curve, chosen)
    return _core._check_shape(
        points,
        piecewise(curve),
        chosen,
        boundary,
        closed,
        repeated,
        criteria,
        resolution,
        coplanarity,
        collinearity,
        tolerance,
        False,
        corners,
        straight,
    )


def _is_at(points: Floats, curve: SpaceCurve, closed: bool) -> bool:
    """Whether these are the points that the curve was made for."""
    own = curve.points
    if closed and len(points) + 1 == len(own):
        own = own[:-1] if curve.boundary == "periodic" else own
    return np.array_equal(points, own)


def _is_own(points: Floats, curve: SpaceCurve, parameters: Any, closed: bool) -> bool:
    """Whether these are the points that the curve was made for, at the same parameters."""
    if not _is_at(points, curve, closed) or (closed and curve.boundary != "periodic"):
        return False
    if parameters is None:
        return True
    return not isinstance(parameters, str) and np.array_equal(parameters, curve.parameters)


def _at_its_points(curve: TensionSpline, parameters: Any) -> None:
    """Refuse other parameters than those of the points: between them u is no polynomial's."""
    if parameters is None:
        return
    if isinstance(parameters, str) or np.ndim(parameters) != 1:
        text = "parameters must be an array of a TensionSpline's own, or left out"
        raise InputError(text, "parameters", value=parameters)
    strange = np.flatnonzero(~np.isin(parameters, curve.parameters))
    if strange.size:
        i = int(strange[0])
        value = parameters[i]
        raise InputError(
            f"parameters[{i}] = {value} is not one of the parameters at which the TensionSpline "
            "has a point: it can be judged at these only",
            "parameters",
            i,
            value,
        )


def _breaks(points: Floats, control: Floats, parameters: Any, closed: bool) -> Floats:
    """Return the breaks of Bézier control points: the parameters of the points."""
    if parameters is None:
        raise InputError(
            "parameters must be given where curve is an array of Bézier control points, one for "
            "each point",
            "parameters",
        )
    shape = control.shape
    if len(shape) != 3:
        text = f"curve must have shape (segments, degree + 1, dim), got shape {shape}"
        raise InputError(text, "curve", value=shape)
    # By name, or checked as for a curve through the points.
    shape_of_points = _core._polygon_shape(points, parameters, None, closed, "error", 0.0, 0.0)
    u: Floats = shape_of_points["parameters"]
    if len(u) != shape[0] + 1:
        raise InputError(
            f"curve must hold one piece between two points: {len(u) - 1} for {len(u)} points, got "
            f"{shape[0]}",
            "curve",
            value=shape[0],
        )
    dim = points.shape[1]
    if shape[2] == dim + 1:
        raise InputError(
            f"points have {dim} coordinates, curve has {shape[2]}; for control points with weights "
            "use shapespline.PiecewiseBezier(control, breaks, weights=weights)",
            "curve",
            value=shape[2],
        )
    return u


def fairness(curve: Any) -> Fairness:
    """Measure how fair a curve is: bending, variation and extrema of its curvature.

    Parameters
    ----------
    curve : SpaceCurve, BSpline, PPoly, BPoly or PiecewiseBezier
        A curve as for `check_shape`: of this module, of SciPy, or Bézier pieces, rational or not. A
        function of one variable stands for its graph.

    Returns
    -------
    Fairness
        ``length``, ``bending`` (L∫κ²ds), ``variation`` (L³∫(κ'² + κ²τ²)ds), ``max_curvature`` and
        where, the number of ``curvature_extrema``, ``max_curvature_jump``; ``cusps`` and
        ``corners``.

    Raises
    ------
    TypeError
        If the curve is of a wrong kind.
    ValueError
        If the curve holds a number that is not finite, or a shape is wrong.

    See Also
    --------
    check_shape : does the curve keep the shape of points?

    Notes
    -----
    Extrema of curvature are sign changes of a polynomial (for cubics of degree 5 in the plane and 7
    in space), isolated by Bernstein subdivision with an error bound; nothing is sampled. Cost O(n),
    on all threads for long curves. Farin & Sapidis, IEEE Comput. Graph. Appl. 9 (1989) 52–57,
    doi:10.1109/38.19051; Moreton & Séquin, Comput. Graph. 26 (1992) 167–176,
    doi:10.1145/133994.134035.

    Examples
    --------
    A parabola has one extremum of curvature, 2 at its vertex:

    >>> import shapespline as ss
    >>> parabola = ss.PiecewiseBezier([[[-1, 1], [0, -1], [1, 1]]], [0, 1])
    >>> found = ss.fairness(parabola)
    >>> round(found.max_curvature, 12), round(found.max_curvature_at, 12), found.curvature_extrema
    (2.0, 0.5, 1)
    """
    measured = curve if isinstance(curve, SpaceCurve) else piecewise(curve)
    return measured.fairness()


class InflectionCount(int):
    """A number of inflections: an int that knows the direction that shows them.

    Attributes
    ----------
    direction : numpy.ndarray, shape (3,)
        Unit vector along which so many inflections are seen.
    exact : bool
        Whether the number is certain. Of a spatial curve that is neither planar nor one cubic, the
        number is attained from ``direction``, but another direction might show more.

    Examples
    --------
    >>> import shapespline as ss
    >>> count = ss.inflection_count([[0, 0], [1, 1], [2, 0], [3, 1]])
    >>> count, count.exact
    (1, True)
    """

    _direction: tuple[float, ...]
    _exact: bool

    def __new__(cls, count: int, direction: ArrayLike, exact: bool) -> InflectionCount:
        """Make the count."""
        self = super().__new__(cls, count)
        vars(self).update(_direction=tuple(map(float, np.asarray(direction))), _exact=bool(exact))
        return self

    @property
    def direction(self) -> Floats:
        """Unit vector along which so many inflections are seen, shape (3,); a fresh array."""
        return np.array(self._direction)

    @property
    def exact(self) -> bool:
        """Whether the number is certain."""
        return self._exact

    def __setattr__(self, name: str, value: object) -> None:
        """Refuse: a count is immutable, as every int."""
        raise AttributeError(f"an InflectionCount is immutable: {name} cannot be set")

    def __delattr__(self, name: str) -> None:
        """Refuse, too."""
        raise AttributeError(f"an InflectionCount is immutable: {name} cannot be deleted")

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle all three."""
        return sealed(type(self), int(self), self._direction, self._exact)


def inflection_count(curve: Any, direction: ArrayLike | None = None) -> InflectionCount:
    """Count how often a polygon or a curve changes the sense in which it turns.

    Parameters
    ----------
    curve : array_like, SpaceCurve, BSpline, PPoly, BPoly or PiecewiseBezier
        Points, shape (n, 3) or (n, 2); or a curve as for `check_shape`, Bézier control points of
        shape (pieces, degree + 1, dim) included.
    direction : array_like, shape (3,), optional
        Along which to look. Default: the most inflections that any direction shows; in the plane
        the ones there are.

    Returns
    -------
    InflectionCount
        An int, with the attributes ``direction`` (unit vector that shows so many) and ``exact``.

    Raises
    ------
    ValueError
        If neighbouring points are equal, a number is not finite, a shape is wrong, or the direction
        is zero.
    TypeError
        If the curve or the direction is of a wrong kind.

    Notes
    -----
    Gautam, *Shape preservation behavior of spline curves*, sections 4, 5 and 7. Seen along w a
    polygon shows the strict sign changes of w·(L₀×L₁), w·(L₁×L₂), … (Definition 5.4), a curve those
    of w·(γ'×γ''), with corners counted by their turn (5.2). Over all directions, the counts of
    polygons and of curves of polynomial pieces up to degree three are exact maxima: what is seen
    changes only across the great circles normal to Lᵢ×Lᵢ₊₁ (or to γ'×γ'' at knots) and across the
    curve of tangents ±γ', and all of these are walked along. That costs O(n² log n) and memory O(n)
    for n points or pieces, about a second at 2000, and Ctrl-C ends it. Of one spatial cubic the
    count is 2 (Theorem 7.2). ``exact`` is false where rounding may hide directions that show more.
    For other curves in space a direction that shows the count is found among many, and ``exact``
    says that more is not excluded. Along a given direction curves are counted exactly, by certified
    isolation of roots, cost O(n). In the
    plane the count of a Bézier curve whose control polygon is regular (its chords lie in one
    half-plane) never exceeds the polygon's (Corollary 4.5); in space it may. A closed curve is gone
    through once, from its first to its last point.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]]
    >>> ss.inflection_count(points)
    1
    >>> ss.inflection_count(points, direction=[1, 0, 1])
    0
    >>> ss.inflection_count([points])  # as the control points of a cubic
    2
    """
    if _is_array(curve):
        curve = _core._floats("curve", curve)
        if curve.ndim == 2:
            return InflectionCount(*_core._polygon_inflections(curve, direction))
        if curve.ndim != 3:
            raise InputError(
                "curve must be points of shape (n, 2) or (n, 3), or Bézier control points of shape "
                f"(pieces, degree + 1, dim); got shape {curve.shape}",
                "curve",
                value=curve.shape,
            )
        curve = _core.PiecewiseBezier(curve, np.arange(len(curve) + 1.0))
    return InflectionCount(*_core._curve_inflections(piecewise(curve), direction))
